#include "systems/water/water_noise_system.h"

#include "ecs/base/gradient_noise.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <cmath>

// Techniques: water.noise-surface

namespace limn {

namespace {

constexpr std::uint32_t kMaxPoints = 1024;
constexpr std::uint32_t kMaxOctaves = 16;
constexpr std::size_t kNoiseRowGrain = 8;

}  // namespace

float perlin_noise(const Vec3& at, std::uint32_t seed) {
    constexpr float kScale = 1.22474487f;  // from the scale of gradient_noise to Perlin's
    const bool has_fraction =
        std::abs(at.x) < 0x1p23f && std::abs(at.y) < 0x1p23f && std::abs(at.z) < 0x1p23f;
    return has_fraction ? kScale * gradient_noise(at, seed) : 0.0f;
}

float noise_height(const NoiseSurface& noise, const Vec2& at, double time) {
    float sum = 0;
    float amplitude = noise.amplitude;
    float frequency = noise.frequency;
    double speed = static_cast<double>(noise.speed);
    for (std::uint32_t i = 0; i < std::min(noise.octaves, kMaxOctaves); ++i) {
        const Vec3 point = {at.x * frequency, at.y * frequency, static_cast<float>(time * speed)};
        sum += amplitude * perlin_noise(point, noise.seed + i);
        amplitude *= 0.5f;
        frequency *= 2.0f;
        speed *= 2.0;
    }
    return std::isfinite(sum) ? sum : 0.0f;
}

void fill_noise_field(const NoiseSurface& noise, double time, HeightField& field) {
    const std::uint32_t points = std::clamp(noise.points, 2u, kMaxPoints);
    const std::size_t side = points;
    const std::size_t outer = side + 2;  // with a border, so that every point has neighbors
    const Vec2 cell = noise.size / static_cast<float>(points - 1);
    thread_local std::vector<float> memory;
    std::vector<float>& around = memory;
    around.resize(outer * outer);
    field.points = points;
    field.size = noise.size;
    field.height.resize(side * side);
    field.normal.resize(side * side);
    parallel_for(outer, kNoiseRowGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) {
            for (std::size_t x = 0; x < outer; ++x) {
                const Vec2 at = cell * (Vec2(x, z) - 1.0f) - 0.5f * noise.size;
                around[z * outer + x] = noise_height(noise, at, time);
            }
        }
    });
    float low = INFINITY;
    float high = -INFINITY;
    for (std::size_t z = 0; z < side; ++z) {
        for (std::size_t x = 0; x < side; ++x) {
            const float* const here = around.data() + (z + 1) * outer + x + 1;
            const Vec2 rise = {here[1] - here[-1], here[outer] - here[-static_cast<int>(outer)]};
            const Vec3 normal = {-rise.x * cell.y, 2 * cell.x * cell.y, -rise.y * cell.x};
            field.height[z * side + x] = *here;
            field.normal[z * side + x] = normalize_or(normal, Vec3(0, 1, 0));
            low = std::min(low, *here);
            high = std::max(high, *here);
        }
    }
    field.low = low;
    field.range = high - low;
}

void add_noise_fields(Query<const NoiseSurface, Without<HeightField>> bare, Commands commands) {
    bare.each([&](Entity entity, const NoiseSurface&) { commands.add(entity, HeightField{}); });
}

void update_noise_surfaces(
    Query<const NoiseSurface, HeightField> surfaces, Res<const FrameTime> time) {
    surfaces.each([&](const NoiseSurface& noise, HeightField& field) {
        fill_noise_field(noise, time->time, field);
    });
}

}  // namespace limn
