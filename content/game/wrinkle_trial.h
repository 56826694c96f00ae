#pragma once

#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// A viewer's judgment of wrinkles (wrinkle.compression.ab-evaluation): a face plays its clip twice,
// once with and once without its wrinkles, in an order derived from a seed. Then the viewer
// answers whether anything differed and which was better; viewers who saw no difference are told
// so and shown both again before the second question. Nothing else differs: both show the same
// frames of the clip, and wrinkles move no vertex.

/// The viewer's answer, given by a key.
enum class TrialAnswer : std::uint8_t { None, Same, Different, First, Second };

/// With a ClipPlayer and a WrinkleSurface whose method is isometric. Without wrinkles its share is
/// 0: the same program draws it, with the same rounding.
struct WrinkleTrial {
    float duration = 6.0f;
    float pause = 1.0f;
    std::uint64_t seed = 1;
    TrialAnswer answer = TrialAnswer::None;
};

LIMN_FIELDS(WrinkleTrial) {
    LIMN_FIELD(duration, "of each playback of the clip", "s", 0.1, 600);
    LIMN_FIELD(pause, "at rest, before each playback", "s", 0, 60);
    LIMN_FIELD(seed, "random seed: whether wrinkles come first, for each viewer");
    LIMN_FIELD(
        answer, .doc = "the viewer's next answer; reset once it is counted",
        .values = "none same different first second");
}

/// The current stage of the trial.
enum class TrialStage : std::uint8_t {
    FirstClip,
    SecondClip,
    AnyDifference,  ///< waits for same or different
    Preference,     ///< waits for first or second
};

/// The answers of one viewer.
struct TrialRecord {
    bool wrinkles_first = false;
    bool noticed = false;  ///< answered that there was a difference
    bool preferred_wrinkles = false;
};

LIMN_FIELDS(TrialRecord) {
    LIMN_FIELD(wrinkles_first, "whether wrinkles came first");
    LIMN_FIELD(noticed, "answered that there was a difference");
    LIMN_FIELD(preferred_wrinkles, "preferred the one with wrinkles");
}

/// State of a WrinkleTrial.
struct WrinkleTrialState {
    TrialStage stage = TrialStage::FirstClip;
    float time = 0;  ///< in the stage [s]
    bool noticed = false;
    bool told = false;  ///< the viewer saw none, was told, and is shown both again
    float share = -1;   ///< of the WrinkleSurface with wrinkles; < 0: not known yet
    std::vector<TrialRecord> records;
};

LIMN_FIELDS(WrinkleTrialState) {
    LIMN_FIELD(
        stage, .doc = "current stage",
        .values = "first_clip second_clip any_difference preference");
    LIMN_FIELD(time, "in the stage", "s");
    LIMN_FIELD(noticed, "the viewer saw a difference");
    LIMN_FIELD(told, "the viewer saw none, was told that there is one, and is shown both again");
    LIMN_FIELD(share, "of the wrinkle_surface with wrinkles; negative: not known yet");
    LIMN_FIELD(records, "answers of viewers so far");
}

}  // namespace limn
