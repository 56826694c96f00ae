#pragma once

#include "ecs/base/math.h"
#include "ecs/components/billboard.h"
#include "render/shaders/particle_gpu.h"

#include <cstdint>
#include <vector>

namespace limn {

// Quads of all Billboards, in the order in which they are added (engine.billboard). The vertex
// shader computes their corners, which depend on the view (lib/billboard.glsl).

/// What particle.vert reads of a quad: texels of four floats.
struct BillboardQuad {
    Vec3 right = {1, 0, 0};  ///< half of its width [m]; only the length counts if it turns
    float alignment = 0;     ///< BillboardAlignment
    Vec3 up = {0, 1, 0};     ///< half of its height [m]
    float frame = 0;
    Vec3 velocity = {0, 0, 0};  ///< [m/s]
    float unused = 0;
};
static_assert(sizeof(BillboardQuad) == 16 * layout::kBillboardTexels);

/// The rest of a quad.
struct BillboardShading {
    Vec3 position = {0, 0, 0};  ///< of its center
    float color_at = 0;         ///< position in the look's colors, 0 .. 1
    float opacity = 1;
    bool is_section = false;  ///< has its own image
};

struct BillboardList {
    std::vector<BillboardQuad> quads{};
    std::vector<BillboardShading> shadings{};  ///< of each quad
};

/// Adds the quads of a billboard at `world`, `time` seconds after its start: one, or two for a
/// composite one. None if it has no extent or a number is not finite. `random` chooses the first
/// frame of a flipbook, unless it plays from frame 0.
void append_billboard(
    const Billboard& billboard, const ParticleLook& look, const Affine& world, double time,
    std::uint32_t random, BillboardList& list);

}  // namespace limn
