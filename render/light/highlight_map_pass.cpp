#include "render/light/highlight_map_pass.h"

#include "ecs/components/shading_comparison.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/geometry/render_items.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/light_list.h"
#include "render/light/lighting.h"
#include "render/light/shading_rates.h"
#include "render/material/material_pool.h"
#include "render/shaders/highlight_gpu.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>

// Techniques: fakephong.blinn-texture, fakephong.envmap-bake

namespace limn {
namespace {

constexpr unsigned kHighlightGroup = 8;

/// Whether a rate of the frame reads the map; also if the user can switch to one.
bool is_in_use(const FrameData& frame, HighlightMap map) {
    const auto* rendering = frame.world->find_resource<Rendering>();
    const auto* comparison = frame.world->find_resource<ShadingComparison>();
    return (frame.warm_up && comparison != nullptr)
           || (rendering != nullptr && row_of(rendering->shading).map == map)
           || (comparison != nullptr && row_of(comparison->right).map == map);
}

/// Whether a rate of the view reads the map.
bool reads(const ViewData& view, HighlightMap map) {
    const auto& method = view.data.get<LightingMethod>();
    return (view.frame->warm_up && method.compared) || row_of(method.shading).map == map
           || (method.compared && row_of(*method.compared).map == map);
}

/// The center of the bounds of the objects of each layer.
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
           && (a.lights.empty()
               || std::memcmp(
                      a.lights.data(), b.lights.data(),
                      a.lights.size() * sizeof(layout::LightRecord))
                      == 0)
           && a.directional == b.directional && a.layout == b.layout
           && std::equal(
               std::begin(a.camera.row), std::end(a.camera.row), std::begin(b.camera.row));
}

/// The global vector that fixes the axes of Blinn maps: unit, or zero.
Vec3 blinn_axis(const Rendering& rendering, const RenderView& camera) {
    const auto unit_or_zero = [](const Vec3& v) {
        const float length = glm::length(v);
        return length > 1e-6f && std::isfinite(length) ? v / length : Vec3(0);
    };
    switch (rendering.blinn_axis) {
    case BlinnAxis::WorldUp:
        return {0, 1, 0};
    case BlinnAxis::Custom:
        return unit_or_zero(rendering.blinn_vector);
    default: {
        const auto& r = camera.world_from_camera.row;
        return unit_or_zero({r[0][1], r[1][1], r[2][1]});
    }
    }
}

}  // namespace

Result<HighlightMapEffect> HighlightMapEffect::create(gpu::Device& device, const RenderSettings&) {
    return HighlightMapEffect{
        .bake_blinn = LIMN_TRY(device.shaders().load({.compute = "highlight_maps.comp"})),
        .bake_environment = ProgramVariants(device, {.compute = "highlight_environment.comp"})};
}

bool HighlightMapEffect::is_used(const FrameData& frame) {
    return is_in_use(frame, HighlightMap::Blinn) || is_in_use(frame, HighlightMap::Environment);
}

void HighlightMapEffect::collect(FrameData& frame) {
    const auto& materials = frame.assets->materials;
    if (is_in_use(frame, HighlightMap::Blinn)) {
        blinn.layers = layers_by_exponent(materials);
        frame.materials->append_plain(blinn.layers.of_record);
        blinn.layer_of_material.upload(*frame.ring, blinn.layers.of_record);
    }
    if (is_in_use(frame, HighlightMap::Environment)) {
        environment.layers = layers_by_material(materials);
        frame.materials->append_plain(environment.layers.of_record);
        environment.layer_of_material.upload(*frame.ring, environment.layers.of_record);
    }
}

bool HighlightMapEffect::prepare(const FrameData& frame, ViewData& view) {
    const auto* found = frame.world->find_resource<Rendering>();
    const Vec3 axis = blinn_axis(found != nullptr ? *found : Rendering{}, view.camera);
    view.publish_block(layout::kHighlightBinding, layout::HighlightBlock{Vec4(axis, 0)});
    return reads(view, HighlightMap::Blinn) || reads(view, HighlightMap::Environment);
}

void HighlightMapEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    auto& published = view.data.publish<HighlightMaps>();
    published = {};
    for (const HighlightMap map : {HighlightMap::Blinn, HighlightMap::Environment}) {
        if (reads(view, map)) {
            published.maps[static_cast<std::size_t>(map)] =
                draw_map(graph, frame, view, map == HighlightMap::Environment);
        }
    }
}

HighlightMaps::Map HighlightMapEffect::draw_map(
    FrameGraph& graph, const FrameData& frame, const ViewData& view, bool by_view) {
    Maps& maps = by_view ? environment : blinn;
    const HighlightLayers& layers = maps.layers;
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
        wanted.layout = view.data.get<LightingMethod>().highlights;
        wanted.camera = view.camera.world_from_camera;
    }

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
    const HighlightMaps::Map published = {
        graph.import(by_view ? "highlight environment" : "Blinn maps", maps.texture),
        &maps.layer_of_material};
    if (is_same(maps.source, wanted)) {
        return published;
    }
    maps.source = std::move(wanted);
    maps.layer_records.upload(*frame.ring, maps.source.layers);
    if (by_view) {
        lights.upload(*frame.ring, maps.source.lights);
    }
    graph.add_pass(
        "highlight maps", {}, {image(published.layers)},
        [this, &maps, texture = published.layers, count, by_view, &view](PassContext& context) {
            Variant variant;
            variant.add("ENVIRONMENT_LAYOUT", static_cast<int>(maps.source.layout));
            const gpu::Program* program = by_view ? bake_environment.get(variant) : bake_blinn;
            if (program == nullptr) {
                return;
            }
            context.device().use(*program);
            maps.layer_records.bind(context.device(), layout::kHighlightRecordsUnit);
            context.bind_image(layout::kHighlightMapsImage, texture, GL_WRITE_ONLY);
            if (by_view) {
                bind_view(context, view);
                lights.bind(context.device(), layout::kLightsUnit);
                program->set("light_count", static_cast<int>(environment.source.lights.size()));
            }
            context.device().dispatch(
                kHighlightMapSize / kHighlightGroup, kHighlightMapSize / kHighlightGroup,
                static_cast<unsigned>(count));
        });
    return published;
}

}  // namespace limn
