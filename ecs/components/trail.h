#pragma once

#include "ecs/base/math.h"
#include "ecs/base/ring.h"
#include "ecs/reflect.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Ribbons along a path, drawn with the ParticleLook of their entity (engine.trail): behind a moving
// entity, behind each particle of an emitter, or through its particles.
//
// A component of its own rather than another ParticleFacing, because what leaves a trail need not
// be an emitter, and an emitter may draw its particles and their trails with different looks: the
// trail is then an entity of its own that names the emitter, as a ParticleSource does.
//
// The look's curves run over the trail instead of a life: from 0 at the head to 1 where `length` or
// `life` ends, whichever comes first.

enum class TrailPath : std::uint8_t {
    Entity,
    Particles,  ///< of each particle of the emitter
    Births,     ///< through the emitter's particles, in the order of their births
};

struct Trail {
    TrailPath path = TrailPath::Entity;
    Entity emitter{};
    bool active = true;
    float spacing = 0.1f;
    float length = 5;
    float life = 1;
    float jump = 5;
    Vec3 span = {0, 0, 0};
    float tile = 0;
    std::uint32_t count = 256;
};

LIMN_FIELDS(Trail) {
    LIMN_FIELD(
        path, .doc = "what is followed: the entity, each particle, or particles by age",
        .values = "entity particles births");
    LIMN_FIELD(emitter, "whose particles or, for an entity's path, which entity; none: this one");
    LIMN_FIELD(active, "whether it grows; existing parts fade either way");
    LIMN_FIELD(
        spacing, "between points, whatever the frame rate; at least a thousandth of the length",
        "m", 0.001, 1e3);
    LIMN_FIELD(length, "where it ends; not for births", "m", 0.01, 1e5);
    LIMN_FIELD(life, "how long its parts last; births last as long as particles", "s", 0.001, 1e4);
    LIMN_FIELD(jump, "a longer step or, between births, gap breaks it", "m", 0.001, 1e5);
    LIMN_FIELD(
        span,
        "from edge to edge, in local space, as of a blade; 0: as wide as the look's size, facing "
        "the camera",
        "m", -1e3, 1e3);
    LIMN_FIELD(
        tile, "length of an image, births counting as a spacing each; 0: one over the whole trail",
        "m", 0, 1e4);
    LIMN_FIELD(count, "maximum number of particles with a trail", "", 1, 65536);
}

struct TrailPoint {
    Vec3 position = {0, 0, 0};
    float age = 0;
    Vec3 span = {0, 0, 0};
};

LIMN_FIELDS(TrailPoint) {
    LIMN_FIELD(position, "in world space", "m");
    LIMN_FIELD(age, "since it was passed", "s");
    LIMN_FIELD(span, "in world space", "m");
}

/// One unbroken trail. Its points are a ring in its slot, exactly a spacing apart.
struct TrailStrand {
    TrailPoint head;          ///< at the end of the step; ages when it no longer moves
    TrailPoint previous;      ///< one step earlier
    Vec3 before = {0, 0, 0};  ///< two steps earlier
    bool live = true;         ///< still grows
    std::uint32_t key = 0;    ///< random bits of its particle
    std::uint32_t slot = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t number = 0;  ///< points so far, with those that are gone
};

LIMN_FIELDS(TrailStrand) {
    LIMN_FIELD(head, "its end");
    LIMN_FIELD(previous, "its end one step earlier");
    LIMN_FIELD(before, "its end two steps earlier", "m");
    LIMN_FIELD(live, "still grows");
    LIMN_FIELD(key, "random bits of its particle");
    LIMN_FIELD(slot, "index of its points");
    LIMN_FIELD(first, "oldest point");
    LIMN_FIELD(count, "number of points");
    LIMN_FIELD(number, "points so far");
}

/// What the trail system keeps for each Trail.
struct TrailState {
    std::uint32_t capacity = 0;        ///< points of a slot
    std::vector<TrailStrand> strands;  ///< live ones in the order of their particles
    std::vector<TrailPoint> points;    ///< slot after slot
    std::vector<std::uint32_t> free_slots;
};

LIMN_FIELDS(TrailState) {
    LIMN_FIELD(capacity, "maximum number of points of a strand");
    LIMN_FIELD(strands, "unbroken trails");
    LIMN_FIELD(points, "of all strands");
    LIMN_FIELD(free_slots, "slots without a strand");
}

/// The points of a strand, the oldest first.
[[nodiscard]] inline Ring<TrailPoint> trail_points(TrailState& state, TrailStrand& strand) {
    const std::size_t begin = std::size_t{strand.slot} * state.capacity;
    return {std::span(state.points).subspan(begin, state.capacity), strand.first, strand.count};
}
[[nodiscard]] inline Ring<const TrailPoint>
trail_points(const TrailState& state, const TrailStrand& strand) {
    const std::size_t begin = std::size_t{strand.slot} * state.capacity;
    return {std::span(state.points).subspan(begin, state.capacity), strand.first, strand.count};
}
[[nodiscard]] inline const TrailPoint&
trail_point(const TrailState& state, const TrailStrand& strand, std::uint32_t i) {
    return trail_points(state, strand)[i];
}

/// Distance between points that the trail keeps [m].
[[nodiscard]] inline float trail_spacing(const Trail& trail) {
    return std::max({trail.spacing, trail.length / 1000, 1e-4f});
}

template <>
struct ComponentTraits<TrailState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
