#include "render/material/texture_combine_pass.h"

#include "ecs/components/texture_combine.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/geometry/surface_draws.h"
#include "render/material/drawn_image.h"
#include "render/material/material_pool.h"
#include "render/shaders/texture_combine_gpu.h"

#include <cmath>

// Techniques: tex.combine

namespace limn {
namespace {

float wrapped(double copies) {
    return static_cast<float>(copies - std::floor(copies));
}

}  // namespace

Result<TextureCombineEffect>
TextureCombineEffect::create(gpu::Device& device, const RenderSettings&) {
    return TextureCombineEffect{
        LIMN_TRY(load_fullscreen(device, "texture_combine.frag")),
        gpu::Sampler("combined", {.minify = GL_LINEAR})};
}

bool TextureCombineEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const TextureCombine>().empty();
}

void TextureCombineEffect::collect(FrameData& frame) {
    const ImagePool& images = frame.materials->images();
    auto& drawn = frame.data.publish<DrawnImages>();
    drawn.arrays.clear();
    frame.world->query<const TextureCombine>().each([&](const TextureCombine& combine) {
        drawn.arrays.push_back(&images.array(find_drawn_image(images, combine.target).array));
    });
}

void TextureCombineEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    const ImagePool& images = frame.materials->images();
    frame.world->query<const TextureCombine>().each([&](const TextureCombine& combine) {
        const gpu::Texture* water = images.find_texture(combine.water);
        const gpu::Texture* grating = images.find_texture(combine.grating);
        const ImageLayer target = find_drawn_image(images, combine.target);
        if (water == nullptr || grating == nullptr || target.array == 0
            || combine.target == combine.water || combine.target == combine.grating) {
            return;
        }
        const auto array_of = [&](ImageId image) {
            return graph.import("images", images.array(images.find(image).array));
        };
        const Vec2 offset(
            wrapped(frame.time * static_cast<double>(combine.speed.x)),
            wrapped(frame.time * static_cast<double>(combine.speed.y)));
        const gpu::Texture& array = images.array(target.array);
        const TextureId combined = create_drawn_image(graph, images, target);
        add_fullscreen_pass(
            graph, "combine textures",
            {array_of(combine.water), array_of(combine.grating),
             sampled(graph.import("combined image", *water), layout::kCombinedWaterUnit, &repeat),
             sampled(
                 graph.import("combined image", *grating), layout::kCombinedGratingUnit, &repeat)},
            {target_level(discarded(combined), 0)}, program,
            [&array, offset, gain = combine.gain](PassContext&, const gpu::Program& shader) {
                shader.set("size", Vec2(array.width(), array.height()));
                shader.set("offset", offset);
                shader.set("gain", gain);
                shader.set("encoded", array.desc().format == GL_SRGB8_ALPHA8 ? 1 : 0);
            });
        store_drawn_image(graph, images, combined, target);
    });
}

}  // namespace limn
