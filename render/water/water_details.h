#pragma once

#include "ecs/components/water_detail.h"
#include "ecs/components/water_waves.h"
#include "render/buffer_texture.h"
#include "render/gpu/texture.h"
#include "render/shaders/water_detail_gpu.h"

#include <span>
#include <vector>

namespace limn {

// What tilts the normals of waters without moving them (WaterDetail), ready for texture_waves.frag
// and lib/water_detail.glsl. All waters share one normal map, that of the first which has one; up
// to kMaxWaveTiles have waves in a texture, the others draw theirs as vertices.

inline constexpr int kMaxWaveTiles = 8;
inline constexpr int kWaveTileSize = 256;  ///< texels of a side

/// Which lines of a table move vertices and which are drawn into a texture.
struct WaveSplit {
    std::size_t geometric = 0;            ///< so many lines from the first on, the longest
    std::vector<std::size_t> texture{};   ///< lines
    std::vector<std::size_t> left_out{};  ///< lines: too many, or too short for the texture
};

/// Waves move vertices that are at least `detail.split` long, and not shorter than two cells of
/// `spacing` [m], and among the kMaxGeometricWaves longest. Of the others up to kMaxTextureWaves,
/// with at least four texels a wave, go into the texture.
[[nodiscard]] WaveSplit
split_waves(std::span<const WaveLine> lines, const WaterDetail& detail, float spacing);

/// Of the bodies of a frame; keeps its memory.
struct WaterDetails {
    std::vector<layout::WaterDetailRecord> records;  ///< of each body
    std::vector<layout::TextureWaveRecord> waves;
    std::vector<std::size_t> ends;  ///< of each tile: of its waves
    ImageId normal_map;
    bool needed = false;  ///< some body has detail

    void clear();
    /// Appends the body's record, at `time` [s]; its waves `seconds` after the end of the step.
    /// Returns how many of its lines are to move vertices.
    std::size_t
    add(const WaterDetail* detail, const WaveTable* table, float spacing, double time,
        float seconds);
};

}  // namespace limn
