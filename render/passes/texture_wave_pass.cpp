#include "render/passes/texture_wave_pass.h"

#include "render/gpu/shader_library.h"

namespace limn {

Result<TextureWavePass> create_texture_wave_pass(gpu::Device& device) {
    const Result<const gpu::Program*> program =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "texture_waves.frag"});
    if (!program) {
        return program.error();
    }
    return TextureWavePass{*program};
}

void draw_texture_waves(FrameGraph& graph, const TextureWavePass& pass, WaterSurfaces& waters) {
    const auto tiles = static_cast<int>(waters.list.details.ends.size());
    if (tiles == 0) {
        return;
    }
    gpu::Texture& slopes = waters.wave_tiles;
    if (!slopes || slopes.layers() < tiles) {
        slopes = gpu::Texture(
            "wave tiles", {.format = GL_RGBA32F,
                           .width = kWaveTileSize,
                           .height = kWaveTileSize,
                           .depth = tiles,
                           .levels = 0,
                           .target = GL_TEXTURE_2D_ARRAY});
        slopes.set_wrap(GL_REPEAT);
    }
    const TextureId target = graph.import("wave tiles", slopes);
    for (int tile = 0; tile < tiles; ++tile) {
        graph.add_pass(
            "texture waves", {}, {target_level(discarded(target), 0, tile)},
            [&pass, &waters, tile](PassContext& context) {
                const std::vector<std::size_t>& ends = waters.list.details.ends;
                const auto i = static_cast<std::size_t>(tile);
                const std::size_t first = i > 0 ? ends[i - 1] : 0;
                context.device().use(gpu::Pipeline{pass.program, gpu::kFullscreenState});
                pass.program->set("first", static_cast<int>(first));
                pass.program->set("count", static_cast<int>(ends[i] - first));
                pass.program->set("texels", static_cast<float>(kWaveTileSize));
                waters.texture_waves.bind(context.device(), 0);
                context.device().draw_fullscreen();
            });
    }
    graph.add_pass("texture waves, smaller", {}, {image(target)}, [&waters](PassContext&) {
        waters.wave_tiles.generate_mipmaps();
    });
}

}  // namespace limn
