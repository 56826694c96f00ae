#pragma once

#include "ecs/components/dazzle.h"
#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/light/disk_visibility.h"

#include <vector>

namespace limn {

// Dazzles the viewer of a bright point: mixes the image with its color (engine.obfuscating-point).
//
// Reads    radiance, depth; Dazzle with WorldTransform, DirectionalLight
// Writes   radiance, a new texture
// Order    after lens flare, before glare and glow: veiling light within the eye
// Shaders  disk_visibility.frag, dazzle.frag
//
// The weight falls off linearly from the opacity, for a view straight at the point, to 0 at
// Dazzle::angle. It is multiplied by the visible fraction of the point's disk; outside the image,
// where visibility is unknown, the disk counts as occluded.

/// Weight of the color for a view axis `off_axis` [rad] from the point; 0 where a number is not
/// finite.
[[nodiscard]] float dazzle_weight(const Dazzle& dazzle, float off_axis);

/// A dazzling point: one texel.
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
