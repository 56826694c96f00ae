#pragma once

#include "content/speech/speech_track.h"
#include "content/speech/wave_file.h"
#include "ecs/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Text to timed sounds and to audio (face.talking-head). Audio and face share one clock: the track
// is as long as the audio, and each phrase begins and ends in both at the same time.

struct Utterance {
    SpeechTrack track;
    Recording wave;  ///< without samples: no audio
};

/// The phrases of a text, each with its final punctuation; none without letters or digits.
[[nodiscard]] std::vector<std::string> phrases_of(std::string_view text);

/// The utterance by spelling rules, without audio: the same on every machine. Empty for text
/// without letters or digits.
[[nodiscard]] Utterance spell_utterance(std::string_view text);

/// Whether the program espeak-ng can be run.
[[nodiscard]] bool has_espeak();

/// The utterance as espeak-ng speaks it. Fails when it cannot be run, does not know `voice` ("en",
/// "en-us", ...), or writes no sound.
[[nodiscard]] Result<Utterance> speak_utterance(std::string_view text, const std::string& voice);

/// One phrase from its sounds and audio, with a margin of silence on both sides.
[[nodiscard]] Utterance join_phrase(std::span<const Sound> sounds, const Recording& wave);

/// Appends `next` to `utterance`.
void append_utterance(Utterance& utterance, const Utterance& next);

}  // namespace limn
