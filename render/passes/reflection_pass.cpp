#include "render/passes/reflection_pass.h"

#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"

#include <algorithm>
#include <bit>
#include <string>

namespace limn {
namespace {

constexpr int kSmallestLevel = 16;  ///< [px]; smaller ones show their texels, however blurred
constexpr int kSamples = 256;  ///< of a blurred level at most; the first one is sharp and takes 1
constexpr int kIrradianceFace = 32;  ///< [px] of the level that irradiance is summed from
constexpr unsigned kCubeUnit = 5;
constexpr unsigned kSumsBinding = 0;

/// All levels of one layer; `cube` is null where a function is the sky.
void draw_levels(
    FrameGraph& graph, const ReflectionPass& pass, const FrameScene& scene,
    const gpu::Program& program, const gpu::Texture* cube, int layer, int samples) {
    const TextureId maps = graph.import("reflection map", pass.maps);
    for (int level = 0; level < pass.maps.desc().levels; ++level) {
        graph.add_pass(
            "reflection map", {}, {target_level(discarded(maps), level, layer)},
            [&pass, &scene, &program, cube, level, samples](PassContext& context) {
                context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
                const gpu::RingSlice& block = scene.environment_block;
                context.device().bind_uniforms(
                    kEnvironmentBinding, block.buffer, block.offset, block.size);
                if (cube != nullptr) {
                    context.device().bind_texture(kCubeUnit, *cube);
                }
                const int levels = pass.maps.desc().levels;
                program.set(
                    "roughness",
                    square(static_cast<float>(level) / static_cast<float>(levels - 1)));
                program.set("size", static_cast<float>(pass.maps.width(level)));
                // Levels get smaller faster than their lobes get wider: the few texels can have
                // more.
                const int wanted = samples << std::max(level - 1, 0);
                program.set("samples", level == 0 ? 1 : std::min(wanted, kSamples));
                context.device().draw_fullscreen();
            });
    }
}

}  // namespace

Result<ReflectionPass> create_reflection_pass(gpu::Device& device, int size) {
    LIMN_CHECK(size >= 16 && std::has_single_bit(static_cast<unsigned>(size)));
    ReflectionPass pass;
    for (int kind = 0; kind < kSkyKinds; ++kind) {
        const Result<const gpu::Program*> program = device.shaders().load(
            {.vertex = "fullscreen.vert",
             .fragment = "reflection_map.frag",
             .defines = {{"SKY_KIND", std::to_string(kind)}}});
        if (!program) {
            return program.error();
        }
        pass.programs[kind] = *program;
    }
    const Result<const gpu::Program*> irradiance =
        device.shaders().load({.compute = "irradiance.comp"});
    if (!irradiance) {
        return irradiance.error();
    }
    pass.irradiance_program = *irradiance;
    const int levels = std::bit_width(static_cast<unsigned>(size / kSmallestLevel));
    pass.maps = gpu::Texture(
        "reflection maps", {.format = GL_RGBA32F,
                            .width = size,
                            .height = size,
                            .depth = static_cast<int>(layout::kReflectionLayers),
                            .levels = levels,
                            .target = GL_TEXTURE_2D_ARRAY});
    pass.maps.set_filter(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
    pass.irradiance = gpu::Buffer(
        "irradiance", layout::kReflectionLayers * sizeof(layout::Irradiance),
        gpu::BufferUse::Dynamic);
    return pass;
}

void describe_reflection(const ReflectionPass& pass, layout::EnvironmentBlock& block) {
    block.reflection = {pass.maps.desc().levels, pass.maps.width(), 0, 0};
}

void draw_sky_reflection(FrameGraph& graph, ReflectionPass& pass, const FrameScene& scene) {
    const SkyKind sky = scene.environment.settings.sky;
    if (sky == SkyKind::Panorama) {
        draw_cube_reflection(graph, pass, scene, *scene.environment.cube, 0, kSamples);
        return;
    }
    const layout::Irradiance irradiance = project_irradiance(scene.environment.block);
    pass.irradiance.write(0, std::span(&irradiance, 1));
    draw_levels(graph, pass, scene, *pass.programs[static_cast<int>(sky)], nullptr, 0, kSamples);
}

void draw_cube_reflection(
    FrameGraph& graph, ReflectionPass& pass, const FrameScene& scene, const gpu::Texture& cube,
    int layer, int samples) {
    const gpu::Program& program = *pass.programs[static_cast<int>(SkyKind::Panorama)];
    draw_levels(graph, pass, scene, program, &cube, layer, samples);
    const BufferId sums = graph.import("irradiance", pass.irradiance);
    graph.add_pass("irradiance", {}, {sums}, [&pass, &cube, layer](PassContext& context) {
        const gpu::Program& sum = *pass.irradiance_program;
        context.device().use(sum);
        context.device().bind_texture(kCubeUnit, cube);
        context.device().bind_storage(kSumsBinding, pass.irradiance);
        const auto shrink = static_cast<unsigned>(std::max(cube.width() / kIrradianceFace, 1));
        sum.set("level", static_cast<int>(std::bit_width(shrink)) - 1);
        sum.set("layer", layer);
        context.device().dispatch(1);
        // Passes that are lit read it without saying so.
        glMemoryBarrier(GL_UNIFORM_BARRIER_BIT);
    });
}

}  // namespace limn
