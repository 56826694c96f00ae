#pragma once

#include "content/speech/mouth.h"
#include "content/speech/speech_units.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

// Recordings of speech in a JSON file, from motion capture or from `limn speak --record`:
//
//     {"rate": 60, "markers": ["lip", "chin", ...], "rest": [[0, -0.02, 0.1], ...], "recordings":
//     [{
//         "text": "It is one.",
//         "sounds": [{"name": "sil", "end": 0.15}, {"name": "ih", "end": 0.22, "word": true}, ...],
//         "sound": "clock-1.wav",
//         "samples": [[0, 0, 0, 0, 0, 0], ...]}]}
//
// Sample i is at i / rate seconds. Each is the offsets of the markers from rest, three numbers each
// [m]; in a library without markers, a MouthPose. Sounds follow one another from 0 on. "sound" is a
// .wav in the folder of the library; a recording may lack it.

struct SpeechLibrary {
    float rate = 60.0f;                ///< samples per second
    std::vector<std::string> markers;  ///< whose motion was recorded, or none: a MouthPose
    std::vector<Vec3> rest;            ///< of the markers [m]
    std::vector<SpeechRecording> recordings;

    [[nodiscard]] std::size_t channels() const {
        return markers.empty() ? kMouthAxes : 3 * markers.size();
    }
};

/// Fails with "file:line:column: found X, expected Y": unknown sounds, ends that do not increase or
/// lie beyond the samples, silence missing at an end, samples of the wrong length, markers without
/// a position at rest. With the sound of the recordings.
[[nodiscard]] Result<SpeechLibrary> load_speech_library(const std::string& path);

/// Without the sound.
[[nodiscard]] Result<SpeechLibrary>
parse_speech_library(std::string_view text, const std::string& file);

/// Text that parse_speech_library reads back to the same library.
[[nodiscard]] std::string write_speech_library(const SpeechLibrary& library);

/// The mouth's motion in an utterance as a recording.
[[nodiscard]] SpeechRecording
record_mouth(const std::string& text, const SpeechTrack& track, float rate);

/// The mouth at `time` [s] of curves with a channel per axis; at rest outside.
[[nodiscard]] MouthPose mouth_at(const SampledCurves& curves, float time);

}  // namespace limn
