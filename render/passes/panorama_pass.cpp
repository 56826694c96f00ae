#include "render/passes/panorama_pass.h"

#include "render/cube_map.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"

#include <algorithm>
#include <bit>

namespace limn {
namespace {

constexpr int kSmallestFace = 16;  ///< [px]

int face_size(const PanoramaPass& pass, int panorama_width) {
    const auto quarter = static_cast<unsigned>(std::max(panorama_width / 4, 1));
    return std::clamp(static_cast<int>(std::bit_ceil(quarter)), kSmallestFace, pass.max_face);
}

}  // namespace

Result<PanoramaPass> create_panorama_pass(gpu::Device& device) {
    const Result<const gpu::Program*> program =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "panorama_pass.frag"});
    if (!program) {
        return program.error();
    }
    PanoramaPass pass;
    pass.program = *program;
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
                context.device().bind_texture(kGbufferUnit, panorama, &pass.sampler);
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

}  // namespace limn
