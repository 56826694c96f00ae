#include "systems/water/water_query.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "systems/water/water_ripple_field.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limn {

namespace {

constexpr int kMaxEvaluations = 32;
constexpr float kMiss = 1e-4f;           ///< tolerance [m]
constexpr float kRoundedMiss = 2.5e-7f;  ///< tolerance relative to the distance from the origin
constexpr float kMinDamping =
    1.0f / 64;                  ///< smallest fraction of a Newton step tried by backtracking
constexpr float kCusp = 0.01f;  ///< Jacobian below which the surface counts as a cusp
constexpr std::size_t kQueryGrain = 64;  ///< points per task

WavePoint evaluate_cascade(const OceanCascade& cascade, float step, const Vec2& rest) {
    const auto size = static_cast<float>(cascade.size);
    const Vec2 turns = rest / cascade.patch;
    const Vec2 cell = (turns - glm::floor(turns)) * size;
    const IVec2 corner = glm::min(IVec2(cell), IVec2(cascade.size - 1));
    const Vec2 u = cell - Vec2(corner);
    const int next_x = (corner.x + 1) % cascade.size;
    const int next_z = (corner.y + 1) % cascade.size;
    const auto blend = [&](const std::vector<float>& plane) {
        const float* const near = plane.data() + corner.y * cascade.size;
        const float* const far = plane.data() + next_z * cascade.size;
        return glm::mix(
            glm::mix(near[corner.x], near[next_x], u.x), glm::mix(far[corner.x], far[next_x], u.x),
            u.y);
    };
    WavePoint point;
    point.offset = {blend(cascade.shift_x), blend(cascade.height), blend(cascade.shift_z)};
    const float across = blend(cascade.shift_xz);
    point.by_x = {blend(cascade.shift_xx), blend(cascade.slope_x), across};
    point.by_z = {across, blend(cascade.slope_z), blend(cascade.shift_zz)};
    if (step > 0) {
        const Vec3 last = {
            blend(cascade.previous_shift_x), blend(cascade.previous_height),
            blend(cascade.previous_shift_z)};
        point.velocity = (point.offset - last) / step;
    }
    return point;
}

/// Remaining horizontal error for the rest point `rest`.
struct Trial {
    Vec2 rest{};
    WavePoint point{};
    Vec2 missing{};
    float error = 0;
};

Trial try_rest(const WaterSurface& surface, const Vec2& wanted, const Vec2& rest) {
    Trial trial;
    trial.rest = rest;
    trial.point = displace_water(surface, rest);
    trial.missing = wanted - rest - Vec2(trial.point.offset.x, trial.point.offset.z);
    trial.error = std::sqrt(glm::dot(trial.missing, trial.missing));
    return trial;
}

/// Newton step: change of the rest point that moves the water by `delta` to first order.
Vec2 newton_step(const WavePoint& point, const Vec2& delta) {
    const float xx = 1 + point.by_x.x;
    const float zx = point.by_x.z;
    const float xz = point.by_z.x;
    const float zz = 1 + point.by_z.z;
    const float determinant = xx * zz - xz * zx;
    // At a cusp the determinant is 0, and a small displacement needs a large change of the rest
    // point.
    const float divisor = std::abs(determinant) > kCusp ? determinant : kCusp;
    return Vec2(zz * delta.x - xz * delta.y, xx * delta.y - zx * delta.x) / divisor;
}

/// Upward surface normal from these derivatives, including their products.
Vec3 normal_of(const WavePoint& point) {
    const Vec3 along_x = Vec3(1, 0, 0) + point.by_x;
    const Vec3 along_z = Vec3(0, 0, 1) + point.by_z;
    const Vec3 normal = glm::cross(along_z, along_x);
    return normalize_or(normal.y < 0 ? -normal : normal, Vec3(0, 1, 0));
}

}  // namespace

std::vector<WaterSurface> collect_water_surfaces(WaterQuery waters) {
    std::vector<WaterSurface> surfaces;
    waters.each([&](Entity entity, const Water& water, const WorldTransform& transform,
                    const OceanState* ocean, const WaveTable* waves, const RippleState* ripples) {
        surfaces.push_back({water_frame(transform.world), water, ocean, waves, ripples, 0, entity});
    });
    return surfaces;
}

WavePoint displace_water(const WaterSurface& surface, const Vec2& rest) {
    WavePoint sum;
    if (surface.ocean != nullptr) {
        for (const OceanCascade& cascade : surface.ocean->cascades) {
            if (cascade.band_low * surface.min_wavelength <= 2 * kPi) {
                sum += evaluate_cascade(cascade, surface.ocean->step, rest);
            }
        }
    }
    if (surface.waves != nullptr) {
        sum += evaluate_waves(*surface.waves, rest, surface.min_wavelength);
    }
    if (surface.ripples != nullptr) {
        const RipplePoint ripples = sample_ripples(*surface.ripples, rest);
        sum.offset.y += ripples.height;
        sum.velocity.y += ripples.velocity;
        sum.by_x.y += ripples.slope.x;
        sum.by_z.y += ripples.slope.y;
    }
    return sum;
}

WaterPoint sample_water(const WaterSurface& surface, const Vec2& at) {
    WaterPoint found;
    const Vec3 local = surface.frame.local({at.x, surface.frame.origin.y, at.y});
    const Vec2 wanted = {local.x, local.z};
    if (!is_finite(wanted) || !is_inside(surface.water, wanted)) {
        return found;
    }
    const float good = kMiss + kRoundedMiss * (std::abs(wanted.x) + std::abs(wanted.y));
    Trial best = try_rest(surface, wanted, wanted);
    int evaluations = 1;
    while (best.error > good && evaluations < kMaxEvaluations) {
        const Vec2 step = newton_step(best.point, best.missing);
        float damping = 1;
        Trial next = try_rest(surface, wanted, best.rest + step);
        ++evaluations;
        while (!(next.error < best.error) && damping > kMinDamping
               && evaluations < kMaxEvaluations) {
            damping *= 0.5f;
            next = try_rest(surface, wanted, best.rest + damping * step);
            ++evaluations;
        }
        if (!(next.error < best.error)) {
            break;  // stuck in a fold
        }
        best = next;
    }
    found.is_water = true;
    found.position = surface.frame.world(Vec3(best.rest.x, 0, best.rest.y) + best.point.offset);
    found.normal = surface.frame.direction_to_world(normal_of(best.point));
    found.velocity = surface.frame.direction_to_world(best.point.velocity);
    found.rest = best.rest;
    found.error = best.error;
    found.evaluations = evaluations;
    return found;
}

void sample_waters(
    const WaterSurface& surface, std::span<const Vec2> at, std::span<WaterPoint> points) {
    LIMN_CHECK(at.size() == points.size());
    parallel_for(at.size(), kQueryGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            points[i] = sample_water(surface, at[i]);
        }
    });
}

float water_bottom(const WaterSurface& surface) {
    return surface.water.depth > 0 ? surface.frame.origin.y - surface.water.depth
                                   : -std::numeric_limits<float>::infinity();
}

std::optional<WaterAround> find_water(std::span<const WaterSurface> surfaces, const Vec3& point) {
    std::optional<WaterAround> nearest;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (!(point.y >= water_bottom(surfaces[i]))) {
            continue;
        }
        const WaterPoint top = sample_water(surfaces[i], {point.x, point.z});
        const float depth = top.position.y - point.y;
        if (top.is_water && depth > 0 && (!nearest || depth < nearest->depth)) {
            nearest = WaterAround{i, depth, top};
        }
    }
    return nearest;
}

std::optional<WaterPoint> hit_water(
    const WaterSurface& surface, const Vec3& origin, const Vec3& direction, float max_distance) {
    if (!(direction.y < 0) || !std::isfinite(glm::dot(origin, direction))) {
        return std::nullopt;
    }
    // Newton's method along the ray, starting at the rest surface.
    float distance = (surface.frame.origin.y - origin.y) / direction.y;
    for (int i = 0; i < 12 && distance >= 0 && distance <= max_distance; ++i) {
        const Vec3 there = origin + distance * direction;
        const WaterPoint point = sample_water(surface, {there.x, there.z});
        const float above = there.y - point.position.y;
        if (!point.is_water) {
            return std::nullopt;
        }
        if (std::abs(above) < 1e-3f * (1 + 1e-3f * distance)) {
            return point;
        }
        const Vec2 slope = point.slope();
        const float sinking = slope.x * direction.x + slope.y * direction.z - direction.y;
        distance += above / std::max(sinking, -0.5f * direction.y);
    }
    return std::nullopt;
}

}  // namespace limn
