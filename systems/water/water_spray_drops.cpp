#include "systems/water/water_spray_drops.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: water.crest-spray, water.impact-spray

namespace limn {

namespace {

constexpr float kNearCrest = 0.3f;          ///< largest phase offset from the crest [rad]
constexpr float kMaxSprayDrops = 10000.0f;  ///< per wave and step

/// Phase of a line at a rest position; leaned(): with forward lean, p - lean max(0, sin p).
float phase_at(const WaveLine& line, const Vec2& rest) {
    return line.k.x * rest.x + line.k.y * rest.y + line.phase;
}
float leaned(const WaveLine& line, float phase) {
    return phase - line.lean * std::max(0.0f, std::sin(phase));
}
/// Inverse of leaned() near a crest, by Newton's method.
float unleaned(const WaveLine& line, float wanted) {
    float phase = wanted;
    for (int i = 0; i < 8; ++i) {
        phase -= (leaned(line, phase) - wanted) / (1 - line.lean * std::cos(phase));
    }
    return phase;
}

/// Wrapped to -pi .. pi.
float wrapped_phase(float phase) {
    return phase - 2 * kPi * std::round(phase / (2 * kPi));
}

Vec3 direction_of(const WaveLine& line) {
    return normalize_or({line.k.x, 0, line.k.y}, Vec3(0));
}

/// Uniformly distributed direction within `angle` of unit `axis`.
Vec3 draw_direction(const Vec3& axis, float angle, Random& random) {
    const float cosine = 1 - random.uniform() * (1 - std::cos(std::clamp(angle, 0.0f, kPi)));
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const float turn = 2 * kPi * random.uniform();
    const Vec3 aside = any_perpendicular(axis);
    return cosine * axis
           + sine * (std::cos(turn) * aside + std::sin(turn) * glm::cross(axis, aside));
}

float draw_speed(float mean, float spread, Random& random) {
    return std::max(mean * (1 + spread * random.normal()), 0.0f);
}

/// Random count with the mean `expected`.
int draw_count(float expected, Random& random) {
    return expected > 0 ? static_cast<int>(std::min(expected, kMaxSprayDrops) + random.uniform())
                        : 0;
}

/// Extents of the area that emits [m].
Vec2 spray_window(const WaterSurface& surface, const SpraySource& source) {
    return {
        surface.water.size.x > 0 ? surface.water.size.x : source.window.x,
        surface.water.size.y > 0 ? surface.water.size.y : source.window.y};
}

}  // namespace

float orbital_speed(float height, float length, float speed) {
    return kPi * height * speed / length;
}

float orbital_speed(const WaveLine& line) {
    return line.amplitude * line.frequency;  // pi 2A (omega / k) / (2 pi / k)
}

float steepness(const WaveLine& line) {
    return line.amplitude * glm::length(line.k) / kPi;
}

void spray_crests(
    const WaterSurface& surface, const SpraySource& source, float step, Random& random,
    std::vector<SprayDrop>& drops) {
    if (surface.waves == nullptr) {
        return;
    }
    const Vec2 size = spray_window(surface, source);
    for (const WaveLine& line : surface.waves->lines) {
        if (!(steepness(line) >= source.steepness)) {
            continue;
        }
        const float k2 = glm::dot(line.k, line.k);
        const Vec3 along = surface.frame.direction_to_world(direction_of(line));
        const int count = draw_count(source.rate * step, random);
        for (int i = 0; i < count; ++i) {
            const float x = random.uniform(-0.5f, 0.5f);
            const float z = random.uniform(-0.5f, 0.5f);
            const float near = random.uniform(-kNearCrest, kNearCrest);
            const Vec3 direction = draw_direction(along, source.angle, random);
            const float speed = draw_speed(orbital_speed(line), source.spread, random);
            Vec2 rest = Vec2(x, z) * size;
            const float crest = unleaned(line, 0.5f * kPi + near);
            rest += line.k * (wrapped_phase(crest - phase_at(line, rest)) / k2);
            if (std::abs(rest.x) > 0.5f * size.x || std::abs(rest.y) > 0.5f * size.y) {
                continue;
            }
            const Vec3 there = Vec3(rest.x, 0, rest.y) + displace_water(surface, rest).offset;
            drops.push_back({surface.frame.world(there), speed * direction});
        }
    }
}

void spray_breakers(
    const WaterSurface& surface, const SpraySource& source, float step, Random& random,
    std::vector<SprayDrop>& drops) {
    if (surface.ocean == nullptr) {
        return;
    }
    const Vec2 size = spray_window(surface, source);
    const float threshold = surface.ocean->made_for.foam_threshold;
    const int count = draw_count(0.01f * size.x * size.y * source.rate * step, random);
    for (int i = 0; i < count; ++i) {
        const Vec2 rest = Vec2(random.uniform(-0.5f, 0.5f), random.uniform(-0.5f, 0.5f)) * size;
        const WavePoint point = displace_water(surface, rest);
        const float jacobian =
            (1 + point.by_x.x) * (1 + point.by_z.z) - point.by_x.z * point.by_z.x;
        const float speed = glm::length(point.velocity);
        if (!(random.uniform() < threshold - jacobian) || !(speed > 0)) {
            continue;
        }
        const Vec3 direction = draw_direction(point.velocity / speed, source.angle, random);
        drops.push_back(
            {surface.frame.world(Vec3(rest.x, 0, rest.y) + point.offset),
             surface.frame.direction_to_world(direction)
                 * draw_speed(speed, source.spread, random)});
    }
}

float impact_share(float phase) {
    const float near = std::max(0.0f, std::cos(phase));
    return near * near * near * near;
}

void spray_impact(
    const WaterSurface& surface, const SprayObstacle& obstacle, const Vec3& point,
    const Vec3& normal, float step, Random& random, std::vector<SprayDrop>& drops) {
    if (surface.waves == nullptr) {
        return;
    }
    // The wave with the largest orbital speed toward the wall.
    const WaveLine* strongest = nullptr;
    float max_speed = 1e-4f;
    for (const WaveLine& line : surface.waves->lines) {
        const float against =
            -glm::dot(surface.frame.direction_to_world(direction_of(line)), normal);
        if (orbital_speed(line) * against > max_speed) {
            max_speed = orbital_speed(line) * against;
            strongest = &line;
        }
    }
    const WaterPoint top = sample_water(surface, {point.x, point.z});
    if (strongest == nullptr || !top.is_water) {
        return;
    }
    const float phase =
        wrapped_phase(leaned(*strongest, phase_at(*strongest, top.rest)) - 0.5f * kPi);
    const Vec3 along = surface.frame.direction_to_world(direction_of(*strongest));
    const Vec3 back = along - 2 * glm::dot(along, normal) * normal;
    const int count = draw_count(obstacle.rate * impact_share(phase) * step, random);
    for (int i = 0; i < count; ++i) {
        Vec3 direction = draw_direction(back, obstacle.angle, random);
        direction -= 2 * std::min(glm::dot(direction, normal), 0.0f) * normal;  // not into the wall
        const float speed = draw_speed(orbital_speed(*strongest), obstacle.spread, random);
        drops.push_back({{point.x, top.position.y, point.z}, speed * direction});
    }
}

}  // namespace limn
