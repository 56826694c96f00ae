#include "systems/water/water_spray_drops.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>

// Techniques: water.crest-spray, water.impact-spray

namespace limn {

namespace {

constexpr float kNearCrest = 0.3f;          ///< largest phase offset from the crest [rad]
constexpr float kMaxSprayDrops = 10000.0f;  ///< per wave and step
constexpr float kRunUp = 1.5f;  ///< of water at a wall: how much more it goes up than back, by eye

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

/// Velocity of the water at a rest position, in its local space. That of closed-form waves is of
/// their orbits, since those that are not sharp move the surface up and down alone.
Vec3 surge_velocity(const WaterSurface& surface, const Vec2& rest) {
    WaterSurface others = surface;
    others.waves = nullptr;
    Vec3 velocity = displace_water(others, rest).velocity;
    if (surface.waves != nullptr) {
        velocity.y = displace_water(surface, rest).velocity.y;
        for (const WaveLine& line : surface.waves->lines) {
            const float phase = leaned(line, phase_at(line, rest));
            velocity += orbital_speed(line) * std::sin(phase) * direction_of(line);
        }
    }
    return velocity;
}

/// Where water meets a wall.
struct Surge {
    Vec3 position = {0, 0, 0};
    Vec3 normal = {0, 1, 0};    ///< unit, out of the wall
    Vec3 velocity = {0, 0, 0};  ///< of the water, relative to the wall [m/s]
};

/// `rate` drops per second in crests of `crest_speed`.
void throw_drops(
    const Surge& surge, const SprayObstacle& obstacle, float rate, float crest_speed, float step,
    Random& random, std::vector<SprayDrop>& drops) {
    const float toward = -glm::dot(surge.velocity, surge.normal);
    const int count = draw_count(rate * surge_share(toward, crest_speed) * step, random);
    if (count == 0) {
        return;
    }
    const Vec3 along = normalize_or(surge.velocity, -surge.normal);
    const Vec3 back = along - 2 * glm::dot(along, surge.normal) * surge.normal;
    for (int i = 0; i < count; ++i) {
        Vec3 direction = draw_direction(back, obstacle.angle, random);
        direction -= 2 * std::min(glm::dot(direction, surge.normal), 0.0f) * surge.normal;
        const float speed = draw_speed(glm::length(surge.velocity), obstacle.spread, random);
        drops.push_back({surge.position, speed * direction});
    }
}

/// A point of the outline of a body at the height `y` above its center, relative to its half
/// height, and the normal there; in its local space. None above and below it.
struct OutlinePoint {
    Vec3 at = {0, 0, 0};
    Vec3 normal = {1, 0, 0};
};
OutlinePoint draw_outline(const SprayBody& body, float y, Random& random) {
    const float local_y = y * body.half.y;
    if (!body.is_box) {
        const float angle = 2 * kPi * random.uniform();
        const float width = std::sqrt(std::max(1 - y * y, 0.0f));
        const Vec2 circle = {std::cos(angle), std::sin(angle)};
        const Vec3 at = {circle.x * width * body.half.x, local_y, circle.y * width * body.half.z};
        return {at, {circle.x / body.half.x, 0, circle.y / body.half.z}};
    }
    const float sides = body.half.x + body.half.z;
    const bool is_x_side = random.uniform() * sides < body.half.z;  // as often as it is long
    const float side = random.uniform() < 0.5f ? -1.0f : 1.0f;
    const float along = random.uniform(-1, 1);
    return is_x_side
               ? OutlinePoint{{side * body.half.x, local_y, along * body.half.z}, {side, 0, 0}}
               : OutlinePoint{{along * body.half.x, local_y, side * body.half.z}, {0, 0, side}};
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
    // The wave with the largest orbital speed toward the wall.
    const WaveLine* strongest = nullptr;
    float max_speed = 1e-4f;
    const std::span<const WaveLine> lines =
        surface.waves != nullptr ? std::span(surface.waves->lines) : std::span<const WaveLine>();
    for (const WaveLine& line : lines) {
        const float against =
            -glm::dot(surface.frame.direction_to_world(direction_of(line)), normal);
        if (orbital_speed(line) * against > max_speed) {
            max_speed = orbital_speed(line) * against;
            strongest = &line;
        }
    }
    const WaterPoint top = sample_water(surface, {point.x, point.z});
    if (!top.is_water) {
        return;
    }
    if (strongest == nullptr && !lines.empty()) {
        return;  // all closed-form waves run away from the wall
    }
    if (strongest == nullptr) {
        const Vec3 position = {point.x, top.position.y, point.z};
        throw_drops(
            {position, normal, surface.frame.direction_to_world(surge_velocity(surface, top.rest))},
            obstacle, obstacle.rate, surge_speed(surface, {point.x, point.z}), step, random, drops);
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

float surge_speed(const WaterSurface& surface, const Vec2& around) {
    constexpr int kSide = 8;
    constexpr float kSpacing = 7.3f;  // between points [m]
    const Vec3 center = surface.frame.local({around.x, surface.frame.origin.y, around.y});
    float sum = 0;
    int count = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const Vec2 offset = Vec2(i % kSide, i / kSide) - 0.5f * (kSide - 1);
        const Vec2 rest = Vec2(center.x, center.z) + kSpacing * offset;
        if (is_inside(surface.water, rest)) {
            const Vec3 velocity = surge_velocity(surface, rest);
            sum += velocity.x * velocity.x + velocity.z * velocity.z;
            ++count;
        }
    }
    return count > 0 ? std::sqrt(2 * sum / static_cast<float>(count)) : 0.0f;
}

float surge_share(float speed, float crest_speed) {
    const float share = std::clamp(speed / std::max(crest_speed, kMinSurge), 0.0f, 1.0f);
    return share * share * share * share;
}

void spray_body(
    const WaterSurface& surface, const SprayObstacle& obstacle, const SprayBody& body,
    float crest_speed, float step, Random& random, std::vector<SprayDrop>& drops) {
    // Points of the waterline: twice as many as drops, of which most fail.
    const int points = std::clamp(static_cast<int>(2 * obstacle.rate * step), 4, 32);
    const Vec3 center = transform_point(body.world, Vec3(0));
    const float half_height = glm::length(transform_vector(body.world, {0, body.half.y, 0}));
    const WaterPoint around = sample_water(surface, {center.x, center.z});
    const float level = around.is_water ? around.position.y : surface.frame.origin.y;
    for (int i = 0; i < points; ++i) {
        const float y = (level - center.y) / std::max(half_height, 1e-6f);
        const OutlinePoint point = draw_outline(body, std::clamp(y, -1.0f, 1.0f), random);
        const Vec3 at = transform_point(body.world, point.at);
        const WaterPoint top = sample_water(surface, {at.x, at.z});
        const float height = (top.position.y - center.y) / std::max(half_height, 1e-6f);
        if (!top.is_water || !(std::abs(height) < 1)) {
            continue;  // dry there, or under water
        }
        Vec3 outward = transform_vector(body.world, point.normal);
        outward = normalize_or({outward.x, 0, outward.z}, Vec3(1, 0, 0));
        const Vec3 moved = at - transform_point(body.before, point.at);
        // Water that runs against a wall can only go up.
        const Surge surge = {
            .position = {at.x, top.position.y, at.z},
            .normal = outward,
            .velocity = surface.frame.direction_to_world(surge_velocity(surface, top.rest))
                        - (step > 0 ? moved / step : Vec3(0))};
        const std::size_t first = drops.size();
        throw_drops(
            surge, obstacle, obstacle.rate / static_cast<float>(points), crest_speed, step, random,
            drops);
        for (std::size_t k = first; k < drops.size(); ++k) {
            const float speed = glm::length(drops[k].velocity);
            const Vec3 up = drops[k].velocity + Vec3(0, kRunUp * speed, 0);
            drops[k].velocity = speed * normalize_or(up, Vec3(0, 1, 0));
        }
    }
}

}  // namespace limn
