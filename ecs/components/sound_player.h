#pragma once

#include "ecs/reflect.h"

#include <string>

namespace limn {

/// A sound of the scene, heard in `limn play` and in films (face.talking-head). What is heard is a
/// function of the simulation's time; hearing it changes nothing in the world.
struct SoundPlayer {
    std::string file{};
    double start = 0;
    double every = 0;
    float gain = 1;

    bool operator==(const SoundPlayer&) const = default;
};

LIMN_FIELDS(SoundPlayer) {
    LIMN_FIELD(file, "WAV, FLAC or Ogg file, relative to the level's folder");
    LIMN_FIELD(start, "time of the simulation at which it begins", "s", 0, 86400);
    LIMN_FIELD(every, "begins again after as long; 0 = once", "s", 0, 86400);
    LIMN_FIELD(gain, "factor on its amplitude", "", 0, 16);
}

}  // namespace limn
