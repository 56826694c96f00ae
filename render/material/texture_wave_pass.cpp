#include "render/material/texture_wave_pass.h"

#include "render/fullscreen.h"
#include "render/shaders/water_detail_gpu.h"
#include "render/water/water_surfaces.h"

// Techniques: water.geometric-texture-split

namespace limn {

void draw_texture_waves(
    FrameGraph& graph, const gpu::Program* program, gpu::Texture& tiles,
    const WaterSurfaces& waters) {
    const std::vector<std::size_t>& ends = waters.list.details.ends;
    const auto count = static_cast<int>(ends.size());
    if (count == 0) {
        return;
    }
    if (!tiles || tiles.layers() < count) {
        tiles = gpu::Texture(
            "wave tiles", {.format = GL_RGBA32F,
                           .width = kWaveTileSize,
                           .height = kWaveTileSize,
                           .depth = count,
                           .levels = 0,
                           .target = GL_TEXTURE_2D_ARRAY});
        tiles.set_wrap(GL_REPEAT);
    }
    const TextureId target = graph.import("wave tiles", tiles);
    std::size_t first = 0;
    for (int tile = 0; tile < count; ++tile) {
        const std::size_t end = ends[static_cast<std::size_t>(tile)];
        add_fullscreen_pass(
            graph, "texture waves", {}, {target_level(discarded(target), 0, tile)}, program,
            [&waters, first, end](PassContext& context, const gpu::Program& waves) {
                waves.set("first", static_cast<int>(first));
                waves.set("count", static_cast<int>(end - first));
                waves.set("texels", static_cast<float>(kWaveTileSize));
                waters.texture_waves.bind(context.device(), layout::kTextureWavesUnit);
            });
        first = end;
    }
    graph.add_pass("texture waves, smaller", {}, {image(target)}, [&tiles](PassContext&) {
        tiles.generate_mipmaps();
    });
}

}  // namespace limn
