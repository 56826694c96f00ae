#pragma once

#include "render/environment_light.h"
#include "render/frame_scene.h"
#include "render/gpu/buffer.h"
#include "render/graph/frame_graph.h"

namespace limn {

// Makes what surfaces need to know of their surroundings, a layer each of the sky and of every
// probe: for mirrors an octahedral map, blurred more level by level, for diffuse surfaces the
// irradiance.
//
// Reads    environment, the sky's or a probe's cube map
// Writes   reflection maps, RGBA32F with mip levels, and irradiance
// Order    before everything that is lit, when the surroundings have changed
// Shaders  reflection_map.frag, irradiance.comp, lib/reflection_map.glsl, lib/sky.glsl
//
// 32-bit floats because a software OpenGL filters them 1.6 times faster than half floats.

struct ReflectionPass {
    const gpu::Program* programs[kSkyKinds] = {};  ///< by SkyKind; cube maps are Panorama's
    const gpu::Program* irradiance_program = nullptr;
    gpu::Texture maps;       ///< a layer each
    gpu::Buffer irradiance;  ///< layout::Irradiance of each layer
};

/// `size`: of level 0 [px], a power of two >= 16.
[[nodiscard]] Result<ReflectionPass> create_reflection_pass(gpu::Device& device, int size);

/// Fills the block's `reflection` field.
void describe_reflection(const ReflectionPass& pass, layout::EnvironmentBlock& block);

/// Makes layer 0 of the scene's sky: its function or, of a Panorama, its cube map.
void draw_sky_reflection(FrameGraph& graph, ReflectionPass& pass, const FrameScene& scene);

/// Makes `layer` of a cube map whose mip levels are filled. `samples`: of a texel of the least
/// blurred level; each further one has twice as many, at most 256.
void draw_cube_reflection(
    FrameGraph& graph, ReflectionPass& pass, const FrameScene& scene, const gpu::Texture& cube,
    int layer, int samples);

}  // namespace limn
