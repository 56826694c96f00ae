#pragma once

#include "content/speech/spelling.h"
#include "content/speech/wave_file.h"

#include <span>
#include <vector>

namespace limn {

// When each of a row of sounds is spoken (face.unit-generate), from what is heard: dynamic
// programming over the ends of sounds. A sound costs by how far its duration is from the usual one
// and by how unlike its kind it is in loudness and brightness; an end gains by how much the
// spectrum changes there. Of the words of a synthesized voice, half are found to 10 ms and
// nine in ten to 70 ms; nothing is learned from a speaker.

/// Ends of the sounds, none of them silence, that are spoken from `begin` to `end` [s]: rising, the
/// last is `end`. `usual`: their durations [s], in any proportion to that time.
[[nodiscard]] std::vector<float> align_sounds(
    const Recording& recording, float begin, float end, std::span<const Sound> sounds,
    std::span<const float> usual);

}  // namespace limn
