#pragma once

#include "ecs/base/result.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace limn {

class World;

// The sounds of a scene (SoundPlayer): read from their files by libsndfile, and mixed for films.

/// Sampled sound of one or two channels.
struct SoundData {
    int rate = 48000;  ///< sample frames per second
    int channels = 1;
    std::vector<float> samples;  ///< channel by channel within a frame; full scale is 1

    [[nodiscard]] double duration() const {
        return static_cast<double>(samples.size()) / (static_cast<double>(channels) * rate);
    }
};

/// Channels beyond two are left out. Fails with "file: found X, expected Y".
[[nodiscard]] Result<SoundData> load_sound(const std::string& path);

/// As 16-bit WAV; what exceeds full scale is clipped.
[[nodiscard]] Status save_wave(const SoundData& sound, const std::string& path);

struct SceneSound {
    SoundData data;
    double start = 0;  ///< [s]
    double every = 0;  ///< [s], 0: once
    float gain = 1;
};

/// Those of the world, in its order; `folder` is the level's. One that cannot be read is left out,
/// with a line in `problems`.
[[nodiscard]] std::vector<SceneSound>
find_sounds(const World& world, const std::string& folder, std::vector<std::string>& problems);

/// Where in the sound the scene is at `time` [s]; none while it is silent.
[[nodiscard]] std::optional<double> sound_position(const SceneSound& sound, double time);

/// What is heard from `begin` to `end` [s], in two channels at the highest rate of the sounds.
[[nodiscard]] SoundData mix_sounds(std::span<const SceneSound> sounds, double begin, double end);

}  // namespace limn
