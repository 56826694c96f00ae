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

constexpr float kRippleReach =
    0.5f;  ///< of ripples up and down, at most [m]; higher ones may be cut
constexpr float kCellsPerWave = 16.0f;  ///< that the finest grid has for the shortest wave
constexpr float kFinest = 0.125f;       ///< side of a patch [m]
constexpr float kCellPixels = 28.0f;    ///< of the picture that a cell of a patch takes, at most
constexpr float kMostDetail = 12.0f;    ///< of very large pictures

/// Seconds from the end of the last step to the moments of a view.
struct Moments {
    float now = 0;
    float before = 0;
    double time = 0;  ///< at the end of the last step [s]
};

Moments moments_of(const World& world, const RenderView& view) {
    const auto* const time = world.find_resource<FrameTime>();
    const float step = time != nullptr ? time->step : 0.0f;
    return {
        (view.alpha - 1) * step, (view.alpha_before - 1) * step,
        time != nullptr ? time->time : 0.0};
}

/// The first `lines` of the table, and its rings.
void add_waves(const WaveTable& table, std::size_t lines, const Moments& at, WaterList& list) {
    for (const WaveLine& line : std::span(table.lines).first(lines)) {
        list.lines.push_back(
            {.run = Vec4(line.k, line.side),
             .phase = {
                 line.phase - line.frequency * at.now, line.phase - line.frequency * at.before,
                 line.amplitude, line.lean}});
    }
    for (const WaveRing& ring : table.rings) {
        const float front = ring.front_speed * at.now;
        list.rings.push_back(
            {.place = {ring.center.x, ring.center.y, ring.first + front, ring.last + front},
             .phase =
                 {ring.phase + ring.frequency * at.now, ring.phase + ring.frequency * at.before,
                  ring.k, ring.amplitude},
             .fade = {
                 ring.full, ring.smooth ? 1.0f : 0.0f, ring.front_speed * (at.before - at.now),
                 0}});
    }
}

/// How far waves may move the surface, up, down and sideways [m].
Vec3 reach_of(const WaveTable* table) {
    Vec3 reach(0);
    if (table != nullptr) {
        for (const WaveLine& line : table->lines) {
            reach += Vec3(std::abs(line.side.x), line.amplitude, std::abs(line.side.y));
        }
        for (const WaveRing& ring : table->rings) {
            reach.y += ring.amplitude;
        }
    }
    return reach;
}

/// Side of the smallest patch that shows all there is; `lines` of the table move vertices.
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
    return std::max(kFinest, cell * static_cast<float>(layout::kWaterGrid));
}

/// PatchSource::detail that makes the cells of patches small in the picture.
float detail_of(const RenderView& view) {
    const Mat4& m = view.clip_from_world;
    const float radian = 0.5f * static_cast<float>(view.width)
                         * glm::length(Vec3(m[0][0], m[1][0], m[2][0]));  // [px]
    const float cell = kCellPixels * static_cast<float>(layout::kWaterGrid);
    return glm::clamp(radian / cell, kLeastDetail, kMostDetail);
}

Mat4 matrix_of(const WaterFrame& frame) {
    Mat4 m(1.0f);
    m[0] = Vec4(frame.turned_out({1, 0, 0}), 0);
    m[2] = Vec4(frame.turned_out({0, 0, 1}), 0);
    m[3] = Vec4(frame.origin, 1);
    return m;
}

void place_ripples(const RippleAtlas& atlas, WaterList& list) {
    for (std::size_t i = 0; i < list.bodies.size(); ++i) {
        const AtlasPlace& place = atlas.places()[i];
        if (!place.fits) {
            continue;
        }
        const RippleState& state = *list.ripples[i];
        const Vec2 sheet(atlas.texture().width(), atlas.texture().height());
        const Vec2 scale = 1.0f / (state.cell * sheet);
        const Vec2 middle = (Vec2(place.corner) + 0.5f * Vec2(state.cells)) / sheet;
        list.bodies[i].ripples = Vec4(scale, middle);
        const Vec2 half = 0.5f * state.size();
        list.bodies[i].rippling.x = half.x;
        list.bodies[i].rippling.y = half.y;
    }
}

void place_sea(
    const OceanTextures& textures, const OceanSource& sea, const OceanPlace& place,
    layout::WaterRecord& body) {
    body.ocean = {
        static_cast<float>(place.first_layer), static_cast<float>(place.patches),
        static_cast<float>(textures.size()), body.ocean.w};
    for (int i = 0; i < place.patches; ++i) {
        body.patches[i] = 1.0f / sea.state->cascades[static_cast<std::size_t>(i)].patch;
    }
    body.variance = place.variance;
}

/// How low and high waves go that are no ripples of this body, and those.
Vec2 heights_of(float reach, const RippleState* ripples) {
    Vec2 heights(-reach, reach);
    if (ripples != nullptr && !ripples->height.empty()) {
        const auto [least, greatest] =
            std::minmax_element(ripples->height.begin(), ripples->height.end());
        heights += Vec2(*least, *greatest);
    }
    return heights;
}

struct Body {
    const Water* water = nullptr;
    const WaveTable* table = nullptr;
    WaterFrame frame;
    WaterLook look;
    const WaterDetail* detail = nullptr;
};

/// Whether a camera there is in this water, or may be.
std::optional<WaterAroundView> find_around(const PatchSource& source, float depth, float near) {
    const Vec3& eye = source.camera;
    const float reach = source.margin.y + 2 * near;
    const bool beside = (source.half.x > 0 && std::abs(eye.x) > source.half.x)
                        || (source.half.y > 0 && std::abs(eye.z) > source.half.y);
    if (beside || !(eye.y < reach) || (depth > 0 && eye.y < -depth)) {
        return std::nullopt;
    }
    return WaterAroundView{static_cast<int>(source.body), eye.y > -reach};
}

void add_body(
    const Body& body, const Moments& at, const Vec3& reach, const RenderView& view,
    WaterList& list) {
    const Water& water = *body.water;
    const Affine& pose = view.world_from_camera;
    const RippleState* const ripples = list.ripples[list.bodies.size()];
    const OceanState* const sea = list.seas[list.bodies.size()].state;
    const std::size_t lines = list.details.add(
        body.detail, body.table, kFinest / static_cast<float>(layout::kWaterGrid), at.time, at.now);
    PatchSource source;
    source.half = 0.5f * water.size;
    source.camera = body.frame.local({pose.row[0].w, pose.row[1].w, pose.row[2].w});
    source.margin = reach + reach_of(body.table);
    source.margin.y += ripples != nullptr ? kRippleReach : 0.0f;
    source.frustum = make_frustum(view.clip_from_world * matrix_of(body.frame));
    source.finest = finest_of(body.table, lines, ripples, sea);
    source.detail = detail_of(view);
    source.body = static_cast<float>(list.bodies.size());
    append_water_patches(source, list.patches);
    list.seen_from_below |= !(source.camera.y > source.margin.y);
    if (!list.around) {
        list.around = find_around(source, body.water->depth, view.near);
    }
    const bool by_height = list.caustics[list.bodies.size()] != nullptr
                           && list.caustics[list.bodies.size()]->method == CausticMethod::Pool;
    list.heights.push_back(
        by_height ? heights_of(reach.y + reach_of(body.table).y, ripples) : Vec2(0));

    list.looks = list.looks || pack_look(body.look) != 0;
    list.planar = list.planar || body.look.reflection == WaterReflection::Planar;
    list.bent = list.bent || body.look.refraction == WaterRefraction::Traced;
    list.traced = list.traced || body.look.reflection == WaterReflection::Picture;
    const auto first_line = static_cast<float>(list.lines.size());
    const auto first_ring = static_cast<float>(list.rings.size());
    if (body.table != nullptr) {
        add_waves(*body.table, lines, at, list);
    }
    list.bodies.push_back(
        {.origin = Vec4(body.frame.origin, body.frame.along_x.x),
         .shape = Vec4(body.frame.along_x.y, source.half, water.refractive_index),
         .absorption = Vec4(water.absorption, water.depth),
         .scattering = Vec4(water.scattering, pack_look(body.look)),
         .waves =
             {first_line, static_cast<float>(list.lines.size()) - first_line, first_ring,
              static_cast<float>(list.rings.size()) - first_ring},
         .ripples = Vec4(0),
         .rippling = {0, 0, at.now, at.before},
         .ocean = {0, 0, 0, body.look.distortion},
         .patches = Vec4(0),
         .variance = Vec4(0)});
}

/// One body has the planar reflection; another that asks for it makes do with the picture, as does
/// one with a floor that is not there.
WaterLook served_look(const Water& water, const WaterLook* look, bool planar) {
    WaterLook served = look != nullptr ? *look : WaterLook{};
    const bool floor = served.floor_map.index != kNoAsset && water.depth > 0;
    if (served.refraction == WaterRefraction::Floor && !floor) {
        served.refraction = WaterRefraction::Traced;
    }
    if (served.reflection == WaterReflection::Planar && !planar) {
        served.reflection = WaterReflection::Picture;
    }
    return served;
}

}  // namespace

float pack_look(const WaterLook& look) {
    return static_cast<float>(
        static_cast<int>(look.fresnel) + 4 * static_cast<int>(look.reflection)
        + 16 * static_cast<int>(look.refraction));
}

void collect_waters(
    const World& world, const RenderView& view, bool velocity, Entity planar, int max_texture_size,
    RippleAtlas& ripples, OceanTextures& seas, WaterList& list) {
    list.bodies.clear();
    list.lines.clear();
    list.rings.clear();
    list.patches.clear();
    list.ripples.clear();
    list.seas.clear();
    list.around.reset();
    list.seen_from_below = false;
    list.entities.clear();
    list.caustics.clear();
    list.heights.clear();
    list.details.clear();
    list.looks = list.planar = list.traced = list.bent = false;
    list.floor = nullptr;
    const Moments at = moments_of(world, view);
    std::vector<Body> bodies;
    world
        .query<
            const Water, const WorldTransform, Optional<const WaterLook>,
            Optional<const WaterDetail>, Optional<const WaveTable>, Optional<const RippleState>,
            Optional<const OceanState>, Optional<const OceanFoam>, Optional<const Caustics>>()
        .each([&](Entity entity, const Water& water, const WorldTransform& place,
                  const WaterLook* look, const WaterDetail* detail, const WaveTable* table,
                  const RippleState* rippling, const OceanState* sea, const OceanFoam* foam,
                  const Caustics* caustics) {
            list.entities.push_back(entity);
            if (list.floor == nullptr && look != nullptr && look->floor_map.index != kNoAsset) {
                list.floor = look;
            }
            list.caustics.push_back(caustics);
            bodies.push_back(
                {&water, table, water_frame(place.world),
                 served_look(water, look, entity == planar), detail});
            list.ripples.push_back(rippling);
            list.seas.push_back({sea, foam, at.now, at.before});
        });
    if (bodies.empty()) {
        return;
    }
    ripples.update(list.ripples, max_texture_size);
    seas.update(list.seas, velocity);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        add_body(bodies[i], at, seas.places()[i].reach, view, list);
        if (seas.places()[i].patches > 0) {
            place_sea(seas, list.seas[i], seas.places()[i], list.bodies[i]);
        }
    }
    place_ripples(ripples, list);
}

}  // namespace limn
