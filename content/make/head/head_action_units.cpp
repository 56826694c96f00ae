#include "content/make/head/head_action_units.h"

#include "content/make/head/head_surface.h"
#include "ecs/base/check.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: wrinkle.compression.face-model

namespace limn {

namespace {

constexpr float kPerMm = 0.1f;       ///< centimeters
constexpr float kSkinOnJaw = 0.85f;  ///< the skin of the chin turns less than the teeth

constexpr Lips kUpper = Lips::Upper;
constexpr Lips kLower = Lips::Lower;
constexpr bool kSlides = true;

// Peaks after the descriptions in FACS and measured expressions of ICT FaceKit (Li et al. 2020).
constexpr ActionUnit kUnits[] = {
    {.name = "AU1",
     .sided = true,
     .pulls = {{
         {{1.0f, 5.4f, 10.6f}, {0.2f, 5.6f, 0}, {2.1f, 3.7f, 3.4f}, Lips::Both, kSlides},
         {{1.6f, 10.2f, 8.8f}, {0, -1.5f, 0}, {3, 2.6f, 4}, Lips::Both, kSlides},
     }}},
    {.name = "AU2",
     .sided = true,
     .pulls = {{
         {{4.2f, 5.5f, 9.4f}, {0.8f, 8.2f, 0}, {2.6f, 3.7f, 3.8f}, Lips::Both, kSlides},
         {{3.6f, 10.2f, 8.2f}, {0, -1.5f, 0}, {3, 2.6f, 4}, Lips::Both, kSlides},
         {{3.6f, 4.6f, 9.4f}, {0, 1.5f, 0}, {1.8f, 0.9f, 2}, Lips::Both},
     }}},
    {.name = "AU4",
     .sided = true,
     .pulls = {{
         {{1.7f, 5.4f, 10.4f}, {-3.4f, -4.2f, 0.6f}, {2.5f, 2.3f, 3}, Lips::Both, kSlides},
         {{3.6f, 5.3f, 9.8f}, {-1.5f, -3.5f, 0}, {2.2f, 1.9f, 3}, Lips::Both, kSlides},
         {{0.5f, 4.9f, 10.6f}, {0, -1.2f, 0.7f}, {1.3f, 1.5f, 2}},
     }}},
    {.name = "AU5", .sided = true, .upper_lid = -0.34f},
    {.name = "AU6",
     .sided = true,
     .pulls = {{
         {{3.9f, 0.9f, 9.4f}, {-1.2f, 4.6f, 1.2f}, {2.7f, 2.3f, 3}},
         {{5.5f, 2.0f, 7.8f}, {-1.6f, 3.6f, 0}, {1.9f, 1.9f, 2.5f}, Lips::Both, kSlides},
         {{5.4f, 4.6f, 7.8f}, {-0.4f, -1.6f, 0}, {1.5f, 1.4f, 2.5f}, Lips::Both, kSlides},
     }},
     .lower_lid = 0.2f},
    {.name = "AU7",
     .sided = true,
     .pulls = {{
         {{3.2f, 2.3f, 9.4f}, {-2.2f, 1.4f, 0.3f}, {1.9f, 1.4f, 2}},
         {{5.4f, 2.2f, 7.9f}, {-1.6f, 2.4f, 0}, {1.7f, 1.6f, 2.5f}, Lips::Both, kSlides},
         {{5.4f, 4.5f, 7.8f}, {-0.4f, -1.4f, 0}, {1.4f, 1.3f, 2.5f}, Lips::Both, kSlides},
     }},
     .lower_lid = 0.27f},
    {.name = "AU8",
     .pulls = {{
         {{0, -2.9f, 11.6f}, {0, -1.0f, 0}, {3.2f, 1.2f, 2.5f}, kUpper},
         {{0, -3.6f, 11.5f}, {0, 2.5f, 0}, {3.2f, 1.4f, 2.5f}, kLower},
     }}},
    {.name = "AU9",
     .sided = true,
     .pulls = {{
         {{1.3f, 1.4f, 11.0f}, {-0.2f, 5.5f, 0.6f}, {1.6f, 2.3f, 2.4f}},
         {{1.8f, 0.0f, 11.0f}, {0.4f, 3.8f, 0}, {1.3f, 1.6f, 2}},
         {{1.2f, -2.4f, 11.4f}, {0, 3.5f, 0.4f}, {1.8f, 1.9f, 2.5f}, kUpper},
         {{1.2f, 5.1f, 10.4f}, {-1.2f, -2.6f, 0.3f}, {1.8f, 1.7f, 2.5f}, Lips::Both, kSlides},
         {{3.0f, 1.6f, 9.5f}, {-0.4f, 2.6f, 0.5f}, {1.8f, 1.6f, 2.5f}},
     }}},
    {.name = "AU10",
     .sided = true,
     .pulls = {{
         {{1.2f, -2.6f, 11.5f}, {0.3f, 6.2f, 0.7f}, {1.9f, 2.2f, 2.5f}, kUpper},
         {{2.2f, -0.3f, 10.4f}, {0.3f, 2.2f, 0.4f}, {1.4f, 1.6f, 2.4f}},
     }}},
    {.name = "AU11",
     .sided = true,
     .pulls = {{{{2.1f, -1.6f, 10.9f}, {1.6f, 5.6f, 0}, {1.7f, 2.1f, 2.4f}, kUpper}}}},
    {.name = "AU12",
     .sided = true,
     // Wide radii, so that cheek and lip bunch up instead of meeting at a ledge.
     .pulls = {{
         {{3.0f, -3.3f, 9.9f}, {6.8f, 8.6f, -3.8f}, {3.3f, 3.4f, 3.4f}},
         {{4.3f, 0.1f, 9.2f}, {0.2f, 3.2f, 2.0f}, {3.0f, 2.8f, 3.6f}},
         {{1.9f, -0.9f, 10.8f}, {0.9f, 1.8f, 0.3f}, {1.5f, 1.9f, 2.4f}},
         {{0.8f, -3.0f, 11.6f}, {0.6f, 0.4f, -2.0f}, {2.3f, 1.9f, 2.8f}, kUpper},  // lips thin on
                                                                                   // the teeth
         {{1.0f, -4.2f, 11.4f}, {0.6f, 1.2f, -1.8f}, {2.2f, 1.7f, 2.6f}, kLower},
     }},
     .lower_lid = 0.12f},
    {.name = "AU13",
     .sided = true,
     .pulls = {{{{2.5f, -3.3f, 10.3f}, {0.6f, 6.6f, -0.4f}, {1.9f, 1.9f, 2.4f}}}}},
    {.name = "AU14",
     .sided = true,
     .pulls = {{{{2.7f, -3.5f, 10.1f}, {2.6f, 0.2f, -5.8f}, {1.7f, 1.5f, 2}}}}},
    {.name = "AU15",
     .sided = true,
     .pulls = {{
         {{2.5f, -3.6f, 10.2f}, {1.0f, -6.2f, -0.8f}, {2.0f, 2.0f, 2.4f}},
         {{1.2f, -5.0f, 11}, {0, 1.2f, 0.3f}, {1.4f, 0.9f, 2}},
     }}},
    {.name = "AU16",
     .sided = true,
     .pulls = {{{{1.1f, -3.9f, 11.3f}, {0.6f, -5.0f, -0.4f}, {1.9f, 2.1f, 2.4f}, kLower}}}},
    {.name = "AU17",
     .pulls = {{
         {{0, -6.6f, 10.8f}, {0, 6.6f, 1.4f}, {2.6f, 2.3f, 2.6f}},
         {{0, -3.5f, 11.4f}, {0, 3.4f, 1.4f}, {2.6f, 1.9f, 2.6f}},
         {{1.6f, -6.0f, 10.7f}, {-2.8f, 0, 0.4f}, {2.2f, 1.9f, 2.6f}},  // the boss bunches up
     }}},
    {.name = "AU18",
     .pulls = {{
         {{2.3f, -3.45f, 10.3f}, {-8.4f, 0.3f, 5.0f}, {2.6f, 2.3f, 3}},
         {{0, -3.35f, 11.5f}, {0, 0.2f, 6.4f}, {2.5f, 2.1f, 2.8f}},
     }},
     .upper_roll = -10,
     .lower_roll = -10},
    {.name = "AU19", .jaw = 7, .tongue = 26},
    {.name = "AU20",
     .sided = true,
     .pulls = {{
         {{2.6f, -3.55f, 10.1f}, {8.0f, -0.9f, -3.6f}, {2.9f, 2.0f, 3}},
         {{3.4f, -5.6f, 9}, {1.5f, -1.2f, 0}, {2.2f, 2.0f, 2.6f}},
     }}},
    {.name = "AU21",
     .sided = true,
     .pulls = {{
         {{2.8f, -9.9f, 4.6f}, {1.5f, -3.5f, 5.2f}, {1.7f, 4.2f, 3}},
         {{3.4f, -5.4f, 8.6f}, {1.2f, -2.2f, 0}, {2.4f, 2.4f, 3}},
     }}},
    {.name = "AU22",
     .pulls = {{
         {{0, -3.35f, 11.4f}, {0, 0, 7.4f}, {2.8f, 2.2f, 2.8f}},
         {{2.3f, -3.45f, 10.3f}, {-4.6f, 0, 4.2f}, {2.4f, 2.2f, 3}},
         {{0, -2.9f, 11.7f}, {0, 2.4f, 0.4f}, {2.0f, 1.6f, 2.4f}, kUpper},
         {{0, -3.8f, 11.6f}, {0, -2.6f, 0.4f}, {2.0f, 1.7f, 2.4f}, kLower},
     }},
     .upper_roll = -18,
     .lower_roll = -18},
    {.name = "AU23",
     .pulls = {{
         {{2.3f, -3.45f, 10.3f}, {-2.2f, 0, 0.4f}, {2.2f, 1.6f, 2.4f}},
         {{0, -2.3f, 11.7f}, {0, -1.6f, -0.6f}, {2.6f, 1.0f, 2}, kUpper},
         {{0, -4.4f, 11.5f}, {0, 1.6f, -0.6f}, {2.6f, 1.1f, 2}, kLower},
     }},
     .upper_roll = 14,
     .lower_roll = 14},
    {.name = "AU24",
     .pulls = {{
         {{0, -2.3f, 11.7f}, {0, -2.6f, -1.0f}, {2.8f, 1.05f, 2}, kUpper},
         {{0, -4.4f, 11.5f}, {0, 2.6f, -1.0f}, {2.8f, 1.15f, 2}, kLower},
     }},
     .upper_roll = 22,
     .lower_roll = 22},
    {.name = "AU25",
     .pulls = {{
         {{0, -2.9f, 11.6f}, {0, 1.8f, 0.2f}, {2.5f, 1.6f, 2.5f}, kUpper},
         {{0, -3.7f, 11.5f}, {0, -3.4f, -0.2f}, {2.5f, 2.0f, 2.5f}, kLower},
     }}},
    {.name = "AU26", .jaw = 9.3f},
    {.name = "AU27", .jaw = 25.3f},
    {.name = "AU28",
     .pulls = {{
         {{0, -2.9f, 11.6f}, {0, -1.2f, -8.0f}, {2.7f, 1.7f, 2.6f}, kUpper},
         {{0, -3.8f, 11.5f}, {0, 1.2f, -8.0f}, {2.7f, 1.8f, 2.6f}, kLower},
     }},
     .jaw = 2,
     .upper_roll = 28,
     .lower_roll = 28},
    {.name = "AU29", .jaw_shift = {0, 0, 9}},
    {.name = "AU30_L", .jaw_shift = {9, 0, 0}},
    {.name = "AU30_R", .jaw_shift = {-9, 0, 0}},
    {.name = "AU31",
     .sided = true,
     .pulls = {{{{5.8f, -3.4f, 4.6f}, {2.4f, 0, 0.8f}, {2.2f, 2.6f, 2.8f}}}}},
    {.name = "AU32",
     .pulls = {{{{0, -3.8f, 11.5f}, {0, 2.8f, -5.4f}, {2.4f, 1.8f, 2.6f}, kLower}}},
     .jaw = 2,
     .lower_roll = 30},
    {.name = "AU33",
     .sided = true,
     .pulls = {{{{3.6f, -2.6f, 10}, {5.2f, 0.4f, 8.2f}, {2.8f, 2.6f, 3.2f}}}}},
    {.name = "AU34",
     .sided = true,
     .pulls = {{
         {{3.5f, -2.0f, 10}, {4.6f, 2.2f, 10.0f}, {3.2f, 3.1f, 3.6f}},
         {{0, -2.0f, 11.5f}, {0, 0, 1.6f}, {2.0f, 1.3f, 2.4f}},
     }}},
    {.name = "AU35",
     .sided = true,
     .pulls = {{{{4.2f, -2.2f, 9.2f}, {-4.6f, 0, -4.0f}, {2.7f, 2.5f, 3.2f}}}}},
    {.name = "AU36",
     .sided = true,
     .pulls = {{{{1.5f, -5.0f, 11}, {1.2f, 0, 6.4f}, {1.7f, 1.5f, 2.2f}}}}},
    {.name = "AU37",  // the tongue wipes the lower lip
     .pulls = {{
         {{0, -3.8f, 11.5f}, {0, -1.6f, 3.0f}, {2.0f, 1.6f, 2.4f}, kLower},
         {{0, -2.9f, 11.6f}, {0, 1.6f, 0.4f}, {2.2f, 1.5f, 2.4f}, kUpper},
     }},
     .jaw = 4,
     .tongue = 24},
    {.name = "AU38",
     .sided = true,
     .pulls = {{{{1.7f, -0.1f, 11.2f}, {2.2f, 0.6f, 0.2f}, {1.1f, 1.1f, 1.5f}}}}},
    {.name = "AU39",
     .sided = true,
     .pulls = {{{{1.7f, -0.1f, 11.2f}, {-1.9f, -0.4f, 0}, {1.2f, 1.1f, 1.5f}}}}},
    {.name = "AU41", .sided = true, .upper_lid = 0.38f},
    {.name = "AU42", .sided = true, .upper_lid = 0.64f, .lower_lid = 0.06f},
    {.name = "AU43", .sided = true, .upper_lid = 0.8f, .lower_lid = 0.2f},
    {.name = "AU44",
     .sided = true,
     .pulls = {{{{3.6f, 5.2f, 9.7f}, {-0.8f, -1.8f, 0}, {2.0f, 1.4f, 2.5f}, Lips::Both, kSlides}}},
     .upper_lid = 0.26f,
     .lower_lid = 0.36f},
    {.name = "AU45", .sided = true, .upper_lid = 0.82f, .lower_lid = 0.18f},
    {.name = "AU46",  // a wink: cheek and brow help the lids
     .sided = true,
     .pulls = {{
         {{3.9f, 0.5f, 9.4f}, {-0.8f, 3.2f, 0.8f}, {2.5f, 1.9f, 3}},
         {{3.6f, 5.6f, 9.8f}, {-0.5f, -1.8f, 0}, {2.2f, 1.3f, 3}, Lips::Both, kSlides},
     }},
     .upper_lid = 0.74f,
     .lower_lid = 0.26f},
    {.name = "AU63", .sided = true, .upper_lid = -0.3f, .lower_lid = 0.05f},
    {.name = "AU64", .sided = true, .upper_lid = 0.55f, .lower_lid = -0.12f},
};

/// 1 at 0, 0 from 1 on, smooth at both; `d2` is the square of a distance.
float fall_off(float d2) {
    return square(std::max(1 - d2, 0.0f));
}

float lip_weight(Lips lips, float upper) {
    return lips == Lips::Both ? 1 : lips == Lips::Upper ? upper : 1 - upper;
}

Vec3 mirrored_unit(const Vec3& v) {
    return {-v.x, v.y, v.z};
}

/// Offset by a pull and its mirror image.
Vec3 pull_offset(const MusclePull& pull, const HeadPoint& point) {
    const auto weight = [&](const Vec3& center) {
        const Vec3 q = (point.rest - center) / pull.radii;
        return fall_off(glm::dot(q, q));
    };
    Vec3 offset = weight(pull.center) * pull.motion;
    if (pull.center.x > 0) {
        offset += weight(mirrored_unit(pull.center)) * mirrored_unit(pull.motion);
    }
    return kPerMm * lip_weight(pull.lips, point.upper_lip) * offset;
}

/// Rotates about the axis parallel to x through `center` by `angle` [rad], z towards y.
Vec3 turn_about_x(const Vec3& p, const Vec3& center, float angle) {
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    const Vec3 q = p - center;
    return center + Vec3(q.x, c * q.y + s * q.z, c * q.z - s * q.y);
}

/// `p` and the result on the left side.
Vec3 turn_lid(const ActionUnit& unit, const HeadPoint& point, const Vec3& p) {
    // How much each loop follows the edge of the lid; less again in the pocket behind it.
    constexpr std::array<float, kEyeLoops + 1> kFollow = {
        0, 0.01f, 0.04f, 0.1f, 0.19f, 0.32f, 0.49f, 0.67f, 0.83f, 1, 1, 0.9f, 0.6f, 0.3f, 0};
    static_assert(kFollow[kLidLoop] == 1);
    const bool upper = std::sin(point.angle) > 0;
    const float closing = upper ? unit.upper_lid : unit.lower_lid;
    if (point.loops != HeadLoops::Eye || closing == 0) {
        return p;
    }
    const Vec3 own = lid_margin(point.angle) - kEyeCenter;
    const Vec3 other = lid_margin(-point.angle) - kEyeCenter;
    const float turn = closing * (std::atan2(other.y, other.z) - std::atan2(own.y, own.z));
    const float corner = glm::smoothstep(0.9f, 1.0f, std::abs(std::cos(point.angle)));
    const float follow = std::pow(kFollow[point.loop], 1 + 3 * corner);
    const float radius = glm::length(Vec2(own.y, own.z));
    // Skin in front of the corners, farther from the axis, moves as far as they do.
    const float slowing =
        std::min(radius / glm::length(Vec2(p.y, p.z) - Vec2(kEyeCenter.y, kEyeCenter.z)), 1.0f);
    Vec3 turned = turn_about_x(p, kEyeCenter, slowing * follow * turn) - kEyeCenter;
    // Both edges meet at one distance from the axis, and stay clear of the cornea on their straight
    // path there.
    float scale = glm::mix(1.0f, glm::length(Vec2(other.y, other.z)) / radius, closing);
    if (point.loop > kLidLoop) {
        const float clear = (kEyeRadius + 0.12f) / glm::length(turned);
        scale = std::max(scale, glm::mix(1.0f, clear, std::min(std::abs(closing), 1.0f)));
    }
    scale = glm::mix(1.0f, scale, follow);
    turned.y *= scale;
    turned.z *= scale;
    return kEyeCenter + turned;
}

Vec3 roll_lip(const ActionUnit& unit, const HeadPoint& point, const Vec3& p) {
    constexpr float kRollRadius = 1.05f;
    const float c = p.x / 2.5f;
    if (std::abs(c) >= 1 || (unit.upper_roll == 0 && unit.lower_roll == 0)) {
        return p;
    }
    const Vec3 line = lip_line((1 - c) * kPi / 2);
    const float side = p.y > line.y ? 1.0f : -1.0f;
    const Vec3 axis = {p.x, line.y + 0.36f * side, line.z + 0.12f};
    const Vec3 q = (point.rest - axis) / kRollRadius;
    const float weight =
        fall_off(glm::dot(q, q)) * square(1 - square(c)) * std::abs(2 * point.upper_lip - 1);
    const float roll = side > 0 ? -unit.upper_roll : unit.lower_roll;
    return turn_about_x(p, axis, weight * radians(roll));
}

float jaw_weight(const HeadPoint& point, const Vec3& p) {
    // It changes abruptly between the lips, and gradually over the cheek beside the mouth.
    const float cheek = glm::smoothstep(0.9f, -5.4f, p.y);
    const float mouth =
        1 - glm::smoothstep(1.9f, 4.4f, glm::length(Vec2(p.x, 1.2f * (p.y + 3.4f))));
    const float neck = glm::smoothstep(-12.5f, -7.0f, p.y);
    const float front = glm::smoothstep(-3.5f, 2.0f, p.z);
    return kSkinOnJaw * neck * front * glm::mix(cheek, 1 - point.upper_lip, mouth);
}

}  // namespace

std::span<const ActionUnit> action_units() {
    return kUnits;
}

const ActionUnit& action_unit(std::string_view name) {
    const auto* const found = std::ranges::find(kUnits, name, &ActionUnit::name);
    LIMN_CHECK(found != std::end(kUnits));
    return *found;
}

HeadPoint skin_point(const HeadVertex& vertex, const Vec3& rest) {
    HeadPoint point;
    point.rest = rest;
    point.loops = vertex.loops;
    point.loop = vertex.loop;
    point.angle = vertex.angle;
    const float open = 1 - square(across_mouth(vertex.angle));
    point.upper_lip = vertex.loops == HeadLoops::Mouth
                          ? 0.5f + std::copysign(0.5f, std::sin(vertex.angle)) * open
                          : glm::smoothstep(-1.8f, 1.8f, rest.y + 3.4f);
    point.jaw = vertex.loops == HeadLoops::Ear ? 0 : jaw_weight(point, rest);
    return point;
}

HeadPoint bone_point(const Vec3& rest, float jaw) {
    HeadPoint point;
    point.rest = rest;
    point.jaw = jaw;
    point.skin = false;
    return point;
}

Vec3 action_offset(const ActionUnit& unit, const HeadPoint& point, const HeadShape& shape) {
    Vec3 p = point.rest;
    if (point.skin) {
        for (const MusclePull& pull : unit.pulls) {
            const Vec3 offset = pull.radii.x > 0 ? pull_offset(pull, point) : Vec3(0);
            if (offset == Vec3(0)) {
                continue;
            }
            const Vec3 from = p;
            p += offset;
            if (pull.slides) {
                const float side = p.x < 0 ? -1.0f : 1.0f;  // so that both sides are bit-identical
                const Vec3 out = Vec3(side, 1, 1) * head_gradient({side * p.x, p.y, p.z}, shape, 1)
                                 * Vec3(std::abs(p.x) < 0.01f ? 0 : 1, 1, 1);
                const float rise = head_distance(p, shape, 1) - head_distance(from, shape, 1);
                p -= glm::clamp(rise, -0.5f, 0.5f) / std::max(glm::dot(out, out), 0.25f) * out;
            }
        }
        p = roll_lip(unit, point, p);
        const bool right = p.x < 0;
        p = right ? mirrored_unit(turn_lid(unit, point, mirrored_unit(p)))
                  : turn_lid(unit, point, p);
    }
    p = turn_about_x(p, {0, kJawAxis.x, kJawAxis.y}, -point.jaw * radians(unit.jaw));
    p += kPerMm * point.jaw * unit.jaw_shift;
    p += kPerMm * square(point.tongue) * unit.tongue * Vec3(0, -0.25f, 1);
    return p - point.rest;
}

float left_weight(float x) {
    return glm::smoothstep(-1.0f, 1.0f, x);
}

}  // namespace limn
