#include "content/make/head/head_parts.h"
#include "content/make/head/head_surface.h"
#include "ecs/base/rng.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace limn {

namespace {

// An eye of 24 mm, scaled to kBallRadius: P. Riordan-Eva and J. Augsburger, "Vaughan & Asbury's
// General Ophthalmology" (2018): a cornea of 11.7 mm whose apex stands 1.1 mm proud, an iris 3 mm
// behind it.
constexpr float kLimbus = 0.61f;  ///< radius of the cornea's border [cm]
constexpr float kApex = 1.385f;   ///< of the cornea, from the center
constexpr float kPupil = 0.185f;  ///< radius
constexpr float kIrisDepth = 0.31f;
constexpr std::uint32_t kSegments = 72;

struct Ring {
    float radius, z;  ///< around the axis, along it [cm]
};

/// Value noise along a circle, 0 .. 1: `count` values around.
float fibers(float angle, int count, std::uint32_t seed) {
    const float at = angle / (2 * kPi) * static_cast<float>(count);
    const int first = static_cast<int>(std::floor(at));
    const auto value = [&](int i) {
        const auto k = static_cast<std::uint32_t>((i + count) % count);
        return Random(seed, k, name_hash("iris"), 0).uniform();
    };
    return glm::mix(
        value(first), value(first + 1), glm::smoothstep(0.0f, 1.0f, at - std::floor(at)));
}

Vec3 iris_tint(float radius, float angle) {
    if (radius < kPupil) {
        return Vec3(0.004f);
    }
    const float t = glm::clamp((radius - kPupil) / (kLimbus - kPupil), 0.0f, 1.0f);
    const float fine = fibers(angle, 72, 1);
    const float broad = fibers(angle, 19, 2);
    Vec3 color = glm::mix(
        Vec3(0.20f, 0.105f, 0.035f), Vec3(0.085f, 0.10f, 0.075f),
        glm::smoothstep(0.12f, 0.5f, t + 0.18f * (broad - 0.5f)));
    color *= 0.55f + 0.75f * fine * (0.5f + broad);
    color *= glm::mix(1.0f, 0.45f, glm::smoothstep(0.2f, 0.6f, std::sin(angle) * radius));
    color *= glm::mix(0.55f, 1.0f, glm::smoothstep(0.0f, 0.12f, t));  // the pupil's dark border
    return color * glm::mix(1.0f, 0.16f, glm::smoothstep(0.72f, 1.0f, t));  // the limbal ring
}

/// `angle` 0 lateral, pi / 2 up.
Vec3 sclera_tint(float radius, float angle, float z) {
    // Pink towards the corners, a little yellow below.
    const float corner = glm::smoothstep(0.66f, 1.15f, radius) * square(std::cos(angle));
    const float up = std::sin(angle) * radius;
    Vec3 color = glm::mix(Vec3(0.76f, 0.71f, 0.655f), Vec3(0.74f, 0.43f, 0.37f), 0.8f * corner);
    color *= glm::mix(Vec3(1), Vec3(1, 0.97f, 0.9f), glm::smoothstep(0.0f, -0.6f, up));
    // Shaded by the upper lid and its lashes, and by the lower one; skin lights it red.
    const float upper = glm::smoothstep(0.02f, 0.5f, up);
    color *= glm::mix(Vec3(1), Vec3(0.36f, 0.30f, 0.28f), upper);
    color *= glm::mix(Vec3(1), Vec3(0.74f, 0.67f, 0.64f), glm::smoothstep(-0.26f, -0.58f, up));
    color *=
        glm::mix(1.0f, 0.62f, glm::smoothstep(0.8f, 1.15f, radius) * std::abs(std::cos(angle)));
    // The limbus, 1.5 mm wide.
    color = glm::mix(
        Vec3(0.12f, 0.11f, 0.10f), color,
        glm::smoothstep(kLimbus - 0.02f, kLimbus + 0.11f, radius));
    return z < 0 ? Vec3(0.3f, 0.05f, 0.04f) : color;
}

template <typename Tint>
void append_shell(HeadPart& part, std::span<const Ring> rings, bool left, const Tint& tint) {
    const float side = left ? 1.0f : -1.0f;
    for (std::size_t row = 0; row < rings.size(); ++row) {
        for (std::uint32_t i = 0; i < kSegments; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / kSegments;
            const Ring& ring = rings[row];
            const Vec3 p = {ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.z};
            HeadPoint point = bone_point((kEyeCenter + p) * Vec3(side, 1, 1), 0);
            point.eye = left ? 1 : -1;
            part.mesh.positions.push_back(point.rest);
            part.mesh.uvs.emplace_back(
                0.5f + 0.5f * p.x / kBallRadius, 0.5f - 0.5f * p.y / kBallRadius);
            part.mesh.colors.emplace_back(tint(ring.radius, angle, ring.z), 1.0f);
            part.points.push_back(point);
        }
    }
    append_grid(part.mesh, static_cast<std::uint32_t>(rings.size()), kSegments, true, left);
}

float ball_z(float radius) {
    return std::sqrt(square(kBallRadius) - square(radius));
}

/// The pink flesh in the inner corner of an eye, fixed to the skull.
void append_caruncle(HeadPart& part, bool left) {
    constexpr Vec3 kCenter = {-1.2f, -0.1f, 0.5f};  // from the center of the ball [cm]
    constexpr Vec3 kRadii = {0.2f, 0.15f, 0.15f};
    constexpr std::uint32_t kRows = 9;
    constexpr std::uint32_t kColumns = 16;
    const float side = left ? 1.0f : -1.0f;
    for (std::uint32_t row = 0; row < kRows; ++row) {
        const float polar = kPi * (0.01f + 0.98f * static_cast<float>(row) / (kRows - 1));
        for (std::uint32_t i = 0; i < kColumns; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / kColumns;
            const Vec3 out = {
                std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                std::cos(polar)};
            const Vec3 p = kEyeCenter + kCenter + kRadii * out;
            part.points.push_back(bone_point(p * Vec3(side, 1, 1), 0));
            part.mesh.positions.push_back(part.points.back().rest);
            part.mesh.uvs.emplace_back(0.5f + 0.5f * out.x, 0.5f - 0.5f * out.y);
            part.mesh.colors.emplace_back(0.62f, 0.27f, 0.24f, 1.0f);
        }
    }
    append_grid(part.mesh, kRows, kColumns, true, left);
}

/// The wet line where the lower lid touches the ball: a hollow film that moves with the lid.
void append_tear_line(HeadPart& part, bool left) {
    struct Row {
        float radius;  // from the center of the ball [cm]
        float rise;    // above the edge of the lid [rad]
    };
    constexpr std::array<Row, 5> kProfile = {{
        {kEyeRadius + 0.05f, 0},
        {kEyeRadius + 0.02f, 0.022f},
        {kEyeRadius - 0.005f, 0.04f},
        {kEyeRadius - 0.02f, 0.062f},
        {kBallRadius - 0.003f, 0.1f},
    }};
    constexpr std::uint32_t kColumns = 40;
    const float side = left ? 1.0f : -1.0f;
    for (const Row& row : kProfile) {
        for (std::uint32_t i = 0; i < kColumns; ++i) {
            const float along = static_cast<float>(i) / (kColumns - 1);
            const float angle = -kPi * glm::mix(0.12f, 0.86f, along);
            const Vec3 out = glm::normalize(lid_margin(angle) - kEyeCenter);
            // It tapers towards its ends.
            const float rise = row.rise * glm::smoothstep(0.0f, 0.2f, std::min(along, 1 - along));
            const float c = std::cos(rise);
            const float s = std::sin(rise);
            const Vec3 p =
                kEyeCenter + row.radius * Vec3(out.x, c * out.y + s * out.z, c * out.z - s * out.y);
            HeadPoint point;
            point.rest = p * Vec3(side, 1, 1);
            point.loops = HeadLoops::Eye;
            point.loop = kLidLoop + 1;
            point.angle = angle;
            part.points.push_back(point);
            part.mesh.positions.push_back(point.rest);
            part.mesh.uvs.emplace_back(along, row.rise);
            part.mesh.colors.emplace_back(Vec3(1), 1.0f);
        }
    }
    append_grid(part.mesh, static_cast<std::uint32_t>(kProfile.size()), kColumns, false, !left);
}

}  // namespace

void append_grid(
    MeshData& mesh, std::uint32_t rows, std::uint32_t columns, bool closed, bool flip) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size()) - rows * columns;
    for (std::uint32_t row = 0; row + 1 < rows; ++row) {
        for (std::uint32_t i = 0; i < (closed ? columns : columns - 1); ++i) {
            const std::uint32_t a = first + row * columns + i;
            const std::uint32_t b = first + row * columns + (i + 1) % columns;
            for (const std::uint32_t k :
                 {a, flip ? a + columns : b, flip ? b : a + columns, b,
                  flip ? a + columns : b + columns, flip ? b + columns : a + columns}) {
                mesh.indices.push_back(k);
            }
        }
    }
}

HeadPart make_eye_balls() {
    // From the pupil over the iris to its root, up to the sclera and around the ball.
    std::vector<Ring> rings;
    const float plane = kApex - kIrisDepth;
    // A cone, which reflects no light to the front: a pupil is a hole.
    constexpr float kSteep = 6;
    constexpr float kRim = kPupil - 0.012f;
    for (const float radius : {0.001f, 0.5f * kRim, kRim}) {
        rings.push_back({radius, plane - 0.03f - kSteep * (kRim - radius)});
    }
    constexpr int kIrisRings = 14;
    for (int i = 0; i <= kIrisRings; ++i) {
        const float t = static_cast<float>(i) / kIrisRings;
        rings.push_back(
            {glm::mix(kPupil, kLimbus - 0.01f, t), plane + 0.025f * std::sin(kPi * t) + 0.02f * t});
    }
    constexpr int kBallRings = 28;
    const float from = std::asin((kLimbus + 0.002f) / kBallRadius);
    for (int i = 0; i <= kBallRings; ++i) {
        const float t = static_cast<float>(i) / kBallRings;
        const float polar = glm::mix(from, 0.999f * kPi, t * (0.35f + 0.65f * t));
        rings.push_back({kBallRadius * std::sin(polar), kBallRadius * std::cos(polar)});
    }
    HeadPart part;
    part.mesh.name = "eyes";
    for (const bool left : {true, false}) {
        append_shell(part, rings, left, [](float radius, float angle, float z) {
            return radius < kLimbus - 0.005f && z > 0 ? iris_tint(radius, angle)
                                                      : sclera_tint(radius, angle, z);
        });
        append_caruncle(part, left);
    }
    return part;
}

HeadPart make_corneas() {
    const float sag = kApex - ball_z(kLimbus);
    const float radius = (square(kLimbus) + square(sag)) / (2 * sag);
    std::vector<Ring> rings;
    constexpr int kRings = 16;
    for (int i = 0; i <= kRings; ++i) {
        const float at = std::max(0.001f, 1.25f * kLimbus * static_cast<float>(i) / kRings);
        // Beyond the limbus it continues on the ball, as a film of tears.
        const float cap = at < radius ? kApex - radius + std::sqrt(square(radius) - square(at)) : 0;
        const float ball = ball_z(at) + 0.004f;
        const float blend = glm::smoothstep(0.85f * kLimbus, 1.15f * kLimbus, at);
        rings.push_back({at, glm::mix(std::max(cap, ball), ball, blend)});
    }
    HeadPart part;
    part.mesh.name = "corneas";
    for (const bool left : {true, false}) {
        append_shell(part, rings, left, [](float, float, float) { return Vec3(1); });
        append_tear_line(part, left);
    }
    return part;
}

}  // namespace limn
