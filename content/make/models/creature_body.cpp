#include "content/make/models/creature_body.h"

#include "content/make/patterns/noise.h"
#include "content/models/fox_model.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace limn {

namespace {

using enum CreatureJoint;

/// The right joint that corresponds to a left one.
std::size_t other_side(std::size_t joint) {
    return joint >= static_cast<std::size_t>(LeftShoulder) ? joint + 4 : joint;
}

float from(float low, float high, float x) {
    return glm::smoothstep(low, high, x);
}

/// The bone chain that a UV chart is unwrapped around, from one end to the other.
std::span<const Vec3> chart_bones(int chart) {
    if (chart == 0) {
        return fox::kTrunkBones;
    }
    return chart <= 2 ? std::span<const Vec3>(fox::kFrontBones) : fox::kHindBones;
}

bool is_right(int chart) {
    return chart == 2 || chart == 4;
}

}  // namespace

float creature_distance(const Vec3& p) {
    return group_distance(fox::kParts, p, true);
}

std::array<float, kCreatureJoints> creature_part_distances(const Vec3& p) {
    std::array<float, kCreatureJoints> distances;
    distances.fill(1e3f);
    for (const ModelPart& part : fox::kParts) {
        if (part.use != PartUse::Join) {
            continue;
        }
        float& left = distances[part.joint];
        left = std::min(left, part_distance(part, p));
        if (part.a.x > 0.0f) {
            float& right = distances[other_side(part.joint)];
            right = std::min(right, part_distance(part, mirrored(p)));
        }
    }
    return distances;
}

Vec3 creature_color(const Vec3& p, const Vec3& normal) {
    const float noise =
        fractal_noise(40.0f * Vec2(p.z + 0.3f * p.x, p.y + 0.2f * p.x), 5, {.count = 3});
    const float ragged = 0.012f * noise;

    const bool is_tail = p.z < -0.29f;
    const float head = from(0.535f, 0.57f, p.y) * from(0.22f, 0.25f, p.z);
    Vec3 color = glm::mix(
        fox::kCoat, fox::kBack, 0.75f * from(0.25f, 0.95f, normal.y) * (1.0f - 0.6f * head));
    // Below: belly, throat and bib, the inside of the legs.
    float light = from(-0.3f, -0.8f, normal.y - 0.25f * noise) * from(0.24f, 0.3f, p.y + ragged)
                  * (is_tail ? 0.0f : 1.0f);
    const float bib = from(0.3f, 0.75f, normal.z - 0.5f * normal.y)
                      * from(0.055f, 0.03f, std::abs(p.x) + ragged) * from(0.12f, 0.15f, p.z)
                      * from(0.34f, 0.37f, p.y) * from(0.62f, 0.58f, p.y);
    light = std::max(light, bib);
    // The mask: cheeks and muzzle below a line that rises backward.
    const float line = 0.609f - 0.022f * from(0.37f, 0.48f, p.z) + 0.14f * std::abs(p.x);
    const float mask = from(0.005f, -0.007f, p.y - line + 0.5f * ragged)
                       * from(0.268f, 0.29f, p.z + 0.35f * std::abs(p.x) + ragged);
    light = std::max(light, head * mask * from(0.675f, 0.65f, p.y));
    color = glm::mix(color, fox::kCream, light);
    // From the corner of the eye down the muzzle.
    const Vec3 side(std::abs(p.x), p.y, p.z);
    color =
        glm::mix(color, fox::kSock, 0.65f * from(0.011f, 0.001f, part_distance(fox::kTear, side)));
    // Ears: dark behind toward the tip, lined inside.
    const float ear = from(0.7f, 0.735f, p.y);
    const float lining = ear * from(0.3f, 0.65f, normal.z + 0.3f * ragged);
    color = glm::mix(color, fox::kSock, ear * from(0.745f, 0.775f, p.y + ragged));
    color = glm::mix(color, fox::kEarLining, lining);
    if (is_tail) {
        const float tip = from(-0.585f, -0.62f, p.z + 1.5f * ragged);
        color = glm::mix(glm::mix(color, fox::kBack, 0.35f), fox::kCream, tip);
    }
    if (!is_tail) {
        const float high = std::abs(p.z) > 0.02f ? (p.z > 0 ? 0.165f : 0.15f) : 0.0f;
        color = glm::mix(color, fox::kSock, from(high + 0.02f, high - 0.02f, p.y + 1.5f * ragged));
    }
    const float nose = glm::distance(p, Vec3(0, 0.609f, 0.482f));
    color = glm::mix(color, fox::kNose, from(0.019f, 0.0145f, nose));
    return color * (1.0f + 0.16f * noise);
}

float creature_fur_length(const Vec3& p) {
    const float tail = from(-0.22f, -0.4f, p.z);
    const float leg = from(0.36f, 0.2f, p.y) * (1.0f - tail);
    const float paw = from(0.09f, 0.03f, p.y) * (1.0f - tail);
    const float ruff = from(0.12f, 0.2f, p.z) * from(0.3f, 0.42f, p.y);
    const float head = from(0.53f, 0.57f, p.y) * from(0.2f, 0.26f, p.z);
    const float ear = from(0.67f, 0.72f, p.y);
    const float muzzle = from(0.33f, 0.42f, p.z);
    const float nose = from(0.022f, 0.035f, glm::distance(p, Vec3(0, 0.609f, 0.482f)));
    float length = glm::mix(0.5f, 1.0f, tail);
    length = glm::mix(length, 0.68f, ruff);
    length = glm::mix(length, 0.22f, leg);
    length = glm::mix(length, 0.1f, paw);
    length = glm::mix(length, 0.3f, head);
    length = glm::mix(length, 0.12f, ear);
    return glm::mix(length, 0.1f, muzzle) * nose;
}

Vec3 creature_eye_color(float angle) {
    const Vec3 iris = glm::mix(fox::kIris, fox::kIrisEdge, from(0.6f, 1.05f, angle));
    return glm::mix(fox::kPupil, iris, from(0.5f, 0.62f, angle)) * from(1.35f, 1.1f, angle);
}

int creature_chart(const Vec3& p) {
    const std::array<float, kCreatureJoints> flesh = creature_part_distances(p);
    const auto nearest = std::min_element(flesh.begin(), flesh.end()) - flesh.begin();
    const auto first_leg = static_cast<std::ptrdiff_t>(LeftShoulder);
    return nearest < first_leg ? 0 : static_cast<int>((nearest - first_leg) / 4) + 1;
}

Vec2 creature_chart_uv(int chart, const Vec3& position) {
    const Vec3 p = is_right(chart) ? mirrored(position) : position;
    const std::span<const Vec3> bones = chart_bones(chart);
    float best = 1e9f;
    float along = 0;
    float total = 0;
    Vec3 away(0);
    Vec3 bone(0);
    for (std::size_t i = 0; i + 1 < bones.size(); ++i) {
        const Vec3 step = bones[i + 1] - bones[i];
        const float length = glm::length(step);
        // The chain is extrapolated beyond its ends.
        const float low = i == 0 ? -1.0f : 0.0f;
        const float high = i + 2 == bones.size() ? 2.0f : 1.0f;
        const float t = glm::clamp(glm::dot(p - bones[i], step) / square(length), low, high);
        const Vec3 offset = p - bones[i] - t * step;
        if (const float distance = glm::length(offset); distance < best) {
            best = distance;
            along = total + t * length;
            away = offset;
            bone = step / length;
        }
        total += length;
    }
    // The angle around the bone, starting below or at the inside of a leg.
    const Vec3 side = chart == 0 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
    const Vec3 up = glm::cross(bone, side);
    const float angle = std::atan2(glm::dot(away, side), glm::dot(away, up));
    const float u = 0.5f + angle / (2.0f * kPi);
    const float v = glm::clamp((along + 0.03f) / (total + 0.06f), 0.0f, 1.0f);
    return {is_right(chart) ? 1.0f - u : u, v};
}

Vec2 atlas_uv(int chart, const Vec2& uv) {
    // A margin beside each chart, for triangles that wrap around.
    const float left = chart == 0 ? 0.02f : 0.52f + 0.12f * static_cast<float>(chart - 1);
    const float width = chart == 0 ? 0.46f : 0.1f;
    return {left + width * uv.x, uv.y};
}

}  // namespace limn
