#pragma once

#include "content/speech/phonemes.h"
#include "content/speech/spelling.h"

#include <span>
#include <vector>

namespace limn {

/// One sound in time.
struct SpeechSegment {
    Sound sound;
    float start = 0.0f;  ///< [s]
    float end = 0.0f;    ///< [s], > start; the start of the next
};

/// Timing of the sounds of an utterance (face.viseme). It begins at 0 and has no gaps; `segments`
/// is empty for silence.
struct SpeechTrack {
    std::vector<SpeechSegment> segments;

    [[nodiscard]] float duration() const { return segments.empty() ? 0.0f : segments.back().end; }
};

/// Pause at the start and at the end of a track [s].
inline constexpr float kSpeechMargin = 0.15f;

/// Each sound with the phoneme's duration, 1.2 times that of stressed vowels, 1.4 times in the last
/// syllable of a phrase, divided by `rate` > 0; between two margins of silence.
[[nodiscard]] SpeechTrack make_speech_track(std::span<const Sound> sounds, float rate = 1.0f);

/// Scales everything except the margins so that the track lasts `duration` [s], which must exceed
/// both margins. A track of silence is unchanged.
void fit_duration(SpeechTrack& track, float duration);

/// Appends `next` to `track`.
void append_track(SpeechTrack& track, const SpeechTrack& next);

[[nodiscard]] inline Viseme viseme_of(const SpeechSegment& segment) {
    return phonemes()[segment.sound.phoneme].viseme;
}

}  // namespace limn
