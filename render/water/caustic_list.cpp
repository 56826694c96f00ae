#include "render/water/caustic_list.h"

#include "ecs/base/optics.h"
#include "ecs/components/water_frame.h"
#include "render/geometry/culling.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

// Techniques: caustic.projected-vertices

namespace limn {
namespace {

constexpr float kMinSunSine = 0.02f;       ///< sine of the height above the horizon
constexpr float kRim = 0.03f;              ///< of the map, around a rectangle of water
constexpr float kUnboundedRim = 0.1f;      ///< of the map of unbounded water
constexpr float kBelowBottom = 0.05f;      ///< how far below the bottom light still lands [m]
constexpr int kMinMapSide = 32;            ///< of distant maps [texels]
constexpr float kFullResolutionRange = 2;  ///< in window sides; nearer maps have full size
constexpr int kMaxGridSide = 64;           ///< cells of the world grid per side
constexpr std::size_t kMaxWatersWithoutGrid = 4;  ///< fewer bounded waters need no grid
constexpr float kCascadeRatio = 4;                ///< of the windows of unbounded water
constexpr int kMaxCausticCascades = 3;
constexpr float kMirrorRim = 0.2f;  ///< fraction of the cells of a reflection map, on each side

WaterFrame frame_of(const layout::WaterRecord& body) {
    return {Vec3(body.origin), {body.origin.w, body.shape.x}};
}

/// Index of the brightest directional light that is above the horizon, or -1.
int brightest_sun(const LightList& lights) {
    int found = -1;
    float brightest = 0;
    for (int i = 0; i < lights.directional; ++i) {
        const layout::LightRecord& light = lights.records[static_cast<std::size_t>(i)];
        const float brightness = light.color.x + light.color.y + light.color.z;
        if (light.position.y > kMinSunSine && brightness > brightest) {
            brightest = brightness;
            found = i;
        }
    }
    return found;
}

float distance_to_water(const layout::WaterRecord& body, const Vec3& camera) {
    const Vec3 at = frame_of(body).local(camera);
    const Vec2 half(body.shape.y, body.shape.z);
    Vec3 out(0, at.y, 0);
    out.x = half.x > 0 ? std::max(std::abs(at.x) - half.x, 0.0f) : 0.0f;
    out.z = half.y > 0 ? std::max(std::abs(at.z) - half.y, 0.0f) : 0.0f;
    return glm::length(out);
}

std::int32_t power_of_two(std::int32_t side, std::int32_t min_side) {
    return static_cast<std::int32_t>(
        std::bit_ceil(static_cast<unsigned>(std::clamp(side, min_side, 1024))));
}

Caustics sanitize(const Caustics& caustics) {
    Caustics valid = caustics;
    valid.resolution = power_of_two(caustics.resolution, 64);
    valid.mirror_resolution = power_of_two(caustics.mirror_resolution, 32);
    valid.cascades = std::clamp(caustics.cascades, 1, kMaxCausticCascades);
    valid.shaft_steps = std::clamp(caustics.shaft_steps, 0, 64);
    valid.mirror_reach = std::clamp(finite_or(caustics.mirror_reach, 0.0f), 0.0f, 1000.0f);
    valid.spacing = std::clamp(caustics.spacing, 1, 8);
    valid.strength = std::clamp(finite_or(caustics.strength, 1.0f), 0.0f, 4.0f);
    valid.reach = std::clamp(finite_or(caustics.reach, 20.0f), 0.01f, 1000.0f);
    valid.window = std::clamp(finite_or(caustics.window, 40.0f), 0.1f, 10000.0f);
    return valid;
}

/// The part of the surface that a map covers, in the water's own space.
struct Window {
    Vec2 corner = {0, 0};
    Vec2 size = {0, 0};
    float rim = 0;
};

Window
window_of(const layout::WaterRecord& body, const Caustics& caustics, const Vec3& camera, int side) {
    const Vec3 at = frame_of(body).local(camera);
    Window window;
    window.rim = 1e9f;
    for (int axis = 0; axis < 2; ++axis) {
        const float half = axis == 0 ? body.shape.y : body.shape.z;
        if (half > 0) {
            window.size[axis] = 2 * half * (1 + 2 * kRim);
            window.corner[axis] = -0.5f * window.size[axis];
            window.rim = std::min(window.rim, 2 * half * kRim);
        } else {
            // Snapped, so that it does not swim when the camera moves.
            const float step = caustics.window / static_cast<float>(side) * 8;
            const float center = std::floor((axis == 0 ? at.x : at.z) / step) * step;
            window.size[axis] = caustics.window;
            window.corner[axis] = center - 0.5f * caustics.window;
            window.rim = std::min(window.rim, kUnboundedRim * caustics.window);
        }
    }
    return window;
}

/// The same for reflected light, followed up to `height`: the border of a rectangle lies at cell
/// centers, so that border cells get the right amount of light.
Window mirror_window(
    const layout::WaterRecord& body, const Caustics& caustics, const Vec3& camera,
    const Vec2& slant, int cells) {
    // For unbounded water, the part that reflects light to the camera's surroundings.
    Window window = window_of(
        body, caustics,
        camera
            - frame_of(body).direction_to_world(Vec3(slant.x, 0, slant.y)) * 0.5f
                  * caustics.mirror_reach,
        caustics.mirror_resolution);
    const auto count = static_cast<float>(cells);
    const float inner = count - 2 * (std::floor(kMirrorRim * count) + 0.5f);
    for (int axis = 0; axis < 2; ++axis) {
        const float half = axis == 0 ? body.shape.y : body.shape.z;
        if (half > 0) {
            window.size[axis] = 2 * half * count / inner;
            window.corner[axis] = -0.5f * window.size[axis];
        }
    }
    return window;
}

/// View of the world along light in flat water, from the surface to `depth` below it; above it if
/// negative.
ShadowView make_water_view(
    const WaterFrame& frame, const Window& window, const Vec2& slant, float depth, int resolution) {
    // Rows of a matrix in the water's own space. Horizontal displacement of the light per meter
    // along y:
    const Vec2 displacement = depth > 0 ? slant : -slant;
    Mat4 rows(0.0f);
    rows[0] =
        Vec4(1, displacement.x, 0, -window.corner.x - 0.5f * window.size.x) * (2 / window.size.x);
    rows[1] =
        Vec4(0, displacement.y, 1, -window.corner.y - 0.5f * window.size.y) * (2 / window.size.y);
    rows[2] = {0, 1 / depth, 0, 1};
    rows[3] = {0, 0, 0, 1};
    Mat4 local_from_world(1.0f);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit(0);
        unit[axis] = 1;
        local_from_world[axis] = Vec4(frame.direction_to_local(unit), 0);
    }
    local_from_world[3] = Vec4(frame.local(Vec3(0)), 1);
    ShadowView view;
    view.clip_from_world = glm::transpose(rows) * local_from_world;
    const Vec2 center = window.corner + 0.5f * window.size;
    view.eye = frame.world({center.x, 0, center.y});
    view.resolution = resolution;
    return view;
}

layout::UnderwaterRecord sunken_of(const layout::WaterRecord& body) {
    return {
        .origin = body.origin,
        .shape = body.shape,
        .extinction = Vec4(Vec3(body.absorption) + Vec3(body.scattering), body.absorption.w),
        .maps = Vec4(0, 0, -1, 0),
        .bent = Vec4(0)};
}

/// A water with caustics, and the light that causes them.
struct Source {
    const WaterList& waters;
    std::size_t body;
    Caustics caustics;  ///< clamped
    const layout::LightRecord& light;
    Vec3 to_sun;  ///< in the water's own space
};

/// Map index within its water: cascades below the surface, or kAbove.
constexpr int kAbove = kMaxCausticCascades;

/// Appends a map, its tile of the atlas and its shadow view.
void add_map(
    const Source& source, int part, const Window& window, const Vec2& slant, float depth_range,
    bool make, CausticList& list, std::vector<WaterShadow>& shadows) {
    const layout::WaterRecord& body = source.waters.bodies[source.body];
    const bool above = part == kAbove;
    const int side = above ? source.caustics.mirror_resolution : source.caustics.resolution;
    const float reflectance = fresnel(source.to_sun.y, body.shape.w);
    const Vec2 heights = source.waters.heights[source.body];
    list.tiles.push_back(
        {.window = Vec4(window.corner, 1.0f / window.size),
         .rect = {0, 0, static_cast<float>(side), make ? 1.0f : 0.0f},
         .view = {-1, window.rim / std::max(window.size.x, window.size.y), depth_range, 0}});
    list.maps.push_back(
        {.window = Vec4(window.corner, window.size),
         .to_sun = Vec4(source.to_sun, static_cast<float>(source.body)),
         .bent =
             Vec4(slant, depth_range, (above ? reflectance : 1 - reflectance) * source.to_sun.y),
         .shadows = Vec4(0),
         .world = Vec4(Vec3(source.light.position), -1),
         .grid =
             {static_cast<float>(side / std::min(source.caustics.spacing, side)),
              static_cast<float>(side), window.rim,
              above ? layout::kCausticsMirrored : static_cast<float>(source.caustics.method)},
         .pool =
             {body.shape.y > 0 ? body.shape.y : 1e6f, body.shape.z > 0 ? body.shape.z : 1e6f,
              heights.x, 1 / std::max(heights.y - heights.x, 1e-4f)},
         .target = {0, 0, 0, source.caustics.strength},
         .wires = Vec4(static_cast<float>(source.caustics.wires), 0, 0, 0)});
    shadows.push_back(
        {source.waters.entities[source.body], static_cast<std::uint64_t>(part),
         make_water_view(frame_of(body), window, slant, above ? -depth_range : depth_range, side)});
}

/// Appends the maps of light refracted into this water.
void add_below(
    const Source& source, const Vec3& camera, int light, bool make,
    layout::UnderwaterRecord& sunken, CausticList& list, std::vector<WaterShadow>& shadows) {
    const layout::WaterRecord& body = source.waters.bodies[source.body];
    const Caustics& caustics = source.caustics;
    const Vec2 slant = refracted_slope(source.to_sun, body.shape.w);
    const float bottom = body.absorption.w > 0 ? body.absorption.w + kBelowBottom : 1e9f;
    const float depth = std::min(bottom, caustics.reach);
    const bool unbounded = body.shape.y <= 0 || body.shape.z <= 0;
    const int count = unbounded ? caustics.cascades : 1;
    sunken.maps = {
        static_cast<float>(list.tiles.size()), static_cast<float>(count), static_cast<float>(light),
        0.999f * depth};
    sunken.bent = Vec4(slant, caustics.strength, static_cast<float>(caustics.shaft_steps));
    Caustics ring = caustics;
    for (int i = 0; i < count; ++i) {
        const Window window = window_of(body, ring, camera, caustics.resolution);
        add_map(source, i, window, slant, depth, make, list, shadows);
        ring.window *= kCascadeRatio;
    }
}

/// Appends the map of light that it reflects.
void add_above(
    const Source& source, const Vec3& camera, int light, CausticList& list,
    std::vector<WaterShadow>& shadows) {
    const layout::WaterRecord& body = source.waters.bodies[source.body];
    const Caustics& caustics = source.caustics;
    const Vec2 slant = reflected_slope(source.to_sun);
    const int cells = caustics.mirror_resolution / caustics.spacing;
    list.mirrors.push_back(
        {.origin = body.origin,
         .shape =
             {body.shape.x, static_cast<float>(list.tiles.size()), static_cast<float>(light),
              0.999f * caustics.mirror_reach},
         .bent = Vec4(slant, fresnel(source.to_sun.y, body.shape.w), 0)});
    const Window window = mirror_window(body, caustics, camera, slant, cells);
    add_map(source, kAbove, window, slant, caustics.mirror_reach, true, list, shadows);
}

/// Packs the maps into the atlas: largest first, along a Z-order curve, so that no space is wasted
/// between them.
void pack_caustic_atlas(CausticList& list) {
    std::vector<std::size_t> order(list.maps.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return list.maps[a].grid.y > list.maps[b].grid.y;
    });
    std::uint64_t texels = 0;
    for (const std::size_t i : order) {
        layout::CausticRecord& map = list.maps[i];
        const int side = static_cast<int>(map.grid.y);
        IVec2 at(0);
        for (int bit = 0; bit < 16; ++bit) {
            at.x |= static_cast<int>(texels >> (2 * bit) & 1) << bit;
            at.y |= static_cast<int>(texels >> (2 * bit + 1) & 1) << bit;
        }
        texels += static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side);
        map.target.x = list.tiles[i].rect.x = static_cast<float>(at.x);
        map.target.y = list.tiles[i].rect.y = static_cast<float>(at.y);
        list.atlas = glm::max(list.atlas, at + side);
    }
}

/// Appends the bytes of records as texels.
template <typename Record>
void append(std::vector<Vec4>& texels, const std::vector<Record>& records) {
    const std::size_t first = texels.size();
    texels.resize(first + records.size() * sizeof(Record) / sizeof(Vec4));
    if (!records.empty()) {
        std::memcpy(texels.data() + first, records.data(), records.size() * sizeof(Record));
    }
}

/// Builds the work group list of the rays of all maps.
void list_rays(CausticList& list) {
    list.jobs.clear();
    list.rays = 0;
    for (std::size_t i = 0; i < list.maps.size(); ++i) {
        const auto points = static_cast<std::size_t>(list.maps[i].grid.x) + 1;
        list.maps[i].target.z = static_cast<float>(list.rays);
        for (std::size_t first = 0; first < points * points; first += layout::kRayGroup) {
            list.jobs.emplace_back(static_cast<float>(i), static_cast<float>(first), 0, 0);
        }
        list.rays += points * points;
    }
    list.groups = static_cast<int>(list.jobs.size());
    append(list.jobs, list.maps);
}

}  // namespace

Vec2 refracted_slope(const Vec3& to_sun, float index) {
    const Vec3 ray = refract_ray({0, 1, 0}, to_sun, 1 / index);
    return Vec2(ray.x, ray.z) / std::max(-ray.y, 0.1f);
}

Vec2 reflected_slope(const Vec3& to_sun) {
    return -Vec2(to_sun.x, to_sun.z) / std::max(to_sun.y, kMinSunSine);
}

namespace {

/// Halves the resolution repeatedly for waters that are far away for their size.
void adapt(Caustics& caustics, const layout::WaterRecord& body, float distance) {
    const float across = 2 * std::max(body.shape.y, body.shape.z);
    float range = kFullResolutionRange * (across > 0 ? across : INFINITY);
    while (distance > range && caustics.resolution > kMinMapSide) {
        caustics.resolution /= 2;
        caustics.mirror_resolution = std::max(caustics.mirror_resolution / 2, kMinMapSide);
        range *= 2;
    }
}

/// Whether anything in the water may be visible.
bool may_be_visible(const layout::WaterRecord& body, const Frustum& frustum) {
    if (body.shape.y <= 0 || body.shape.z <= 0 || body.absorption.w <= 0) {
        return true;
    }
    const WaterFrame frame = frame_of(body);
    const Vec3 half(body.shape.y, 0.5f * body.absorption.w + kBelowBottom, body.shape.z);
    const Vec3 center = frame.world({0, -0.5f * body.absorption.w, 0});
    return std::none_of(
        std::begin(frustum.planes), std::end(frustum.planes), [&](const Vec4& plane) {
            const Vec3 normal = frame.direction_to_local(Vec3(plane));
            const float radius = glm::dot(glm::abs(normal), half);
            return glm::dot(Vec3(plane), center) + plane.w < -radius;
        });
}

/// Waters with maps, nearest first, with resolutions reduced to the texel budget.
struct ChosenWater {
    std::size_t body = 0;
    Caustics caustics;
};
std::vector<ChosenWater> choose_waters(
    const WaterList& waters, const std::vector<std::size_t>& order, const Vec3& camera,
    const Frustum& frustum) {
    std::vector<ChosenWater> chosen;
    std::int64_t texels = 0;
    const auto size_of = [](const Caustics& c) {
        return std::int64_t{c.resolution} * c.resolution * c.cascades;
    };
    for (const std::size_t i : order) {
        if (waters.caustics[i] != nullptr && chosen.size() < kMaxCausticMaps
            && (waters.caustics[i]->mirror_reach > 0
                || may_be_visible(waters.bodies[i], frustum))) {
            ChosenWater choice = {i, sanitize(*waters.caustics[i])};
            adapt(choice.caustics, waters.bodies[i], distance_to_water(waters.bodies[i], camera));
            texels += size_of(choice.caustics);
            chosen.push_back(choice);
        }
    }
    for (bool more = true; texels > kMaxCausticTexels && more;) {
        more = false;
        for (std::size_t i = chosen.size(); i-- > 0 && texels > kMaxCausticTexels;) {
            Caustics& caustics = chosen[i].caustics;
            if (caustics.resolution > kMinMapSide) {
                texels -= size_of(caustics);
                caustics.resolution /= 2;
                texels += size_of(caustics);
                more = true;
            }
        }
    }
    return chosen;
}

/// The world grid, and the waters that may overlap each cell.
void append_grid(CausticList& list) {
    Vec2 low(1e9f);
    Vec2 high(-1e9f);
    std::vector<std::array<Vec2, 2>> boxes;
    std::size_t bounded = 0;
    for (const layout::UnderwaterRecord& sunken : list.sunken) {
        const Vec2 center(finite_or(sunken.origin.x, 0), finite_or(sunken.origin.z, 0));
        const Vec2 axis = glm::abs(Vec2(sunken.origin.w, sunken.shape.x));
        const Vec2 half(sunken.shape.y, sunken.shape.z);
        const Vec2 extent =
            half.x > 0 && half.y > 0
                ? Vec2(axis.x * half.x + axis.y * half.y, axis.y * half.x + axis.x * half.y) + 0.01f
                : Vec2(1e9f);
        boxes.push_back({center - extent, center + extent});
        if (extent.x < 1e9f) {
            low = glm::min(low, boxes.back()[0]);
            high = glm::max(high, boxes.back()[1]);
            ++bounded;
        }
    }
    const int side =
        bounded <= kMaxWatersWithoutGrid
            ? 1
            : std::min(kMaxGridSide, static_cast<int>(2 * std::sqrt(static_cast<float>(bounded))));
    const Vec2 origin = bounded > 0 ? low : Vec2(0);
    const Vec2 size = bounded > 0 ? glm::max(high - low, Vec2(1e-3f)) : Vec2(1);
    const Vec2 per_meter = static_cast<float>(side) / size;
    const std::size_t first = list.texels.size();
    list.texels[0].w = static_cast<float>(first);
    list.texels[1] = Vec4(origin, per_meter);
    list.texels[2] = Vec4(static_cast<float>(side), static_cast<float>(side), 0, 0);
    const auto cell_of = [&](const Vec2& at) {
        return IVec2(
            glm::clamp((at - origin) * per_meter, Vec2(0), Vec2(static_cast<float>(side - 1))));
    };
    std::vector<std::vector<std::size_t>> cells(static_cast<std::size_t>(side * side));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const IVec2 from = cell_of(boxes[i][0]);
        const IVec2 to = cell_of(boxes[i][1]);
        for (int z = from.y; z <= to.y; ++z) {
            for (int x = from.x; x <= to.x; ++x) {
                cells[static_cast<std::size_t>(z * side + x)].push_back(i);
            }
        }
    }
    std::size_t at = first + cells.size();
    for (const std::vector<std::size_t>& cell : cells) {
        list.texels.emplace_back(
            static_cast<float>(at), static_cast<float>(at + cell.size()), 0, 0);
        at += cell.size();
    }
    for (const std::vector<std::size_t>& cell : cells) {
        for (const std::size_t i : cell) {
            list.texels.emplace_back(static_cast<float>(i), 0, 0, 0);
        }
    }
}

}  // namespace

void collect_caustics(
    const WaterList& waters, const LightList& lights, const RenderView& view, bool maps,
    CausticList& list, std::vector<WaterShadow>& shadows) {
    const auto& pose = view.world_from_camera.row;
    const Vec3 camera(pose[0].w, pose[1].w, pose[2].w);
    list.sunken.clear();
    list.mirrors.clear();
    list.tiles.clear();
    list.maps.clear();
    list.atlas = {0, 0};
    shadows.clear();
    std::vector<std::size_t> order(waters.bodies.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return distance_to_water(waters.bodies[a], camera)
               < distance_to_water(waters.bodies[b], camera);
    });
    const int sun = brightest_sun(lights);
    const std::vector<ChosenWater> chosen =
        sun >= 0 ? choose_waters(waters, order, camera, make_frustum(view.clip_from_world))
                 : std::vector<ChosenWater>{};
    std::size_t next = 0;
    for (const std::size_t i : order) {
        layout::UnderwaterRecord& sunken = list.sunken.emplace_back(sunken_of(waters.bodies[i]));
        if (next == chosen.size() || chosen[next].body != i) {
            continue;
        }
        const layout::LightRecord& light = lights.records[static_cast<std::size_t>(sun)];
        const Source source = {
            waters, i, chosen[next++].caustics, light,
            frame_of(waters.bodies[i]).direction_to_local(Vec3(light.position))};
        add_below(source, camera, sun, maps, sunken, list, shadows);
        if (maps && source.caustics.mirror_reach > 0 && list.mirrors.size() < kMaxMirrorMaps) {
            add_above(source, camera, sun, list, shadows);
        }
    }
    if (maps) {
        pack_caustic_atlas(list);
    }
}

void finish_caustics(const LightList& lights, const ShadowList& shadows, CausticList& list) {
    const int sun = brightest_sun(lights);
    for (std::size_t i = 0; i < list.maps.size(); ++i) {
        list.maps[i].shadows = lights.records[static_cast<std::size_t>(sun)].shadow;
        list.maps[i].world.w = list.tiles[i].view.x = static_cast<float>(shadows.waters[i].record);
    }
    list_rays(list);
    std::reverse(list.sunken.begin(), list.sunken.end());  // where they overlap, the last wins
    list.texels.clear();
    const layout::WaterLightHeader head = {
        .counts =
            {static_cast<float>(list.sunken.size()), static_cast<float>(list.mirrors.size()),
             static_cast<float>(list.tiles.size()), 0},
        .grid = Vec4(0),
        .cells = Vec4(0)};
    append(list.texels, std::vector{head});
    append(list.texels, list.sunken);
    append(list.texels, list.mirrors);
    append(list.texels, list.tiles);
    append_grid(list);
}

}  // namespace limn
