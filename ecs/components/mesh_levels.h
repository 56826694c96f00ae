#pragma once

#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <vector>

namespace limn {

/// Levels of detail: chooses the entity's mesh by its size on screen (anim.bezier-patch-lod). Each
/// level has twice as many quads along a side as the one before.
struct MeshLevels {
    std::vector<MeshId> meshes;
    float span = 1.0f;
    float pixels_per_quad = 8.0f;
    float drawn_from = 0.0f;
};

LIMN_FIELDS(MeshLevels) {
    LIMN_FIELD(meshes, "meshes of the level, by name, from coarse to fine");
    LIMN_FIELD(span, "length that the single quad of the coarsest mesh spans", "m", 1e-6, 1e6);
    LIMN_FIELD(
        pixels_per_quad, "wanted length of a quad in an image of rendering.level_rows, 1080", "px",
        0.1, 10000);
    LIMN_FIELD(
        drawn_from,
        "length of `span` in such an image below which the entity is not drawn, as the teeth of a "
        "face far away",
        "px", 0, 10000);
}

}  // namespace limn
