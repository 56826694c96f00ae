#include "render/passes/highlight_map_pass.h"

#include "ecs/components/shading_comparison.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light_list.h"
#include "render/lighting.h"
#include "render/render_items.h"
#include "render/shading_rates.h"
#include "render/view_block.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace limn {
namespace {

constexpr unsigned kExponentsUnit = 7;
constexpr unsigned kLightsUnit = 9;
constexpr unsigned kMapsImage = 0;
constexpr unsigned kGroup = 8;

/// The texture for `layers` layers, new if they were fewer or more.
void fit(gpu::Texture& maps, const char* label, GLenum format, std::size_t layers) {
    if (!maps || maps.layers() != static_cast<int>(layers)) {
        maps = gpu::Texture(
            label, {.format = format,
                    .width = kHighlightMapSize,
                    .height = kHighlightMapSize,
                    .depth = static_cast<int>(layers),
                    .target = GL_TEXTURE_2D_ARRAY});
    }
}

void dispatch(gpu::Device& device, std::size_t layers) {
    device.dispatch(
        kHighlightMapSize / kGroup, kHighlightMapSize / kGroup, static_cast<unsigned>(layers));
}

/// The middle of the box around all objects.
Vec3 center_of(const RenderItems& items) {
    Bounds all;
    for (std::size_t n = 0; n < items.block_count(); ++n) {
        const RenderItemBlock& block = items.block(n);
        for (std::size_t i = 0; i < block.size(); ++i) {
            if (block.is_drawable(i)) {
                grow(all, block.box(i));
            }
        }
    }
    return is_empty(all) ? Vec3(0) : center(all);
}

/// Whether a rate of the view reads the map.
bool reads(const LightingMethod& method, HighlightMap map) {
    return row_of(method.shading).map == map
           || (method.compared && row_of(*method.compared).map == map);
}

bool is_same(const HighlightMapEffect::Environment& a, const HighlightMapEffect::Environment& b) {
    return a.lights.size() == b.lights.size()
           && std::memcmp(
                  a.lights.data(), b.lights.data(), a.lights.size() * sizeof(layout::LightRecord))
                  == 0
           && a.directional == b.directional && a.center == b.center
           && std::equal(std::begin(a.camera.row), std::end(a.camera.row), std::begin(b.camera.row))
           && a.exponents == b.exponents;
}

}  // namespace

Result<HighlightMapEffect> HighlightMapEffect::create(gpu::Device& device, const RenderSettings&) {
    return HighlightMapEffect{
        .bake_blinn = LIMN_TRY(device.shaders().load({.compute = "highlight_maps.comp"})),
        .bake_environment =
            LIMN_TRY(device.shaders().load({.compute = "highlight_environment.comp"}))};
}

bool HighlightMapEffect::is_used(const FrameData& frame) {
    const auto* rendering = frame.world->find_resource<Rendering>();
    const auto* comparison = frame.world->find_resource<ShadingComparison>();
    return (rendering != nullptr && row_of(rendering->shading).map != HighlightMap::None)
           || (comparison != nullptr && row_of(comparison->right).map != HighlightMap::None);
}

void HighlightMapEffect::collect(FrameData& frame) {
    layers = assign_highlight_layers(frame.assets->materials);
    exponents.upload(*frame.ring, layers.exponents);
    layer_of_material.upload(*frame.ring, layers.of_record);
}

bool HighlightMapEffect::prepare(const FrameData& frame, ViewData& view) {
    const auto& method = view.data.get<LightingMethod>();
    if (reads(method, HighlightMap::Environment)) {
        lights.upload(*frame.ring, view.data.get<LightList>().records);
        return true;
    }
    return reads(method, HighlightMap::Blinn);
}

void HighlightMapEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto& method = view.data.get<LightingMethod>();
    auto& published = view.data.publish<HighlightMaps>();
    published.layers = {};
    published.layer_of_material = &layer_of_material;
    if (reads(method, HighlightMap::Blinn)) {
        published.layers[static_cast<std::size_t>(HighlightMap::Blinn)] = draw_blinn(graph);
    }
    if (reads(method, HighlightMap::Environment)) {
        published.layers[static_cast<std::size_t>(HighlightMap::Environment)] =
            draw_environment(graph, frame, view);
    }
}

TextureId HighlightMapEffect::draw_blinn(FrameGraph& graph) {
    const std::size_t count = layers.exponents.size();
    fit(blinn, "Blinn maps", GL_R16F, count);
    const TextureId maps = graph.import("Blinn maps", blinn);
    if (std::exchange(blinn_exponents, layers.exponents) != layers.exponents) {
        graph.add_pass("Blinn maps", {}, {image(maps)}, [this, maps, count](PassContext& context) {
            context.device().use(*bake_blinn);
            exponents.bind(context.device(), kExponentsUnit);
            context.bind_image(kMapsImage, maps, GL_WRITE_ONLY);
            dispatch(context.device(), count);
        });
    }
    return maps;
}

TextureId HighlightMapEffect::draw_environment(
    FrameGraph& graph, const FrameData& frame, const ViewData& view) {
    const std::size_t count = layers.exponents.size();
    const auto& list = view.data.get<LightList>();
    Environment wanted = {
        list.records, list.directional, center_of(*frame.items), view.camera.world_from_camera,
        layers.exponents};
    fit(environment, "highlight environment", GL_RGBA16F, count);
    const TextureId maps = graph.import("highlight environment", environment);
    if (is_same(baked, wanted)) {
        return maps;
    }
    baked = std::move(wanted);
    graph.add_pass(
        "highlight environment", {}, {image(maps)},
        [this, maps, count, &view](PassContext& context) {
            context.device().use(*bake_environment);
            bind_view(context, view);
            exponents.bind(context.device(), kExponentsUnit);
            lights.bind(context.device(), kLightsUnit);
            bake_environment->set("center", baked.center);
            bake_environment->set("light_count", static_cast<int>(baked.lights.size()));
            context.bind_image(kMapsImage, maps, GL_WRITE_ONLY);
            dispatch(context.device(), count);
        });
    return maps;
}

}  // namespace limn
