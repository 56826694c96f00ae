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

constexpr int kMostEvaluations = 32;
constexpr float kMiss = 1e-4f;            ///< that is good enough [m]
constexpr float kRoundedMiss = 2.5e-7f;   ///< the same, of the distance from the origin
constexpr float kLeastShare = 1.0f / 64;  ///< of a Newton step, that backtracking tries
constexpr float kCusp = 0.01f;  ///< share of area below which water counts as squeezed to nothing
constexpr std::size_t kGrain = 64;  ///< points a task

WavePoint evaluate_cascade(const OceanCascade& cascade, float step, const Vec2& rest) {
    const auto size = static_cast<float>(cascade.size);
    const Vec2 turns = rest / cascade.patch;
    const Vec2 place = (turns - glm::floor(turns)) * size;
    const IVec2 corner = glm::min(IVec2(place), IVec2(cascade.size - 1));
    const Vec2 u = place - Vec2(corner);
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
            blend(cascade.last_shift_x), blend(cascade.last_height), blend(cascade.last_shift_z)};
        point.velocity = (point.offset - last) / step;
    }
    return point;
}

/// What is still missing when the water at rest at `rest` is where it is.
struct Trial {
    Vec2 rest{};
    WavePoint point{};
    Vec2 missing{};
    float miss = 0;
};

Trial try_rest(const WaterSurface& surface, const Vec2& wanted, const Vec2& rest) {
    Trial trial;
    trial.rest = rest;
    trial.point = displace_water(surface, rest);
    trial.missing = wanted - rest - Vec2(trial.point.offset.x, trial.point.offset.z);
    trial.miss = std::sqrt(glm::dot(trial.missing, trial.missing));
    return trial;
}

/// How far to move at rest so that the water moves by `way`, if derivatives hold.
Vec2 newton_step(const WavePoint& point, const Vec2& way) {
    const float xx = 1 + point.by_x.x;
    const float zx = point.by_x.z;
    const float xz = point.by_z.x;
    const float zz = 1 + point.by_z.z;
    const float determinant = xx * zz - xz * zx;
    // At a cusp it is 0, and to move the water a little, water at rest must be moved far.
    const float divisor = std::abs(determinant) > kCusp ? determinant : kCusp;
    return Vec2(zz * way.x - xz * way.y, xx * way.y - zx * way.x) / divisor;
}

/// The upward normal of the surface with these derivatives, products of them included.
Vec3 normal_of(const WavePoint& point) {
    const Vec3 along_x = Vec3(1, 0, 0) + point.by_x;
    const Vec3 along_z = Vec3(0, 0, 1) + point.by_z;
    const Vec3 normal = glm::cross(along_z, along_x);
    return normalize_or(normal.y < 0 ? -normal : normal, Vec3(0, 1, 0));
}

bool is_finite(const Vec2& v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}

}  // namespace

WavePoint displace_water(const WaterSurface& surface, const Vec2& rest) {
    WavePoint sum;
    if (surface.ocean != nullptr) {
        for (const OceanCascade& cascade : surface.ocean->cascades) {
            if (cascade.band_low * surface.shortest <= 2 * kPi) {
                sum += evaluate_cascade(cascade, surface.ocean->step, rest);
            }
        }
    }
    if (surface.waves != nullptr) {
        sum += evaluate_waves(*surface.waves, rest, surface.shortest);
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
    while (best.miss > good && evaluations < kMostEvaluations) {
        const Vec2 step = newton_step(best.point, best.missing);
        float share = 1;
        Trial next = try_rest(surface, wanted, best.rest + step);
        ++evaluations;
        while (!(next.miss < best.miss) && share > kLeastShare && evaluations < kMostEvaluations) {
            share *= 0.5f;
            next = try_rest(surface, wanted, best.rest + share * step);
            ++evaluations;
        }
        if (!(next.miss < best.miss)) {
            break;  // a fold, and no way out of it downhill
        }
        best = next;
    }
    found.is_water = true;
    found.position = surface.frame.world(Vec3(best.rest.x, 0, best.rest.y) + best.point.offset);
    found.normal = surface.frame.turned_out(normal_of(best.point));
    found.velocity = surface.frame.turned_out(best.point.velocity);
    found.rest = best.rest;
    found.miss = best.miss;
    found.evaluations = evaluations;
    return found;
}

void sample_waters(
    const WaterSurface& surface, std::span<const Vec2> at, std::span<WaterPoint> points) {
    LIMN_CHECK(at.size() == points.size());
    parallel_for(at.size(), kGrain, [&](std::size_t begin, std::size_t end) {
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

std::optional<WaterPoint>
hit_water(const WaterSurface& surface, const Vec3& origin, const Vec3& direction, float reach) {
    if (!(direction.y < 0) || !std::isfinite(glm::dot(origin, direction))) {
        return std::nullopt;
    }
    // From where it meets the surface at rest, Newton along the ray.
    float way = (surface.frame.origin.y - origin.y) / direction.y;
    for (int i = 0; i < 12 && way >= 0 && way <= reach; ++i) {
        const Vec3 there = origin + way * direction;
        const WaterPoint point = sample_water(surface, {there.x, there.z});
        const float above = there.y - point.position.y;
        if (!point.is_water) {
            return std::nullopt;
        }
        if (std::abs(above) < 1e-3f * (1 + 1e-3f * way)) {
            return point;
        }
        const Vec2 slope = point.slope();
        const float sinking = slope.x * direction.x + slope.y * direction.z - direction.y;
        way += above / std::max(sinking, -0.5f * direction.y);
    }
    return std::nullopt;
}

}  // namespace limn
