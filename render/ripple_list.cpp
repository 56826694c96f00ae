#include "render/ripple_list.h"

#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/render_view.h"
#include "render/shadow/light_bounds.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace limn {
namespace {

constexpr double kRainCycle = 1024;  // [s] after which rain repeats: floats stay exact enough

/// Of a sphere; empty if it is nowhere in the picture.
std::optional<NdcRect> ndc_rect(const RenderView& view, const Vec3& center, float radius) {
    const LightBounds bounds = light_bounds(view, center, radius);
    if (is_empty(bounds)) {
        return std::nullopt;
    }
    const Vec2 pixel = {
        2.0f / static_cast<float>(view.width), 2.0f / static_cast<float>(view.height)};
    const Vec2 low = Vec2(bounds.x, bounds.y) * pixel - 1.0f;
    return NdcRect(low, low + Vec2(bounds.width, bounds.height) * pixel);
}

float view_distance(const RenderView& view, const Vec3& place) {
    float distance = 0;
    for (int i = 0; i < 3; ++i) {  // the camera looks along -z
        const Vec4& row = view.world_from_camera.row[i];
        distance -= row.z * (place[i] - row.w);
    }
    return distance;
}

Affine shown(const WorldTransform& now, const PreviousWorldTransform* before, float alpha) {
    return before == nullptr || alpha == 1.0f ? now.world
                                              : mix_affine(before->world, now.world, alpha);
}

void collect_rings(const World& world, const RenderView& view, float ago, RippleList& list) {
    world.query<const RippleRing, const WorldTransform, Optional<const PreviousWorldTransform>>()
        .each([&](const RippleRing& last, const WorldTransform& now,
                  const PreviousWorldTransform* before) {
            RippleRing ring = last;
            ring.age -= ago;
            const Affine place = shown(now, before, view.alpha);
            const Vec3 center = {place.row[0].w, place.row[1].w, place.row[2].w};
            const float radius = ring.start_radius + ring.speed * ring.age;
            const float amplitude = ring.amplitude * ripple_fade(ring);
            if (amplitude == 0 || !(ring.wavelength > 0)) {
                return;
            }
            if (const auto rect = ndc_rect(view, center, radius + ring.wavelength)) {
                list.rings.push_back(
                    {*rect, view_distance(view, center), center, radius, ring.wavelength,
                     amplitude});
            }
        });
}

void collect_hazes(const World& world, const RenderView& view, double time, RippleList& list) {
    world.query<const HeatHaze, const WorldTransform, Optional<const PreviousWorldTransform>>()
        .each([&](const HeatHaze& haze, const WorldTransform& now,
                  const PreviousWorldTransform* before) {
            const Mat4 place = to_mat4(shown(now, before, view.alpha));
            // The box lies within the sphere about its farthest corner.
            float reach = 0;
            for (int corner = 0; corner < 4; ++corner) {
                const Vec4 local(corner % 2 == 0 ? -1 : 1, corner / 2 == 0 ? -1 : 1, 1, 0);
                reach = std::max(reach, glm::length(Vec3(place * local)));
            }
            const bool flat = !(std::abs(glm::determinant(place)) > 1e-12f);
            if (haze.strength <= 0 || flat || !(haze.scale > 0)) {
                return;
            }
            const double raised = haze.rise * time / haze.scale;
            if (const auto rect = ndc_rect(view, Vec3(place[3]), reach)) {
                list.hazes.push_back(
                    {*rect, view_distance(view, Vec3(place[3])), glm::inverse(place), haze.shape,
                     haze.strength * static_cast<float>(view.height), haze.scale,
                     static_cast<float>(raised), haze.seed});
            }
        });
}

void collect_screens(const World& world, const RenderView& view, float ago, RippleList& list) {
    world.query<const ScreenRipple>().each([&](const ScreenRipple& last) {
        ScreenRipple ripple = last;
        ripple.age -= ago;
        const float radius = ripple.radius + ripple.radius_speed * ripple.age;
        const float amplitude = ripple.amplitude * ripple_fade(ripple);
        if (amplitude == 0 || radius <= 0) {
            return;
        }
        const float aspect =
            ripple.round ? static_cast<float>(view.width) / static_cast<float>(view.height) : 1.0f;
        list.screens.push_back({ripple.center, radius, amplitude, aspect, ripple.grid});
    });
}

}  // namespace

RippleList collect_ripples(const World& world, const RenderView& view) {
    RippleList list;
    const auto* clock = world.find_resource<FrameTime>();
    const float ago = clock != nullptr ? (1.0f - view.alpha) * clock->step : 0.0f;
    const double time = clock != nullptr ? clock->time - ago : 0.0;
    collect_rings(world, view, ago, list);
    collect_hazes(world, view, time, list);
    const auto nearer = [](const auto& a, const auto& b) { return a.distance < b.distance; };
    std::stable_sort(list.rings.begin(), list.rings.end(), nearer);
    std::stable_sort(list.hazes.begin(), list.hazes.end(), nearer);
    collect_screens(world, view, ago, list);
    const auto* rain = world.find_resource<LensRain>();
    if (rain != nullptr && rain->amount > 0 && rain->strength > 0) {
        list.rain = {*rain, static_cast<float>(std::fmod(time, kRainCycle))};
    }
    return list;
}

}  // namespace limn
