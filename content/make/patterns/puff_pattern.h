#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

/// A flipbook of a cloud that swells and frays, rendered from a volume: white with its opacity, and
/// the light that it scatters toward the viewer from six sides (PatternMaps::positive_light), for
/// ParticleLook::negative_light.
struct PuffPattern {
    PatternSize image;
    int frames = 4;
    float lumps = 0.5f;
    float density = 9;
    float fray = 0.6f;
};

LIMN_FIELDS(PuffPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(lumps, "height of its lumps / radius", "", 0, 1);
    LIMN_FIELD(density, "optical depth across half a frame", "", 0.1, 100);
    LIMN_FIELD(fray, "how much has dissolved in the last frame", "", 0, 1);
}

[[nodiscard]] PatternMaps make_puff(const PuffPattern& pattern);

}  // namespace limn
