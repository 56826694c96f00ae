#include "render/passes/texture_combine_pass.h"

#include "ecs/components/texture_combine.h"
#include "ecs/world.h"
#include "render/gpu/shader_library.h"

#include <cmath>

namespace limn {

namespace {

float wrapped(double copies) {
    return static_cast<float>(copies - std::floor(copies));
}

}  // namespace

Result<TextureCombinePass> create_texture_combine_pass(gpu::Device& device) {
    const Result<const gpu::Program*> program =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "texture_combine.frag"});
    if (!program) {
        return program.error();
    }
    return TextureCombinePass{*program, gpu::Sampler("combined", {.minify = GL_LINEAR})};
}

int combine_textures(
    FrameGraph& graph, const TextureCombinePass& pass, const World& world,
    const MaterialPool& materials, double time) {
    int count = 0;
    world.query<const TextureCombine>().each([&](const TextureCombine& combine) {
        const gpu::Texture* water = materials.find_image(combine.water);
        const gpu::Texture* grating = materials.find_image(combine.grating);
        const gpu::Texture* texture = materials.find_image(combine.target);
        if (water == nullptr || grating == nullptr || texture == nullptr || texture == water
            || texture == grating) {
            return;
        }
        ++count;
        const Vec2 offset(
            wrapped(time * static_cast<double>(combine.speed.x)),
            wrapped(time * static_cast<double>(combine.speed.y)));
        const TextureId target = graph.import("combined texture", *texture);
        graph.add_pass(
            "combine textures", {}, {target_level(discarded(target), 0)},
            [&pass, water, grating, texture, offset, gain = combine.gain](PassContext& context) {
                context.device().use(gpu::Pipeline{pass.program, gpu::kFullscreenState});
                context.device().bind_texture(0, *water, &pass.repeat);
                context.device().bind_texture(1, *grating, &pass.repeat);
                pass.program->set("size", Vec2(texture->width(), texture->height()));
                pass.program->set("offset", offset);
                pass.program->set("gain", gain);
                pass.program->set("encoded", texture->desc().format == GL_SRGB8_ALPHA8 ? 1 : 0);
                context.device().draw_fullscreen();
            });
        graph.add_pass("combined textures, smaller", {}, {image(target)}, [texture](PassContext&) {
            glGenerateTextureMipmap(texture->id());
        });
    });
    return count;
}

}  // namespace limn
