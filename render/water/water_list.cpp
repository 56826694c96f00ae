#include "render/water/water_list.h"

#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_frame.h"
#include "ecs/components/water_waves.h"
#include "ecs/world.h"

#include <algorithm>

namespace limn {

namespace {

constexpr float kMaxRippleHeight = 0.5f;  ///< [m]; higher ripples may be culled
constexpr float kCellsPerWave = 16.0f;    ///< of the finest grid, for the shortest wave
constexpr float kMinPatchSide = 0.125f;   ///< side of a patch [m]
constexpr float kCellPixels = 28.0f;      ///< maximum size of a patch cell on screen [px]
constexpr float kMaxDetail = 12.0f;       ///< for very large images

/// Appends the first `lines` of the table, and its rings.
void add_waves(const WaveTable& table, std::size_t lines, const WaterSources& at, WaterList& list) {
    for (const WaveLine& line : std::span(table.lines).first(lines)) {
        list.lines.push_back(
            {.run = Vec4(line.k, line.side),
             .phase = {
                 line.phase - line.frequency * at.now, line.phase - line.frequency * at.previous,
                 line.amplitude, line.lean}});
    }
    for (const WaveRing& ring : table.rings) {
        const float front = ring.front_speed * at.now;
        list.rings.push_back(
            {.circle = {ring.center.x, ring.center.y, ring.first + front, ring.last + front},
             .phase =
                 {ring.phase + ring.frequency * at.now, ring.phase + ring.frequency * at.previous,
                  ring.k, ring.amplitude},
             .fade = {
                 ring.fade_radius, ring.smooth ? 1.0f : 0.0f,
                 ring.front_speed * (at.previous - at.now), 0}});
    }
}

/// Maximum displacement of the surface by waves, vertical and horizontal [m].
Vec3 margin_of(const WaveTable* table) {
    Vec3 margin(0);
    if (table != nullptr) {
        for (const WaveLine& line : table->lines) {
            margin += Vec3(std::abs(line.side.x), line.amplitude, std::abs(line.side.y));
        }
        for (const WaveRing& ring : table->rings) {
            margin.y += ring.amplitude;
        }
    }
    return margin;
}

/// Side of the smallest patch needed to resolve all waves; `lines` of the table move vertices.
float finest_of(
    const WaveTable* table, std::size_t lines, const RippleState* ripples, const OceanState* sea) {
    float cell = 1e9f;
    if (sea != nullptr) {
        for (const OceanCascade& cascade : sea->cascades) {
            cell = std::min(cell, cascade.patch / static_cast<float>(cascade.size));
        }
    }
    if (table != nullptr && lines > 0) {
        const float k = glm::length(table->lines[lines - 1].k);
        cell = std::min(cell, 2 * kPi / (std::max(k, 1e-6f) * kCellsPerWave));
    }
    if (table != nullptr) {
        for (const WaveRing& ring : table->rings) {
            cell = std::min(cell, 2 * kPi / (std::max(ring.k, 1e-6f) * kCellsPerWave));
        }
    }
    if (ripples != nullptr && ripples->cells.x > 0) {
        cell = std::min(cell, ripples->cell);
    }
    return std::max(kMinPatchSide, cell * static_cast<float>(layout::kWaterGrid));
}

/// PatchSource::detail that limits patch cells to kCellPixels on screen.
float detail_of(const RenderView& view) {
    const Mat4& m = view.clip_from_world;
    const float radian = 0.5f * static_cast<float>(view.width)
                         * glm::length(Vec3(m[0][0], m[1][0], m[2][0]));  // [px]
    const float cell = kCellPixels * static_cast<float>(layout::kWaterGrid);
    return glm::clamp(radian / cell, kMinPatchDetail, kMaxDetail);
}

Mat4 matrix_of(const WaterFrame& frame) {
    Mat4 m(1.0f);
    m[0] = Vec4(frame.direction_to_world({1, 0, 0}), 0);
    m[2] = Vec4(frame.direction_to_world({0, 0, 1}), 0);
    m[3] = Vec4(frame.origin, 1);
    return m;
}

void set_ripples(
    const RippleAtlas& atlas, std::span<const RippleState* const> ripples, WaterList& list) {
    for (std::size_t i = 0; i < list.bodies.size(); ++i) {
        const RippleTile& tile = atlas.tiles()[i];
        if (!tile.fits) {
            continue;
        }
        const RippleState& state = *ripples[i];
        const Vec2 sheet(atlas.texture().width(), atlas.texture().height());
        const Vec2 scale = 1.0f / (state.cell * sheet);
        const Vec2 center = (Vec2(tile.corner) + 0.5f * Vec2(state.cells)) / sheet;
        list.bodies[i].ripples = Vec4(scale, center);
        const Vec2 half = 0.5f * state.size();
        list.bodies[i].rippling.x = half.x;
        list.bodies[i].rippling.y = half.y;
    }
}

void set_sea(
    const OceanTextures& textures, const OceanSource& sea, const OceanLayers& layers,
    layout::WaterRecord& body) {
    body.ocean = {
        static_cast<float>(layers.first_layer), static_cast<float>(layers.patches),
        static_cast<float>(textures.size()), body.ocean.w};
    for (int i = 0; i < layers.patches; ++i) {
        body.patches[i] = 1.0f / sea.state->cascades[static_cast<std::size_t>(i)].patch;
    }
    body.variance = layers.variance;
}

/// Minimum and maximum height: +-`wave_height` of the other waves plus the ripples of this body.
Vec2 heights_of(float wave_height, const RippleState* ripples) {
    Vec2 heights(-wave_height, wave_height);
    if (ripples != nullptr && !ripples->height.empty()) {
        const auto [lowest, highest] =
            std::minmax_element(ripples->height.begin(), ripples->height.end());
        heights += Vec2(*lowest, *highest);
    }
    return heights;
}

/// Set if the camera is, or may be, in this water.
std::optional<WaterAroundView> find_around(const PatchSource& source, float depth, float near) {
    const Vec3& eye = source.camera;
    const float margin = source.margin.y + 2 * near;
    const bool beside = (source.half.x > 0 && std::abs(eye.x) > source.half.x)
                        || (source.half.y > 0 && std::abs(eye.z) > source.half.y);
    if (beside || !(eye.y < margin) || (depth > 0 && eye.y < -depth)) {
        return std::nullopt;
    }
    return WaterAroundView{static_cast<int>(source.body), eye.y > -margin};
}

void add_body(
    const WaterSources& at, std::size_t index, const WaterLook& look, const Vec3& margin,
    const RenderView& view, WaterList& list) {
    const WaterSources::Body& body = at.bodies[index];
    const RippleState* const ripples = at.ripples[index];
    const OceanState* const sea = at.seas[index].state;
    const Water& water = *body.water;
    const Affine& pose = view.world_from_camera;
    const std::size_t lines = list.details.add(
        body.detail, body.table, kMinPatchSide / static_cast<float>(layout::kWaterGrid), at.time,
        at.now);
    PatchSource source;
    source.half = 0.5f * water.size;
    source.camera = body.frame.local({pose.row[0].w, pose.row[1].w, pose.row[2].w});
    source.margin = margin + margin_of(body.table);
    source.margin.y += ripples != nullptr ? kMaxRippleHeight : 0.0f;
    source.frustum = make_frustum(view.clip_from_world * matrix_of(body.frame));
    source.finest = finest_of(body.table, lines, ripples, sea);
    source.detail = detail_of(view);
    source.body = static_cast<float>(index);
    const std::size_t first_patch = list.patches.size();
    append_water_patches(source, list.patches);
    if (body.table != nullptr) {
        resolve_lines(
            std::span(body.table->lines).first(lines),
            std::span(list.patches).subspan(first_patch));
    }
    list.visible_from_below |= !(source.camera.y > source.margin.y);
    if (!list.around) {
        list.around = find_around(source, body.water->depth, view.near);
    }
    const bool by_height = body.caustics != nullptr && body.caustics->method == CausticMethod::Pool;
    list.heights.push_back(
        by_height ? heights_of(margin.y + margin_of(body.table).y, ripples) : Vec2(0));

    list.looks = list.looks || pack_look(look) != 0;
    list.crests = list.crests || look.foam_below > -1;
    list.planar = list.planar || look.reflection == WaterReflection::Planar;
    list.bent = list.bent || look.refraction == WaterRefraction::Traced;
    list.traced = list.traced || look.reflection == WaterReflection::ScreenSpace;
    const auto first_line = static_cast<float>(list.lines.size());
    const auto first_ring = static_cast<float>(list.rings.size());
    if (body.table != nullptr) {
        add_waves(*body.table, lines, at, list);
    }
    list.bodies.push_back(
        {.origin = Vec4(body.frame.origin, body.frame.along_x.x),
         .shape = Vec4(body.frame.along_x.y, source.half, water.refractive_index),
         .absorption = Vec4(water.absorption, water.depth),
         .scattering = Vec4(water.scattering, pack_look(look)),
         .waves =
             {first_line, static_cast<float>(list.lines.size()) - first_line, first_ring,
              static_cast<float>(list.rings.size()) - first_ring},
         .ripples = Vec4(0),
         .rippling = {0, 0, at.now, at.previous},
         .ocean = {0, 0, 0, look.distortion},
         .patches = Vec4(0),
         .variance = Vec4(0),
         .foam = {look.foam_below, 1 / look.foam_decay, 0, 0}});
}

/// Sorts flat patches, which no wave displaces, behind the others; both keep their order.
void move_flat_back(WaterList& list) {
    const auto is_flat = [&](const WaterPatch& patch) {
        const layout::WaterRecord& body = list.bodies[static_cast<std::size_t>(patch.body)];
        const bool has_fields = body.rippling.x > 0 || body.ocean.y > 0;
        return patch.lines == 0 && body.waves.w == 0 && !has_fields;
    };
    list.flat_patches.clear();
    std::ranges::copy_if(list.patches, std::back_inserter(list.flat_patches), is_flat);
    std::erase_if(list.patches, is_flat);
    list.first_flat_patch = list.patches.size();
    list.patches.insert(list.patches.end(), list.flat_patches.begin(), list.flat_patches.end());
}

/// The look that is actually available: without the planar reflection a body falls back to
/// screen-space reflections, without a reflection map to those of the environment, without a floor
/// map to traced refraction.
WaterLook available_look(const Water& water, const WaterLook* look, bool planar) {
    WaterLook available = look != nullptr ? *look : WaterLook{};
    const bool floor = available.floor_map.index != kNoAsset && water.depth > 0;
    if (available.refraction == WaterRefraction::Floor && !floor) {
        available.refraction = WaterRefraction::Traced;
    }
    if (available.reflection == WaterReflection::Map
        && available.reflection_map.index == kNoAsset) {
        available.reflection = WaterReflection::Environment;
    }
    if (available.reflection == WaterReflection::Planar && !planar) {
        available.reflection = WaterReflection::ScreenSpace;
    }
    return available;
}

}  // namespace

float pack_look(const WaterLook& look) {
    return static_cast<float>(
        static_cast<int>(look.fresnel) + 4 * static_cast<int>(look.reflection)
        + 16 * static_cast<int>(look.refraction));
}

void read_water_sources(const World& world, const RenderView& view, WaterSources& sources) {
    const auto* const time = world.find_resource<FrameTime>();
    const float step = time != nullptr ? time->step : 0.0f;
    sources.now = (view.alpha - 1) * step;
    sources.previous = (view.previous_alpha - 1) * step;
    sources.time = time != nullptr ? time->time : 0.0;
    sources.bodies.clear();
    sources.ripples.clear();
    sources.seas.clear();
    world
        .query<
            const Water, const WorldTransform, Optional<const WaterLook>,
            Optional<const WaterDetail>, Optional<const WaveTable>, Optional<const RippleState>,
            Optional<const OceanState>, Optional<const OceanFoam>, Optional<const Caustics>>()
        .each([&](Entity entity, const Water& water, const WorldTransform& pose,
                  const WaterLook* look, const WaterDetail* detail, const WaveTable* table,
                  const RippleState* rippling, const OceanState* sea, const OceanFoam* foam,
                  const Caustics* caustics) {
            sources.bodies.push_back(
                {entity, &water, look, detail, table, caustics, water_frame(pose.world)});
            sources.ripples.push_back(rippling);
            sources.seas.push_back({sea, foam, sources.now, sources.previous});
        });
}

void build_water_list(
    const WaterSources& sources, const RenderView& view, Entity planar, const RippleAtlas& ripples,
    const OceanTextures& seas, WaterList& list) {
    list.bodies.clear();
    list.lines.clear();
    list.rings.clear();
    list.patches.clear();
    list.around.reset();
    list.visible_from_below = false;
    list.entities.clear();
    list.caustics.clear();
    list.heights.clear();
    list.details.clear();
    list.looks = list.crests = list.planar = list.traced = list.bent = false;
    list.floor = list.ceiling = nullptr;
    for (std::size_t i = 0; i < sources.bodies.size(); ++i) {
        const WaterSources::Body& body = sources.bodies[i];
        list.entities.push_back(body.entity);
        list.caustics.push_back(body.caustics);
        if (list.floor == nullptr && body.look != nullptr
            && body.look->floor_map.index != kNoAsset) {
            list.floor = body.look;
        }
        if (list.ceiling == nullptr && body.look != nullptr
            && body.look->reflection_map.index != kNoAsset) {
            list.ceiling = body.look;
        }
        const WaterLook look = available_look(*body.water, body.look, body.entity == planar);
        add_body(sources, i, look, seas.layers()[i].margin, view, list);
        if (seas.layers()[i].patches > 0) {
            set_sea(seas, sources.seas[i], seas.layers()[i], list.bodies[i]);
        }
    }
    if (!sources.bodies.empty()) {
        set_ripples(ripples, sources.ripples, list);
    }
    move_flat_back(list);
}

}  // namespace limn
