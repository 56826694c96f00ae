#include "content/speech/speech_track.h"

#include "ecs/base/check.h"

// Techniques: face.viseme

namespace limn {

namespace {

constexpr float kStressedVowel = 1.2f;
constexpr float kPhraseFinal = 1.4f;

}  // namespace

SpeechTrack make_speech_track(std::span<const Sound> sounds, float rate) {
    LIMN_CHECK(rate > 0.0f);
    SpeechTrack track;
    if (sounds.empty()) {
        return track;
    }
    float time = kSpeechMargin;
    track.segments.push_back({Sound{}, 0.0f, time});
    for (std::size_t i = 0; i < sounds.size(); ++i) {
        const Phoneme& phoneme = phonemes()[sounds[i].phoneme];
        float duration = phoneme.duration;
        if (sounds[i].stressed) {
            duration *= kStressedVowel;
        }
        const bool before_final = i + 1 < sounds.size() && sounds[i + 1].ends_phrase;
        if (sounds[i].ends_phrase || (before_final && phoneme.is_vowel)) {
            duration *= kPhraseFinal;
        }
        const float end = time + duration / rate;
        track.segments.push_back({sounds[i], time, end});
        time = end;
    }
    track.segments.push_back({Sound{}, time, time + kSpeechMargin});
    return track;
}

void fit_duration(SpeechTrack& track, float duration) {
    LIMN_CHECK(duration > 2.0f * kSpeechMargin);
    if (track.segments.empty()) {
        return;
    }
    const float scale =
        (duration - 2.0f * kSpeechMargin) / (track.duration() - 2.0f * kSpeechMargin);
    const auto fit = [&](float time) { return kSpeechMargin + (time - kSpeechMargin) * scale; };
    const std::size_t last = track.segments.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
        track.segments[i].end = fit(track.segments[i].end);
        track.segments[i + 1].start = track.segments[i].end;
    }
    track.segments[last].end = duration;
}

void append_track(SpeechTrack& track, const SpeechTrack& next) {
    const float offset = track.duration();
    for (SpeechSegment segment : next.segments) {
        segment.start += offset;
        segment.end += offset;
        track.segments.push_back(segment);
    }
}

}  // namespace limn
