#include "render/environment/environment_maps.h"

#include "render/environment/cube_map.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/lighting.h"
#include "render/shaders/environment_gpu.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

// Techniques: env.angular-map

namespace limn {
namespace {

constexpr int kMinMapFace = 16;  ///< [px]

int face_size(const PanoramaPass& pass, int panorama_width) {
    const auto quarter = static_cast<unsigned>(std::max(panorama_width / 4, 1));
    return std::clamp(static_cast<int>(std::bit_ceil(quarter)), kMinMapFace, pass.max_face);
}

constexpr int kMinLevel = 16;  ///< [px]; texels of smaller levels become visible, however blurred
constexpr int kMaxMapSamples = 256;  ///< maximum per texel; level 0 is sharp and takes 1
constexpr int kIrradianceFace =
    32;  ///< [px] of the cube map level that irradiance is integrated from

/// All levels of one layer; `source`: a cube map or the table of an atmosphere, null for a sky that
/// is a function.
void draw_levels(
    FrameGraph& graph, const ReflectionPass& pass, const gpu::RingSlice& block,
    const gpu::Program& program, const gpu::Texture* source, int layer, int samples) {
    const TextureId maps = graph.import("reflection map", pass.maps);
    std::vector<Use> reads;
    if (source != nullptr) {
        reads.emplace_back(graph.import("sky", *source));
    }
    for (int level = 0; level < pass.maps.desc().levels; ++level) {
        graph.add_pass(
            "reflection map", reads, std::array{target_level(discarded(maps), level, layer)},
            [&pass, block, &program, source, level, samples](PassContext& context) {
                context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
                context.device().bind_uniforms(
                    layout::kEnvironmentBinding, block.buffer, block.offset, block.size);
                if (source != nullptr) {
                    context.device().bind_texture(layout::kSkyCubeUnit, *source);
                }
                const int levels = pass.maps.desc().levels;
                program.set(
                    "roughness",
                    square(static_cast<float>(level) / static_cast<float>(levels - 1)));
                program.set("size", static_cast<float>(pass.maps.width(level)));
                // Levels shrink faster than their lobes widen: fewer texels afford more samples.
                const int doubled = samples << std::max(level - 1, 0);
                program.set("samples", level == 0 ? 1 : std::min(doubled, kMaxMapSamples));
                context.device().draw_fullscreen();
            });
    }
}

}  // namespace

Result<PanoramaPass> create_panorama_pass(gpu::Device& device) {
    PanoramaPass pass;
    pass.program = LIMN_TRY(
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "panorama_pass.frag"}));
    pass.sampler = gpu::Sampler("panorama", {.minify = GL_LINEAR_MIPMAP_LINEAR});
    glSamplerParameteri(pass.sampler.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return pass;
}

void draw_panorama(
    FrameGraph& graph, PanoramaPass& pass, const gpu::Texture& panorama,
    const Environment& environment) {
    const int size = face_size(pass, panorama.width());
    if (!pass.cube || pass.cube.width() != size) {
        pass.cube = gpu::Texture(
            "sky cube", {.format = GL_RGBA16F,
                         .width = size,
                         .height = size,
                         .levels = 0,
                         .target = GL_TEXTURE_CUBE_MAP});
    }
    const TextureId cube = graph.import("sky cube", pass.cube);
    for (int face = 0; face < kCubeFaces; ++face) {
        graph.add_pass(
            "panorama", {}, {target_level(discarded(cube), 0, face)},
            [&pass, &panorama, environment, face, size](PassContext& context) {
                const gpu::Program& program = *pass.program;
                context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
                context.device().bind_texture(layout::kSkyCubeUnit, panorama, &pass.sampler);
                program.set("face", face);
                program.set("size", static_cast<float>(size));
                program.set("mapping", static_cast<int>(environment.mapping));
                program.set("half_angle", environment.half_angle);
                program.set(
                    "turn", Vec2(std::cos(environment.rotation), std::sin(environment.rotation)));
                const float shrink =
                    static_cast<float>(panorama.width()) / static_cast<float>(4 * size);
                program.set("level", std::max(std::log2(shrink), 0.0f));
                program.set("intensity", environment.intensity);
                context.device().draw_fullscreen();
            });
    }
    draw_cube_levels(graph, pass.cube);
}

void draw_cube_levels(FrameGraph& graph, const gpu::Texture& cube) {
    const TextureId id = graph.import("cube levels", cube);
    graph.add_pass("cube levels", {}, {image(id)}, [&cube](PassContext&) {
        glGenerateTextureMipmap(cube.id());
    });
}

Result<ReflectionPass> create_reflection_pass(gpu::Device& device, int size) {
    LIMN_CHECK(size >= 16 && std::has_single_bit(static_cast<unsigned>(size)));
    ReflectionPass pass;
    for (int kind = 0; kind < kSkyKinds; ++kind) {
        pass.programs[kind] = LIMN_TRY(device.shaders().load(
            {.vertex = "fullscreen.vert",
             .fragment = "reflection_map.frag",
             .defines = {{"SKY_KIND", std::to_string(kind)}}}));
    }
    pass.irradiance_program = LIMN_TRY(device.shaders().load({.compute = "irradiance.comp"}));
    const int levels = std::bit_width(static_cast<unsigned>(size / kMinLevel));
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

void draw_sky_reflection(
    FrameGraph& graph, ReflectionPass& pass, const SceneEnvironment& environment) {
    const SkyKind sky = environment.settings.sky;
    if (sky == SkyKind::Panorama) {
        draw_cube_reflection(
            graph, pass, environment.block_slice, *environment.sky, 0, kMaxMapSamples);
        return;
    }
    const layout::Irradiance irradiance =
        project_irradiance(environment.block, environment.sky_view);
    pass.irradiance.write(0, std::span(&irradiance, 1));
    draw_levels(
        graph, pass, environment.block_slice, *pass.programs[static_cast<int>(sky)],
        environment.sky, 0, kMaxMapSamples);
}

void draw_cube_reflection(
    FrameGraph& graph, ReflectionPass& pass, const gpu::RingSlice& block, const gpu::Texture& cube,
    int layer, int samples) {
    const gpu::Program& program = *pass.programs[static_cast<int>(SkyKind::Panorama)];
    draw_levels(graph, pass, block, program, &cube, layer, samples);
    const BufferId sums = graph.import("irradiance", pass.irradiance);
    const TextureId source = graph.import("cube levels", cube);
    graph.add_pass(
        "irradiance", {source}, {sums}, [&pass, &cube, sums, layer](PassContext& context) {
            const gpu::Program& sum = *pass.irradiance_program;
            context.device().use(sum);
            context.device().bind_texture(layout::kSkyCubeUnit, cube);
            context.bind_storage(layout::kIrradianceSumsBinding, sums);
            const auto shrink = static_cast<unsigned>(std::max(cube.width() / kIrradianceFace, 1));
            sum.set("level", static_cast<int>(std::bit_width(shrink)) - 1);
            sum.set("layer", layer);
            context.device().dispatch(1);
        });
}

}  // namespace limn
