#include "bench/oracles/caustic_oracle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace limn::oracle {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Random number 0 .. 1 from a counter (Steele, Lea and Flood 2014).
double random_unit(std::uint64_t counter) {
    std::uint64_t z = (counter + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1p-53;
}

/// Fresnel transmittance, from the angles on both sides [rad].
double transmittance(double in, double out) {
    const double s = std::sin(in - out) / std::sin(in + out);
    const double p = std::tan(in - out) / std::tan(in + out);
    return 1 - 0.5 * (s * s + p * p);
}

struct RefractedRay {
    dvec3 direction{0};
    double transmittance = 0;
};

/// Snell's law, in the plane of normal and ray.
RefractedRay refract_sunlight(const dvec3& normal, const dvec3& to_sun, double index) {
    const double cosine = std::clamp(glm::dot(normal, to_sun), -1.0, 1.0);
    if (cosine <= 0) {
        return {};
    }
    const double in = std::acos(cosine);
    const double out = std::asin(std::sin(in) / index);
    const dvec3 across = normal * cosine - to_sun;
    const double length = glm::length(across);
    const dvec3 aside = length > 1e-12 ? across / length : dvec3(0);
    const double head_on = 4 * index / ((index + 1) * (index + 1));
    return {
        std::sin(out) * aside - std::cos(out) * normal,
        in < 1e-6 ? head_on : transmittance(in, out)};
}

double distance_to_box(const dvec3& from, const dvec3& ray, const CausticBox& box) {
    double near = 0;
    double far = kFar;
    for (int i = 0; i < 3; ++i) {
        const double a = (box.low[i] - from[i]) / ray[i];
        const double b = (box.high[i] - from[i]) / ray[i];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far ? near : kFar;
}

double distance_to_walls(const dvec3& from, const dvec3& ray, const dvec2& half) {
    const double x = ((ray.x > 0 ? half.x : -half.x) - from.x) / ray.x;
    const double z = ((ray.z > 0 ? half.y : -half.y) - from.z) / ray.z;
    return std::min(ray.x != 0 ? std::max(x, 0.0) : kFar, ray.z != 0 ? std::max(z, 0.0) : kFar);
}

}  // namespace

CausticLight trace_photons(
    const CausticPool& pool, const CausticSurfaceAt& surface, const dvec3& to_sun, int side,
    long photons) {
    CausticLight light;
    light.side = side;
    light.floor.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0);
    const long rows = std::max(1L, std::lround(std::sqrt(static_cast<double>(photons))));
    const dvec2 step = 2.0 * pool.half / static_cast<double>(rows);
    const double flat = refract_sunlight({0, 1, 0}, to_sun, pool.index).transmittance * to_sun.y;
    const dvec2 cell = 2.0 * pool.half / static_cast<double>(side);
    const double per_cell = 1 / (cell.x * cell.y);

    for (long j = 0; j < rows; ++j) {
        for (long i = 0; i < rows; ++i) {
            const auto counter = static_cast<std::uint64_t>(2 * (j * rows + i));
            const dvec2 rest = -pool.half
                               + step
                                     * dvec2(
                                         static_cast<double>(i) + random_unit(counter),
                                         static_cast<double>(j) + random_unit(counter + 1));
            const CausticSurface at = surface(rest);
            const RefractedRay ray = refract_sunlight(glm::normalize(at.area), to_sun, pool.index);
            const double amount =
                ray.transmittance * glm::dot(at.area, to_sun) / flat * step.x * step.y;
            if (ray.transmittance <= 0) {
                continue;
            }
            light.entered += amount;
            const double down = (-pool.depth - at.position.y) / ray.direction.y;
            const double wall = distance_to_walls(at.position, ray.direction, pool.half);
            double box = kFar;
            for (const CausticBox& one : pool.boxes) {
                box = std::min(box, distance_to_box(at.position, ray.direction, one));
            }
            if (box <= std::min(down, wall)) {
                light.on_boxes += amount;
            } else if (wall < down) {
                light.on_walls += amount;
            } else {
                light.on_floor += amount;
                const dvec3 hit = at.position + down * ray.direction;
                const int x = static_cast<int>((hit.x + pool.half.x) / cell.x);
                const int z = static_cast<int>((hit.z + pool.half.y) / cell.y);
                light.floor
                    [static_cast<std::size_t>(std::clamp(z, 0, side - 1))
                         * static_cast<std::size_t>(side)
                     + static_cast<std::size_t>(std::clamp(x, 0, side - 1))] += amount * per_cell;
            }
        }
    }
    return light;
}

CausticLight trace_mirrored_photons(
    const CausticPool& pool, const CausticSurfaceAt& surface, const dvec3& to_sun, double height,
    const dvec2& center, int side, long photons) {
    CausticLight light;
    light.side = side;
    light.floor.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0);
    const long rows = std::max(1L, std::lround(std::sqrt(static_cast<double>(photons))));
    const dvec2 step = 2.0 * pool.half / static_cast<double>(rows);
    const double flat =
        (1 - refract_sunlight({0, 1, 0}, to_sun, pool.index).transmittance) * to_sun.y;
    const dvec2 cell = 2.0 * pool.half / static_cast<double>(side);
    for (long n = 0; n < rows * rows; ++n) {
        const auto counter = static_cast<std::uint64_t>(2 * n);
        const dvec2 part(
            static_cast<double>(n % rows) + random_unit(counter),
            static_cast<double>(n / rows) + random_unit(counter + 1));
        const CausticSurface at = surface(-pool.half + step * part);
        const dvec3 normal = glm::normalize(at.area);
        const double cosine = glm::dot(normal, to_sun);
        if (cosine <= 0) {
            continue;
        }
        // Reflection.
        const dvec3 ray = 2 * cosine * normal - to_sun;
        if (ray.y <= 0) {
            continue;
        }
        const double amount = (1 - refract_sunlight(normal, to_sun, pool.index).transmittance)
                              * glm::dot(at.area, to_sun) / flat * step.x * step.y;
        light.entered += amount;
        const double up = (height - at.position.y) / ray.y;
        double box = kFar;
        for (const CausticBox& one : pool.boxes) {
            box = std::min(box, distance_to_box(at.position, ray, one));
        }
        if (box <= up) {
            light.on_boxes += amount;
            continue;
        }
        light.on_floor += amount;
        const dvec3 hit = at.position + up * ray;
        const dvec2 floor_cell = (dvec2(hit.x, hit.z) - center + pool.half) / cell;
        const auto x = static_cast<long>(std::floor(floor_cell.x));
        const auto z = static_cast<long>(std::floor(floor_cell.y));
        if (x >= 0 && z >= 0 && x < side && z < side) {
            light.floor[static_cast<std::size_t>(z * side + x)] += amount / (cell.x * cell.y);
        }
    }
    return light;
}

}  // namespace limn::oracle
