#pragma once

#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

/// A line from the entity to another one or along its -z axis, drawn as a ribbon with the
/// ParticleLook of the entity: a laser, an arc, lightning. The look's curves run from 0 at the
/// start to 1 at the end.
struct Beam {
    bool active = true;
    Entity to{};
    float length = 10;
    bool stops = true;
    float jag = 0;
    std::uint32_t detail = 6;
    std::uint32_t branches = 0;
    float rate = 15;
    std::uint32_t seed = 0;
    float tile = 0;
};

LIMN_FIELDS(Beam) {
    LIMN_FIELD(active, "whether it is drawn");
    LIMN_FIELD(to, "the entity where it ends; none: along -z");
    LIMN_FIELD(length, "along -z", "m", 0, 1e5);
    LIMN_FIELD(stops, "along -z: at the first particle_collider");
    LIMN_FIELD(
        jag, "maximum offset as a fraction of its length, by midpoint displacement; 0: straight",
        "", 0, 1);
    LIMN_FIELD(detail, "levels of subdivision of a jagged one", "", 1, 9);
    LIMN_FIELD(branches, "of a jagged one", "", 0, 32);
    LIMN_FIELD(rate, "new shapes per second; 0: always the same", "1/s", 0, 1000);
    LIMN_FIELD(seed, "of its shapes; 0: a different one for each entity");
    LIMN_FIELD(tile, "length of an image; 0: one over the whole beam", "m", 0, 1e4);
}

/// What the beam system keeps for each Beam: where it is, in world space.
struct BeamState {
    bool shown = false;
    Vec3 start = {0, 0, 0};
    Vec3 end = {0, 0, 0};
    Vec3 previous_start = {0, 0, 0};
    Vec3 previous_end = {0, 0, 0};
};

LIMN_FIELDS(BeamState) {
    LIMN_FIELD(shown, "whether it has a start and an end");
    LIMN_FIELD(start, "at the end of the step", "m");
    LIMN_FIELD(end, "at the end of the step", "m");
    LIMN_FIELD(previous_start, "one step earlier", "m");
    LIMN_FIELD(previous_end, "one step earlier", "m");
}

template <>
struct ComponentTraits<BeamState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// Replaces `points` by 2^detail + 1 from `start` to `end`, which are exact: midpoints are
/// displaced at right angles to the line, by ever less, by no more than jag times its length in
/// all.
void make_bolt(
    const Vec3& start, const Vec3& end, float jag, std::uint32_t detail, Random& random,
    std::vector<Vec3>& points);

/// Which of its shapes a beam has at `time`, and the numbers for it.
[[nodiscard]] Random beam_random(const Beam& beam, Entity entity, double time);

}  // namespace limn
