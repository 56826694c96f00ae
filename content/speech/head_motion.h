#pragma once

#include "content/speech/speech_track.h"
#include "ecs/base/math.h"

#include <cstdint>

namespace limn {

/// Rotation of a speaker's head at `time` [s]: nods of up to 3 degrees at stressed vowels on a slow
/// sway of up to 2 degrees; none at the ends of the track. Determined by `seed`.
[[nodiscard]] Quat head_at(const SpeechTrack& track, float time, std::uint64_t seed);

}  // namespace limn
