#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>

namespace limn {

// What a generated walk needs to know of a skeleton, in the space of the character at rest.

struct WalkLeg {
    std::uint16_t thigh = 0xffff;
    std::uint16_t shin = 0xffff;
    std::uint16_t foot = 0xffff;
    std::uint16_t toes = 0xffff;  ///< 0xffff: none
    Vec3 socket = {0, 0, 0};      ///< of the thigh, from the hips [m]
    float length = 0.0f;          ///< thigh and shin [m]
    float side = 0.0f;            ///< of the socket, to the left of the middle [m]
    Vec3 ankle = {0, 0, 0};       ///< above the point of the ground below it [m]
    Vec3 ball = {0, 0, 0};        ///< the joint of the toes, from that point [m]
    Vec3 heel = {0, 0, 0};        ///< lowest point of the heel, from there [m]
    Vec3 across = {1, 0, 0};      ///< unit, horizontal: left of the foot's own direction
};

struct WalkArm {
    std::uint16_t upper = 0xffff;
    std::uint16_t fore = 0xffff;
    std::uint16_t hand = 0xffff;
    std::uint16_t collar = 0xffff;  ///< 0xffff: none
    Vec3 upper_way = {1, 0, 0};     ///< from shoulder to elbow, unit
    Vec3 fore_way = {1, 0, 0};      ///< from elbow to wrist, unit
};

/// Where the feet of a character and its hips have to be, in its space. A walk places the feet;
/// what else it does may move the rest (motor_pose.h).
struct WalkTargets {
    std::array<Vec3, 2> places = {};     ///< of the feet, as in WalkFoot [m]
    std::array<float, 2> headings = {};  ///< relative to rest [rad]
    std::array<float, 2> pitches = {};   ///< as in WalkFoot [rad]
    std::array<float, 2> slack = {};     ///< by which feet do not pull the hips [leg lengths]
    std::array<float, 2> limp = {};      ///< 1: toes follow the foot; 0: they stay level
    Vec3 shift = {0, 0, 0};              ///< of the hips [m]
    Quat turn = {1, 0, 0, 0};            ///< of the hips and all above
    float lean = 0.0f;                   ///< more of the back, forward [rad]
    Vec3 forward = {0, 0, 1};            ///< unit, horizontal
    Vec3 left = {1, 0, 0};               ///< unit, horizontal
};

/// Found when a character gets a Walk, and the targets in each step; never saved.
struct WalkBody {
    bool can_walk = false;
    std::array<WalkLeg, 2> legs = {};  ///< left, right
    std::array<WalkArm, 2> arms = {};
    std::uint16_t hips = 0;
    std::uint16_t spine = 0xffff;
    std::uint16_t chest = 0xffff;
    std::uint16_t head = 0xffff;
    Vec3 hips_place = {0, 0, 0};  ///< at rest, the soles at a height of 0 [m]
    float heading = 0.0f;         ///< where it faces at rest, about +y from +z [rad]
    WalkTargets targets = {};
};
template <>
struct ComponentTraits<WalkBody> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

/// can_walk is false for a skeleton without two legs of thigh, shin and foot.
[[nodiscard]] WalkBody find_walk_body(const SkeletonData& skeleton);

/// Mean length of both legs, thigh and shin [m].
[[nodiscard]] inline float leg_length(const WalkBody& body) {
    return 0.5f * (body.legs[0].length + body.legs[1].length);
}

}  // namespace limn
