#pragma once

#include "render/frame_scene.h"
#include "render/graph/frame_graph.h"

namespace limn {

// Makes what mirrors show of the surroundings: an octahedral map, blurred more level by level.
//
// Reads    environment
// Writes   reflection map, RGBA32F with mip levels
// Order    before everything that is lit, when the environment has changed
// Shaders  reflection_map.frag, lib/reflection_map.glsl, lib/sky.glsl
//
// 32-bit floats because a software OpenGL filters them 1.6 times faster than half floats.

struct ReflectionPass {
    const gpu::Program* programs[3] = {};  ///< by SkyKind
    gpu::Texture map;
};

/// `size`: of level 0 [px], a power of two >= 16.
[[nodiscard]] Result<ReflectionPass> create_reflection_pass(gpu::Device& device, int size);

/// Fills the block's `reflection` field.
void describe_reflection(const ReflectionPass& pass, layout::EnvironmentBlock& block);

void draw_reflection(FrameGraph& graph, const ReflectionPass& pass, const FrameScene& scene);

}  // namespace limn
