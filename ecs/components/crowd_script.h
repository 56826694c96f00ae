#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Background scripts: what the people of a crowd do besides walking, where they go to do it, and
// how they take notice of somebody. Gestures are made from the skeleton, not recorded.

/// What someone does who is not walking.
enum class CrowdActivity : std::uint8_t {
    Stand,
    Talk,  ///< with gestures
    Sit,   ///< on something as high as its knees
    Wave,
};

/// With a CrowdWalk: walks when its CrowdAgent moves it, at that speed, else does this. Looks at
/// somebody who comes near.
struct CrowdScript {
    CrowdActivity activity = CrowdActivity::Stand;
    Entity notices{};
    float notice_within = 3.5f;
    float waves = 0.25f;
};

LIMN_FIELDS(CrowdScript) {
    LIMN_FIELD(
        activity, .doc = "what it does when it does not walk", .values = "stand talk sit wave");
    LIMN_FIELD(notices, "entity at which it looks when that comes near, by name");
    LIMN_FIELD(notice_within, "how near", "m", 0, 100);
    LIMN_FIELD(waves, "probability that it waves then, unless it walks", "", 0, 1);
}

/// State of a CrowdScript.
struct CrowdScriptState {
    float attention = 0.0f;
    float waving = 0.0f;
    std::uint32_t aware = 0;
    std::uint32_t walks = 0;
};

LIMN_FIELDS(CrowdScriptState) {
    LIMN_FIELD(attention, "how much it looks at whom it notices", "", 0, 1);
    LIMN_FIELD(waving, "for how long it still waves", "s");
    LIMN_FIELD(aware, "whether whom it notices is near", "", 0, 1);
    LIMN_FIELD(walks, "whether it walks", "", 0, 1);
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<CrowdScriptState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// With a CrowdExit: a place that CrowdVisitors go to: a stall, a fountain, a gate.
struct CrowdPlace {
    float stay = 8.0f;
    float appeal = 1.0f;
};

LIMN_FIELDS(CrowdPlace) {
    LIMN_FIELD(stay, "how long visitors stay, half to one and a half of it", "s", 0, 3600);
    LIMN_FIELD(appeal, "how often it is chosen, relative to other places", "", 0, 1000);
}

/// With a CrowdAgent, a CrowdGoal and a MoveIntent: goes from CrowdPlace to CrowdPlace, at random,
/// and faces each for a while.
struct CrowdVisitor {
    float patience = 1.0f;
};

LIMN_FIELDS(CrowdVisitor) {
    LIMN_FIELD(patience, "factor on how long it stays", "", 0, 100);
}

/// State of a CrowdVisitor.
struct CrowdVisit {
    Entity place{};
    float left = 0.0f;
    std::uint32_t arrived = 0;
};

LIMN_FIELDS(CrowdVisit) {
    LIMN_FIELD(place, "where it goes or is");
    LIMN_FIELD(left, "how long it still stays there", "s");
    LIMN_FIELD(arrived, "whether it is there", "", 0, 1);
}

template <>
struct ComponentTraits<CrowdVisit> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// With a CrowdAgent, a CrowdState and a MoveIntent, on an entity of its own: takes the place of a
/// character with a CharacterMotor among the walkers, so that they avoid it.
struct CrowdStandIn {
    Entity character{};
};

LIMN_FIELDS(CrowdStandIn) {
    LIMN_FIELD(character, "entity that walkers avoid, by name");
}

}  // namespace limn
