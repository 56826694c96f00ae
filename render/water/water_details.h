#pragma once

#include "ecs/components/water_detail.h"
#include "ecs/components/water_waves.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/texture.h"
#include "render/shaders/water_detail_gpu.h"

#include <span>
#include <vector>

namespace limn {

// Surface detail that perturbs the normals of waters without displacing them (WaterDetail), for
// texture_waves.frag and lib/water_detail.glsl. All waters share one normal map, that of the first
// which has one; up to kMaxWaveTiles waters have waves in a texture, the others displace vertices
// with all of theirs.

inline constexpr int kMaxWaveTiles = 8;
inline constexpr int kWaveTileSize = 256;  ///< [texels] per side

/// Which lines of a table displace vertices and which are rendered into a texture.
struct WaveSplit {
    std::size_t geometric = 0;  ///< number of leading, longest lines that displace vertices
    std::vector<std::size_t> texture{};   ///< lines rendered into the texture
    std::vector<std::size_t> left_out{};  ///< lines beyond the limit or too short for the texture
};

/// Vertices are displaced by the kMaxGeometricWaves longest waves that have at least length
/// `detail.split` and two cells of `spacing` [m]. Up to kMaxTextureWaves of the others, at least
/// four texels long, go into the texture.
[[nodiscard]] WaveSplit
split_waves(std::span<const WaveLine> lines, const WaterDetail& detail, float spacing);

/// Details of all bodies in a frame; reuses its memory.
struct WaterDetails {
    std::vector<layout::WaterDetailRecord> records;  ///< one per body
    std::vector<layout::TextureWaveRecord> waves;
    std::vector<std::size_t> ends;  ///< end of the waves of each tile
    ImageId normal_map;
    bool needed = false;  ///< some body has detail

    void clear();
    /// Appends a body's record at `time` [s], with its waves `seconds` after the end of the step.
    /// Returns the number of its lines that displace vertices.
    std::size_t
    add(const WaterDetail* detail, const WaveTable* table, float spacing, double time,
        float seconds);
};

}  // namespace limn
