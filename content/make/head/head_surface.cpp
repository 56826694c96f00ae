#include "content/make/head/head_surface.h"

#include "content/make/head/head_clay.h"
#include "content/make/head/head_shoulders.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

constexpr std::array<Solid, 7> kBase = {{
    // cranium, and the forehead in front of it
    {{0, 6.41f, 0.28f}, {0, 6.41f, 0.28f}, {7.86f, 8.16f, 10.02f}, {7.86f, 8.16f, 10.02f}, 0.1f},
    {{0, 5.29f, 2.99f}, {0, 5.29f, 2.99f}, {6.83f, 4.95f, 7.48f}, {6.83f, 4.95f, 7.48f}, 1.5f},
    // base of the skull, from ear to ear
    {{0, 2.28f, 0.17f}, {0, 2.28f, 0.17f}, {7.94f, 6.4f, 8.71f}, {7.94f, 6.4f, 8.71f}, 1.5f},
    // midface, from cheekbone to cheekbone
    {{0, -1.47f, 4.97f}, {0, -1.47f, 4.97f}, {7.01f, 5.65f, 5.15f}, {7.01f, 5.65f, 5.15f}, 1.5f},
    // upper jaw and lower jaw
    {{0, -2.69f, 4.82f}, {0, -3.93f, 4.91f}, {4.24f, 2.53f, 7.07f}, {4.8f, 4.69f, 6.56f}, 1.5f},
    // branch of the jaw, from below the ear to the chin
    {{5.6f, -3.05f, 2}, {0.62f, -7.08f, 9.15f}, {0.36f, 1.82f, 2.08f}, {1.56f, 0.49f, 1.16f}, 1.8f},
    // neck
    {{0, -3.54f, 0.02f}, {0, -16.92f, -2.26f}, {4.94f, 4.99f, 5.85f}, {6.96f, 4.95f, 5.07f}, 1.6f},
}};

constexpr std::array<Solid, 7> kFeatures = {{
    // socket, carved, and the ball with its lids
    {{2.7f, 4.03f, 10.56f},
     {3.48f, 3.41f, 10.49f},
     {1.58f, 1.22f, 1.42f},
     {1.38f, 0.87f, 1.6f},
     -1.1f},
    {kEyeCenter, kEyeCenter, Vec3(kEyeRadius + kLidThickness), Vec3(kEyeRadius + kLidThickness),
     0.55f},
    // bridge, tip and wing of the nose, and the column between the nostrils
    {{0, 3.85f, 9.12f}, {0, 1.53f, 10.89f}, {0.58f, 1.01f, 1.09f}, {1.13f, 0.87f, 1.25f}, 1.2f},
    {{0, 0.24f, 12.12f}, {0, 0.6f, 11.84f}, {1.12f, 0.96f, 0.95f}, {1.08f, 0.87f, 0.91f}, 0.7f},
    {{1.52f, -0.01f, 10.8f},
     {1.29f, 0.08f, 11.33f},
     {0.24f, 0.86f, 0.83f},
     {0.38f, 0.62f, 0.76f},
     0.6f},
    {{0, -0.48f, 11.56f}, {0, -0.9f, 10.97f}, {0.24f, 0.37f, 0.45f}, {1.02f, 0.75f, 0.72f}, 0.6f},
    // chin
    {{0, -6.25f, 9.31f}, {0.65f, -6.15f, 8.9f}, {1.11f, 1.04f, 1.21f}, {0.98f, 0.96f, 0.98f}, 1.2f},
}};

/// The fold of the upper lid, as a quadratic Bezier curve.
constexpr std::array<Vec3, 3> kLidCrease = {
    {{1.85f, 3.9f, 9.1f}, {3.05f, 5.1f, 9.6f}, {4.65f, 3.85f, 8.5f}}};

constexpr std::array<Stroke, 32> kSurfaceStrokes = {{
    // Brow ridge, glabella, temple, frontal eminence.
    {{1.07f, 5.26f, 9.77f}, {3.49f, 5.9f, 9.85f}, {5.46f, 4.62f, 8.08f}, 1.11f, 0.48f, 0.12f},
    {{0, 5.21f, 10.06f}, {0.4f, 5.3f, 10.11f}, {0.83f, 5.17f, 10.09f}, 0.87f, -0.21f, 0.1f},
    {{6.89f, 5.97f, 4.42f},
     {6.89f, 4.81f, 4.82f},
     {6.9f, 4.19f, 4.41f},
     2.22f,
     -0.19f,
     0,
     0.2f,
     -0.1f},
    {{2.83f, 9.05f, 8.96f}, {3, 9, 9}, {3.24f, 8.97f, 8.88f}, 2.23f, 0.17f, -0.1f},
    // Cheekbone, its arch to the ear, the hollow below, the fat of the cheek.
    {{3.69f, 0.95f, 8.75f}, {5.27f, 1.07f, 8.4f}, {6.13f, 1.96f, 5.91f}, 1.78f, 0.72f, 0, 0, -0.1f},
    {{6.34f, 1.71f, 5.82f}, {6.99f, 2, 4}, {7.2f, 2, 2}, 0.94f, -0.08f, 0.05f},
    {{5.42f, -1.73f, 6.65f},
     {5.72f, -2.04f, 6.03f},
     {5.74f, -2.11f, 4.75f},
     1.46f,
     -0.48f,
     0,
     0.45f,
     -0.2f},
    {{2.97f, -0.36f, 9.15f},
     {3.35f, -0.77f, 9},
     {3.62f, -1.48f, 8.75f},
     1.41f,
     0.25f,
     -0.04f,
     0.2f},
    // Angle and edge of the jaw.
    {{6, -3.6f, 1.2f}, {5.7f, -4.6f, 2.2f}, {5.1f, -5.21f, 3.8f}, 1, -0.01f, 0.2f, 0.15f},
    {{5.1f, -5.2f, 3.8f}, {3.9f, -6.4f, 6.4f}, {1.9f, -7, 8.7f}, 0.7f, -0.01f, 0.08f, -0.05f},
    // Below the eye: trough, bag.
    {{1.52f, 2.53f, 9.35f},
     {2.49f, 1.67f, 9.27f},
     {3.79f, 1.66f, 8.96f},
     0.49f,
     -0.16f,
     0,
     0.05f,
     -0.2f},
    {{2.2f, 2.35f, 9.28f},
     {3.1f, 2.05f, 9.3f},
     {4.01f, 2.41f, 8.91f},
     0.4f,
     -0.02f,
     0,
     0.02f,
     0.2f},
    // Fold of the upper lid; the flesh above it.
    {kLidCrease[0], kLidCrease[1], kLidCrease[2], 0.15f, -0.15f},
    {{2.29f, 4.52f, 9.5f},
     {3.41f, 4.83f, 9.39f},
     {4.76f, 4.53f, 8.55f},
     0.52f,
     0.25f,
     0.05f,
     0.05f,
     0.25f},
    // Inner corner of the eye, side of the nose.
    {{1.39f, 3.33f, 9.28f}, {1.49f, 3.18f, 9.21f}, {1.64f, 3.16f, 9.15f}, 0.44f, -0.22f},
    {{1.13f, 2.49f, 9.66f}, {1.45f, 1.82f, 9.69f}, {1.83f, 1.01f, 9.65f}, 0.67f, 0.17f},
    // Root of the nose, its back.
    {{0, 4, 9.77f}, {0, 3.91f, 9.78f}, {0.48f, 3.8f, 9.74f}, 0.83f, -0.37f, 0.02f},
    {{0, 2.31f, 10.51f}, {0, 2.1f, 10.6f}, {0, 1.9f, 10.7f}, 0.6f, 0.06f, 0.07f, 0, 0.1f},
    // Groove around the wing, dimple in front of it.
    {{1.3f, 0.95f, 11.3f}, {1.95f, 0.75f, 10.6f}, {1.85f, -0.5f, 10.75f}, 0.22f, -0.13f},
    {{0.5f, 0.95f, 11.5f}, {0.74f, 0.6f, 11.2f}, {0.85f, 0.44f, 11}, 0.3f, -0.04f},
    // Nasolabial fold, and the roll beside it.
    {{1.85f, -0.1f, 9.7f},
     {2.6f, -1, 9.4f},
     {3.05f, -2.8f, 8.8f},
     0.38f,
     -0.08f,
     0,
     -0.04f,
     -0.35f},
    {{2.38f, 0.02f, 9.52f},
     {3.1f, -1, 9.19f},
     {3.61f, -2.61f, 8.61f},
     0.61f,
     0.13f,
     0,
     0.08f,
     0.3f},
    // Muzzle: skin above the lip over the teeth.
    {{0, -1.91f, 10.19f}, {1, -2.11f, 10}, {1.9f, -2.41f, 9.51f}, 0.92f, 0.01f},
    // Philtrum: its ridges and its groove.
    {{0.42f, -0.95f, 10.3f}, {0.45f, -1.6f, 10.4f}, {0.52f, -2.35f, 10.6f}, 0.2f, 0.07f},
    {{0, -0.9f, 10.3f}, {0, -1.6f, 10.4f}, {0, -2.3f, 10.6f}, 0.24f, -0.06f},
    // Upper lip: tubercle, wing to the corner. Lower lip: the two pillows.
    {{0, -2.92f, 10.6f},
     {1.1f, -2.65f, 10.6f},
     {2.4f, -3.2f, 9.3f},
     0.42f,
     0.23f,
     -0.03f,
     0.03f,
     -0.25f},
    {{0, -2.95f, 10.6f}, {0.05f, -2.9f, 10.6f}, {0.1f, -2.9f, 10.6f}, 0.3f, 0.08f},
    {{0, -3.75f, 10.36f},
     {0.94f, -3.91f, 10.27f},
     {2.12f, -3.39f, 9.28f},
     0.29f,
     -0.05f,
     -0.04f,
     0.03f,
     -0.25f},
    // Corner of the mouth; groove above the chin.
    {{2.5f, -3.2f, 9.31f}, {2.6f, -3.25f, 9.2f}, {2.8f, -3.35f, 9}, 0.45f, -0.07f, 0, 0, -0.1f},
    {{0, -4.91f, 10.1f}, {0.95f, -4.88f, 9.92f}, {1.73f, -3.86f, 9.74f}, 0.86f, -0.79f},
    // Throat, and the sternocleidomastoid from behind the ear to the breastbone.
    {{0, -9.91f, 4.19f}, {0, -10.51f, 3.51f}, {0, -10.97f, 3.35f}, 1.57f, 0.86f, 0.18f},
    {{6, -3.47f, -1.75f},
     {4.95f, -7.97f, 0.89f},
     {1.38f, -14.99f, 2.58f},
     1,
     0.37f,
     0.06f,
     -0.2f,
     0.1f},
}};

const std::vector<StrokePath>& head_paths() {
    static const std::vector<StrokePath> paths = make_stroke_paths(kSurfaceStrokes);
    return paths;
}

/// One point as a Vec3.
Vec3 one_of(const PointOf<float>& p, int /*index*/) {
    return {p.x, p.y, p.z};
}
Vec3 one_of(const PointOf<Four>& p, int index) {
    return {p.x[index], p.y[index], p.z[index]};
}
void set_one(PointOf<float>& p, int /*index*/, const Vec3& one) {
    p = {one.x, one.y, one.z};
}
void set_one(PointOf<Four>& p, int index, const Vec3& one) {
    p.x[index] = one.x;
    p.y[index] = one.y;
    p.z[index] = one.z;
}

/// How much of `p` is neck: 0 above the line from the angle of the jaw to the chin, 1 some
/// centimeters below it, and with shoulders 0 again where they begin.
float on_neck(const Vec3& p, const HeadShape& shape) {
    const float below_jaw = -0.905f * (p.y + 4.6f) - 0.425f * (p.z - 2.2f);
    const float ends = shape.shoulders ? glm::smoothstep(-12.0f, -16.5f, p.y) : 0.0f;
    return glm::smoothstep(0.0f, 3.0f, below_jaw) * (1 - ends);
}

/// Maps `p` to a neutral head. Women's faces are smaller below the brow, increasingly downwards,
/// their necks slender; heavy ones are broader.
Vec3 to_neutral_head(const Vec3& point, const HeadShape& shape) {
    constexpr float kNeckAxis = -1.8f;  // z [cm]
    const float low = glm::smoothstep(6.0f, -7.0f, point.y);
    const float neck = on_neck(point, shape);
    Vec3 p = {std::abs(point.x), point.y, point.z};
    p.x /= 1 + 0.03f * shape.sex * low + 0.05f * shape.build * low;
    p.x /= 1 + (shape.sex > 0 ? 0.035f : 0.06f) * shape.sex * neck;
    p.z -= (p.z - kNeckAxis) * (1 - 1 / (1 + 0.1f * shape.sex * neck));
    p.y /= 1 + 0.025f * shape.sex * low;
    return shape.shoulders ? to_neutral_shoulders(p, shape) : p;
}

/// Number: float for one point, or Four for four points.
template <typename Number>
Number distance_of(PointOf<Number> p, const HeadShape& shape, float detail) {
    for (int i = 0; i < static_cast<int>(sizeof(Number) / sizeof(float)); ++i) {
        set_one(p, i, to_neutral_head(one_of(p, i), shape));
    }
    Number distance = join<Number>(same_for_all<Number>(1e6f), kBase, p);
    if (shape.shoulders) {
        distance = join_shoulders(distance, p);
    }
    const Number base = distance;
    if (detail == 0) {
        return base;
    }
    distance = join<Number>(distance, kFeatures, p)
               - relief<Number>(kSurfaceStrokes, head_paths(), p, shape);
    if (shape.shoulders) {
        distance -= shoulder_relief(p, shape);
    }
    return base * (1 - detail) + distance * detail;
}

struct DistanceAndGradient {
    float distance;
    Vec3 gradient;
};

/// By finite differences from `p`.
DistanceAndGradient distance_and_gradient(const Vec3& p, const HeadShape& shape, float detail) {
    constexpr float kStep = 0.01f;
    const PointOf<Four> points = {
        p.x + kStep * Four{0, 1, 0, 0}, p.y + kStep * Four{0, 0, 1, 0},
        p.z + kStep * Four{0, 0, 0, 1}};
    const Four distances = distance_of(points, shape, detail);
    const Four slopes = (distances - distances[0]) / kStep;
    return {distances[0], {slopes[1], slopes[2], slopes[3]}};
}

/// Moves one point or four along z to the foremost point of the surface.
template <typename Number>
void step_forwards(PointOf<Number>& p, const HeadShape& shape, float detail) {
    p.z = same_for_all<Number>(13);
    for (int i = 0; i < 30; ++i) {
        const Number before = p.z;
        p.z -= 0.6f * distance_of(p, shape, detail);
        if (!any_of(p.z != before)) {
            break;  // converged
        }
    }
}

}  // namespace

float head_distance(const Vec3& p, const HeadShape& shape, float detail) {
    return distance_of(PointOf<float>{p.x, p.y, p.z}, shape, detail);
}

Vec3 head_gradient(const Vec3& p, const HeadShape& shape, float detail) {
    return distance_and_gradient(p, shape, detail).gradient;
}

Vec3 project_to_head(Vec3 p, const HeadShape& shape, float detail, int steps) {
    auto [distance, gradient] = distance_and_gradient(p, shape, detail);
    const float slope2 = std::max(glm::dot(gradient, gradient), 0.15f);
    for (int i = 0; i < steps; ++i) {
        distance = i == 0 ? distance : head_distance(p, shape, detail);
        p -= glm::clamp(distance / slope2, -0.5f, 0.5f) * gradient;
    }
    return p;
}

Vec3 project_forwards(const Vec3& p, const HeadShape& shape, float detail) {
    Vec3 projected = p;
    project_forwards({&projected, 1}, shape, detail);
    return projected;
}

void project_forwards(std::span<Vec3> points, const HeadShape& shape, float detail) {
    for (; points.size() > 1; points = points.subspan(std::min<std::size_t>(points.size(), 4))) {
        const int count = static_cast<int>(std::min<std::size_t>(points.size(), 4));
        PointOf<Four> four;
        for (int i = 0; i < 4; ++i) {
            set_one(four, i, points[static_cast<std::size_t>(std::min(i, count - 1))]);
        }
        step_forwards(four, shape, detail);
        for (int i = 0; i < count; ++i) {
            points[static_cast<std::size_t>(i)] = one_of(four, i);
        }
    }
    if (!points.empty()) {
        PointOf<float> one = {points[0].x, points[0].y, points[0].z};
        step_forwards(one, shape, detail);
        points[0] = one_of(one, 0);
    }
}

Vec3 lid_margin(float angle) {
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    // The outer corner is higher; the upper lid is highest medially, the lower lid lowest
    // laterally.
    const float x = 1.36f * c;
    const float shift = s > 0 ? -0.12f : 0.12f;
    const float skew = std::pow(std::max(0.0f, 1 - square(c)), 0.72f) * (1 + shift * c);
    const float y = 0.08f * c - 0.02f + (s > 0 ? 0.50f : -0.46f) * skew;
    const float radius = kEyeRadius + kLidThickness * 0.9f;
    // Corners beyond the ball continue in front of it.
    const float depth = std::sqrt(std::max(square(radius) - x * x - y * y, 0.0f));
    const float inner = 0.35f * glm::smoothstep(-0.75f, -1.0f, c);
    return kEyeCenter + Vec3(x, y, std::max(depth, 0.45f) + inner);
}

float lid_crease(float x) {
    const Vec3& a = kLidCrease[0];
    const Vec3& b = kLidCrease[1];
    const Vec3& c = kLidCrease[2];
    const float bend = a.x - 2 * b.x + c.x;
    const float half = b.x - a.x;
    const float root = std::sqrt(std::max(square(half) - bend * (a.x - x), 0.0f));
    const float t = glm::clamp((root - half) / bend, 0.0f, 1.0f);
    return glm::mix(glm::mix(a.y, b.y, t), glm::mix(b.y, c.y, t), t);
}

Vec3 nostril_rim(float angle) {
    // An oval that points to the tip, wider at the back; its outer side is higher.
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    const float width = 1 - 0.22f * s;
    return Vec3(0.73f, -0.6f, 11.95f) + width * c * Vec3(0.38f, 0.09f, -0.12f)
           + s * Vec3(-0.2f, 0.08f, 0.48f);
}

float across_mouth(float angle) {
    return 1 - 2 / kPi * std::abs(std::remainder(angle, 2 * kPi));
}

Vec3 lip_line(float angle) {
    const float c = across_mouth(angle);
    const float bow = 0.07f * std::cos(3 * kPi * c * 0.5f) * (1 - c * c);  // dips at the center
    // The lips touch, but no vertex of one has the position, and so the normal, of one of the
    // other.
    constexpr float kApart = 2e-4f;  // [cm]
    const float apart = std::sin(angle) < -1e-3f ? kApart : 0.0f;
    const float y = -3.32f - 0.16f * square(c) * square(c) - bow - apart;
    return {2.5f * c, y, 11.1f - 0.95f * std::pow(std::abs(c), 2.2f)};
}

float lip_height(float angle) {
    const float c = across_mouth(angle);
    if (std::sin(angle) < 0) {
        return 0.95f * std::pow(1 - square(c), 0.85f);
    }
    constexpr float kRound = 0.06f;
    const float off = std::max(std::sqrt(square(c) + square(kRound)) - kRound, 0.0f);
    const float bow = 0.19f * std::exp(-square(c / 0.16f));  // between the peaks
    return 0.92f
               * std::pow(std::max(1 - off / (std::sqrt(1 + square(kRound)) - kRound), 0.0f), 0.72f)
           - bow;
}

}  // namespace limn
