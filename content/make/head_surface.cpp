#include "content/make/head_surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

/// An ellipsoid swept from `a` to `b`, with radii that change from `ra` to `rb`.
struct Solid {
    Vec3 a, b;
    Vec3 ra, rb;
    float blend;  ///< width of the transition to the solids before [cm]; < 0: carved out
};

/// A quadratic Bezier curve of clay.
struct Stroke {
    Vec3 a, b, c;
    float radius;
    float amount;     ///< height on the surface [cm]; < 0: a groove
    float sex = 0;    ///< added to `amount` times HeadShape::sex ...
    float build = 0;  ///< ... build ...
    float age = 0;    ///< ... and age - 0.3
};

constexpr std::array<Solid, 7> kBase = {{
    // cranium, and the forehead before it
    {{0, 7.0f, 0.2f}, {0, 7.0f, 0.2f}, {7.75f, 8.3f, 9.6f}, {7.75f, 8.3f, 9.6f}, 0.1f},
    {{0, 7.2f, 2.6f}, {0, 7.2f, 2.6f}, {6.4f, 5.6f, 7.5f}, {6.4f, 5.6f, 7.5f}, 1.5f},
    // base of the skull, from ear to ear
    {{0, 2.3f, -0.8f}, {0, 2.3f, -0.8f}, {6.9f, 6.0f, 7.9f}, {6.9f, 6.0f, 7.9f}, 1.5f},
    // middle of the face, from cheekbone to cheekbone
    {{0, 1.6f, 3.3f}, {0, 1.6f, 3.3f}, {6.6f, 5.6f, 6.5f}, {6.6f, 5.6f, 6.5f}, 1.5f},
    // upper jaw and lower jaw
    {{0, -2.4f, 4.2f}, {0, -4.4f, 4.3f}, {5.1f, 3.6f, 6.0f}, {4.3f, 3.0f, 5.55f}, 1.5f},
    // branch of the jaw, from below the ear to the chin
    {{5.1f, -2.4f, 1.6f}, {1.1f, -6.1f, 8.7f}, {1.25f, 1.8f, 1.5f}, {1.3f, 1.2f, 1.15f}, 1.8f},
    // neck
    {{0, -3, -2.0f}, {0, -17, -3.4f}, {5.4f, 5, 5.5f}, {5.8f, 5, 5.7f}, 1.6f},
}};

constexpr std::array<Solid, 7> kFeatures = {{
    // socket, carved, and the ball with its lids
    {{2.9f, 3.75f, 10.5f}, {3.6f, 3.6f, 10.3f}, {1.35f, 1.0f, 1.5f}, {1.4f, 1.0f, 1.7f}, -1.1f},
    {kEyeCenter, kEyeCenter, Vec3(kEyeRadius + kLidThickness), Vec3(kEyeRadius + kLidThickness),
     0.55f},
    // bridge, tip and wing of the nose, and the column between the nostrils
    {{0, 3.6f, 8.7f}, {0, 0.75f, 10.6f}, {0.75f, 0.9f, 1.0f}, {0.78f, 0.9f, 1.15f}, 1.2f},
    {{0, 0.35f, 11.35f}, {0, 0.4f, 11.35f}, {0.92f, 0.82f, 0.92f}, {0.92f, 0.82f, 0.92f}, 0.7f},
    {{1.12f, 0.15f, 10.25f},
     {0.95f, 0.1f, 10.8f},
     {0.62f, 0.72f, 0.75f},
     {0.6f, 0.6f, 0.6f},
     0.35f},
    {{0, -0.2f, 11.4f}, {0, -0.75f, 10.1f}, {0.36f, 0.36f, 0.4f}, {0.42f, 0.4f, 0.5f}, 0.6f},
    // chin
    {{0, -6.1f, 9.1f}, {0.7f, -6.15f, 8.95f}, {1.1f, 1.0f, 1.1f}, {1.0f, 0.95f, 1.0f}, 1.2f},
}};

constexpr std::array<Stroke, 33> kStrokes = {{
    // Brow ridge, glabella, temple, frontal eminence.
    {{1.0f, 5.15f, 9.9f}, {3.3f, 5.75f, 9.6f}, {5.4f, 4.7f, 7.6f}, 0.85f, 0.18f, 0.12f},
    {{0, 5.2f, 10.1f}, {0.4f, 5.3f, 10.1f}, {0.8f, 5.2f, 10}, 0.8f, 0.08f, 0.1f},
    {{6.9f, 6.0f, 4.4f}, {6.9f, 4.8f, 4.8f}, {6.9f, 4.2f, 4.4f}, 1.9f, -0.35f, 0, 0.2f, -0.1f},
    {{2.8f, 9, 9.0f}, {3, 9, 9}, {3.2f, 9, 8.9f}, 2.0f, 0.12f, -0.1f},
    // Cheekbone, its arch to the ear, the hollow below, the fat of the cheek.
    {{3.6f, 1.1f, 8.8f}, {5.0f, 1.3f, 8.2f}, {6.3f, 1.7f, 5.8f}, 1.2f, 0.33f, 0, 0, -0.1f},
    {{6.3f, 1.7f, 5.8f}, {7.0f, 2.0f, 4}, {7.2f, 2, 2}, 0.9f, 0.22f, 0.05f},
    {{5.4f, -1.6f, 6.8f}, {5.6f, -2, 6}, {5.8f, -2.2f, 4.6f}, 1.5f, -0.3f, 0, 0.45f, -0.2f},
    {{3.0f, -0.3f, 9.2f}, {3.3f, -0.8f, 9}, {3.5f, -1.4f, 8.7f}, 1.2f, 0.16f, -0.04f, 0.2f},
    // Angle and edge of the jaw.
    {{6.0f, -3.6f, 1.2f}, {5.7f, -4.6f, 2.2f}, {5.1f, -5.2f, 3.8f}, 1.0f, 0.15f, 0.2f, 0.15f},
    {{5.1f, -5.2f, 3.8f}, {3.9f, -6.4f, 6.4f}, {1.9f, -7.0f, 8.7f}, 0.7f, 0.12f, 0.08f, -0.05f},
    // Below the eye: trough, bag.
    {{1.6f, 2.5f, 9.3f}, {2.5f, 1.7f, 9.3f}, {3.8f, 1.7f, 8.9f}, 0.45f, -0.10f, 0, 0.05f, -0.2f},
    {{2.2f, 2.35f, 9.3f}, {3.1f, 2.05f, 9.3f}, {4.0f, 2.4f, 8.9f}, 0.4f, 0.03f, 0, 0.02f, 0.2f},
    // Fold of the upper lid; the flesh above it.
    {{1.85f, 3.9f, 9.1f}, {3.05f, 5.1f, 9.6f}, {4.65f, 3.85f, 8.5f}, 0.13f, -0.13f},
    {{2.3f, 4.75f, 9.5f},
     {3.4f, 5.0f, 9.4f},
     {4.7f, 4.4f, 8.5f},
     0.42f,
     0.14f,
     0.05f,
     0.05f,
     0.25f},
    // Inner corner of the eye, side of the nose.
    {{1.45f, 3.35f, 9.2f}, {1.5f, 3.2f, 9.2f}, {1.6f, 3.1f, 9.2f}, 0.4f, -0.15f},
    {{1.15f, 2.6f, 9.7f}, {1.4f, 1.8f, 9.6f}, {1.75f, 1.0f, 9.5f}, 0.6f, -0.12f},
    // Root of the nose, its back.
    {{0, 4.0f, 9.8f}, {0, 3.9f, 9.8f}, {0.3f, 3.9f, 9.7f}, 0.7f, -0.14f, 0.02f},
    {{0, 2.3f, 10.5f}, {0, 2.1f, 10.6f}, {0, 1.9f, 10.7f}, 0.6f, 0.05f, 0.07f, 0, 0.1f},
    // Groove around the wing, nostril, its edge.
    {{1.3f, 0.95f, 10.55f}, {1.95f, 0.7f, 9.9f}, {1.75f, -0.5f, 9.8f}, 0.22f, -0.07f},
    {{0.52f, -0.42f, 10.95f}, {0.68f, -0.45f, 10.6f}, {0.78f, -0.45f, 10.25f}, 0.20f, -0.28f},
    {{0.5f, 0.95f, 11.5f}, {0.75f, 0.6f, 11.2f}, {0.85f, 0.45f, 11}, 0.3f, -0.03f},
    // Nasolabial fold, and the roll beside it.
    {{1.85f, -0.1f, 9.7f},
     {2.6f, -1.0f, 9.4f},
     {3.05f, -2.8f, 8.8f},
     0.38f,
     -0.08f,
     0,
     -0.04f,
     -0.35f},
    {{2.4f, 0.0f, 9.5f}, {3.1f, -1.0f, 9.2f}, {3.6f, -2.6f, 8.6f}, 0.6f, 0.06f, 0, 0.08f, 0.3f},
    // Muzzle: skin above the lip over the teeth.
    {{0, -1.9f, 10.2f}, {1.0f, -2.1f, 10}, {1.9f, -2.4f, 9.5f}, 0.9f, 0.14f},
    // Philtrum: its ridges and its groove.
    {{0.42f, -0.95f, 10.3f}, {0.45f, -1.6f, 10.4f}, {0.52f, -2.35f, 10.6f}, 0.2f, 0.07f},
    {{0, -0.9f, 10.3f}, {0, -1.6f, 10.4f}, {0, -2.3f, 10.6f}, 0.24f, -0.06f},
    // Upper lip: tubercle, wing to the corner. Lower lip: the two pillows.
    {{0, -2.92f, 10.6f},
     {1.1f, -2.65f, 10.6f},
     {2.4f, -3.2f, 9.3f},
     0.42f,
     0.24f,
     -0.03f,
     0.03f,
     -0.25f},
    {{0, -2.95f, 10.6f}, {0.05f, -2.9f, 10.6f}, {0.1f, -2.9f, 10.6f}, 0.3f, 0.08f},
    {{0, -3.68f, 10.5f},
     {1.0f, -3.85f, 10.4f},
     {2.2f, -3.35f, 9.4f},
     0.46f,
     0.25f,
     -0.04f,
     0.03f,
     -0.25f},
    // Corner of the mouth; groove above the chin.
    {{2.5f, -3.2f, 9.3f}, {2.6f, -3.25f, 9.2f}, {2.8f, -3.35f, 9}, 0.45f, -0.06f, 0, 0, -0.1f},
    {{0, -4.85f, 10}, {0.9f, -4.8f, 9.9f}, {1.9f, -4.35f, 9.3f}, 0.5f, -0.26f},
    // Throat, and the muscle from behind the ear to the breastbone.
    {{0, -10.0f, 3.6f}, {0, -10.5f, 3.5f}, {0, -11, 3.4f}, 1.0f, 0.08f, 0.18f},
    {{6.0f, -3.5f, -1.8f}, {4.9f, -8.0f, 0.8f}, {1.4f, -15, 2.6f}, 1.0f, 0.3f, 0.06f, -0.2f, 0.1f},
}};

/// Scaled so that its gradient is about 1 near the surface.
float solid_distance(const Solid& solid, const Vec3& p) {
    const Vec3 along = solid.b - solid.a;
    const float length2 = glm::dot(along, along);
    const float t =
        length2 > 0 ? glm::clamp(glm::dot(p - solid.a, along) / length2, 0.0f, 1.0f) : 0.0f;
    const Vec3 radii = glm::mix(solid.ra, solid.rb, t);
    const Vec3 q = p - solid.a - t * along;
    const float k0 = glm::length(q / radii);
    const float k1 = glm::length(q / (radii * radii));
    return k1 > 1e-6f ? k0 * (k0 - 1) / k1 : -std::min({radii.x, radii.y, radii.z});
}

/// Smooth minimum that begins to blend where the distances differ by `width`.
float blend_min(float a, float b, float width) {
    const float h = std::max(width - std::abs(a - b), 0.0f) / width;
    return std::min(a, b) - h * h * width * 0.25f;
}

float join(float distance, const Solid& solid, const Vec3& p) {
    const float other = solid_distance(solid, p);
    return solid.blend > 0 ? blend_min(distance, other, solid.blend)
                           : -blend_min(-distance, other, -solid.blend);
}

constexpr float kFar = 100;  // [cm]

/// Whether a stroke counts at `p`: exp(-9) of it does not.
bool reaches(const Stroke& stroke, const Vec3& p) {
    const Vec3 low = glm::min(stroke.a, glm::min(stroke.b, stroke.c)) - 3 * stroke.radius;
    const Vec3 high = glm::max(stroke.a, glm::max(stroke.b, stroke.c)) + 3 * stroke.radius;
    return p.x > low.x && p.y > low.y && p.z > low.z && p.x < high.x && p.y < high.y
           && p.z < high.z;
}

/// To the curve, by its nearest of a few chords [cm].
float stroke_distance(const Stroke& stroke, const Vec3& p) {
    constexpr int kChords = 6;
    float nearest2 = kFar * kFar;
    Vec3 from = stroke.a;
    for (int i = 1; i <= kChords; ++i) {
        const float t = static_cast<float>(i) / kChords;
        const Vec3 to =
            glm::mix(glm::mix(stroke.a, stroke.b, t), glm::mix(stroke.b, stroke.c, t), t);
        const Vec3 chord = to - from;
        const float s = glm::clamp(glm::dot(p - from, chord) / glm::dot(chord, chord), 0.0f, 1.0f);
        const Vec3 offset = p - from - s * chord;
        nearest2 = std::min(nearest2, glm::dot(offset, offset));
        from = to;
    }
    return std::sqrt(nearest2);
}

}  // namespace

float head_distance(const Vec3& point, const HeadShape& shape, float detail) {
    // Women's faces are smaller below the brow, more so the lower; heavy ones broader.
    const float low = glm::smoothstep(6.0f, -7.0f, point.y);
    Vec3 p = {std::abs(point.x), point.y, point.z};
    p.x /= 1 + 0.03f * shape.sex * low + 0.05f * shape.build * low;
    p.y /= 1 + 0.025f * shape.sex * low;
    float distance = 1e6f;
    for (const Solid& solid : kBase) {
        distance = join(distance, solid, p);
    }
    const float base = distance;
    if (detail == 0) {
        return base;
    }
    for (const Solid& solid : kFeatures) {
        distance = join(distance, solid, p);
    }
    for (const Stroke& stroke : kStrokes) {
        if (!reaches(stroke, p)) {
            continue;
        }
        const float amount = stroke.amount + stroke.sex * shape.sex + stroke.build * shape.build
                             + stroke.age * (shape.age - 0.3f);
        distance -= amount * std::exp(-square(stroke_distance(stroke, p) / stroke.radius));
    }
    return glm::mix(base, distance, detail);
}

Vec3 project_to_head(Vec3 p, const HeadShape& shape, float detail) {
    constexpr float kStep = 0.01f;
    for (int i = 0; i < 3; ++i) {
        const float distance = head_distance(p, shape, detail);
        const auto slope = [&](const Vec3& axis) {
            return (head_distance(p + kStep * axis, shape, detail) - distance) / kStep;
        };
        const Vec3 gradient = {slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
        const float slope2 = std::max(glm::dot(gradient, gradient), 0.15f);
        p -= glm::clamp(distance / slope2, -0.5f, 0.5f) * gradient;
    }
    return p;
}

Vec3 project_forwards(Vec3 p, const HeadShape& shape, float detail) {
    p.z = 13;
    for (int i = 0; i < 30; ++i) {
        p.z -= 0.6f * head_distance(p, shape, detail);
    }
    return p;
}

Vec3 lid_margin(float angle) {
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    // The outer corner lies higher; the upper lid is highest inwards, the lower lowest outwards of
    // the middle.
    const float x = 1.36f * c;
    const float shift = s > 0 ? -0.12f : 0.12f;
    const float skew = std::pow(std::max(0.0f, 1 - square(c)), 0.72f) * (1 + shift * c);
    const float y = 0.08f * c - 0.02f + (s > 0 ? 0.50f : -0.46f) * skew;
    const float reach = kEyeRadius + kLidThickness * 0.9f;
    // Beyond the ball, corners run on forward of it.
    const float depth = std::sqrt(std::max(square(reach) - x * x - y * y, 0.0f));
    const float inner = 0.35f * glm::smoothstep(-0.75f, -1.0f, c);
    return kEyeCenter + Vec3(x, y, std::max(depth, 0.45f) + inner);
}

Vec3 lip_line(float angle) {
    const float c = std::cos(angle);
    const float bow = 0.07f * std::cos(3 * kPi * c * 0.5f) * (1 - c * c);  // dips in the middle
    const float y = -3.3f - bow + 0.02f * std::sin(angle);
    return {2.5f * c, y, 10.35f - 1.25f * std::pow(std::abs(c), 2.2f)};
}

}  // namespace limn
