#include "render/water/water_pass.h"

#include "ecs/components/transform.h"
#include "ecs/components/water_frame.h"
#include "ecs/components/water_look.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/lighting.h"
#include "render/material/material_pool.h"
#include "render/material/shading_models.h"
#include "render/material/texture_wave_pass.h"
#include "render/render_frame.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/water_detail_gpu.h"
#include "render/shaders/water_gpu.h"
#include "render/view_block.h"
#include "render/water/foam_pattern.h"
#include "render/water/water_reflection.h"
#include "render/water/water_surfaces.h"

#include <array>
#include <utility>

// Techniques: water.reflection-refraction-maps

namespace limn {

namespace {

constexpr int kLobe = static_cast<int>(lobe_number(ShadingModel::Pbr));
constexpr int kCells = layout::kWaterGrid;
constexpr int kSide = kCells + 1;
constexpr int kIndices = 6 * kCells * kCells;
constexpr int kFanIndices = 3 * 4 * kCells;

/// Two triangles per cell with alternating diagonals, so that vertices that morph onto their
/// neighbors leave whole squares.
std::array<std::uint16_t, kIndices> grid_indices() {
    std::array<std::uint16_t, kIndices> indices{};
    std::size_t next = 0;
    for (int z = 0; z < kCells; ++z) {
        for (int x = 0; x < kCells; ++x) {
            const int a = z * kSide + x;
            const int corners[4] = {a, a + 1, a + kSide, a + kSide + 1};
            const bool turned = (x + z) % 2 != 0;
            const int order[2][6] = {{0, 2, 3, 0, 3, 1}, {0, 2, 1, 1, 2, 3}};
            for (const int corner : order[turned ? 1 : 0]) {
                indices[next++] = static_cast<std::uint16_t>(corners[corner]);
            }
        }
    }
    return indices;
}

/// The same square where it is flat: triangles around its center, with all vertices of its border,
/// so that it fits its neighbors.
std::array<std::uint16_t, kFanIndices> fan_indices() {
    std::array<std::uint16_t, kFanIndices> indices{};
    constexpr int kCenter = kCells / 2 * kSide + kCells / 2;
    const int corners[4] = {0, kCells, kSide * kSide - 1, kCells * kSide};
    const int steps[4] = {1, kSide, -1, -kSide};
    std::size_t next = 0;
    for (int side = 0; side < 4; ++side) {
        for (int i = 0; i < kCells; ++i) {
            const int from = corners[side] + i * steps[side];
            for (const int vertex : {kCenter, from + steps[side], from}) {
                indices[next++] = static_cast<std::uint16_t>(vertex);
            }
        }
    }
    return indices;
}

/// Null if no water has one.
const gpu::Texture* detail_map(const FrameData& frame, const WaterSurfaces& waters) {
    return frame.materials->images().find_texture(waters.list.details.normal_map);
}

const gpu::Texture* floor_map(const FrameData& frame, const WaterSurfaces& waters) {
    const WaterLook* look = waters.list.floor;
    return look != nullptr ? frame.materials->images().find_texture(look->floor_map) : nullptr;
}

const gpu::Texture* reflection_map(const FrameData& frame, const WaterSurfaces& waters) {
    const WaterLook* look = waters.list.ceiling;
    return look != nullptr ? frame.materials->images().find_texture(look->reflection_map) : nullptr;
}

/// What the surfaces of all waters of the view need.
Variant surface_variant(const ViewData& view, const WaterSurfaces& waters) {
    Variant variant;
    variant.add_if(view.velocity, "VELOCITY");
    variant.add_if(waters.any_seas(), "OCEAN");
    return variant;
}

/// What their light needs.
Variant light_variant(const ViewData& view, const WaterSurfaces& waters) {
    const WaterList& list = waters.list;
    Variant variant = view.lighting.variant;
    variant.add("SHADING_LOBE", kLobe);
    variant.add_if(view.attributes, "ATTRIBUTES");
    variant.add_if(waters.any_seas(), "OCEAN");
    variant.add_if(list.crests, "CRESTS");
    variant.add_if(list.looks, "LOOKS");
    variant.add_if(list.planar, "PLANAR");
    variant.add_if(list.visible_from_below, "FROM_BELOW");
    variant.add_if(!list.traced, "NO_SCREEN_REFLECTION");
    variant.add_if(list.details.needed, "DETAIL");
    variant.add_if(detail_map(*view.frame, waters) != nullptr, "DETAIL_MAP");
    variant.add_if(floor_map(*view.frame, waters) != nullptr, "FLOOR_MAP");
    variant.add_if(reflection_map(*view.frame, waters) != nullptr, "REFLECTION_MAP");
    variant.add_if(!list.bent, "NO_TRACED_REFRACTION");
    return variant;
}

void bind_details(
    gpu::Device& device, const WaterEffect& effect, const FrameData& frame,
    const WaterSurfaces& waters) {
    waters.details.bind(device, layout::kWaterDetailsUnit);
    if (const gpu::Texture* map = detail_map(frame, waters)) {
        device.bind_texture(layout::kDetailMapUnit, *map, &effect.repeat);
    }
    if (effect.wave_tiles) {
        device.bind_texture(layout::kDetailWavesUnit, effect.wave_tiles);
    }
}

void bind_foam(gpu::Device& device, WaterEffect& pass) {
    if (!pass.foam) {
        constexpr int side = kFoamPatternSide;
        pass.foam =
            gpu::Texture("foam", {.format = GL_R8, .width = side, .height = side, .levels = 0});
        pass.foam.set_wrap(GL_REPEAT);
        int level = 0;
        for (const std::vector<std::uint8_t>& pattern : make_foam_pattern()) {
            pass.foam.upload(std::as_bytes(std::span(pattern)), level++);
        }
    }
    device.bind_texture(layout::kFoamPatternUnit, pass.foam);
}

/// Copies of radiance and depth, which the water is drawn over.
struct BehindWater {
    TextureId radiance;
    TextureId depth;
};

BehindWater copy_behind(FrameGraph& graph, const ViewData& view) {
    const TextureId radiance = view.radiance;
    const TextureId depth = view.gbuffer.depth;
    const BehindWater copies = {
        create_like(graph, "behind water", radiance),
        create_like(graph, "depth behind water", depth)};
    graph.add_pass(
        "behind water", {radiance, depth}, {image(copies.radiance), image(copies.depth)},
        [radiance, depth, copies](PassContext& context) {
            context.texture(radiance).copy_to(context.texture(copies.radiance));
            context.texture(depth).copy_to(context.texture(copies.depth));
        });
    return copies;
}

/// Heights of the highest surfaces, of each tile and of it and all above it.
TextureId
find_highest(FrameGraph& graph, const WaterEffect& effect, const ViewData& view, TextureId depth) {
    const IVec2 tiles = (view.size() + layout::kHighestTile - 1) / layout::kHighestTile;
    const TextureId highest = create_target(graph, "highest surfaces", GL_R32F, tiles);
    add_fullscreen_pass(
        graph, "highest surfaces", {sampled(depth, layout::kBehindWaterDepthUnit)},
        {discarded(highest)}, effect.highest,
        [&view](PassContext& context, const gpu::Program&) { bind_view(context, view); });
    const TextureId columns = create_target(graph, "highest in columns", GL_RG32F, tiles);
    add_fullscreen_pass(
        graph, "highest in columns", {sampled(highest, layout::kColumnSourceUnit)},
        {discarded(columns)}, effect.columns, [](PassContext&, const gpu::Program&) {});
    return columns;
}

/// Visibility buffer of the surfaces: texels of lib/water_visibility.glsl, and a depth that marks
/// the pixels that show water.
struct VisibleWater {
    TextureId surfaces;
    TextureId pixels;
};

VisibleWater draw_surfaces(
    FrameGraph& graph, WaterEffect& effect, const ViewData& view, const WaterSurfaces& waters) {
    const IVec2 size = view.size();
    const VisibleWater visible = {
        graph.create(
            {.name = "water surfaces",
             .format = GL_RGBA32UI,
             .width = size.x,
             .height = size.y,
             .depth = 2,
             .target = GL_TEXTURE_2D_ARRAY}),
        create_target(graph, "water pixels", GL_DEPTH_COMPONENT32F, size)};
    std::vector<Use> writes = {
        target_level(cleared(visible.surfaces), 0, 0),
        target_level(discarded(visible.surfaces), 0, 1), view.gbuffer.depth};
    if (view.velocity) {
        writes.emplace_back(view.gbuffer.velocity);
    }
    graph.add_pass(
        "water surfaces", {}, std::span<const Use>(writes),
        [&effect, &waters, &view](PassContext& context) {
            const gpu::Program* program = effect.surface.get(surface_variant(view, waters));
            if (program == nullptr) {
                return;
            }
            gpu::Device& device = context.device();
            device.use(gpu::Pipeline{program, {.cull = GL_NONE}});
            bind_view(context, view);
            waters.patches.bind(device, layout::kWaterPatchesUnit);
            bind_water_surfaces(device, waters);
            device.bind_vertex_array(effect.grid);
            const auto draw = [&](int count, std::size_t offset, std::size_t first,
                                  std::size_t end) {
                if (first < end) {
                    program->set("first_patch", static_cast<int>(first));
                    device.draw_indexed(
                        GL_TRIANGLES, count, GL_UNSIGNED_SHORT, offset, 0,
                        static_cast<int>(end - first));
                }
            };
            const std::size_t flat = waters.list.first_flat_patch;
            draw(kIndices, 0, 0, flat);
            draw(kFanIndices, kIndices * sizeof(std::uint16_t), flat, waters.list.patches.size());
        });
    gpu::PipelineState state = gpu::kFullscreenState;
    state.depth = {.test = true, .write = true, .func = GL_ALWAYS};
    add_fullscreen_pass(
        graph, "water pixels", {sampled(visible.surfaces, layout::kVisibleWaterUnit)},
        {discarded(visible.pixels)}, effect.pixels, state,
        [](PassContext&, const gpu::Program&) {});
    return visible;
}

bool any_water(const FrameData& frame) {
    return !frame.world->query<const Water>().empty();
}

/// The frame's view from a point in the space of a water, straight up or down.
RenderView
view_of_water(const FrameData& frame, const WaterFrame& water, float height, bool upward) {
    const Vec3 eye = water.world({0, height, 0});
    const Affine pose = look_at(eye, eye + Vec3(0, upward ? 1 : -1, 0));
    return make_render_view(
        Camera{}, pose, pose, {.width = frame.camera.width, .height = frame.camera.height});
}

}  // namespace

bool WaterEffect::is_used(const FrameData& frame) {
    return any_water(frame);
}

Result<WaterEffect> WaterEffect::create(gpu::Device& device, const RenderSettings&) {
    gpu::ShaderLibrary& shaders = device.shaders();
    WaterEffect effect{
        .surface =
            ProgramVariants(device, {.vertex = "water.vert", .fragment = "water_surface.frag"}),
        .light = ProgramVariants::fullscreen(device, "water.frag"),
        .pixels =
            LIMN_TRY(shaders.load({.vertex = "fullscreen.vert", .fragment = "water_pixels.frag"})),
        .highest =
            LIMN_TRY(shaders.load({.vertex = "fullscreen.vert", .fragment = "water_highest.frag"})),
        .columns =
            LIMN_TRY(shaders.load({.vertex = "fullscreen.vert", .fragment = "water_columns.frag"})),
        .waves = LIMN_TRY(
            shaders.load({.vertex = "fullscreen.vert", .fragment = "texture_waves.frag"}))};
    std::array<std::uint16_t, kIndices + kFanIndices> indices{};
    std::ranges::copy(fan_indices(), std::ranges::copy(grid_indices(), indices.begin()).out);
    effect.indices = gpu::Buffer::of("water grid", std::span<const std::uint16_t>(indices));
    effect.repeat = gpu::Sampler("water detail", {});
    effect.grid = gpu::VertexArray("water grid");
    effect.grid.set_indices(effect.indices);
    return effect;
}

/// A water with a planar reflection, and one without, each from above and below.
void WaterEffect::add_warm_up_views(const FrameData& frame, std::vector<RenderView>& views) {
    constexpr float kAbove = 50;  // waves [m]
    constexpr float kBelow = -1;  // the surface of a sea [m]
    bool added[2] = {};
    frame.world->query<const Water, const WorldTransform, Optional<const WaterLook>>().each(
        [&](const Water& water, const WorldTransform& pose, const WaterLook* look) {
            const bool planar = look != nullptr && look->reflection == WaterReflection::Planar;
            if (!std::exchange(added[planar ? 1 : 0], true)) {
                const WaterFrame surface_frame = water_frame(pose.world);
                const float below = water.depth > 0 ? -0.5f * water.depth : kBelow;
                views.push_back(view_of_water(frame, surface_frame, kAbove, false));
                views.push_back(view_of_water(frame, surface_frame, below, true));
            }
        });
}

void WaterEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto* waters = view.data.find<WaterSurfaces>();
    if (waters == nullptr) {
        return;
    }
    if (waves_frame != frame.number) {  // the same for all views
        waves_frame = frame.number;
        draw_texture_waves(graph, waves, wave_tiles, *waters);
    }
    if (waters->list.empty()) {
        return;
    }
    const BehindWater behind = copy_behind(graph, view);
    const VisibleWater visible = draw_surfaces(graph, *this, view, *waters);
    std::vector<Use> reads = lighting_reads(
        view, {sampled(behind.radiance, layout::kBehindWaterUnit),
               sampled(behind.depth, layout::kBehindWaterDepthUnit),
               sampled(visible.surfaces, layout::kVisibleWaterUnit), depth_tested(visible.pixels)});
    if (waters->list.traced || waters->list.visible_from_below) {
        const TextureId surfaces = find_highest(graph, *this, view, behind.depth);
        reads.push_back(sampled(surfaces, layout::kHighestWaterUnit));
    }
    const auto* reflection = frame.data.find<PlanarReflection>();
    if (waters->list.planar) {
        reads.push_back(sampled(
            graph.import("water reflection", *reflection->map), layout::kWaterReflectionUnit));
    }
    if (waters->list.details.needed && wave_tiles) {
        reads.emplace_back(graph.import("wave tiles", wave_tiles));
    }
    for (const gpu::Texture* map :
         {detail_map(frame, *waters), floor_map(frame, *waters), reflection_map(frame, *waters)}) {
        if (map != nullptr) {
            reads.emplace_back(graph.import("water map", *map));
        }
    }
    std::vector<Use> writes = {view.radiance};
    if (view.attributes) {
        writes.emplace_back(view.gbuffer.surface);
    }
    graph.add_pass(
        "water", std::span<const Use>(reads), std::span<const Use>(writes),
        [this, waters, &view](PassContext& context) {
            const gpu::Program* program = light.get(light_variant(view, *waters));
            if (program == nullptr) {
                return;
            }
            gpu::Device& device = context.device();
            device.use(gpu::Pipeline{program, kWhereLobe});
            bind_lighting(context, view);
            bind_water_surfaces(device, *waters);
            if (waters->any_seas() || waters->list.crests) {
                bind_foam(device, *this);
            }
            if (waters->list.details.needed) {
                bind_details(device, *this, *view.frame, *waters);
            }
            if (const gpu::Texture* floor = floor_map(*view.frame, *waters)) {
                device.bind_texture(layout::kFloorMapUnit, *floor, &repeat);
                program->set("floor_tile", waters->list.floor->floor_tile);
            }
            if (const gpu::Texture* above = reflection_map(*view.frame, *waters)) {
                const WaterLook& look = *waters->list.ceiling;
                device.bind_texture(layout::kReflectionImageUnit, *above, &repeat);
                program->set(
                    "reflection_plane", Vec2(look.reflection_height, look.reflection_tile));
            }
            device.draw_fullscreen();
        });
}

void WaterEffect::report(const FrameData& frame, const ViewData&, FrameOutput& out) {
    out.statistics.water_reflections = frame.data.find<PlanarReflection>() != nullptr ? 1 : 0;
}

bool WaterMirrorEffect::is_used(const FrameData& frame) {
    return any_water(frame) && find_planar_water(*frame.world, frame.camera).has_value();
}

Result<WaterMirrorEffect> WaterMirrorEffect::create(gpu::Device& device, const RenderSettings&) {
    return WaterMirrorEffect{LIMN_TRY(
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "water_behind.frag"}))};
}

void WaterMirrorEffect::request_views(FrameData& frame) {
    const std::optional<PlanarWater> water = find_planar_water(*frame.world, frame.camera);
    if (!water) {
        return;
    }
    const RenderView camera = make_reflected_view(frame.camera, water->level, water->map_scale);
    frame.views.push_back({kMirrorView, camera, "water reflection"});
    if (!map || map.width() != camera.width || map.height() != camera.height) {
        map = gpu::Texture(
            "water reflection",
            {.format = GL_RGBA32F, .width = camera.width, .height = camera.height, .levels = 0});
    }
    auto& published = frame.data.publish<PlanarReflection>();
    published = {water->entity, &map};
}

void WaterMirrorEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const TextureId target = graph.import("water reflection", map);
    add_fullscreen_pass(
        graph, "water reflection",
        {sampled(view.radiance, layout::kSourceUnit),
         sampled(view.gbuffer.depth, layout::kWaterCopyDepthUnit)},
        {target_level(discarded(target), 0)}, copy,
        [&view](PassContext& context, const gpu::Program&) { bind_view(context, view); });
    graph.add_pass("water reflection, blurred", {}, {image(target)}, [this](PassContext&) {
        map.generate_mipmaps();
    });
}

}  // namespace limn
