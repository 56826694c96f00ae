#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>

namespace limn {

// Closest points of segments, triangles and boxes, after C. Ericson, "Real-Time Collision
// Detection" (2005), chapter 5. In double precision.

using RigidVec = glm::dvec3;

struct LineSegment {
    RigidVec from = RigidVec(0);
    RigidVec to = RigidVec(0);

    [[nodiscard]] RigidVec at(double u) const { return from + u * (to - from); }
};

struct ClosestPair {
    RigidVec on_a = RigidVec(0);
    RigidVec on_b = RigidVec(0);
};

/// Fraction of the segment at which it is closest to the point; 0 if it has no length.
[[nodiscard]] inline double closest_fraction(const LineSegment& segment, const RigidVec& point) {
    const RigidVec along = segment.to - segment.from;
    const double length2 = glm::dot(along, along);
    return length2 > 0 ? std::clamp(glm::dot(point - segment.from, along) / length2, 0.0, 1.0)
                       : 0.0;
}

/// Of two segments; of parallel ones, one of the pairs.
[[nodiscard]] inline ClosestPair closest_points(const LineSegment& a, const LineSegment& b) {
    const RigidVec d1 = a.to - a.from;
    const RigidVec d2 = b.to - b.from;
    const RigidVec r = a.from - b.from;
    const double aa = glm::dot(d1, d1);
    const double ee = glm::dot(d2, d2);
    const double f = glm::dot(d2, r);
    const double c = glm::dot(d1, r);
    const double bb = glm::dot(d1, d2);
    const double denominator = aa * ee - bb * bb;
    double s =
        denominator > 1e-12 * aa * ee ? std::clamp((bb * f - c * ee) / denominator, 0.0, 1.0) : 0.5;
    const double t = ee > 0 ? std::clamp((bb * s + f) / ee, 0.0, 1.0) : 0.0;
    s = aa > 0 ? std::clamp((bb * t - c) / aa, 0.0, 1.0) : 0.0;
    return {a.at(s), b.at(t)};
}

struct Triangle3 {
    RigidVec a = RigidVec(0);
    RigidVec b = RigidVec(0);
    RigidVec c = RigidVec(0);
};

/// Of a triangle to a point.
[[nodiscard]] inline RigidVec closest_point(const Triangle3& triangle, const RigidVec& p) {
    const auto& [a, b, c] = triangle;
    const RigidVec ab = b - a;
    const RigidVec ac = c - a;
    const double d1 = glm::dot(ab, p - a);
    const double d2 = glm::dot(ac, p - a);
    if (d1 <= 0 && d2 <= 0) {
        return a;
    }
    const double d3 = glm::dot(ab, p - b);
    const double d4 = glm::dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3) {
        return b;
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return a + d1 / (d1 - d3) * ab;
    }
    const double d5 = glm::dot(ab, p - c);
    const double d6 = glm::dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6) {
        return c;
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        return a + d2 / (d2 - d6) * ac;
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    const double denominator = 1 / (va + vb + vc);
    return a + vb * denominator * ab + vc * denominator * ac;
}

/// Of a segment that does not cross the triangle (a) and the triangle (b).
[[nodiscard]] inline ClosestPair
closest_points(const LineSegment& segment, const Triangle3& triangle) {
    const auto& [a, b, c] = triangle;
    ClosestPair best;
    double best2 = -1;
    const auto take = [&](const ClosestPair& pair) {
        const RigidVec between = pair.on_a - pair.on_b;
        const double distance2 = glm::dot(between, between);
        if (best2 < 0 || distance2 < best2) {
            best2 = distance2;
            best = pair;
        }
    };
    take({segment.from, closest_point(triangle, segment.from)});
    take({segment.to, closest_point(triangle, segment.to)});
    for (const LineSegment& edge : {LineSegment{a, b}, LineSegment{b, c}, LineSegment{c, a}}) {
        take(closest_points(segment, edge));
    }
    return best;
}

/// Fraction of the segment at which it is closest to a box about the origin; the distance to a
/// convex body is convex along it.
[[nodiscard]] inline double
closest_fraction_to_box(const LineSegment& segment, const RigidVec& half) {
    const auto distance2 = [&](double u) {
        const RigidVec p = segment.at(u);
        const RigidVec out = glm::max(glm::abs(p) - half, RigidVec(0));
        return glm::dot(out, out);
    };
    double low = 0;
    double high = 1;
    for (int i = 0; i < 24; ++i) {
        const double third = (high - low) / 3;
        if (distance2(low + third) <= distance2(high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    return 0.5 * (low + high);
}

}  // namespace limn
