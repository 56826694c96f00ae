#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace limn::oracle {

// Inverse kinematics in double precision, slow and plain: chains as products of 4x4 matrices by
// Rodrigues' formula, the Jacobian by central differences, and brute force over joint angles.

using Vec3d = std::array<double, 3>;

inline Vec3d minus(const Vec3d& a, const Vec3d& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double size_of(const Vec3d& a) {
    return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/// A joint of a chain: a link from the previous one, then a turn about a unit axis, or a slide.
struct IkJoint {
    Vec3d offset = {0, 0, 0};
    Vec3d axis = {0, 0, 1};
    bool slides = false;
};

struct IkMatrix4 {
    double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
};

inline IkMatrix4 operator*(const IkMatrix4& a, const IkMatrix4& b) {
    IkMatrix4 product;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            product.m[i][j] = 0;
            for (int k = 0; k < 4; ++k) {
                product.m[i][j] += a.m[i][k] * b.m[k][j];
            }
        }
    }
    return product;
}

inline IkMatrix4 ik_move(const Vec3d& by) {
    IkMatrix4 matrix;
    for (int i = 0; i < 3; ++i) {
        matrix.m[i][3] = by[i];
    }
    return matrix;
}

/// Rodrigues: R = I cos + (1 - cos) a a^T + sin [a]x.
inline IkMatrix4 ik_turn(const Vec3d& a, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double cross[3][3] = {{0, -a[2], a[1]}, {a[2], 0, -a[0]}, {-a[1], a[0], 0}};
    IkMatrix4 matrix;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            matrix.m[i][j] = (i == j ? c : 0) + (1 - c) * a[i] * a[j] + s * cross[i][j];
        }
    }
    return matrix;
}

/// Tip of the chain, `end` beyond its last joint.
inline Vec3d
ik_tip(const std::vector<IkJoint>& joints, const std::vector<double>& theta, const Vec3d& end) {
    IkMatrix4 world;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const IkJoint& joint = joints[i];
        world = world * ik_move(joint.offset);
        const Vec3d slide = {
            joint.axis[0] * theta[i], joint.axis[1] * theta[i], joint.axis[2] * theta[i]};
        world = world * (joint.slides ? ik_move(slide) : ik_turn(joint.axis, theta[i]));
    }
    world = world * ik_move(end);
    return {world.m[0][3], world.m[1][3], world.m[2][3]};
}

/// Column of the Jacobian by central differences.
inline Vec3d ik_column(
    const std::vector<IkJoint>& joints, std::vector<double> theta, const Vec3d& end,
    std::size_t column) {
    constexpr double kStep = 1e-5;
    theta[column] += kStep;
    const Vec3d after = ik_tip(joints, theta, end);
    theta[column] -= 2 * kStep;
    const Vec3d before = ik_tip(joints, theta, end);
    const Vec3d twice = minus(after, before);
    return {twice[0] / (2 * kStep), twice[1] / (2 * kStep), twice[2] / (2 * kStep)};
}

/// Least distance between the tip of two planar links and (x, y), over a grid of angles that is
/// refined around the best.
inline double two_link_distance(double x, double y, double l1, double l2) {
    constexpr double kTurn = 6.283185307179586;
    double best_first = 0;
    double best_second = 0;
    double least = std::numeric_limits<double>::max();
    double range = kTurn / 2;
    for (int level = 0; level < 14; ++level) {
        const double center_first = best_first;
        const double center_second = best_second;
        for (int i = -24; i <= 24; ++i) {
            for (int j = -24; j <= 24; ++j) {
                const double first = center_first + range * i / 24;
                const double second = center_second + range * j / 24;
                const double dx = l1 * std::cos(first) + l2 * std::cos(first + second) - x;
                const double dy = l1 * std::sin(first) + l2 * std::sin(first + second) - y;
                const double distance = std::hypot(dx, dy);
                if (distance < least) {
                    least = distance;
                    best_first = first;
                    best_second = second;
                }
            }
        }
        range /= 4;
    }
    return least;
}

}  // namespace limn::oracle
