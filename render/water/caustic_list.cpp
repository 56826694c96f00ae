#include "render/water/caustic_list.h"

#include "ecs/base/optics.h"
#include "ecs/components/water_frame.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

namespace limn {
namespace {

constexpr float kLowestSun = 0.02f;    ///< sine of the height above the horizon
constexpr float kRim = 0.03f;          ///< of the map, beyond a rectangle of water
constexpr float kEndlessRim = 0.1f;    ///< of the map of endless water
constexpr float kBelowBottom = 0.05f;  ///< how far below the bottom light still lands [m]

WaterFrame frame_of(const layout::WaterRecord& body) {
    return {Vec3(body.origin), {body.origin.w, body.shape.x}};
}

/// Index of the brightest directional light that is above the horizon, or -1.
int brightest_sun(const LightList& lights) {
    int found = -1;
    float most = 0;
    for (int i = 0; i < lights.directional; ++i) {
        const layout::LightRecord& light = lights.records[static_cast<std::size_t>(i)];
        const float bright = light.color.x + light.color.y + light.color.z;
        if (light.position.y > kLowestSun && bright > most) {
            most = bright;
            found = i;
        }
    }
    return found;
}

float distance_to(const layout::WaterRecord& body, const Vec3& camera) {
    const Vec3 at = frame_of(body).local(camera);
    const Vec2 half(body.shape.y, body.shape.z);
    Vec3 out(0, at.y, 0);
    out.x = half.x > 0 ? std::max(std::abs(at.x) - half.x, 0.0f) : 0.0f;
    out.z = half.y > 0 ? std::max(std::abs(at.z) - half.y, 0.0f) : 0.0f;
    return glm::length(out);
}

float finite_or(float x, float fallback) {
    return std::isfinite(x) ? x : fallback;
}

Caustics make_sane(const Caustics& caustics) {
    Caustics sane = caustics;
    sane.resolution = static_cast<std::int32_t>(
        std::bit_ceil(static_cast<unsigned>(std::clamp(caustics.resolution, 64, 1024))));
    sane.spacing = std::clamp(caustics.spacing, 1, 8);
    sane.strength = std::clamp(finite_or(caustics.strength, 1.0f), 0.0f, 4.0f);
    sane.reach = std::clamp(finite_or(caustics.reach, 20.0f), 0.01f, 1000.0f);
    sane.window = std::clamp(finite_or(caustics.window, 40.0f), 0.1f, 10000.0f);
    return sane;
}

/// The part of the surface that a map is of, in the water's own space.
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
            // In whole steps, so that it does not swim when the camera moves.
            const float step = caustics.window / static_cast<float>(side) * 8;
            const float middle = std::floor((axis == 0 ? at.x : at.z) / step) * step;
            window.size[axis] = caustics.window;
            window.corner[axis] = middle - 0.5f * caustics.window;
            window.rim = std::min(window.rim, kEndlessRim * caustics.window);
        }
    }
    return window;
}

/// The world as the light of flat water sees it from the surface down to `depth`.
ShadowView make_water_view(
    const WaterFrame& frame, const Window& window, const Vec2& slant, float depth, int resolution) {
    // Rows of a matrix of the water's own space, then turned and moved there.
    Mat4 rows(0.0f);
    rows[0] = Vec4(1, slant.x, 0, -window.corner.x - 0.5f * window.size.x) * (2 / window.size.x);
    rows[1] = Vec4(0, slant.y, 1, -window.corner.y - 0.5f * window.size.y) * (2 / window.size.y);
    rows[2] = {0, 1 / depth, 0, 1};
    rows[3] = {0, 0, 0, 1};
    Mat4 local_from_world(1.0f);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit(0);
        unit[axis] = 1;
        local_from_world[axis] = Vec4(frame.turned_in(unit), 0);
    }
    local_from_world[3] = Vec4(frame.local(Vec3(0)), 1);
    ShadowView view;
    view.clip_from_world = glm::transpose(rows) * local_from_world;
    const Vec2 middle = window.corner + 0.5f * window.size;
    view.eye = frame.world({middle.x, 0, middle.y});
    view.resolution = resolution;
    return view;
}

layout::SunkenRecord sunken_of(const layout::WaterRecord& body) {
    return {
        .origin = body.origin,
        .shape = body.shape,
        .extinction = Vec4(Vec3(body.absorption) + Vec3(body.scattering), body.absorption.w),
        .window = Vec4(0, 0, 1, 1),
        .map = Vec4(-1, -1, -1, 0),
        .bent = Vec4(0)};
}

}  // namespace

Vec2 flat_slant(const Vec3& to_sun, float index) {
    const Vec3 ray = refract_ray({0, 1, 0}, to_sun, 1 / index);
    return Vec2(ray.x, ray.z) / std::max(-ray.y, 0.1f);
}

void collect_caustics(
    const WaterList& waters,
    const LightList& lights,
    const Vec3& camera,
    bool maps,
    CausticList& list,
    ShadowList& shadows) {
    list.sunken.clear();
    list.maps.clear();
    list.resolution = list.cells = 0;
    shadows.waters.clear();
    std::vector<std::size_t> order(waters.bodies.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return distance_to(waters.bodies[a], camera) < distance_to(waters.bodies[b], camera);
    });
    order.resize(std::min(order.size(), kMaxSunkenWaters));

    const int sun = brightest_sun(lights);
    std::vector<std::size_t> mapped;
    for (const std::size_t i : order) {
        if (sun >= 0 && waters.caustics[i] != nullptr && mapped.size() < kMaxCausticMaps) {
            mapped.push_back(i);
            list.resolution = std::max(
                list.resolution, static_cast<int>(make_sane(*waters.caustics[i]).resolution));
        }
    }
    std::sort(mapped.begin(), mapped.end());  // layers stay when the camera moves
    for (const std::size_t i : order) {
        list.sunken.push_back(sunken_of(waters.bodies[i]));
        const auto found = std::lower_bound(mapped.begin(), mapped.end(), i);
        if (found != mapped.end() && *found == i) {
            list.sunken.back().map.x = static_cast<float>(found - mapped.begin());
        }
    }
    for (std::size_t layer = 0; layer < mapped.size(); ++layer) {
        const layout::WaterRecord& body = waters.bodies[mapped[layer]];
        const Caustics caustics = make_sane(*waters.caustics[mapped[layer]]);
        const layout::LightRecord& light = lights.records[static_cast<std::size_t>(sun)];
        const WaterFrame frame = frame_of(body);
        const Vec3 to_sun = frame.turned_in(Vec3(light.position));
        const float index = body.shape.w;
        const Vec2 slant = flat_slant(to_sun, index);
        const Window window = window_of(body, caustics, camera, list.resolution);
        const float bottom = body.absorption.w > 0 ? body.absorption.w + kBelowBottom : 1e9f;
        const float depth = std::min(bottom, caustics.reach);
        const int cells = list.resolution / caustics.spacing;
        list.cells = std::max(list.cells, cells);
        const Vec2 heights = waters.heights[mapped[layer]];
        list.maps.push_back(
            {.window = Vec4(window.corner, window.size),
             .to_sun = Vec4(to_sun, static_cast<float>(mapped[layer])),
             .bent = Vec4(slant, depth, (1 - fresnel(to_sun.y, index)) * to_sun.y),
             .shadows = Vec4(0),
             .world = Vec4(Vec3(light.position), -1),
             .grid =
                 {static_cast<float>(cells),
                  static_cast<float>(list.resolution),
                  window.rim,
                  static_cast<float>(caustics.method)},
             .pool = {
                 body.shape.y > 0 ? body.shape.y : 1e6f,
                 body.shape.z > 0 ? body.shape.z : 1e6f,
                 heights.x,
                 1 / std::max(heights.y - heights.x, 1e-4f)}});
        shadows.waters.push_back(
            {waters.entities[mapped[layer]],
             make_water_view(frame, window, slant, depth, list.resolution)});
        for (layout::SunkenRecord& sunken : list.sunken) {
            if (sunken.map.x == static_cast<float>(layer)) {
                sunken.window = Vec4(window.corner, 1.0f / window.size);
                sunken.map = {
                    maps ? static_cast<float>(layer) : -1.0f,
                    static_cast<float>(layer),  // its view, until place_caustics()
                    static_cast<float>(sun),
                    0.999f * depth};
                sunken.bent = Vec4(slant, caustics.strength, 0);
            }
        }
    }
}

void place_caustics(const LightList& lights, const ShadowList& shadows, CausticList& list) {
    for (layout::SunkenRecord& sunken : list.sunken) {
        if (sunken.map.y >= 0) {
            const auto layer = static_cast<std::size_t>(sunken.map.y);
            const layout::LightRecord& light =
                lights.records[static_cast<std::size_t>(sunken.map.z)];
            list.maps[layer].shadows = light.shadow;
            list.maps[layer].world.w = static_cast<float>(shadows.waters[layer].record);
            sunken.map.y = list.maps[layer].world.w;
        }
    }
    std::reverse(list.sunken.begin(), list.sunken.end());  // of several, the last one counts
    list.texels.assign(
        1 + list.sunken.size() * layout::kSunkenTexels,
        Vec4(static_cast<float>(list.sunken.size()), 0, 0, 0));
    if (!list.sunken.empty()) {
        std::memcpy(
            list.texels.data() + 1,
            list.sunken.data(),
            list.sunken.size() * sizeof(layout::SunkenRecord));
    }
}

}  // namespace limn
