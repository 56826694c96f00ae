#include "render/water/water_reflection.h"

#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_frame.h"
#include "ecs/components/water_look.h"
#include "ecs/world.h"
#include "render/geometry/culling.h"

#include <algorithm>
#include <cmath>

// Techniques: water.reflection-refraction-maps

namespace limn {

namespace {

constexpr float kWaveMargin = 1.0f;  ///< around the rest rectangle, for displacement by waves [m]

/// Distance from the camera; nullopt if the water cannot be visible from above.
std::optional<float>
visible_distance(const Water& water, const WaterFrame& frame, const RenderView& view) {
    const auto& pose = view.world_from_camera.row;
    const Vec3 eye = frame.local({pose[0].w, pose[1].w, pose[2].w});
    if (!(eye.y > 0)) {
        return std::nullopt;
    }
    const Vec2 unbounded(1e9f);
    const Vec2 half = glm::mix(unbounded, 0.5f * water.size, glm::greaterThan(water.size, Vec2(0)));
    const Vec2 beside = glm::max(glm::abs(Vec2(eye.x, eye.z)) - half, Vec2(0));
    const Vec2 extent = glm::min(half + kWaveMargin, Vec2(1e5f));
    const Frustum frustum = make_frustum(view.clip_from_world);
    for (const Vec4& plane : frustum.planes) {
        const Vec3 normal = frame.direction_to_local(Vec3(plane));
        const float furthest =
            glm::dot(glm::abs(Vec2(normal.x, normal.z)), extent) + std::abs(normal.y) * kWaveMargin;
        if (glm::dot(Vec3(plane), frame.origin) + plane.w + furthest < 0) {
            return std::nullopt;
        }
    }
    return glm::length(Vec3(beside.x, eye.y, beside.y));
}

}  // namespace

std::optional<PlanarWater> find_planar_water(const World& world, const RenderView& view) {
    std::optional<PlanarWater> nearest;
    float nearest_distance = 0;
    world.query<const Water, const WorldTransform, const WaterLook>().each(
        [&](Entity entity, const Water& water, const WorldTransform& pose, const WaterLook& look) {
            if (look.reflection != WaterReflection::Planar) {
                return;
            }
            const WaterFrame frame = water_frame(pose.world);
            const std::optional<float> distance = visible_distance(water, frame, view);
            if (distance && (!nearest || *distance < nearest_distance)) {
                nearest_distance = *distance;
                nearest = {entity, frame.origin.y, std::clamp(look.map_scale, 0.1f, 1.0f)};
            }
        });
    return nearest;
}

RenderView make_reflected_view(const RenderView& view, float level, float map_scale) {
    Mat4 mirror(1.0f);
    mirror[1][1] = -1;
    mirror[3][1] = 2 * level;
    Mat4 upside_down(1.0f);
    upside_down[1][1] = -1;

    RenderView reflected = view;
    const auto scaled = [&](int side) {
        return std::max(1, static_cast<int>(std::lround(map_scale * static_cast<float>(side))));
    };
    reflected.width = scaled(view.width);
    reflected.height = scaled(view.height);
    Vec4* rows = reflected.world_from_camera.row;
    rows[1] = -rows[1];
    rows[1].w += 2 * level;
    for (int i = 0; i < 3; ++i) {
        rows[i].y = -rows[i].y;
    }
    reflected.unjittered_from_world = upside_down * view.unjittered_from_world * mirror;
    reflected.previous_clip_from_world = reflected.unjittered_from_world;
    reflected.clip_plane = {0, 1, 0, -level};
    reflected.lens = {};
    const Vec2 ratio = Vec2(reflected.width, reflected.height) / Vec2(view.width, view.height);
    return with_jitter(reflected, Vec2(view.jitter.x, -view.jitter.y) * ratio);
}

}  // namespace limn
