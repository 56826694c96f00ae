#pragma once

#include "ecs/components/environment.h"
#include "render/environment/environment_light.h"
#include "render/gpu/buffer.h"
#include "render/gpu/ring_buffer.h"
#include "render/gpu/texture.h"
#include "render/graph/frame_graph.h"

namespace limn {

// Environment maps for lighting surfaces: a panorama of any mapping becomes a cube map; the sky,
// and each environment probe (probe_pass.h), becomes one layer of an octahedral reflection map,
// prefiltered per mip level, for specular surfaces and SH irradiance for diffuse ones.
//
// Reads    Environment and its image; cube maps of probes
// Writes   sky cube, RGBA16F with all mip levels; reflection maps, RGBA32F with mip levels;
//          irradiance
// Order    before lighting, when the environment has changed
// Shaders  panorama_pass.frag, reflection_map.frag, irradiance.comp, lib/panorama.glsl,
//          lib/cube_map.glsl, lib/reflection_map.glsl, lib/sky.glsl
//
// A face of the sky cube is as wide as a quarter of the panorama, rounded up to a power of two, so
// no detail is lost near the horizon. Radiance is clamped to 65504, the largest half float.
// Reflection maps are 32-bit floats because a software OpenGL filters them 1.6 times faster than
// half floats.

struct PanoramaPass {
    const gpu::Program* program = nullptr;
    gpu::Sampler sampler;  ///< repeats horizontally
    gpu::Texture cube;     ///< sized for the last panorama
    int max_face = 1024;   ///< [px]
};

[[nodiscard]] Result<PanoramaPass> create_panorama_pass(gpu::Device& device);

/// Fills `pass.cube` from `panorama`, as `environment` maps it.
void draw_panorama(
    FrameGraph& graph, PanoramaPass& pass, const gpu::Texture& panorama,
    const Environment& environment);

/// Adds a pass that fills levels 1 .. n of a cube map.
void draw_cube_levels(FrameGraph& graph, const gpu::Texture& cube);

struct ReflectionPass {
    const gpu::Program* programs[kSkyKinds] = {};  ///< by SkyKind; cube maps are Panorama's
    const gpu::Program* irradiance_program = nullptr;
    gpu::Texture maps;       ///< one layer each
    gpu::Buffer irradiance;  ///< layout::Irradiance of each layer
};

/// `size`: of level 0 [px], a power of two >= 16.
[[nodiscard]] Result<ReflectionPass> create_reflection_pass(gpu::Device& device, int size);

/// Fills the block's `reflection` field.
void describe_reflection(const ReflectionPass& pass, layout::EnvironmentBlock& block);

/// The surroundings of a frame, published by EnvironmentEffect.
struct SceneEnvironment {
    Environment settings;
    layout::EnvironmentBlock block{};
    gpu::RingSlice block_slice;            ///< the same, uploaded
    const gpu::Texture* sky = nullptr;     ///< cube of a Panorama, table of an Atmosphere
    const SkyView* sky_view = nullptr;     ///< of an Atmosphere
    ReflectionPass* reflection = nullptr;  ///< whose layers probes fill, too
    bool changed = false;                  ///< since the previous frame: probes are out of date
};

/// Fills layer 0 from the scene's sky: its function, its table or, for a Panorama, its cube map.
void draw_sky_reflection(
    FrameGraph& graph, ReflectionPass& pass, const SceneEnvironment& environment);

/// Fills `layer` from a cube map with a full mip chain. `samples`: per texel of the least blurred
/// level; each further one has twice as many, at most 256. `block`: the uploaded environment block.
void draw_cube_reflection(
    FrameGraph& graph, ReflectionPass& pass, const gpu::RingSlice& block, const gpu::Texture& cube,
    int layer, int samples);

}  // namespace limn
