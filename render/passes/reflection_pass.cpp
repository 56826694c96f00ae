#include "render/passes/reflection_pass.h"

#include "render/gpu/shader_library.h"

#include <bit>
#include <string>

namespace limn {
namespace {

constexpr int kSmallestLevel = 16;  ///< [px]; smaller ones show their texels, however blurred
constexpr int kSamples = 256;       ///< of a blurred level; the first one is sharp and takes 1

}  // namespace

Result<ReflectionPass> create_reflection_pass(gpu::Device& device, int size) {
    LIMN_CHECK(size >= 16 && std::has_single_bit(static_cast<unsigned>(size)));
    ReflectionPass pass;
    for (int kind = 0; kind < 3; ++kind) {
        const Result<const gpu::Program*> program = device.shaders().load(
            {.vertex = "fullscreen.vert",
             .fragment = "reflection_map.frag",
             .defines = {{"SKY_KIND", std::to_string(kind)}}});
        if (!program) {
            return program.error();
        }
        pass.programs[kind] = *program;
    }
    const int levels = std::bit_width(static_cast<unsigned>(size / kSmallestLevel));
    pass.map = gpu::Texture(
        "reflection map", {.format = GL_RGBA32F, .width = size, .height = size, .levels = levels});
    pass.map.set_filter(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
    return pass;
}

void describe_reflection(const ReflectionPass& pass, layout::EnvironmentBlock& block) {
    block.reflection = {pass.map.desc().levels, pass.map.width(), 0, 0};
}

void draw_reflection(FrameGraph& graph, const ReflectionPass& pass, const FrameScene& scene) {
    const TextureId map = graph.import("reflection map", pass.map);
    for (int level = 0; level < pass.map.desc().levels; ++level) {
        graph.add_pass(
            "reflection map",
            {},
            {target_level(discarded(map), level)},
            [&pass, &scene, level](PassContext& context) {
                const auto kind = static_cast<int>(scene.environment.settings.sky);
                const gpu::Program& program = *pass.programs[kind];
                context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
                const gpu::RingSlice& block = scene.environment_block;
                context.device().bind_uniforms(
                    kEnvironmentBinding, block.buffer, block.offset, block.size);
                const int levels = pass.map.desc().levels;
                program.set(
                    "roughness",
                    square(static_cast<float>(level) / static_cast<float>(levels - 1)));
                program.set("size", static_cast<float>(pass.map.width(level)));
                program.set("samples", level == 0 ? 1 : kSamples);
                context.device().draw_fullscreen();
            });
    }
}

}  // namespace limn
