#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

// Computer puppetry: what one character does, driven by a player, is performed live by others with
// other proportions. Packets of the performer's pose arrive over a link that may lose and delay
// them, are played a little later, filtered without looking ahead, and retargeted.
// After A. Watt, F. Policarpo, "Advanced Game Development with Programmable Graphics Hardware"
// (2005), chapter 9; H. Shin et al., "Computer Puppetry: An Importance-Based Approach" (2001).
// Techniques: char.puppetry

/// With a Skeleton: performs what another character does instead of playing a clip. Joints
/// correspond by name or by the part of a person that they are.
struct Puppet {
    Entity performer{};
    float latency = 0.1f;
    float cutoff = 0.0f;
    float eagerness = 2.0f;
    float hands = 0.0f;
    bool pin_feet = true;
    bool moves_root = true;
    float loss = 0.0f;
    float jitter = 0.0f;
    float noise = 0.0f;
};

LIMN_FIELDS(Puppet) {
    LIMN_FIELD(performer, "character with a skeleton, no puppet itself, by name");
    LIMN_FIELD(latency, "plays what arrives this long after it was performed", "s", 0, 1);
    LIMN_FIELD(cutoff, "of the filter against noise, at rest; 0: none", "Hz", 0, 100);
    LIMN_FIELD(
        eagerness, "by which the cutoff rises with the speed of a joint", "Hz s/rad", 0, 100);
    LIMN_FIELD(hands, "importance of the way of the hands over angles", "", 0, 1);
    LIMN_FIELD(pin_feet, "planted feet stay where they are");
    LIMN_FIELD(moves_root, "walks as far as the performer, by the length of its legs");
    LIMN_FIELD(loss, "share of the packets that the link loses", "", 0, 1);
    LIMN_FIELD(jitter, "largest delay of a packet, each its own: they overtake", "s", 0, 1);
    LIMN_FIELD(noise, "standard deviation of the measured rotations", "rad", 0, 1);
}

/// What is sent of a pose, besides the rotations of its joints.
struct PuppetPacket {
    double time = -1;  ///< < 0: none
    double arrival = 0;
    Vec3 place = {0, 0, 0};
    Quat facing = {1, 0, 0, 0};
    std::array<Vec3, 7> points{};  ///< as in PuppetPoint
};

LIMN_FIELDS(PuppetPacket) {
    LIMN_FIELD(time, "of the performance; < 0: no packet", "s");
    LIMN_FIELD(arrival, "when it can be played", "s");
    LIMN_FIELD(place, "of the performer, in the space of its parent", "m");
    LIMN_FIELD(facing, "rotation of the performer");
    LIMN_FIELD(points, "hips, ankles, toes and hands, in the performer's space", "m");
}

/// Points of a packet; left, then right.
enum class PuppetPoint : std::uint8_t { Hips, Ankles, Toes = 3, Hands = 5 };

/// The packets of the last moments, in any order: a new one replaces the oldest.
struct PuppetStream {
    std::vector<PuppetPacket> packets;
    std::vector<Quat> turns;  ///< joint j of packet p is at p * joints + j
    std::uint32_t joints = 0;
    std::uint32_t late = 0;
    std::uint32_t held = 0;
};

LIMN_FIELDS(PuppetStream) {
    LIMN_FIELD(packets, "ring buffer");
    LIMN_FIELD(turns, "rotations of the performer's joints, packet by packet");
    LIMN_FIELD(joints, "of the performer");
    LIMN_FIELD(late, "packets that arrived too late to be played");
    LIMN_FIELD(held, "steps in which no packet was left to play");
}

/// A rotation or a vector that a filter without look-ahead follows.
struct FilteredTurn {
    Quat value = {1, 0, 0, 0};
    float speed = 0.0f;
};

LIMN_FIELDS(FilteredTurn) {
    LIMN_FIELD(value, "filtered");
    LIMN_FIELD(speed, "of the input, filtered", "rad/s");
}

/// A foot of a puppet.
struct PuppetFoot {
    bool planted = false;
    Vec3 pin = {0, 0, 0};
    Vec3 offset = {0, 0, 0};
    Vec3 last = {0, 0, 0};
};

LIMN_FIELDS(PuppetFoot) {
    LIMN_FIELD(planted, "whether the performer's foot is");
    LIMN_FIELD(pin, "where the puppet's toes stay, in the space of its parent", "m");
    LIMN_FIELD(offset, "of the foot from where it would be without pins", "m");
    LIMN_FIELD(last, "the performer's toes in the previous step", "m");
}

/// State of a Puppet.
struct PuppetState {
    PuppetStream stream{};
    std::vector<FilteredTurn> turns{};
    std::array<Vec3, 7> points{};
    Vec3 place = {0, 0, 0};
    Quat facing = {1, 0, 0, 0};
    bool started = false;
    Vec3 first_place = {0, 0, 0};
    Quat first_facing = {1, 0, 0, 0};
    Vec3 origin = {0, 0, 0};
    Quat origin_facing = {1, 0, 0, 0};
    std::array<PuppetFoot, 2> feet{};
    float drop = 0.0f;
};

LIMN_FIELDS(PuppetState) {
    LIMN_FIELD(stream, "what has arrived");
    LIMN_FIELD(turns, "rotations of the performer's joints, filtered");
    LIMN_FIELD(points, "of the performer, filtered", "m");
    LIMN_FIELD(place, "of the performer, filtered", "m");
    LIMN_FIELD(facing, "of the performer, filtered");
    LIMN_FIELD(started, "whether a packet has been played");
    LIMN_FIELD(first_place, "of the performer in the first packet", "m");
    LIMN_FIELD(first_facing, "of the performer in the first packet");
    LIMN_FIELD(origin, "of the puppet then", "m");
    LIMN_FIELD(origin_facing, "of the puppet then");
    LIMN_FIELD(feet, "left and right");
    LIMN_FIELD(drop, "by which hips are lowered so that legs reach", "m");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<PuppetState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
