#pragma once

#include "content/app/commands/command_values.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Shown by `limn speak "Hello!" --face face.glb -o hello.glb`: face.dominance
// Shown by `limn speak "Hello!" --face face.glb -o hello.glb --express AU12=0.5`: face.categories
// Shown by `limn speak "exactly one" --face face.glb -o one.glb --fragments clock.json`:
//     face.align-resample, face.fragment-blend, face.speech-fragments, face.unit-select
// Shown by `limn speak "exactly one" --face face.glb -o one.glb --record clock.json`:
//     face.unit-generate

struct SpeakOptions {
    std::string text;
    std::string face;          ///< .gltf or .glb with shapes that have action units, or a head
    std::string out;           ///< .glb; audio goes to the same name as .wav
    std::string voice = "en";  ///< of espeak-ng
    std::string fragments;     ///< library of recordings whose motion is used; empty: by rules
    std::string map;           ///< places of the library's markers on the face
    std::string record;        ///< library to which the utterance is added; empty: none
    std::vector<Assignment> expression;  ///< shapes or action units and their weights
    bool silent = false;                 ///< by rules, without espeak-ng and audio
    std::uint64_t seed = 1;              ///< of blinks, gaze and head
};

/// `limn speak`: writes a copy of a face with a clip in which it speaks a text, and the audio
/// beside it. Without espeak-ng the text is pronounced by rules, without audio. Files are written
/// completely or not at all.
[[nodiscard]] Status run_speak(const SpeakOptions& options);

}  // namespace limn
