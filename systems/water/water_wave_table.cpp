#include "systems/water/water_wave_table.h"

#include "ecs/base/rng.h"
#include "systems/water/water_dispersion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>

// Techniques: water.geometric-texture-split, water.gerstner, water.radial-packet,
//     water.radial-wave, water.travelling-wave, water.trochoid, water.wave-sum, water.wind-crest

namespace limn {

namespace {

constexpr double kWaveTurn = 6.28318530717958647692;
constexpr std::uint32_t kMaxWaves = 256;  ///< of a group
constexpr float kMaxLean = 0.99f;

/// Depth for wave speeds; 0 becomes infinite.
double depth_of(const Water& water) {
    return water.depth > 0 ? static_cast<double>(water.depth)
                           : std::numeric_limits<double>::infinity();
}

/// Wrapped to -pi .. pi.
float wrapped(double angle) {
    return static_cast<float>(angle - std::round(angle / kWaveTurn) * kWaveTurn);
}

bool is_wave(float amplitude, float length, float other) {
    return length > 0 && std::isfinite(amplitude + length + other);
}

void add_line(const WaterWave& wave, double depth, double time, WaveTable& table) {
    if (!is_wave(wave.amplitude, wave.length, wave.direction + wave.phase + wave.sharpness)) {
        return;
    }
    const double k = kWaveTurn / static_cast<double>(wave.length);
    const double frequency = wave_frequency(k, depth);
    const Vec2 along = {std::cos(wave.direction), std::sin(wave.direction)};
    WaveLine line;
    line.k = static_cast<float>(k) * along;
    line.side = std::max(wave.sharpness, 0.0f) * wave.amplitude * along;
    line.phase = wrapped(static_cast<double>(wave.phase) - frequency * time);
    line.amplitude = wave.amplitude;
    line.lean = std::clamp(wave.lean, 0.0f, kMaxLean);
    line.frequency = static_cast<float>(frequency);
    table.lines.push_back(line);
}

void add_ring(const RadialWave& wave, double depth, double time, WaveTable& table) {
    if (!is_wave(wave.amplitude, wave.length, wave.center.x + wave.center.y + wave.phase)) {
        return;
    }
    const double k = kWaveTurn / static_cast<double>(wave.length);
    const double frequency = wave_frequency(k, depth) * (wave.inward ? 1 : -1);
    table.rings.push_back(
        {.center = wave.center,
         .k = static_cast<float>(k),
         .phase = wrapped(static_cast<double>(wave.phase) + frequency * time),
         .amplitude = wave.amplitude,
         .frequency = static_cast<float>(frequency),
         .fade_radius = wave.fade_radius,
         .first = 0,
         .last = std::numeric_limits<float>::infinity()});
}

void add_packet(const WavePacket& packet, double depth, WaveTable& table) {
    if (!(packet.age > 0 && packet.age < packet.lifetime)
        || !is_wave(packet.amplitude, packet.length, packet.center.x + packet.center.y)) {
        return;
    }
    const double k = kWaveTurn / static_cast<double>(packet.length);
    const double frequency = wave_frequency(k, depth);
    const double front = frequency / k * static_cast<double>(packet.age);
    const double train = static_cast<double>(packet.length) * std::max(packet.waves, 1u);
    const float fade = packet.decay > 0 ? std::exp(-packet.age / packet.decay) : 1.0f;
    table.rings.push_back(
        {.center = packet.center,
         .k = static_cast<float>(k),
         .phase = wrapped(-k * front),
         .amplitude = packet.amplitude * fade,
         .frequency = static_cast<float>(-frequency),
         .first = static_cast<float>(front - train),
         .last = static_cast<float>(front),
         .front_speed = static_cast<float>(frequency / k),
         .smooth = packet.smooth});
}

/// sin^2 envelope of a ring, and its derivative by r.
struct Window {
    float weight = 1;
    float slope = 0;
};
Window window_at(const WaveRing& ring, float r) {
    if (!ring.smooth) {
        return {};
    }
    const float rate = kPi / (ring.last - ring.first);
    const float u = rate * (r - ring.first);
    return {square(std::sin(u)), rate * std::sin(2 * u)};
}

WavePoint evaluate_ring(const WaveRing& ring, const Vec2& at) {
    const Vec2 out = at - ring.center;
    const float r = std::sqrt(out.x * out.x + out.y * out.y);
    if (r < ring.first || r > ring.last) {
        return {};
    }
    const float phase = ring.k * r + ring.phase;
    const Window window = window_at(ring, r);
    const bool fades = ring.fade_radius > 0 && r > ring.fade_radius;
    const float fade = fades ? std::sqrt(ring.fade_radius / r) : 1.0f;
    const float amplitude = ring.amplitude * fade;
    const float sine = std::sin(phase);
    const float cosine = std::cos(phase);
    const float fade_slope = fades ? -0.5f / r : 0.0f;  // logarithmic derivative
    const float by_r = amplitude
                       * (ring.k * cosine * window.weight + sine * window.slope
                          + sine * window.weight * fade_slope);
    WavePoint point;
    point.offset.y = amplitude * sine * window.weight;
    if (r > 1e-6f) {
        point.by_x.y = by_r * out.x / r;
        point.by_z.y = by_r * out.y / r;
    }
    point.velocity.y =
        amplitude
        * (ring.frequency * cosine * window.weight - sine * window.slope * ring.front_speed);
    return point;
}

}  // namespace

std::vector<WaterWave> generate_waves(const WaveGroup& group) {
    std::vector<WaterWave> waves;
    Random random(group.seed, 0, name_hash("draw_waves"), 0);
    for (std::uint32_t i = 0; i < std::min(group.count, kMaxWaves); ++i) {
        WaterWave wave;
        wave.amplitude = random.uniform(group.amplitude.x, group.amplitude.y);
        wave.length = random.uniform(group.length.x, group.length.y);
        wave.direction = group.direction + random.uniform(-group.spread, group.spread);
        wave.phase = random.uniform(-kPi, kPi);
        wave.sharpness = group.sharpness;
        waves.push_back(wave);
    }
    return waves;
}

void fill_wave_table(const Water& water, const WaterWaves& waves, double time, WaveTable& table) {
    const double depth = depth_of(water);
    table.lines.clear();
    table.rings.clear();
    for (const WaterWave& wave : waves.waves) {
        add_line(wave, depth, time, table);
    }
    for (const WaveGroup& group : waves.groups) {
        for (const WaterWave& wave : generate_waves(group)) {
            add_line(wave, depth, time, table);
        }
    }
    // Crests fold over if the sum of B |k| exceeds 1.
    float sum = 0;
    for (const WaveLine& line : table.lines) {
        sum += glm::length(line.side) * glm::length(line.k);
    }
    if (sum > 1) {
        for (WaveLine& line : table.lines) {
            line.side /= sum;
        }
    }
    std::stable_sort(
        table.lines.begin(), table.lines.end(), [](const WaveLine& a, const WaveLine& b) {
            return glm::dot(a.k, a.k) < glm::dot(b.k, b.k);
        });
    for (const RadialWave& wave : waves.radial) {
        add_ring(wave, depth, time, table);
    }
    for (const WavePacket& packet : waves.packets) {
        add_packet(packet, depth, table);
    }
}

void snap_waves(const WaterDetail& detail, WaveTable& table) {
    const float turns = detail.tile / (2 * kPi);
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
        WaveLine& line = table.lines[i];
        const float k = glm::length(line.k);
        if (i < std::size_t{kMaxGeometricWaves} && 2 * kPi >= detail.split * k) {
            continue;
        }
        Vec2 whole = glm::round(line.k * turns);
        if (whole == Vec2(0)) {
            (std::abs(line.k.x) >= std::abs(line.k.y) ? whole.x : whole.y) = 1;
        }
        line.k = whole / turns;
    }
}

WavePoint evaluate_waves(const WaveTable& table, const Vec2& at, float shortest) {
    const auto too_short = [&](float k) { return k * shortest > 2 * kPi; };
    std::size_t count = table.lines.size();  // they are sorted by length
    while (shortest > 0 && count > 0 && too_short(glm::length(table.lines[count - 1].k))) {
        --count;
    }
    WavePoint sum = sum_lines(std::span(table.lines).first(count), at);
    for (const WaveRing& ring : table.rings) {
        if (!too_short(ring.k)) {
            sum += evaluate_ring(ring, at);
        }
    }
    return sum;
}

}  // namespace limn
