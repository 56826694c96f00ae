#pragma once

#include "content/load/component_json.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Many of one entity, in a grid or a ring, each a little different:
//
//     "repeat": {
//       "count": [400, 1, 250], "spacing": [0.5, 0, 0.5],    // along x, y, z; about the node's own
//       place "jitter": [0.1, 0, 0.1],                             // up to so far away from there
//       "seed": 3,
//       "vary": {
//         "transform.rotation": {"from": [0, 0, 0], "to": [360, 0, 0]},
//         "sway.phase": {"by": "radius", "from": [0, 0, 0], "to": [0, 40, 0]},
//         "mesh_instance.material": {"by": "x", "pick": ["red", "gold", "white"], "noise": 0.2}
//       }
//     }
//
// What uses a prefab that is repeated may change single keys of its "repeat", or end it with null.
//
// With "radius" in place of spacing, the copies along x stand on a circle about +y and turn with
// it: what faced -z faces its middle.
//
// `vary` names fields of the entity's own components. Each copy has a number 0 .. 1, and the field
// is that far between `from` and `to`, or is the item of `pick` there. Where the number comes from
// is `by`:
//
//     random    a random number; each element of a vector that is no color has its own (the
//     default) x y z     from the first copy along that axis to the last radius    from the middle
//     to the farthest copy angle     about +y, from +z toward +x index     from the first copy to
//     the last
//
// `noise` adds a random number of that width, and `times` lets it run from 0 to 1 so often.
// Rotations need angles in degrees.

struct RepeatGrid {
    IVec3 count = {1, 1, 1};   ///< copies along x, y, z, >= 1
    Vec3 spacing = {1, 1, 1};  ///< from copy to copy [m]
    float radius = 0.0f;       ///< > 0: of the ring that the copies along x stand on [m]
    bool centered = true;      ///< the grid's middle is the node's place, else its first copy
    Vec3 jitter = {0, 0, 0};   ///< largest random displacement [m], >= 0
    std::uint64_t seed = 1;    ///< of all that is random
};

enum class VaryBy : std::uint8_t { Random, X, Y, Z, Radius, Angle, Index };

/// How one field changes from copy to copy.
struct Variation {
    ComponentId component = 0;
    const FieldInfo* field = nullptr;
    std::uint32_t offset = 0;  ///< of the field in the component [bytes]
    VaryBy by = VaryBy::Random;
    float noise = 0.0f;        ///< 0 .. 1
    float times = 1.0f;        ///< > 0
    std::vector<double> from;  ///< lane by lane; of rotations yaw, pitch, roll [deg]
    std::vector<double> to;    ///< as many
    std::vector<AnyComponent>
        picks;  ///< components whose field is the item; then from and to are empty
    std::uint32_t name_hash = 0;  ///< of the field's path: what its random numbers are keyed by
};

struct Repeat {
    RepeatGrid grid;
    std::vector<Variation> variations;
};

/// The copies of a repeat, at most kMaxRepeat along each axis.
[[nodiscard]] std::uint64_t repeat_count(const Repeat& repeat);

/// `components` are those of the entity, after all that a prefab gives.
[[nodiscard]] Result<Repeat> read_repeat(
    const JsonValue& json, std::span<const AnyComponent> components, const JsonPlace& place,
    const FindNames& names);

/// Moves copy number `index` to its place and changes its fields. A Sway moves with the Transform.
void apply_repeat(const Repeat& repeat, std::uint64_t index, std::span<AnyComponent> components);

template <typename Visitor>
void visit_fields(RepeatGrid& grid, Visitor&& visit) {
    visit("count", grid.count, {.doc = "copies along x, y and z", .min = 1, .max = 1e6});
    visit("spacing", grid.spacing, {.doc = "from copy to copy", .unit = "m"});
    visit(
        "radius", grid.radius,
        {.doc = "of a ring for the copies along x; 0 = none", .unit = "m", .min = 0});
    visit(
        "centered", grid.centered, {.doc = "the middle is the node's place, else the first copy"});
    visit("jitter", grid.jitter, {.doc = "largest random displacement", .unit = "m", .min = 0});
    visit("seed", grid.seed, {.doc = "of all that is random"});
}

}  // namespace limn
