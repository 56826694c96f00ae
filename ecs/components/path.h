#pragma once

#include "ecs/base/bezier.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/transform.h"
#include "ecs/reflect.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Ways through space that things follow and along which meshes are swept: cubic Bezier segments
// from knot to knot (anim.bezier-track), gone through by distance (anim.arclength). They are kept
// once, in the Assets resource.

struct PathId {
    std::uint32_t index = 0xffffffffu;
    bool operator==(const PathId&) const = default;
};
template <>
inline constexpr const char* asset_kind<PathId> = "path";

/// n segments have n + 1 knots, or n if closed, and 3 n + 1 (3 n) points in all. What comes before
/// the first knot and after the last of an open path is of no effect.
struct PathKnot {
    Vec3 position = {0, 0, 0};  ///< [m]
    Vec3 before = {0, 0, 0};    ///< control point of the segment that ends here, from `position`
    Vec3 after = {0, 0, 0};     ///< of the one that begins here; both 0: smooth by the neighbors
    float roll = 0.0f;          ///< by which what follows leans to the right [rad]
};

/// As a level writes it.
struct PathShape {
    std::vector<PathKnot> knots;  ///< at least two
    bool closed = false;          ///< the last is followed by the first
};

/// Where the way is at one of its points, and how it runs there.
struct PathFrame {
    Vec3 position = {0, 0, 0};
    Vec3 ahead = {0, 0, 1};  ///< unit; right = cross(ahead, up)
    Vec3 up = {0, 1, 0};     ///< unit, at right angles to it; level but for the roll
    float roll = 0.0f;       ///< [rad]
};

/// A path ready to be followed; immutable.
struct PathData {
    std::string name;
    bool closed = false;
    std::vector<Bezier<Vec3>> segments;  ///< [m]
    std::vector<ChordTable> chords;      ///< of each segment
    std::vector<float> begins;           ///< distance at which each begins [m], and the length
    std::vector<float> rolls;            ///< at the beginning of each, and at the end [rad]

    [[nodiscard]] float length() const { return begins.empty() ? 0.0f : begins.back(); }
};

/// Fails with one line: less than two knots, numbers that are not finite, no length.
[[nodiscard]] Result<PathData> make_path(const PathShape& shape);

/// Where `distance` [m] leads: a closed path goes round, an open one ends. Exact at knots.
[[nodiscard]] PathFrame find_path_frame(const PathData& path, double distance);

/// How much the way turns to the left there, 1 / radius [1/m], as seen along its `up`.
[[nodiscard]] float path_curvature(const PathData& path, double distance);

/// The Transform of what follows a path at `frame`, `offset` to the right, up and ahead of it.
[[nodiscard]] Transform
stand_on_path(const PathFrame& frame, const Vec3& offset, bool level, const Vec3& scale);

/// Moves the entity's Transform along a path, +z ahead, at a constant speed.
struct PathFollower {
    PathId path{};
    double distance = 0.0;    ///< from the beginning [m]
    float speed = 1.0f;       ///< [m/s]; negative: backward
    Vec3 offset = {0, 0, 0};  ///< to the right, up and ahead of the way [m]
    bool level = false;       ///< stays upright where the way climbs or leans
};

template <typename Visitor>
void visit_fields(PathKnot& knot, Visitor&& visit) {
    visit("position", knot.position, {.doc = "where the way leads through", .unit = "m"});
    visit("before", knot.before, {.doc = "control point before it, from there", .unit = "m"});
    visit(
        "after", knot.after,
        {.doc = "control point after it, from there; both 0: smooth", .unit = "m"});
    visit("roll", knot.roll, {.doc = "leans to the right", .unit = "rad", .min = -3.2, .max = 3.2});
}

template <typename Visitor>
void visit_fields(PathShape& shape, Visitor&& visit) {
    visit("knots", shape.knots, {.doc = "in order, at least two"});
    visit("closed", shape.closed, {.doc = "the last is followed by the first"});
}

template <typename Visitor>
void visit_fields(PathFollower& follower, Visitor&& visit) {
    visit("path", follower.path, {.doc = "a path of the level, by name"});
    visit(
        "distance", follower.distance,
        {.doc = "from the beginning", .unit = "m", .min = -1e6, .max = 1e6});
    visit("speed", follower.speed, {.doc = "along it", .unit = "m/s", .min = -1000, .max = 1000});
    visit("offset", follower.offset, {.doc = "to the right, up and ahead of it", .unit = "m"});
    visit("level", follower.level, {.doc = "stays upright where it climbs or leans"});
}

}  // namespace limn
