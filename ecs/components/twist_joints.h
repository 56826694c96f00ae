#pragma once

#include "ecs/base/math.h"
#include "ecs/components/skeleton.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Twist joints of characters: helpers along a limb that only skin hangs on. Skin whose weights
// blend a twisted hand with a forearm that is not shrinks like the wrapper of a candy; joints that
// take on their shares of the twist spread it over the length of the bone.

/// A joint that turns about its bone, which leads from its parent to a sibling.
struct TwistJoint {
    std::string joint{};
    std::string of{};
    float share = 0.5f;

    bool operator==(const TwistJoint&) const = default;
};

LIMN_FIELDS(TwistJoint) {
    LIMN_FIELD(joint, "by name");
    LIMN_FIELD(of, "joint whose twist it takes, by name: its parent, or another child of that");
    LIMN_FIELD(
        share, "of the twist; -1 of its parent: stays behind, as skin of a shoulder", "", -1, 1);
}

/// With a Skeleton: its twist joints follow its pose, after inverse kinematics.
struct TwistJoints {
    std::vector<TwistJoint> joints{};
    float weight = 1.0f;
};

LIMN_FIELDS(TwistJoints) {
    LIMN_FIELD(
        joints,
        "empty: those below upper arms, forearms, thighs and shins with \"twist\" in names");
    LIMN_FIELD(weight, "from the animated joints, 0, to the twist, 1", "", 0, 1);
}

/// A TwistJoint, found in a skeleton.
struct TwistLink {
    std::uint16_t joint = 0;
    std::uint16_t of = 0;
    Vec3 axis = {0, 1, 0};  ///< of the bone, in the space of the joint's parent, unit
    float share = 0;
};

/// What the modifier needs to know of a TwistJoints.
struct TwistLinks {
    std::vector<TwistLink> links;
    std::vector<TwistJoint> asked;  ///< what they were found for
    SkeletonId skeleton;            ///< likewise
};
template <>
struct ComponentTraits<TwistLinks> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
