#include "render/material/wrinkle_maps_pass.h"

#include "ecs/components/wrinkle_ladder.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/components/wrinkle_response.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/geometry/surface_draws.h"
#include "render/material/drawn_image.h"
#include "render/material/material_pool.h"
#include "render/shaders/wrinkle_maps_gpu.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>

// Techniques: skin.pipeline, wrinkle.maps.composite, wrinkle.maps.texture-set, wrinkle.maps.weights

namespace limn {
namespace {

/// Scale and offset from texels of a wrinkle map to normals; 128 of 255 is exactly flat.
Vec2 decoding_of(const gpu::Texture& map) {
    return map.desc().format == GL_RGBA8 ? Vec2(255, -128) / 127.0f : Vec2(2, -1);
}

}  // namespace

Result<WrinkleMapsEffect> WrinkleMapsEffect::create(gpu::Device& device, const RenderSettings&) {
    return WrinkleMapsEffect{
        LIMN_TRY(load_fullscreen(device, "wrinkle_maps.frag")),
        gpu::Sampler("texels of wrinkle maps", {.minify = GL_LINEAR, .magnify = GL_LINEAR})};
}

bool WrinkleMapsEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const WrinkleMaps>().empty();
}

void WrinkleMapsEffect::collect(FrameData& frame) {
    const ImagePool& images = frame.materials->images();
    auto& wrinkled = frame.data.publish<WrinkledImages>();
    wrinkled.arrays.clear();
    frame.world->query<const WrinkleMaps>().each([&](const WrinkleMaps& maps) {
        wrinkled.arrays.push_back(&images.array(find_drawn_image(images, maps.target).array));
    });
}

void WrinkleMapsEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    const ImagePool& images = frame.materials->images();
    const auto draw = [&](Entity entity, const WrinkleMaps& maps) {
        const auto* const response = frame.world->find<WrinkleResponse>(entity);
        const auto* const measured = frame.world->find<MeasuredWrinkles>(entity);
        const bool measures = response != nullptr && measured != nullptr;
        const WrinkleWeights* const weights =
            measures ? &measured->weights : frame.world->find<WrinkleWeights>(entity);
        const auto* const found = frame.world->find<WrinkleRungs>(entity);
        const WrinkleRungs rungs = found != nullptr ? *found : WrinkleRungs{};
        // Where the surface measures no strain, regions have the whole influence.
        const float strength =
            rungs.maps * (measures ? glm::mix(1.0f, response->share, rungs.strain) : 1.0f);
        const auto has = [&](ImageId masks) { return images.find_texture(masks) != nullptr; };
        const std::array<ImageId, 6> sources = {
            maps.base,
            maps.stretched,
            maps.compressed,
            maps.first_masks,
            has(maps.second_masks) ? maps.second_masks : maps.first_masks,
            has(maps.third_masks) ? maps.third_masks : maps.first_masks};
        const ImageLayer target = find_drawn_image(images, maps.target);
        const auto is_unfit = [&](ImageId source) {
            return images.find_texture(source) == nullptr || source == maps.target
                   || !have_one_aspect(
                       frame.assets->images[source.index], frame.assets->images[maps.target.index]);
        };
        if (target.array == 0 || std::ranges::any_of(sources, is_unfit)) {
            return;
        }
        const auto read = [&](unsigned i) {
            const gpu::Texture& texture = *images.find_texture(sources[i]);
            return sampled(
                graph.import("wrinkle map", texture), layout::kWrinkleBaseUnit + i, &texels);
        };
        const auto array_of = [&](unsigned i) {
            return graph.import("images", images.array(images.find(sources[i]).array));
        };
        const gpu::Texture& array = images.array(target.array);
        const TextureId composed = create_drawn_image(graph, images, target);
        const std::array<float, kWrinkleRegions.size()> set =
            weights != nullptr ? region_weights(*weights)
                               : std::array<float, kWrinkleRegions.size()>{};
        const Vec4 first = {set[0], set[1], set[2], set[3]};
        const Vec4 second = has(maps.second_masks) ? Vec4(set[4], set[5], set[6], set[7]) : Vec4(0);
        const float third = has(maps.third_masks) ? set[8] : 0.0f;
        const Vec4 decoding = {
            decoding_of(*images.find_texture(maps.stretched)),
            decoding_of(*images.find_texture(maps.compressed))};
        const bool by_slopes = maps.blend == WrinkleBlend::Slopes;
        add_fullscreen_pass(
            graph, "wrinkle maps",
            {array_of(0), array_of(1), array_of(2), array_of(3), array_of(4), array_of(5), read(0),
             read(1), read(2), read(3), read(4), read(5)},
            {target_level(discarded(composed), 0)}, program,
            [&array, first, second, third, decoding, by_slopes,
             strength](PassContext&, const gpu::Program& shader) {
                shader.set("size", Vec2(array.width(), array.height()));
                shader.set("first_weights", first);
                shader.set("second_weights", second);
                shader.set("third_weight", third);
                shader.set("decoding", decoding);
                shader.set("strength", strength);
                shader.set("by_slopes", by_slopes ? 1 : 0);
            });
        store_drawn_image(graph, images, composed, target);
    };
    frame.world->query<const WrinkleMaps>().each(draw);
}

}  // namespace limn
