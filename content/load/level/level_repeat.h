#pragma once

#include "content/load/level/component_json.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Copies of one entity in a grid or a ring, with per-copy variation:
//
//     "repeat": {
//       // along x, y, z, centered on the node's own position
//       "count": [400, 1, 250], "spacing": [0.5, 0, 0.5],
//       "jitter": [0.1, 0, 0.1],  // largest random displacement
//       "seed": 3,
//       "vary": {
//         "transform.rotation": {"from": [0, 0, 0], "to": [360, 0, 0]},
//         "sway.phase": {"by": "radius", "from": [0, 0, 0], "to": [0, 40, 0]},
//         "mesh_instance.material": {"by": "x", "pick": ["red", "gold", "white"], "noise": 0.2}
//       }
//     }
//
// An entity that uses a repeated prefab may override single keys of its "repeat", or disable it
// with null.
//
// With "radius" instead of spacing, the copies along x are placed on a circle about +y and rotated
// with it: a copy that faced -z faces the center.
//
// `vary` names fields of the entity's own components. Each copy has a parameter 0 .. 1 that
// interpolates the field between `from` and `to`, or selects an item of `pick`. `by` chooses the
// parameter:
//
//     random  a random number (the default); each element of a vector other than a color gets its
//     own x y z   from the first to the last copy along that axis radius  from the center to the
//     farthest copy angle   about +y, from -z over -x, +z and +x index   from the first to the last
//     copy
//
// `noise` adds a random number of that width; `times` repeats the range 0 .. 1 that many times.
// Rotations are [yaw, pitch, roll] in degrees.

struct RepeatGrid {
    IVec3 count = {1, 1, 1};
    Vec3 spacing = {1, 1, 1};
    float radius = 0.0f;
    bool centered = true;
    Vec3 jitter = {0, 0, 0};
    std::uint64_t seed = 1;
};

LIMN_FIELDS(RepeatGrid) {
    LIMN_FIELD(count, "copies along x, y and z", "", 1, 1e6);
    LIMN_FIELD(spacing, "distance between copies", "m");
    LIMN_FIELD(radius, "radius of a ring for the copies along x; 0 = none", "m", 0);
    LIMN_FIELD(centered, "the node is the center of the grid, else its first copy");
    LIMN_FIELD(jitter, "largest random displacement", "m", 0);
    LIMN_FIELD(seed, "random seed");
}

enum class VaryBy : std::uint8_t { Random, X, Y, Z, Radius, Angle, Index };

/// How one field changes from copy to copy.
struct Variation {
    ComponentId component = 0;
    const FieldInfo* field = nullptr;
    std::uint32_t offset = 0;  ///< of the field in the component [bytes]
    VaryBy by = VaryBy::Random;
    float noise = 0.0f;        ///< 0 .. 1
    float times = 1.0f;        ///< > 0
    std::vector<double> from;  ///< per lane; of rotations yaw, pitch, roll [deg]
    std::vector<double> to;    ///< same size as `from`
    /// Components whose field is an item of "pick"; then from and to are empty.
    std::vector<AnyComponent> picks;
    std::uint32_t name_hash = 0;  ///< of the field's path; keys its random numbers
};

struct Repeat {
    RepeatGrid grid;
    std::vector<Variation> variations;
};

/// Number of copies, at most 1e6 along each axis.
[[nodiscard]] std::uint64_t repeat_count(const Repeat& repeat);

/// `components` are those of the entity, including those of its prefab.
[[nodiscard]] Result<Repeat> read_repeat(
    const JsonValue& json, std::span<const AnyComponent> components, const JsonLocation& location,
    const NameResolver& names);

/// Moves copy `index` to its position and varies its fields. A Sway moves with the Transform.
void apply_repeat(const Repeat& repeat, std::uint64_t index, std::span<AnyComponent> components);

}  // namespace limn
