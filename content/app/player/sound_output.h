#pragma once

#include "content/sound/scene_sound.h"

#include <memory>
#include <optional>
#include <vector>

namespace limn {

// The sounds of a scene on the loudspeakers, by OpenAL. Without a device nothing is heard, and
// nothing else changes.

class SoundOutput {
  public:
    SoundOutput();
    SoundOutput(const SoundOutput&) = delete;
    SoundOutput& operator=(const SoundOutput&) = delete;
    ~SoundOutput();

    /// Replaces all sounds; opens the device with the first ones.
    void set_sounds(std::vector<SceneSound> sounds);

    /// Plays what is heard at `time` of the scene [s], while it is `running` at the speed of real
    /// time. Returns by how much [s] the scene should advance further, as it lags behind the
    /// sound, or less: pictures follow the sound, whose gaps would be heard. Where both are too
    /// far apart, after a jump or a hitch, the sound follows.
    [[nodiscard]] double update(double time, bool running);

    /// Whether the last update() played something.
    [[nodiscard]] bool is_heard() const { return is_heard_; }

  private:
    struct Device;
    std::unique_ptr<Device> device_;  ///< null: none
    std::vector<SceneSound> sounds_;
    bool tried_ = false;  ///< to open the device
    bool is_heard_ = false;
};

/// By how much to correct the scene whose time is `scene` where the sound is at `sound` [s]; none
/// where the sound has to jump.
[[nodiscard]] std::optional<double> sound_correction(double scene, double sound);

}  // namespace limn
