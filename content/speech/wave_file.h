#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

/// Sound of one channel.
struct Recording {
    std::uint32_t rate = 22050;         ///< samples per second
    std::vector<std::int16_t> samples;  ///< full scale is 32767

    [[nodiscard]] float duration() const {
        return static_cast<float>(samples.size()) / static_cast<float>(rate);
    }
};

/// Parses a .wav of 16-bit PCM with one channel. Sizes in its header may be wrong, as programs that
/// write into a pipe leave them. Fails with "file: found X, expected Y".
[[nodiscard]] Result<Recording>
parse_wave(std::span<const std::byte> bytes, const std::string& file);

/// The bytes of a .wav.
[[nodiscard]] std::vector<std::byte> write_wave(const Recording& wave);

/// First and one past the last sample louder than 1 % of full scale; {0, 0} if all are quieter.
struct WaveRange {
    std::size_t first = 0;
    std::size_t end = 0;
};
[[nodiscard]] WaveRange audible_range(const Recording& wave);

}  // namespace limn
