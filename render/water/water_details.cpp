#include "render/water/water_details.h"

#include "render/water/water_patches.h"

#include <algorithm>
#include <cmath>

// Techniques: water.geometric-texture-split, water.scrolling-normal-map

namespace limn {

namespace {

constexpr float kTexelsPerWave = 4;

float length_of(const WaveLine& line) {
    return 2 * kPi / std::max(glm::length(line.k), 1e-9f);
}

/// Scroll offset of a layer, in tiles.
Vec2 moved(const DetailLayer& layer, double time) {
    const double copies = time * static_cast<double>(layer.speed / layer.tile);
    const auto along = [&](double fraction) {
        const double offset = copies * fraction;
        return static_cast<float>(offset - std::floor(offset));
    };
    const auto direction = static_cast<double>(layer.direction);
    return {along(std::cos(direction)), along(std::sin(direction))};
}

}  // namespace

WaveSplit split_waves(std::span<const WaveLine> lines, const WaterDetail& detail, float spacing) {
    WaveSplit split;
    const float min_length = std::max(detail.split, 2 * spacing);
    while (split.geometric < lines.size()
           && split.geometric < static_cast<std::size_t>(kMaxGeometricWaves)
           && length_of(lines[split.geometric]) >= min_length) {
        ++split.geometric;
    }
    const float shortest = kTexelsPerWave * detail.tile / static_cast<float>(kWaveTileSize);
    for (std::size_t i = split.geometric; i < lines.size(); ++i) {
        const bool fits = split.texture.size() < static_cast<std::size_t>(kMaxTextureWaves)
                          && length_of(lines[i]) >= shortest;
        (fits ? split.texture : split.left_out).push_back(i);
    }
    return split;
}

void WaterDetails::clear() {
    records.clear();
    waves.clear();
    ends.clear();
    normal_map = {};
    needed = false;
}

std::size_t WaterDetails::add(
    const WaterDetail* detail, const WaveTable* table, float spacing, double time, float seconds) {
    layout::WaterDetailRecord& record = records.emplace_back();
    record.waves = {-1, 0, 0, 0};
    const std::size_t all = table != nullptr ? table->lines.size() : 0;
    if (detail == nullptr) {
        return all;
    }
    if (detail->normal_map.index != kNoAsset) {
        normal_map = normal_map.index == kNoAsset ? detail->normal_map : normal_map;
        const std::size_t count =
            std::min(detail->layers.size(), static_cast<std::size_t>(kMaxDetailLayers));
        for (std::size_t i = 0; i < count; ++i) {
            const DetailLayer& layer = detail->layers[i];
            record.layers[i] = Vec4(1 / layer.tile, moved(layer, time + seconds), layer.strength);
        }
        record.waves.w = static_cast<float>(count);
        needed = needed || count > 0;
    }
    if (!(detail->split > 0) || all == 0 || ends.size() >= std::size_t{kMaxWaveTiles}) {
        return all;
    }
    const WaveSplit split = split_waves(table->lines, *detail, spacing);
    const float turns = detail->tile / (2 * kPi);
    for (const std::size_t i : split.texture) {
        const WaveLine& line = table->lines[i];
        waves.push_back(
            {{std::round(line.k.x * turns), std::round(line.k.y * turns),
              line.phase - line.frequency * seconds, line.amplitude / turns}});
    }
    record.waves.x = static_cast<float>(ends.size());
    record.waves.y = 1 / detail->tile;
    for (const std::size_t i : split.left_out) {
        record.waves.z += slope_variance(table->lines[i]);
    }
    ends.push_back(waves.size());
    needed = true;
    return split.geometric;
}

}  // namespace limn
