#include "ecs/components/path.h"

#include "ecs/base/rotation.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

// Techniques: anim.arclength, anim.bezier-edit, anim.bezier-join, anim.bezier-track,
//     anim.boehm-quadrangle, anim.parabolic-blend

namespace limn {
namespace {

Vec3 second_derivative(const Bezier<Vec3>& p, float u) {
    return 6.0f * ((1.0f - u) * (p[2] - 2.0f * p[1] + p[0]) + u * (p[3] - 2.0f * p[2] + p[1]));
}

/// Control points of a centripetal Catmull-Rom spline (Yuksel, Schaefer and Keyser 2011), which has
/// no loops between knots however uneven their spacing. Open ends are straight.
void smooth_knot(PathKnot& knot, const PathKnot* last, const PathKnot* next) {
    const Vec3 in = last != nullptr ? knot.position - last->position : Vec3(0);
    const Vec3 out = next != nullptr ? next->position - knot.position : Vec3(0);
    if (last == nullptr || next == nullptr) {
        knot.before = -in / 3.0f;
        knot.after = out / 3.0f;
        return;
    }
    const float a = std::sqrt(glm::length(in));
    const float b = std::sqrt(glm::length(out));
    if (!(a > 0.0f && b > 0.0f)) {
        return;
    }
    const Vec3 slope = in / a - (in + out) / (a + b) + out / b;  // over the root of the length
    knot.before = -slope * (a / 3.0f);
    knot.after = slope * (b / 3.0f);
}

/// The edits of a knot, its tangents once they are known (anim.bezier-edit).
void edit_knot(PathKnot& knot) {
    const BezierKnot given = {
        knot.position + knot.before, knot.position, knot.position + knot.after};
    BezierKnot edited = knot.slide > 0.0f ? slide_knot(given, knot.slide) : given;
    edited = rotate_knot(edited, normalize_or_identity(knot.turn));
    knot.position = edited.key;
    knot.before = edited.before - edited.key;
    knot.after = edited.after - edited.key;
}

struct PathPosition {
    std::size_t segment = 0;
    float u = 0;
};

PathPosition find_position(const PathData& path, double distance) {
    const double length = path.length();
    double along = std::isfinite(distance) ? distance : 0.0;
    if (path.closed) {
        along -= std::floor(along / length) * length;
    }
    along = std::clamp(along, 0.0, length);
    const auto after =
        std::upper_bound(path.begins.begin() + 1, path.begins.end() - 1, static_cast<float>(along));
    const auto segment = static_cast<std::size_t>(after - path.begins.begin() - 1);
    const double from = path.begins[segment];
    const double segment_length = path.begins[segment + 1] - from;
    const double fraction = segment_length > 0.0 ? (along - from) / segment_length : 0.0;
    return {segment, path.chords[segment].parameter_at(static_cast<float>(fraction))};
}

}  // namespace

Result<PathData> make_path(const PathShape& shape) {
    std::vector<PathKnot> knots = shape.knots;
    const std::size_t count = knots.size();
    if (count < 2) {
        return fail("found {} knots, expected at least 2", count);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const PathKnot& knot = knots[i];
        if (!is_finite(knot.position) || !is_finite(knot.before) || !is_finite(knot.after)
            || !std::isfinite(knot.roll) || !std::isfinite(knot.slide)) {
            return fail("knots[{}]: found a number that is not finite", i);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (knots[i].before == Vec3(0) && knots[i].after == Vec3(0)) {
            const bool first = i == 0 && !shape.closed;
            const bool last = i + 1 == count && !shape.closed;
            smooth_knot(
                knots[i], first ? nullptr : &knots[(i + count - 1) % count],
                last ? nullptr : &knots[(i + 1) % count]);
        }
    }
    for (PathKnot& knot : knots) {
        if (knot.slide > 0.0f || knot.turn != Quat(1, 0, 0, 0)) {
            edit_knot(knot);
        }
    }
    PathData path;
    path.closed = shape.closed;
    path.begins.push_back(0.0f);
    const std::size_t segments = shape.closed ? count : count - 1;
    double length = 0.0;
    for (std::size_t i = 0; i < segments; ++i) {
        const PathKnot& from = knots[i];
        const PathKnot& to = knots[(i + 1) % count];
        const Bezier<Vec3> points = {
            from.position, from.position + from.after, to.position + to.before, to.position};
        path.segments.push_back(shape.curve == PathCurve::Parabolic ? bezier_of(points) : points);
        path.chords.push_back(measure_chords(path.segments.back()));
        length += static_cast<double>(path.chords.back().total());
        path.begins.push_back(static_cast<float>(length));
        path.rolls.push_back(from.roll);
    }
    path.rolls.push_back(shape.closed ? knots[0].roll : knots.back().roll);
    if (!(length > 0.0) || !std::isfinite(length)) {
        return fail("all knots coincide, expected a path of nonzero length");
    }
    return path;
}

PathFrame path_frame_at(const PathData& path, double distance) {
    if (path.segments.empty()) {
        return {};
    }
    const PathPosition at = find_position(path, distance);
    const Bezier<Vec3>& points = path.segments[at.segment];
    PathFrame frame;
    frame.position = bezier_point(points, at.u);
    // Where a control point coincides with its knot, the derivative is 0; use the next difference.
    const Vec3 slope = bezier_derivative(points, at.u);
    frame.ahead = normalize_or(
        glm::length(slope) > 1e-6f * glm::length(points[3] - points[0]) ? slope
        : at.u < 0.5f                                                   ? points[2] - points[0]
                                                                        : points[3] - points[1],
        {0, 0, 1});
    const float ease = at.u * at.u * (3.0f - 2.0f * at.u);
    frame.roll = glm::mix(path.rolls[at.segment], path.rolls[at.segment + 1], ease);
    const Vec3 right =
        normalize_or(glm::cross(frame.ahead, {0, 1, 0}), any_perpendicular(frame.ahead));
    const Vec3 level_up = glm::cross(right, frame.ahead);
    frame.up = level_up * std::cos(frame.roll) + right * std::sin(frame.roll);
    return frame;
}

std::vector<BezierJoin> path_joins(const PathData& path) {
    std::vector<BezierJoin> joins;
    const std::size_t count = path.segments.size();
    for (std::size_t i = 1; i < count + (path.closed ? 1 : 0); ++i) {
        joins.push_back(find_join(path.segments[i - 1], path.segments[i % count], 1e-3f));
    }
    return joins;
}

float path_curvature(const PathData& path, double distance) {
    if (path.segments.empty()) {
        return 0.0f;
    }
    const PathPosition at = find_position(path, distance);
    const Bezier<Vec3>& points = path.segments[at.segment];
    const Vec3 slope = bezier_derivative(points, at.u);
    const float speed = glm::length(slope);
    if (!(speed > 1e-6f)) {
        return 0.0f;
    }
    const Vec3 turn = glm::cross(slope, second_derivative(points, at.u));
    return glm::dot(turn, path_frame_at(path, distance).up) / (speed * speed * speed);
}

Transform
transform_on_path(const PathFrame& frame, const Vec3& offset, bool level, const Vec3& scale) {
    const Vec3 right = glm::cross(frame.ahead, frame.up);
    const Vec3 position =
        frame.position + right * offset.x + frame.up * offset.y + frame.ahead * offset.z;
    const Vec3 flat = {frame.ahead.x, 0, frame.ahead.z};
    const bool upright = level && glm::length(flat) > 0.0f;
    const Vec3 z = upright ? glm::normalize(flat) : frame.ahead;
    const Vec3 y = upright ? Vec3(0, 1, 0) : frame.up;
    // +z ahead and +y up put +x to the left, as in glTF.
    return {position, glm::quat_cast(Mat3(glm::cross(y, z), y, z)), scale};
}

}  // namespace limn
