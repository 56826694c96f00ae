#pragma once

#include "content/bake/marker_motion.h"
#include "content/bake/motion/skeleton_motion.h"
#include "ecs/base/result.h"
#include "ecs/components/skeleton.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Joint rotations from markers on the skin (char.marker-to-joint). A joint with three visible
// markers that are not collinear turns by the best rigid fit; with fewer it turns with its parent,
// and then by the shortest arc towards its markers; without any it is as at rest. Bones keep their
// lengths, so markers that slide on the skin leave a residual.

/// Where a marker is.
struct BodyMarker {
    static constexpr std::uint16_t kUnused = 0xffff;
    std::uint16_t joint = kUnused;  ///< that it moves with; kUnused: ignored
    Vec3 position = Vec3(0);        ///< at rest, in the space of the skeleton [m]
};

struct MarkerFit {
    MotionFrames frames;
    float residual = 0;  ///< root mean square distance of visible markers from where they should be
};

/// `markers` has one entry per marker of the take. The topmost joints with markers are moved as
/// well as turned. Fails with one line where no marker is used.
[[nodiscard]] Result<MarkerFit> fit_markers(
    const SkeletonData& skeleton, std::span<const BodyMarker> markers, const MarkerMotion& take);

}  // namespace limn
