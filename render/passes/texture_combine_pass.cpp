#include "render/passes/texture_combine_pass.h"

#include "ecs/components/texture_combine.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/material_pool.h"
#include "render/surface_draws.h"

#include <cmath>

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
    auto& drawn = frame.data.publish<DrawnImages>();
    drawn.textures.clear();
    frame.world->query<const TextureCombine>().each([&](const TextureCombine& combine) {
        if (const gpu::Texture* texture = frame.materials->find_image(combine.target)) {
            drawn.textures.push_back(texture);
        }
    });
}

void TextureCombineEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    frame.world->query<const TextureCombine>().each([&](const TextureCombine& combine) {
        const gpu::Texture* water = frame.materials->find_image(combine.water);
        const gpu::Texture* grating = frame.materials->find_image(combine.grating);
        const gpu::Texture* texture = frame.materials->find_image(combine.target);
        if (water == nullptr || grating == nullptr || texture == nullptr || texture == water
            || texture == grating) {
            return;
        }
        const Vec2 offset(
            wrapped(frame.time * static_cast<double>(combine.speed.x)),
            wrapped(frame.time * static_cast<double>(combine.speed.y)));
        const TextureId target = graph.import("combined texture", *texture);
        add_fullscreen_pass(
            graph, "combine textures",
            {sampled(graph.import("combined image", *water), 0, &repeat),
             sampled(graph.import("combined image", *grating), 1, &repeat)},
            {target_level(discarded(target), 0)}, program,
            [texture, offset, gain = combine.gain](PassContext&, const gpu::Program& its) {
                its.set("size", Vec2(texture->width(), texture->height()));
                its.set("offset", offset);
                its.set("gain", gain);
                its.set("encoded", texture->desc().format == GL_SRGB8_ALPHA8 ? 1 : 0);
            });
        graph.add_pass("combined textures, smaller", {}, {image(target)}, [texture](PassContext&) {
            glGenerateTextureMipmap(texture->id());
        });
    });
}

}  // namespace limn
