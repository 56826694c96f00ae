#pragma once

#include "content/speech/mouth.h"
#include "content/speech/speech_units.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

// Recordings of speech in a JSON file, from motion capture or from `limn speak --record`:
//
//     {"rate": 60, "recordings": [{
//         "text": "It is one.",
//         "sounds": [{"name": "sil", "end": 0.15}, {"name": "ih", "end": 0.22, "word": true}, ...],
//         "samples": [[0, 0, 0, 0, 0], ...]}]}
//
// Each sample is a MouthPose; sample i is at i / rate seconds. Sounds follow one another from 0 on.

struct SpeechLibrary {
    float rate = 60.0f;  ///< samples per second
    std::vector<SpeechRecording> recordings;
};

/// Fails with "file:line:column: found X, expected Y": unknown sounds, ends that do not increase or
/// lie beyond the samples, silence missing at an end, samples of the wrong length.
[[nodiscard]] Result<SpeechLibrary> load_speech_library(const std::string& path);

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
