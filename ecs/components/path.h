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

// Curves that entities follow and along which meshes are swept: cubic Bezier segments between knots
// (anim.bezier-track), parameterized by arc length (anim.arclength). Stored in the Assets resource.

struct PathId {
    std::uint32_t index = 0xffffffffu;
    bool operator==(const PathId&) const = default;
};
template <>
inline constexpr const char* asset_kind<PathId> = "path";

/// n segments have n + 1 knots, or n if closed, and 3 n + 1 (3 n) points in all. `before` of the
/// first knot and `after` of the last are ignored in an open path.
struct PathKnot {
    Vec3 position = {0, 0, 0};
    Vec3 before = {0, 0, 0};
    Vec3 after = {0, 0, 0};
    float roll = 0.0f;
    float slide = 0.0f;
    Quat turn = {1, 0, 0, 0};
};

LIMN_FIELDS(PathKnot) {
    LIMN_FIELD(position, "point on the path", "m");
    LIMN_FIELD(before, "incoming control point, relative to the position", "m");
    LIMN_FIELD(after, "outgoing control point, relative to the position; both 0: smooth", "m");
    LIMN_FIELD(roll, "bank to the right", "rad", -3.2, 3.2);
    LIMN_FIELD(
        slide, "moves the knot to this fraction of the line between its control points; 0: stays",
        "", 0, 1);
    LIMN_FIELD(turn, "rotates both control points about the knot");
}

/// What the two points between the knots of a segment are.
enum class PathCurve : std::uint8_t {
    Bezier,    ///< control points of a cubic Bezier curve
    Parabolic  ///< corners of a parabolic blend, which the curve comes nearer to
};

/// A path as described in a level.
struct PathShape {
    std::vector<PathKnot> knots;
    bool closed = false;
    PathCurve curve = PathCurve::Bezier;
};

LIMN_FIELDS(PathShape) {
    LIMN_FIELD(knots, "knots in order, at least two");
    LIMN_FIELD(closed, "the last knot connects to the first");
    LIMN_FIELD(
        curve, .doc = "what `before` and `after` are: control points, or corners of a blend",
        .values = "bezier parabolic");
}

/// Position and orientation at a point of a path.
struct PathFrame {
    Vec3 position = {0, 0, 0};
    Vec3 ahead = {0, 0, 1};  ///< unit; right = cross(ahead, up)
    Vec3 up = {0, 1, 0};     ///< unit, perpendicular to `ahead`; level except for the roll
    float roll = 0.0f;       ///< [rad]
};

/// A path preprocessed for evaluation; immutable.
struct PathData {
    std::string name;
    bool closed = false;
    std::vector<Bezier<Vec3>> segments;  ///< [m]
    std::vector<ChordTable> chords;      ///< arc-length table of each segment
    std::vector<float>
        begins;                ///< distance at the start of each segment [m], then the total length
    std::vector<float> rolls;  ///< at the start of each segment, and at the end [rad]

    [[nodiscard]] float length() const { return begins.empty() ? 0.0f : begins.back(); }
};

/// Fails on fewer than two knots, numbers that are not finite, or a length of 0.
[[nodiscard]] Result<PathData> make_path(const PathShape& shape);

/// Frame at `distance` [m], wrapped on a closed path, clamped on an open one. Exact at knots.
[[nodiscard]] PathFrame path_frame_at(const PathData& path, double distance);

/// How the curve goes on at each knot between two segments, in order; of a closed path at its last
/// knot, too.
[[nodiscard]] std::vector<BezierJoin> path_joins(const PathData& path);

/// Signed curvature about `up`, 1 / radius [1/m]; positive for left turns.
[[nodiscard]] float path_curvature(const PathData& path, double distance);

/// Transform of a follower at `frame`, displaced by `offset`: right, up, ahead.
[[nodiscard]] Transform
transform_on_path(const PathFrame& frame, const Vec3& offset, bool level, const Vec3& scale);

/// Moves the entity's Transform along a path at constant speed, facing +z ahead.
struct PathFollower {
    PathId path{};
    double distance = 0.0;
    float speed = 1.0f;  ///< [m/s]; negative: backward
    Vec3 offset = {0, 0, 0};
    bool level = false;
};

LIMN_FIELDS(PathFollower) {
    LIMN_FIELD(path, "a path of the level, by name");
    LIMN_FIELD(distance, "distance along the path", "m", -1e6, 1e6);
    LIMN_FIELD(speed, "speed along the path", "m/s", -1000, 1000);
    LIMN_FIELD(offset, "offset from the path: right, up, ahead", "m");
    LIMN_FIELD(level, "stays upright where the path climbs or banks");
}

}  // namespace limn
