#include "content/bake/face_regions.h"

#include "ecs/base/check.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace limn {

namespace {

constexpr float kSoft = 0.4f;        ///< width of most borders [cm]
constexpr float kFacing = 0.15f;     ///< z of the normals of skin that faces the front
constexpr float kFacingSoft = 0.1f;  ///< width of that border
constexpr float kMidlineBand =
    0.8f;  ///< |x| below which directions turn to those of the midline [cm]
constexpr float kInfiniteDistance = std::numeric_limits<float>::infinity();

// Landmarks of the reference face [cm].
constexpr Vec3 kCanthus = {4.459f, 3.432f, 8.603f};  ///< outer corner of the left eye
constexpr Vec2 kFoldTop = {1.75f, -0.3f};            ///< nasolabial fold beside the left ala
constexpr Vec2 kFoldEnd = {3.1f, -3.0f};             ///< and outside the corner of the mouth
constexpr float kFoldRange = 0.6f;                   ///< distance from the fold
constexpr Vec2 kMouth = {0, -3.4f};                  ///< center
constexpr Vec2 kMouthRadii = {2.6f, 1.9f};           ///< of the ellipse around it, across and up

enum class Across : std::uint8_t {
    Angle,    ///< a fixed angle
    Canthus,  ///< around the outer corner of the eye: folds radiate from it
    Mouth,    ///< around the mouth: folds radiate from it
    None,     ///< no direction
};

struct Rule {
    std::string_view name;
    Vec2 x = {-kInfiniteDistance, kInfiniteDistance};  ///< range of |x| [cm]
    Vec2 y = {-kInfiniteDistance, kInfiniteDistance};
    float min_z = -kInfiniteDistance;
    float soft = kSoft;
    bool fold = false;  ///< within kFoldRange of the nasolabial fold
    bool front = true;  ///< only skin that faces the front
    Across across = Across::Angle;
    float degrees = 0;  ///< from lateral (0) to up (90), on the left side
};

constexpr std::array<Rule, 15> kRules = {{
    {.name = "forehead", .x = {-kInfiniteDistance, 5}, .y = {6.8f, 10.5f}, .degrees = 83},
    {.name = "glabella", .x = {-kInfiniteDistance, 1.4f}, .y = {4.4f, 6.8f}, .degrees = 20},
    {.name = "nose_root", .x = {-kInfiniteDistance, 1}, .y = {2.4f, 4.4f}, .degrees = 94},
    {.name = "nose_side", .x = {0.5f, 1.7f}, .y = {0.8f, 2.9f}, .degrees = 119},
    {.name = "upper_lid", .x = {2, 4.5f}, .y = {4.3f, 5.2f}, .degrees = 90},
    {.name = "lower_lid", .x = {2, 4.4f}, .y = {1.4f, 2.8f}, .degrees = 88},
    {.name = "inner_canthus", .x = {1.2f, 2.4f}, .y = {1.4f, 3.2f}, .degrees = 145},
    {.name = "crows_feet",
     .x = {4.6f, 6.4f},
     .y = {2, 4.8f},
     .front = false,
     .across = Across::Canthus},
    {.name = "cheek", .x = {3, 6}, .y = {-2, 1.2f}, .degrees = 57},
    {.name = "nasolabial", .fold = true, .degrees = 27},
    {.name = "upper_lip",
     .x = {-kInfiniteDistance, 2},
     .y = {-2.4f, -1.35f},
     .min_z = 9.5f,
     .soft = 0.6f,
     .across = Across::Mouth},
    {.name = "mouth_corner", .x = {2.6f, 3.8f}, .y = {-5.2f, -2.8f}, .degrees = 167},
    {.name = "marionette", .x = {1.6f, 3.4f}, .y = {-5.9f, -3.9f}, .soft = 0.8f, .degrees = 50},
    {.name = "mentolabial",
     .x = {-kInfiniteDistance, 2},
     .y = {-5.75f, -4.55f},
     .soft = 0.6f,
     .across = Across::Mouth},
    {.name = "chin", .x = {-kInfiniteDistance, 2}, .y = {-7.2f, -5.6f}, .across = Across::None},
}};

/// 0 below, 1 above `edge`, smooth over `width` around it.
float soft_step(float edge, float width, float x) {
    return glm::smoothstep(edge - 0.5f * width, edge + 0.5f * width, x);
}

/// 1 within `range`, 0 outside.
float soft_range(const Vec2& range, float soft, float x) {
    const float low = range.x == -kInfiniteDistance ? 1 : soft_step(range.x, soft, x);
    const float high = range.y == kInfiniteDistance ? 1 : 1 - soft_step(range.y, soft, x);
    return low * high;
}

/// [cm]
float distance_to_fold(const Vec2& p) {
    const Vec2 along = kFoldEnd - kFoldTop;
    const Vec2 offset = p - kFoldTop;
    const float t = glm::clamp(glm::dot(offset, along) / glm::dot(along, along), 0.0f, 1.0f);
    return glm::length(offset - t * along);
}

/// `p`: on the left side.
float weight_at(const Rule& rule, const Vec3& p, float facing) {
    float weight = soft_range(rule.x, rule.soft, p.x) * soft_range(rule.y, rule.soft, p.y);
    weight *= rule.min_z == -kInfiniteDistance ? 1 : soft_step(rule.min_z, kSoft, p.z);
    weight *= rule.fold ? 1 - soft_step(kFoldRange, kSoft, distance_to_fold({p.x, p.y})) : 1;
    weight *= rule.front ? soft_step(kFacing, kFacingSoft, facing) : 1;
    return weight;
}

/// From lateral towards up [rad] at `p` on the left side; on the midline of the face rounded to
/// across or up, so that both sides meet.
float angle_at(const Rule& rule, const Vec3& p) {
    float angle = radians(rule.degrees);
    if (rule.across == Across::Mouth) {
        const Vec2 outwards = (Vec2(p.x, p.y) - kMouth) / (kMouthRadii * kMouthRadii);
        angle = std::atan2(outwards.y, outwards.x) + 0.5f * kPi;
        return outwards.y < 0 ? angle + kPi : angle;
    }
    const float on_midline = std::round(angle / (0.5f * kPi)) * 0.5f * kPi;
    return glm::mix(on_midline, angle, glm::smoothstep(0.0f, kMidlineBand, p.x));
}

Vec3 across_at(const Rule& rule, const Vec3& reference, const Vec3& normal) {
    const Vec3 left = {std::abs(reference.x), reference.y, reference.z};
    const float side = reference.x < 0 ? -1.0f : 1.0f;
    const Vec3 u = normalize_or(glm::cross(Vec3(0, 1, 0), normal), any_perpendicular(normal));
    const Vec3 v = glm::cross(normal, u);
    if (rule.across == Across::Canthus) {
        const Vec3 outwards = (left - kCanthus) * Vec3(side, 1, 1);
        return normalize_or(glm::cross(normal, outwards) * side, v);
    }
    const float angle = angle_at(rule, left);
    return std::cos(angle) * side * u + std::sin(angle) * v;
}

constexpr std::array<std::string_view, kRules.size()> kNames = [] {
    std::array<std::string_view, kRules.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i) {
        names[i] = kRules[i].name;
    }
    return names;
}();

}  // namespace

std::span<const std::string_view> face_region_names() {
    return kNames;
}

std::vector<VertexRegion>
make_face_regions(std::span<const Vec3> reference, std::span<const Vec3> normals) {
    LIMN_CHECK(reference.size() == normals.size());
    std::vector<VertexRegion> regions;
    for (const Rule& rule : kRules) {
        VertexRegion& region = regions.emplace_back();
        region.name = rule.name;
        region.weights.assign(reference.size(), 0.0f);
        if (rule.across != Across::None) {
            region.across.assign(reference.size(), Vec3(0));
        }
        for (std::size_t v = 0; v < reference.size(); ++v) {
            const Vec3& p = reference[v];
            const float weight =
                is_finite(p) ? weight_at(rule, {std::abs(p.x), p.y, p.z}, normals[v].z) : 0.0f;
            region.weights[v] = weight;
            if (weight > 0 && rule.across != Across::None) {
                region.across[v] = across_at(rule, p, normals[v]);
            }
        }
    }
    return regions;
}

}  // namespace limn
