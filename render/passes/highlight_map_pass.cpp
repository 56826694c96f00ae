#include "render/passes/highlight_map_pass.h"

#include "ecs/components/rendering.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light_list.h"
#include "render/lighting.h"
#include "render/material_pool.h"
#include "render/render_items.h"
#include "render/shading_rates.h"
#include "render/view_block.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

namespace limn {
namespace {

constexpr unsigned kLayersUnit = 7;
constexpr unsigned kLightsUnit = 9;
constexpr unsigned kMapsImage = 0;
constexpr unsigned kGroup = 8;

HighlightMap map_in_use(const World& world) {
    const auto* rendering = world.find_resource<Rendering>();
    return rendering != nullptr ? row_of(rendering->shading).map : HighlightMap::None;
}

/// The middle of the boxes around the objects of each layer.
std::vector<Vec3> layer_centers(const FrameData& frame, const HighlightLayers& layers) {
    std::vector<Bounds> boxes(layers.exponents.size());
    for (std::size_t n = 0; n < frame.items->block_count(); ++n) {
        const RenderItemBlock& block = frame.items->block(n);
        for (std::size_t i = 0; i < block.size(); ++i) {
            const std::uint32_t record = frame.materials->record_of(block.surfaces[i].material);
            if (block.is_drawable(i) && record < layers.of_record.size()) {
                grow(boxes[layers.of_record[record]], block.box(i));
            }
        }
    }
    std::vector<Vec3> centers;
    for (const Bounds& box : boxes) {
        centers.push_back(is_empty(box) ? Vec3(0) : center(box));
    }
    return centers;
}

bool is_same(const HighlightMapEffect::Source& a, const HighlightMapEffect::Source& b) {
    return a.layers == b.layers && a.lights.size() == b.lights.size()
           && std::memcmp(
                  a.lights.data(), b.lights.data(), a.lights.size() * sizeof(layout::LightRecord))
                  == 0
           && a.directional == b.directional
           && std::equal(
               std::begin(a.camera.row), std::end(a.camera.row), std::begin(b.camera.row));
}

}  // namespace

Result<HighlightMapEffect> HighlightMapEffect::create(gpu::Device& device, const RenderSettings&) {
    return HighlightMapEffect{
        .bake_blinn = LIMN_TRY(device.shaders().load({.compute = "highlight_maps.comp"})),
        .bake_environment =
            LIMN_TRY(device.shaders().load({.compute = "highlight_environment.comp"}))};
}

bool HighlightMapEffect::is_used(const FrameData& frame) {
    return map_in_use(*frame.world) != HighlightMap::None;
}

void HighlightMapEffect::collect(FrameData& frame) {
    const auto& materials = frame.assets->materials;
    layers = map_in_use(*frame.world) == HighlightMap::Environment ? layers_by_material(materials)
                                                                   : layers_by_exponent(materials);
    layer_of_material.upload(*frame.ring, layers.of_record);
}

bool HighlightMapEffect::prepare(const FrameData&, ViewData& view) {
    return row_of(view.data.get<LightingMethod>().shading).map != HighlightMap::None;
}

void HighlightMapEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const bool by_view =
        row_of(view.data.get<LightingMethod>().shading).map == HighlightMap::Environment;
    Source wanted;
    for (const float exponent : layers.exponents) {
        wanted.layers.emplace_back(0, 0, 0, exponent);
    }
    if (by_view) {
        const std::vector<Vec3> centers = layer_centers(frame, layers);
        for (std::size_t i = 0; i < centers.size(); ++i) {
            wanted.layers[i] = Vec4(centers[i], wanted.layers[i].w);
        }
        const auto& list = view.data.get<LightList>();
        wanted.lights = list.records;
        wanted.directional = list.directional;
        wanted.camera = view.camera.world_from_camera;
    }

    Maps& maps = by_view ? environment : blinn;
    const std::size_t count = wanted.layers.size();
    if (!maps.texture || maps.texture.layers() != static_cast<int>(count)) {
        maps.texture = gpu::Texture(
            "highlight maps", {.format = static_cast<GLenum>(by_view ? GL_RGBA16F : GL_R16F),
                               .width = kHighlightMapSize,
                               .height = kHighlightMapSize,
                               .depth = static_cast<int>(count),
                               .target = GL_TEXTURE_2D_ARRAY});
        maps.source = {};
    }
    auto& published = view.data.publish<HighlightMaps>();
    published.layers = graph.import("highlight maps", maps.texture);
    published.layer_of_material = &layer_of_material;
    if (is_same(maps.source, wanted)) {
        return;
    }
    maps.source = std::move(wanted);
    layer_records.upload(*frame.ring, maps.source.layers);
    lights.upload(*frame.ring, maps.source.lights);
    graph.add_pass(
        "highlight maps", {}, {image(published.layers)},
        [this, texture = published.layers, count, by_view, &view](PassContext& context) {
            const gpu::Program& program = by_view ? *bake_environment : *bake_blinn;
            context.device().use(program);
            layer_records.bind(context.device(), kLayersUnit);
            context.bind_image(kMapsImage, texture, GL_WRITE_ONLY);
            if (by_view) {
                bind_view(context, view);
                lights.bind(context.device(), kLightsUnit);
                program.set("light_count", static_cast<int>(environment.source.lights.size()));
            }
            context.device().dispatch(
                kHighlightMapSize / kGroup, kHighlightMapSize / kGroup,
                static_cast<unsigned>(count));
        });
}

}  // namespace limn
