#pragma once

#include "content/make/models/implicit_model.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace limn::hovercraft {

// The racing craft as data: shapes and colors, for a craft of 5 m [m]. Only the left side (+x) is
// listed, the right is its mirror image.

inline constexpr float kLength = 5.0f;

/// A front wing, which droops and tapers toward its tip.
inline float wing(const Vec3& p) {
    const float x = std::clamp((p.x - 0.1f) / 0.95f, 0.0f, 1.0f);
    return part_distance(
        {.shape = PartShape::Box,
         .a = {0.45f, 0, 0},
         .b = {0.6f, 0.045f, glm::mix(0.42f, 0.16f, x)},
         .radius_a = 0.04f},
        p + Vec3(0, 0.04f + 0.06f * x, 0.55f * x - 1.3f));
}

/// A plate that leans outwards and is swept back.
inline float fin(const Vec3& p) {
    const Vec3 q = p - Vec3(0.86f, 0.28f, -1.7f);
    const float height = q.y * 0.94f + q.x * 0.34f;  // leans outwards
    const float across = q.x * 0.94f - q.y * 0.34f;
    const float along = q.z + 0.75f * height;  // swept back
    const float outline = std::max(
        std::max(-height - 0.2f, height - 0.62f),
        std::abs(along) - glm::mix(0.5f, 0.2f, std::clamp(height / 0.62f, 0.0f, 1.0f)));
    const Vec2 edge = {outline + 0.05f, std::abs(across) - 0.02f};
    return glm::length(glm::max(edge, Vec2(0))) + std::min(std::max(edge.x, edge.y), 0.0f) - 0.035f;
}

constexpr ModelPart
cone(float blend, const Vec3& a, const Vec3& b, float radius_a, float radius_b) {
    return {.blend = blend, .a = a, .b = b, .radius_a = radius_a, .radius_b = radius_b};
}
constexpr ModelPart box(float blend, const Vec3& center, const Vec3& half, float radius) {
    return {.shape = PartShape::Box, .blend = blend, .a = center, .b = half, .radius_a = radius};
}
constexpr ModelPart used(ModelPart part, PartUse use) {
    part.use = use;
    return part;
}

inline constexpr ModelPart kIntake =
    used(box(0.14f, {0.86f, 0.06f, 0.5f}, {0.21f, 0.16f, 0.45f}, 0.1f), PartUse::Cut);
inline constexpr ModelPart kNozzle =
    used(cone(0.03f, {0.86f, 0.05f, -2.1f}, {0.86f, 0.05f, -2.9f}, 0.17f, 0.25f), PartUse::Cut);

/// A wedge: flat below, round above, from a pointed nose to a broad tail.
inline constexpr ModelPart kHull[] = {
    {.shape = PartShape::Ellipsoid, .a = {0, 0.05f, -0.5f}, .b = {0.66f, 0.27f, 1.8f}},
    cone(0.3f, {0, 0.0f, 2.38f}, {0, 0.06f, -0.4f}, 0.09f, 0.42f),
    {.shape = PartShape::Custom, .blend = 0.16f, .distance = wing},
    {.shape = PartShape::Above, .use = PartUse::Clip, .blend = 0.12f, .a = {0, -0.2f, 0}},
};
inline constexpr ModelPart kStrut[] = {
    box(0, {0.5f, 0.02f, -0.75f}, {0.35f, 0.06f, 0.75f}, 0.05f),
};
inline constexpr ModelPart kEngine[] = {
    box(0, {0.86f, 0.05f, -0.55f}, {0.36f, 0.3f, 1.0f}, 0.15f),
    cone(0.2f, {0.86f, 0.05f, -1.2f}, {0.86f, 0.05f, -2.2f}, 0.33f, 0.29f),
    {.shape = PartShape::Before, .use = PartUse::Clip, .a = {0, 0, -2.32f}},
    kIntake,
    kNozzle,
};
inline constexpr ModelPart kFin[] = {{.shape = PartShape::Custom, .distance = fin}};
inline constexpr ModelGroup kGroups[] = {
    {0, kHull}, {0.18f, kStrut}, {0.06f, kEngine}, {0.06f, kFin}};

inline constexpr Vec3 kCanopyCenter = {0, 0.25f, 0.05f};
inline constexpr Vec3 kCanopyRadii = {0.26f, 0.24f, 0.85f};

inline constexpr Vec4 kPaint = {1, 1, 1, 1};  ///< the material's color shows
inline constexpr Vec4 kDark = {0.015f, 0.017f, 0.02f, 1};
inline constexpr Vec4 kTips = {0.06f, 0.065f, 0.07f, 1};
inline constexpr Vec4 kCanopy = {0.008f, 0.010f, 0.016f, 1.0f};

}  // namespace limn::hovercraft
