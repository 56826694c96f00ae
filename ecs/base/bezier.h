#pragma once

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace limn {

// Cubic Bezier curves of scalars and vectors: evaluation, arc length, continuity.
// After A. Watt, F. Policarpo, "Advanced Game Development with Programmable Graphics Hardware"
// (2005), chapter 7 and its appendix 1 (whose end tangent, expansion and partition of unity are
// misprinted, and corrected here).
// Techniques: anim.arclength, anim.bezier-edit, anim.bezier-join, anim.boehm-quadrangle,
//     anim.parabolic-blend

template <typename T>
using Bezier = std::array<T, 4>;

/// The four cubic Bernstein polynomials at `u`; they sum to 1.
[[nodiscard]] inline Vec4 bernstein(float u) {
    const float s = 1.0f - u;
    return {s * s * s, 3.0f * u * (s * s), 3.0f * s * (u * u), u * u * u};
}

/// The cubic with control points `p` at `u` in 0 .. 1. Exact at both ends and where all control
/// points coincide; summed relative to the midpoint of the ends, so that it is symmetric.
template <typename T>
[[nodiscard]] T bezier_point(const Bezier<T>& p, float u) {
    if (u <= 0.0f || u >= 1.0f) {
        return u <= 0.0f ? p[0] : p[3];
    }
    const Vec4 b = bernstein(u);
    const T midpoint = 0.5f * (p[0] + p[3]);
    return midpoint
           + ((b.x * (p[0] - midpoint) + b.w * (p[3] - midpoint))
              + (b.y * (p[1] - midpoint) + b.z * (p[2] - midpoint)));
}

/// dQ/du of the same cubic; exactly 0 where all control points coincide.
template <typename T>
[[nodiscard]] T bezier_derivative(const Bezier<T>& p, float u) {
    const float s = 1.0f - u;
    return 3.0f * ((s * s * (p[1] - p[0]) + u * u * (p[3] - p[2])) + 2.0f * s * u * (p[2] - p[1]));
}

/// Cumulative arc length of a curve at each hundredth of u, approximated by chords; the relative
/// error falls with the square of their number (anim.arclength).
struct ChordTable {
    static constexpr int kSteps = 100;
    std::array<float, kSteps + 1> length = {};  ///< from 0 to u = i / kSteps; non-decreasing

    [[nodiscard]] float total() const { return length[kSteps]; }

    /// The u at `fraction` in 0 .. 1 of the total length; `fraction` itself on a curve of
    /// length 0.
    [[nodiscard]] float parameter_at(float fraction) const {
        if (!(total() > 0.0f)) {
            return std::clamp(fraction, 0.0f, 1.0f);
        }
        const float wanted = std::clamp(fraction, 0.0f, 1.0f) * total();
        const auto after = std::upper_bound(length.begin() + 1, length.end() - 1, wanted);
        const float from = after[-1];
        const float step = *after - from;
        const float within = step > 0.0f ? std::min((wanted - from) / step, 1.0f) : 0.0f;
        return (static_cast<float>(after - length.begin() - 1) + within) / kSteps;
    }
};

template <typename T>
[[nodiscard]] ChordTable measure_chords(const Bezier<T>& p) {
    ChordTable table;
    T from = p[0];
    for (int i = 1; i <= ChordTable::kSteps; ++i) {
        const T to = bezier_point(p, static_cast<float>(i) / ChordTable::kSteps);
        float chord = 0.0f;
        if constexpr (std::is_same_v<T, float>) {
            chord = std::abs(to - from);
        } else {
            chord = glm::length(to - from);
        }
        table.length[static_cast<std::size_t>(i)] =
            table.length[static_cast<std::size_t>(i - 1)] + chord;
        from = to;
    }
    return table;
}

enum class BezierJoin : std::uint8_t {
    None,       ///< the second does not begin where the first ends
    Position,   ///< C0: they meet at a corner, or a control point coincides with the key
    Direction,  ///< G1: same tangent direction, with a step in speed
    Speed,      ///< C1: same tangent
};

/// Continuity of two curves; lengths and directions may differ by the relative `tolerance`.
[[nodiscard]] inline BezierJoin
find_join(const Bezier<Vec3>& first, const Bezier<Vec3>& second, float tolerance = 1e-4f) {
    const Vec3 in = first[3] - first[2];
    const Vec3 out = second[1] - second[0];
    const float in_length = glm::length(in);
    const float out_length = glm::length(out);
    const float size =
        std::max({in_length, out_length, glm::length(first[3]), glm::length(second[0])});
    if (glm::length(second[0] - first[3]) > tolerance * size) {
        return BezierJoin::None;
    }
    const float product = in_length * out_length;
    const bool is_straight =
        glm::dot(in, out) > 0.0f && glm::length(glm::cross(in, out)) <= tolerance * product;
    if (!is_straight) {
        return BezierJoin::Position;
    }
    return std::abs(in_length - out_length) <= tolerance * in_length ? BezierJoin::Speed
                                                                     : BezierJoin::Direction;
}

/// The key where two curves meet and the control points before and after it, which an editor moves
/// together so that the join stays smooth (anim.bezier-edit).
struct BezierKnot {
    Vec3 before;
    Vec3 key;
    Vec3 after;
};

/// Moves the key to fraction `t` of the line between its control points, clamped to 0.01 .. 0.99.
[[nodiscard]] inline BezierKnot slide_knot(const BezierKnot& knot, float t) {
    const float u = std::clamp(t, 0.01f, 0.99f);
    return {knot.before, knot.before * (1.0f - u) + knot.after * u, knot.after};
}
/// Rotates both control points about the key.
[[nodiscard]] inline BezierKnot rotate_knot(const BezierKnot& knot, const Quat& rotation) {
    return {
        knot.key + rotation * (knot.before - knot.key), knot.key,
        knot.key + rotation * (knot.after - knot.key)};
}
[[nodiscard]] inline BezierKnot move_knot(const BezierKnot& knot, const Vec3& by) {
    return {knot.before + by, knot.key + by, knot.after + by};
}

/// Parabolic blend of the base line q[0] .. q[3] toward the top line q[1] .. q[2], by three linear
/// interpolations (anim.parabolic-blend).
template <typename T>
[[nodiscard]] T parabolic_blend(const std::array<T, 4>& q, float u) {
    const T base = q[0] * (1.0f - u) + q[3] * u;
    const T top = q[1] * (1.0f - u) + q[2] * u;
    const float weight = 2.0f * u * (1.0f - u);
    return base * (1.0f - weight) + top * weight;
}

/// The corners for which parabolic_blend() equals the cubic `p` (W. Boehm, 1982).
template <typename T>
[[nodiscard]] std::array<T, 4> quadrangle_of(const Bezier<T>& p) {
    return {p[0], 0.5f * (3.0f * p[1] - p[3]), 0.5f * (3.0f * p[2] - p[0]), p[3]};
}
template <typename T>
[[nodiscard]] Bezier<T> bezier_of(const std::array<T, 4>& q) {
    return {q[0], (2.0f * q[1] + q[3]) / 3.0f, (2.0f * q[2] + q[0]) / 3.0f, q[3]};
}

}  // namespace limn
