#pragma once

#include "ecs/components/dazzle.h"
#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/light/disk_visibility.h"

#include <vector>

namespace limn {

// Dazzles who looks at a point: mixes the image with its color (engine.obfuscating-point).
//
// Reads    radiance, depth; Dazzle with WorldTransform, DirectionalLight
// Writes   radiance, a new texture
// Order    after lens flare, before glare and glow: veiling light within the eye
// Shaders  disk_visibility.frag, dazzle.frag
//
// The weight falls in a straight line from the opacity, where one looks at the point, to 0 at the
// angle. Times the share of the point's disk that nothing hides; outside of the image, where
// nobody knows, it counts as hidden.

/// Share of the color for one who looks by `from_middle` [rad] past the point; 0 where a number is
/// not finite.
[[nodiscard]] float dazzle_weight(const Dazzle& dazzle, float from_middle);

/// A point that dazzles: one texel.
struct DazzlePoint {
    Vec3 color = {0, 0, 0};
    float weight = 0;
};

struct DazzleEffect {
    const gpu::Program* visibility = nullptr;
    const gpu::Program* program = nullptr;
    std::vector<DazzlePoint> points = {};
    std::vector<DiskSource> sources = {};  ///< of each point
    BufferTexture point_records = BufferTexture("dazzling points", GL_RGBA32F);
    BufferTexture source_records = BufferTexture("dazzling disks", GL_RGBA32F);

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<DazzleEffect> create(gpu::Device& device, const RenderSettings&);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData&, ViewData& view);
};

}  // namespace limn
