#include "render/material/texture_layers_pass.h"

#include "ecs/components/texture_layers.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/geometry/surface_draws.h"
#include "render/material/drawn_image.h"
#include "render/material/material_pool.h"
#include "render/shaders/texture_layers_gpu.h"

#include <cmath>

// Techniques: tex.layer-stack

namespace limn {
namespace {

constexpr int kEncode = -1;  // as `blend` of the shader
constexpr int kCopy = -2;

Vec2 scrolled(double time, const Vec2& speed) {
    const auto wrap = [time](float s) {
        const double copies = time * static_cast<double>(s);
        return static_cast<float>(copies - std::floor(copies));
    };
    return {wrap(speed.x), wrap(speed.y)};
}

float turned(double time, float speed) {
    constexpr double kTurn = 6.283185307179586;
    return static_cast<float>(std::fmod(time * static_cast<double>(speed), kTurn));
}

/// Of the wave of a layer [rad/s].
constexpr float kWaveSpeed = 3.0f;

void set_layer_uniforms(const gpu::Program& shader, const TextureLayer& layer, double time) {
    shader.set("blend", static_cast<int>(layer.blend));
    shader.set("inverted", layer.inverted ? 1 : 0);
    shader.set("factor", layer.factor);
    shader.set("scale", layer.scale);
    shader.set("scroll", scrolled(time, layer.scroll));
    shader.set("angle", turned(time, layer.spin));
    shader.set("wave", Vec2(layer.wave, turned(time, kWaveSpeed)));
}

/// The stack as a texture of the size of its target.
TextureId draw_stack(
    FrameGraph& graph, const FrameData& frame, const TextureLayersEffect& effect,
    const TextureLayers& stack, const IVec2& size) {
    const ImagePool& images = frame.materials->images();
    TextureId below = create_target(graph, "layers", GL_RGBA16F, size);
    graph.add_pass("layers, black", {}, {cleared(below)}, [](PassContext&) {});
    for (const TextureLayer& layer : stack.layers) {
        const gpu::Texture* image = images.find_texture(layer.image);
        const gpu::Texture* map = images.find_texture(layer.map);
        if (image == nullptr || layer.image == stack.target || layer.map == stack.target
            || (layer.blend == LayerBlend::Map && map == nullptr)) {
            continue;
        }
        map = map != nullptr ? map : image;
        const TextureId above = create_target(graph, "layers", GL_RGBA16F, size);
        add_fullscreen_pass(
            graph, "layer",
            {sampled(graph.import("layer", *image), layout::kLayerUnit, &effect.repeat),
             sampled(graph.import("layer map", *map), layout::kLayerMapUnit, &effect.repeat),
             sampled(below, layout::kLayersBelowUnit)},
            {discarded(above)}, effect.program,
            [layer, size, time = frame.time](PassContext&, const gpu::Program& shader) {
                shader.set("size", Vec2(size));
                set_layer_uniforms(shader, layer, time);
            });
        below = above;
    }
    return below;
}

}  // namespace

Result<TextureLayersEffect>
TextureLayersEffect::create(gpu::Device& device, const RenderSettings&) {
    return TextureLayersEffect{
        LIMN_TRY(load_fullscreen(device, "texture_layers.frag")),
        gpu::Sampler("layers", {.minify = GL_LINEAR})};
}

bool TextureLayersEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const TextureLayers>().empty();
}

void TextureLayersEffect::collect(FrameData& frame) {
    const ImagePool& images = frame.materials->images();
    auto& drawn = frame.data.publish<LayeredImages>();
    drawn.arrays.clear();
    frame.world->query<const TextureLayers>().each([&](const TextureLayers& stack) {
        drawn.arrays.push_back(&images.array(find_drawn_image(images, stack.target).array));
    });
}

void TextureLayersEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    const ImagePool& images = frame.materials->images();
    frame.world->query<const TextureLayers>().each([&](const TextureLayers& stack) {
        const ImageLayer target = find_drawn_image(images, stack.target);
        if (target.array == 0) {
            return;
        }
        const gpu::Texture& array = images.array(target.array);
        const IVec2 size = {array.width(), array.height()};
        const TextureId top = draw_stack(graph, frame, *this, stack, size);
        const TextureId drawn = create_drawn_image(graph, images, target);
        add_fullscreen_pass(
            graph, "layers, stored",
            {sampled(top, layout::kLayerUnit), sampled(top, layout::kLayerMapUnit),
             sampled(top, layout::kLayersBelowUnit)},
            {target_level(discarded(drawn), 0)}, program,
            [&array](PassContext&, const gpu::Program& shader) {
                const bool encoded = array.desc().format == GL_SRGB8_ALPHA8;
                shader.set("size", Vec2(1));
                shader.set("blend", encoded ? kEncode : kCopy);
            });
        store_drawn_image(graph, images, drawn, target);
    });
}

}  // namespace limn
