#include "content/sound/scene_sound.h"

#include "ecs/base/text.h"
#include "ecs/components/sound_player.h"
#include "ecs/world.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <sndfile.h>

// Techniques: face.talking-head

namespace limn {
namespace {

struct CloseSound {
    void operator()(SNDFILE* file) const { sf_close(file); }
};
using SoundFile = std::unique_ptr<SNDFILE, CloseSound>;

constexpr sf_count_t kMaxFrames = sf_count_t{1} << 28;  // 93 minutes at 48 kHz

/// One channel of a sound at a position between its sample frames; silent outside.
float sample_at(const SoundData& data, double frame, int channel) {
    const auto count = static_cast<std::ptrdiff_t>(data.samples.size()) / data.channels;
    const double below = std::floor(frame);
    const auto index = static_cast<std::ptrdiff_t>(below);
    const auto read = [&](std::ptrdiff_t i) {
        return i >= 0 && i < count ? data.samples[static_cast<std::size_t>(
                   i * data.channels + std::min(channel, data.channels - 1))]
                                   : 0.0f;
    };
    const auto weight = static_cast<float>(frame - below);
    return read(index) + weight * (read(index + 1) - read(index));
}

}  // namespace

Result<SoundData> load_sound(const std::string& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) {
        return fail("{}: found no such file, expected a sound", path);
    }
    SF_INFO info = {};
    const SoundFile file(sf_open(path.c_str(), SFM_READ, &info));
    if (file == nullptr) {
        return fail("{}: found {}, expected a sound", path, sf_strerror(nullptr));
    }
    if (info.frames > kMaxFrames || info.channels < 1 || info.samplerate < 1) {
        return fail(
            "{}: found {} sample frames in {} channels, expected at most {}", path,
            static_cast<std::int64_t>(info.frames), info.channels,
            static_cast<std::int64_t>(kMaxFrames));
    }
    SoundData sound;
    sound.rate = info.samplerate;
    sound.channels = std::min(info.channels, 2);
    constexpr sf_count_t kBlock = 4096;
    std::vector<float> block(static_cast<std::size_t>(kBlock) * info.channels);
    while (const sf_count_t count = sf_readf_float(file.get(), block.data(), kBlock)) {
        for (sf_count_t i = 0; i < count; ++i) {
            for (int c = 0; c < sound.channels; ++c) {
                const float value = block[static_cast<std::size_t>(i * info.channels + c)];
                sound.samples.push_back(std::isfinite(value) ? value : 0.0f);
            }
        }
    }
    return sound;
}

Status save_wave(const SoundData& sound, const std::string& path) {
    SF_INFO info = {};
    info.samplerate = sound.rate;
    info.channels = sound.channels;
    info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
    const SoundFile file(sf_open(path.c_str(), SFM_WRITE, &info));
    const auto frames = static_cast<sf_count_t>(sound.samples.size()) / sound.channels;
    if (file != nullptr) {
        sf_command(file.get(), SFC_SET_CLIPPING, nullptr, SF_TRUE);
    }
    if (file == nullptr || sf_writef_float(file.get(), sound.samples.data(), frames) != frames) {
        return fail("{}: cannot be written: {}", path, sf_strerror(file.get()));
    }
    return Done{};
}

std::vector<SceneSound>
find_sounds(const World& world, const std::string& folder, std::vector<std::string>& problems) {
    std::vector<SceneSound> sounds;
    world.query<const SoundPlayer>().each([&](const SoundPlayer& sound) {
        Result<SoundData> data = load_sound((std::filesystem::path(folder) / sound.file).string());
        if (data) {
            sounds.push_back({*std::move(data), sound.start, sound.every, sound.gain});
        } else {
            problems.push_back("sound: " + data.error().message);
        }
    });
    return sounds;
}

std::optional<double> sound_position(const SceneSound& sound, double time) {
    double position = time - sound.start;
    if (sound.every > 0 && position >= 0) {
        position = std::fmod(position, sound.every);
    }
    return position >= 0 && position < sound.data.duration() ? std::optional(position)
                                                             : std::nullopt;
}

SoundData mix_sounds(std::span<const SceneSound> sounds, double begin, double end) {
    SoundData mix;
    mix.channels = 2;
    mix.rate = 0;
    for (const SceneSound& sound : sounds) {
        mix.rate = std::max(mix.rate, sound.data.rate);
    }
    mix.rate = mix.rate > 0 ? mix.rate : 48000;
    const auto frames = static_cast<std::size_t>(
        std::llround(std::max(end - begin, 0.0) * static_cast<double>(mix.rate)));
    mix.samples.assign(2 * frames, 0.0f);
    for (const SceneSound& sound : sounds) {
        for (std::size_t i = 0; i < frames; ++i) {
            const double time = begin + static_cast<double>(i) / mix.rate;
            if (const std::optional<double> position = sound_position(sound, time)) {
                const double frame = *position * sound.data.rate;
                for (int c = 0; c < 2; ++c) {
                    mix.samples[2 * i + static_cast<std::size_t>(c)] +=
                        sound.gain * sample_at(sound.data, frame, c);
                }
            }
        }
    }
    return mix;
}

}  // namespace limn
