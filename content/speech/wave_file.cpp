#include "content/speech/wave_file.h"

#include "ecs/base/text.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace limn {

namespace {

constexpr std::size_t kHeader = 12;      ///< "RIFF", size, "WAVE"
constexpr std::size_t kChunkHeader = 8;  ///< name, size
constexpr std::size_t kFormat = 16;      ///< bytes of a PCM format
constexpr std::uint32_t kMaxSampleRate = 768000;
constexpr int kAudible = 327;

template <typename T>
T read(std::span<const std::byte> bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
}

std::string_view name_at(std::span<const std::byte> bytes, std::size_t at) {
    return {reinterpret_cast<const char*>(bytes.data()) + at, 4};
}

template <typename T>
void append_bytes(std::vector<std::byte>& bytes, T value) {
    const auto raw = std::as_bytes(std::span(&value, 1));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

void append_bytes(std::vector<std::byte>& bytes, std::string_view text) {
    const auto raw = std::as_bytes(std::span(text));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

}  // namespace

Result<Recording> parse_wave(std::span<const std::byte> bytes, const std::string& file) {
    if (bytes.size() < kHeader || name_at(bytes, 0) != "RIFF" || name_at(bytes, 8) != "WAVE") {
        return fail("{}: found no RIFF header, expected a .wav file", file);
    }
    Recording wave;
    bool has_format = false;
    for (std::size_t at = kHeader; at + kChunkHeader <= bytes.size();) {
        const std::string_view name = name_at(bytes, at);
        const std::size_t begin = at + kChunkHeader;
        const std::size_t size =
            std::min<std::size_t>(read<std::uint32_t>(bytes, at + 4), bytes.size() - begin);
        if (name == "fmt " && size >= kFormat) {
            const auto format = read<std::uint16_t>(bytes, begin);
            const auto channels = read<std::uint16_t>(bytes, begin + 2);
            const auto bits = read<std::uint16_t>(bytes, begin + 14);
            wave.rate = read<std::uint32_t>(bytes, begin + 4);
            if (format != 1 || channels != 1 || bits != 16 || wave.rate == 0
                || wave.rate > kMaxSampleRate) {
                return fail(
                    "{}: found format {} with {} channels, {} bits, {} samples per second, "
                    "expected PCM with 1 channel and 16 bits",
                    file, format, channels, bits, wave.rate);
            }
            has_format = true;
        } else if (name == "data" && has_format) {
            wave.samples.resize(size / sizeof(std::int16_t));
            if (!wave.samples.empty()) {
                std::memcpy(
                    wave.samples.data(), bytes.data() + begin,
                    wave.samples.size() * sizeof(std::int16_t));
            }
            return wave;
        }
        at = begin + size + size % 2;
    }
    return fail("{}: found no sound, expected the chunks \"fmt \" and \"data\"", file);
}

std::vector<std::byte> write_wave(const Recording& wave) {
    const auto size = static_cast<std::uint32_t>(wave.samples.size() * sizeof(std::int16_t));
    std::vector<std::byte> bytes;
    append_bytes(bytes, std::string_view("RIFF"));
    append_bytes(
        bytes, static_cast<std::uint32_t>(4 + kChunkHeader + kFormat + kChunkHeader + size));
    append_bytes(bytes, std::string_view("WAVEfmt "));
    append_bytes(bytes, static_cast<std::uint32_t>(kFormat));
    append_bytes(bytes, std::uint16_t{1});
    append_bytes(bytes, std::uint16_t{1});
    append_bytes(bytes, wave.rate);
    append_bytes(bytes, static_cast<std::uint32_t>(wave.rate * sizeof(std::int16_t)));
    append_bytes(bytes, static_cast<std::uint16_t>(sizeof(std::int16_t)));
    append_bytes(bytes, std::uint16_t{16});
    append_bytes(bytes, std::string_view("data"));
    append_bytes(bytes, size);
    const auto samples = std::as_bytes(std::span(wave.samples));
    bytes.insert(bytes.end(), samples.begin(), samples.end());
    return bytes;
}

WaveRange audible_range(const Recording& wave) {
    const auto is_audible = [](std::int16_t sample) {
        return sample > kAudible || sample < -kAudible;
    };
    const auto first = std::ranges::find_if(wave.samples, is_audible);
    const auto last = std::find_if(wave.samples.rbegin(), wave.samples.rend(), is_audible);
    if (first == wave.samples.end()) {
        return {};
    }
    return {
        static_cast<std::size_t>(first - wave.samples.begin()),
        static_cast<std::size_t>(last.base() - wave.samples.begin())};
}

}  // namespace limn
