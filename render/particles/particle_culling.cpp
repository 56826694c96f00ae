#include "render/particles/particle_culling.h"

#include "render/particles/particle_list.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace limn {
namespace {

constexpr Bounds kAnywhere = {Vec3(-INFINITY), Vec3(INFINITY)};

/// False if the box, grown by `margin`, is outside one of the planes. NaN counts as inside.
bool may_be_in_view(const Frustum& frustum, const Vec3& center_ws, const Vec3& half, float margin) {
    return std::none_of(
        std::begin(frustum.planes), std::end(frustum.planes), [&](const Vec4& plane) {
            const Vec3 normal = Vec3(plane);
            const float radius_along =
                glm::dot(glm::abs(normal), half) + margin * glm::length(normal);
            return glm::dot(normal, center_ws) + plane.w < -radius_along;
        });
}

/// Scales the planes to unit normals.
Frustum normalized(Frustum frustum) {
    for (Vec4& plane : frustum.planes) {
        plane /= std::max(glm::length(Vec3(plane)), 1e-30f);
    }
    return frustum;
}

/// The same for a sphere; `frustum` must be normalized.
bool may_be_in_view(const Frustum& frustum, const Vec3& center_ws, float radius) {
    return std::none_of(
        std::begin(frustum.planes), std::end(frustum.planes),
        [&](const Vec4& plane) { return glm::dot(Vec3(plane), center_ws) + plane.w < -radius; });
}

}  // namespace

float max_width(const ParticleLook& look) {
    float factor = look.size_curve.empty() ? 1.0f : 0.0f;
    for (const CurveKey& key : look.size_curve) {
        factor = std::max(factor, key.value);
    }
    return look.size * factor;
}

Bounds shape_bounds(const ParticleEmitter& emitter, const Affine& world) {
    const bool is_point = emitter.shape == EmitterShape::Point;
    const Vec3 tube =
        emitter.shape == EmitterShape::Torus ? Vec3(emitter.size.y, 0, emitter.size.y) : Vec3(0);
    const Vec3 half = (is_point ? Vec3(0) : emitter.size + tube) + emitter.size_spread;
    return transform_bounds(world, {-half, half});
}

Bounds travel_bounds(const ParticleEmitter& emitter, const Affine& world) {
    const float speed = std::abs(emitter.speed) + emitter.speed_spread;
    const float travel = speed * (emitter.life + emitter.life_spread);
    const Bounds shape = shape_bounds(emitter, world);
    return {shape.min - travel, shape.max + travel};
}

Bounds bounds_of(std::span<const ParticleInstance> instances) {
    Bounds bounds;
    for (const ParticleInstance& instance : instances) {
        bounds.min = glm::min(bounds.min, instance.position);
        bounds.max = glm::max(bounds.max, instance.position);
    }
    return bounds;
}

Bounds bounds_of(const ParticleInstance& instance, const LookRecord& look) {
    const float facing = look[2].w;
    const bool is_quad = facing == static_cast<float>(ParticleFacing::Camera)
                         || facing == static_cast<float>(ParticleFacing::Ground)
                         || facing == static_cast<float>(ParticleFacing::Point);
    const Vec3& p = instance.position;
    const float radius = corner_radius(instance, look);
    const bool is_finite = std::isfinite(p.x + p.y + p.z + radius);
    return is_quad && is_finite ? Bounds{p - radius, p + radius} : kAnywhere;
}

bool is_group_in_view(const LookExtent& extent, const Frustum& frustum) {
    const Bounds& group = extent.group;
    return is_empty(group)
           || may_be_in_view(frustum, center(group), half_extent(group), extent.radius);
}

LookExtent make_look_extent(const ParticleLook& look) {
    LookExtent extent;
    extent.culling = look.culling;
    if (look.facing != ParticleFacing::Pixels) {
        // Half the diagonal of the square, at its largest.
        const float spread = look.size > 0 ? 1 + std::abs(look.size_spread) / look.size : INFINITY;
        extent.radius = 0.7072f * max_width(look) * spread + look.cull_margin;
        extent.stretch =
            look.facing == ParticleFacing::Velocity ? 0.5f * std::abs(look.stretch) : 0;
    }
    return extent;
}

void cull_particles(
    const std::vector<ParticleInstance>& instances, const std::vector<LookExtent>& extents,
    const Frustum& frustum, std::vector<std::uint8_t>& visible) {
    std::vector<std::uint8_t> group_visible(extents.size());
    for (std::size_t i = 0; i < extents.size(); ++i) {
        group_visible[i] = is_group_in_view(extents[i], frustum) ? 1 : 0;
    }
    const Frustum planes = normalized(frustum);
    visible.resize(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const std::uint32_t look = instances[i].look_and_life >> 16;
        const LookExtent& extent = extents[look];
        if (extent.culling != ParticleCulling::Particles) {
            visible[i] = group_visible[look];
            continue;
        }
        const Vec3& position = instances[i].position;
        visible[i] = may_be_in_view(planes, position, extent.radius);
        if (visible[i] == 0 && extent.stretch > 0) {  // the few that need it unpack their speed
            const float speed = glm::length(Vec3(instances[i].motion()));
            visible[i] = may_be_in_view(planes, position, extent.radius + extent.stretch * speed);
        }
    }
}

void order_by_distance(
    std::span<const ParticleInstance> instances, std::span<const std::optional<Vec3>> positions,
    const Vec3& eye, const Vec3& forward, DistanceOrder& order) {
    order.keys.resize(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const std::uint32_t look = instances[i].look_and_life >> 16;
        const Vec3 position =
            look < positions.size() && positions[look] ? *positions[look] : instances[i].position;
        order.keys[i] = depth_key(glm::dot(position - eye, forward));
    }
    order.indices.resize(instances.size());
    std::iota(order.indices.begin(), order.indices.end(), 0u);
    sort_by_depth(order.keys, order.indices, order.scratch);
}

}  // namespace limn
