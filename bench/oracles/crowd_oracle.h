#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace limn::oracle {

// Crowds in double precision, slow and plain: neighbors by comparing all pairs, velocity obstacles
// by their definition, and optima of linear programs by trying all corners.

struct CrowdVec {
    double x = 0;
    double y = 0;
};
inline CrowdVec operator+(CrowdVec a, CrowdVec b) {
    return {a.x + b.x, a.y + b.y};
}
inline CrowdVec operator-(CrowdVec a, CrowdVec b) {
    return {a.x - b.x, a.y - b.y};
}
inline CrowdVec operator*(double s, CrowdVec a) {
    return {s * a.x, s * a.y};
}
inline double dot(CrowdVec a, CrowdVec b) {
    return a.x * b.x + a.y * b.y;
}
inline double length_of(CrowdVec a) {
    return std::hypot(a.x, a.y);
}

/// The v with dot(normal, v - point) >= 0.
struct CrowdHalfPlane {
    CrowdVec point;
    CrowdVec normal;
};
inline double excess_of(const CrowdHalfPlane& plane, CrowdVec v) {
    return -dot(plane.normal, v - plane.point);
}

/// The largest excess of v over the half-planes from `first` on.
inline double
largest_excess(const std::vector<CrowdHalfPlane>& planes, CrowdVec v, std::size_t first = 0) {
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = first; i < planes.size(); ++i) {
        largest = std::max(largest, excess_of(planes[i], v));
    }
    return largest;
}

/// Where an optimum can be: the preferred velocity, its nearest points on the circle and on every
/// line, and all points where lines meet each other or the circle.
inline std::vector<CrowdVec> optimum_candidates(
    const std::vector<CrowdHalfPlane>& planes, CrowdVec preferred, double max_speed) {
    std::vector<CrowdVec> points = {preferred};
    if (const double speed = length_of(preferred); speed > 0) {
        points.push_back((max_speed / speed) * preferred);
    }
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const CrowdVec n = planes[i].normal;
        const CrowdVec along = {n.y, -n.x};
        const double distance = dot(n, planes[i].point);
        points.push_back(preferred + (distance - dot(n, preferred)) * n);
        if (const double rest = max_speed * max_speed - distance * distance; rest >= 0) {
            points.push_back(distance * n + std::sqrt(rest) * along);
            points.push_back(distance * n - std::sqrt(rest) * along);
        }
        for (std::size_t j = 0; j < i; ++j) {
            const CrowdVec m = planes[j].normal;
            const double sine = n.x * m.y - n.y * m.x;
            if (std::abs(sine) > 1e-12) {
                const double other = dot(m, planes[j].point);
                points.push_back(
                    {(distance * m.y - other * n.y) / sine, (n.x * other - m.x * distance) / sine});
            }
        }
    }
    return points;
}

/// The distance of the best velocity from the preferred one; infinite where none meets all
/// half-planes to within `tolerance`.
inline double best_distance(
    const std::vector<CrowdHalfPlane>& planes, CrowdVec preferred, double max_speed,
    double tolerance) {
    double best = std::numeric_limits<double>::infinity();
    for (const CrowdVec& v : optimum_candidates(planes, preferred, max_speed)) {
        if (length_of(v) <= max_speed + tolerance && largest_excess(planes, v) <= tolerance) {
            best = std::min(best, length_of(v - preferred));
        }
    }
    return best;
}

/// The least largest excess of the half-planes over all velocities of the disc, by sampling it ever
/// finer: the excess is convex.
inline double least_excess(const std::vector<CrowdHalfPlane>& planes, double max_speed) {
    CrowdVec center;
    double size = max_speed;
    double least = largest_excess(planes, center);
    for (int level = 0; level < 60; ++level) {
        CrowdVec best = center;
        for (int i = -8; i <= 8; ++i) {
            for (int j = -8; j <= 8; ++j) {
                CrowdVec v = center + (size / 8) * CrowdVec{double(i), double(j)};
                if (const double speed = length_of(v); speed > max_speed) {
                    v = (max_speed / speed) * v;
                }
                if (const double excess = largest_excess(planes, v); excess < least) {
                    least = excess;
                    best = v;
                }
            }
        }
        center = best;
        size *= 0.75;
    }
    return least;
}

/// Whether two discs that keep a relative velocity touch within `horizon`, by their definition.
inline bool discs_collide(CrowdVec offset, CrowdVec relative, double reach, double horizon) {
    const double speed2 = dot(relative, relative);
    const double t = speed2 > 0 ? std::clamp(dot(offset, relative) / speed2, 0.0, horizon) : 0.0;
    return length_of(offset - t * relative) < reach;
}

/// Pairs of discs that overlap by more than `tolerance`, and the deepest overlap, over all pairs.
inline std::pair<std::size_t, double> count_overlaps(
    const std::vector<CrowdVec>& centers, const std::vector<double>& radii, double tolerance) {
    std::size_t count = 0;
    double deepest = 0;
    for (std::size_t i = 0; i < centers.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double overlap = radii[i] + radii[j] - length_of(centers[i] - centers[j]);
            count += overlap > tolerance ? 1 : 0;
            deepest = std::max(deepest, overlap);
        }
    }
    return {count, deepest};
}

}  // namespace limn::oracle
