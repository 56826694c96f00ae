#include "content/make/creature_body.h"

#include "content/make/noise.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace limn {

namespace {

/// A rounded cone from `a` to `b`, squashed about `a`. Parts of both sides are written once, for
/// the left.
struct Part {
    CreatureJoint joint;
    Vec3 a;
    Vec3 b;
    float radius_a;
    float radius_b;
    float blend;  ///< width of the seam to what came before [m]
    Vec3 squash = {1, 1, 1};
    bool mirrored = false;
};

using enum CreatureJoint;

constexpr Part kParts[] = {
    // the trunk
    {Hips, {0, 0.4f, -0.2f}, {0, 0.402f, -0.1f}, 0.08f, 0.074f, 0.02f},
    {Spine, {0, 0.402f, -0.11f}, {0, 0.398f, 0.03f}, 0.072f, 0.084f, 0.02f},
    {Chest, {0, 0.385f, 0.05f}, {0, 0.395f, 0.135f}, 0.093f, 0.082f, 0.03f, {0.86f, 1.08f, 1}},
    {Chest, {0, 0.43f, 0.11f}, {0, 0.455f, 0.17f}, 0.07f, 0.066f, 0.04f},
    {Neck, {0, 0.455f, 0.17f}, {0, 0.575f, 0.258f}, 0.07f, 0.05f, 0.04f},
    {Neck, {0, 0.42f, 0.195f}, {0, 0.53f, 0.262f}, 0.05f, 0.038f, 0.04f},  // the bib
    // the head
    {Head, {0, 0.638f, 0.3f}, {0, 0.634f, 0.322f}, 0.078f, 0.07f, 0.035f, {0.98f, 0.87f, 1}},
    {Head,
     {0.036f, 0.605f, 0.318f},
     {0.064f, 0.592f, 0.308f},
     0.043f,
     0.022f,
     0.035f,
     {1, 1, 1},
     true},
    {Head, {0, 0.619f, 0.352f}, {0, 0.6f, 0.466f}, 0.042f, 0.0185f, 0.034f, {1, 0.95f, 1}},
    {Head, {0, 0.6075f, 0.476f}, {0, 0.6075f, 0.478f}, 0.0145f, 0.014f, 0.006f, {1.1f, 0.9f, 0.9f}},
    {Jaw, {0, 0.588f, 0.352f}, {0, 0.581f, 0.437f}, 0.024f, 0.0125f, 0.008f, {1.15f, 0.8f, 1}},
    // ears: cups that open forward and outward
    {Head,
     {0.05f, 0.676f, 0.288f},
     {0.088f, 0.8f, 0.274f},
     0.043f,
     0.011f,
     0.018f,
     {1, 1, 0.62f},
     true},
    // the tail
    {Tail, {0, 0.415f, -0.25f}, {0, 0.39f, -0.37f}, 0.032f, 0.043f, 0.03f},
    {Tail, {0, 0.39f, -0.37f}, {0, 0.355f, -0.47f}, 0.043f, 0.056f, 0.004f},
    {TailTip, {0, 0.355f, -0.47f}, {0, 0.322f, -0.57f}, 0.056f, 0.05f, 0.004f},
    {TailTip, {0, 0.322f, -0.57f}, {0, 0.29f, -0.71f}, 0.05f, 0.01f, 0.004f},
    // front legs
    {LeftShoulder,
     {0.05f, 0.4f, 0.125f},
     {0.066f, 0.27f, 0.092f},
     0.055f,
     0.031f,
     0.04f,
     {1, 1, 1},
     true},
    {LeftElbow,
     {0.066f, 0.265f, 0.088f},
     {0.066f, 0.13f, 0.124f},
     0.0295f,
     0.0185f,
     0.02f,
     {1, 1, 1},
     true},
    {LeftWrist,
     {0.066f, 0.128f, 0.125f},
     {0.066f, 0.036f, 0.117f},
     0.019f,
     0.017f,
     0.008f,
     {1, 1, 1},
     true},
    {LeftPaw,
     {0.066f, 0.0225f, 0.12f},
     {0.067f, 0.019f, 0.158f},
     0.0225f,
     0.019f,
     0.015f,
     {1.15f, 1, 1},
     true},
    // hind legs
    {LeftThigh,
     {0.044f, 0.385f, -0.175f},
     {0.07f, 0.27f, -0.13f},
     0.07f,
     0.043f,
     0.04f,
     {0.85f, 1, 1},
     true},
    {LeftKnee,
     {0.071f, 0.262f, -0.126f},
     {0.068f, 0.155f, -0.232f},
     0.037f,
     0.0195f,
     0.02f,
     {1, 1, 1},
     true},
    {LeftHock,
     {0.068f, 0.148f, -0.238f},
     {0.068f, 0.036f, -0.215f},
     0.02f,
     0.017f,
     0.008f,
     {1, 1, 1},
     true},
    {LeftFoot,
     {0.068f, 0.0225f, -0.21f},
     {0.069f, 0.019f, -0.168f},
     0.0225f,
     0.019f,
     0.015f,
     {1.15f, 1, 1},
     true},
};

/// What is taken away of the ears: their insides.
constexpr Part kEarCup = {
    Head, {0.058f, 0.7f, 0.314f}, {0.085f, 0.77f, 0.297f}, 0.028f, 0.008f, 0.012f, {1, 1, 0.55f},
    true};

Vec3 mirrored(const Vec3& p) {
    return {-p.x, p.y, p.z};
}

/// The joint of the right side in the place of one of the left.
CreatureJoint other_side(CreatureJoint joint) {
    const auto index = static_cast<std::uint16_t>(joint);
    return joint >= LeftShoulder ? static_cast<CreatureJoint>(index + 4) : joint;
}

float part_distance(const Part& part, const Vec3& p) {
    const Vec3 q = (p - part.a) / part.squash;
    const Vec3 along = (part.b - part.a) / part.squash;
    const float length2 = glm::dot(along, along);
    const float t = glm::clamp(glm::dot(q, along) / length2, 0.0f, 1.0f);
    const float radius = glm::mix(part.radius_a, part.radius_b, t);
    const float least = std::min({part.squash.x, part.squash.y, part.squash.z});
    return (glm::length(q - t * along) - radius) * least;
}

/// The smaller one; where they are within `k` of each other, rounded (I. Quilez, "Smooth minimum").
float smooth_min(float a, float b, float k) {
    const float h = std::max(k - std::abs(a - b), 0.0f) / k;
    return std::min(a, b) - 0.25f * h * h * k;
}

float from(float low, float high, float x) {
    return glm::smoothstep(low, high, x);
}

/// The bones that the hide is unrolled about, from one end to the other.
std::span<const Vec3> chart_bones(int chart) {
    static const std::vector<Vec3> kTrunk = {
        {0, 0.604f, 0.48f}, {0, 0.62f, 0.32f},  {0, 0.57f, 0.26f},
        {0, 0.46f, 0.18f},  {0, 0.405f, 0.1f},  {0, 0.405f, -0.2f},
        {0, 0.4f, -0.34f},  {0, 0.36f, -0.46f}, {0, 0.28f, -0.72f}};
    static const std::vector<Vec3> kFront = {
        {0.05f, 0.42f, 0.13f},
        {0.066f, 0.26f, 0.088f},
        {0.066f, 0.13f, 0.124f},
        {0.066f, 0.022f, 0.116f},
        {0.067f, 0.018f, 0.175f}};
    static const std::vector<Vec3> kHind = {
        {0.046f, 0.41f, -0.18f},
        {0.071f, 0.258f, -0.122f},
        {0.068f, 0.15f, -0.236f},
        {0.068f, 0.022f, -0.213f},
        {0.069f, 0.018f, -0.15f}};
    return chart == 0 ? kTrunk : chart <= 2 ? kFront : kHind;
}

bool is_right(int chart) {
    return chart == 2 || chart == 4;
}

}  // namespace

float creature_distance(const Vec3& p) {
    float distance = 1e3f;
    for (const Part& part : kParts) {
        distance = smooth_min(distance, part_distance(part, p), part.blend);
        if (part.mirrored) {
            distance = smooth_min(distance, part_distance(part, mirrored(p)), part.blend);
        }
    }
    for (const Vec3& side : {p, mirrored(p)}) {
        distance = -smooth_min(-distance, part_distance(kEarCup, side), kEarCup.blend);
    }
    return distance;
}

std::array<float, kCreatureJoints> creature_flesh(const Vec3& p) {
    std::array<float, kCreatureJoints> distances;
    distances.fill(1e3f);
    for (const Part& part : kParts) {
        float& left = distances[static_cast<std::size_t>(part.joint)];
        left = std::min(left, part_distance(part, p));
        if (part.mirrored) {
            float& right = distances[static_cast<std::size_t>(other_side(part.joint))];
            right = std::min(right, part_distance(part, mirrored(p)));
        }
    }
    return distances;
}

Vec3 creature_color(const Vec3& p, const Vec3& normal) {
    const Vec3 coat(0.56f, 0.175f, 0.036f);
    const Vec3 back(0.36f, 0.095f, 0.022f);
    const Vec3 cream(0.8f, 0.7f, 0.56f);
    const Vec3 sock(0.05f, 0.031f, 0.026f);
    const Vec3 black(0.012f, 0.01f, 0.01f);
    const float noise =
        fractal_noise(40.0f * Vec2(p.z + 0.3f * p.x, p.y + 0.2f * p.x), 5, {.count = 3});
    const float ragged = 0.012f * noise;

    const bool is_tail = p.z < -0.29f;
    const float head = from(0.535f, 0.57f, p.y) * from(0.22f, 0.25f, p.z);
    Vec3 color = glm::mix(coat, back, 0.75f * from(0.25f, 0.95f, normal.y) * (1.0f - 0.6f * head));
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
    color = glm::mix(color, cream, light);
    // From the corner of the eye down the muzzle.
    const Vec3 side(std::abs(p.x), p.y, p.z);
    const Part tear = {Head, {0.043f, 0.641f, 0.372f}, {0.021f, 0.616f, 0.437f}, 0.003f, 0.003f, 0};
    color = glm::mix(color, sock, 0.65f * from(0.011f, 0.001f, part_distance(tear, side)));
    // Ears: dark behind toward the tip, lined inside.
    const float ear = from(0.7f, 0.735f, p.y);
    const float lining = ear * from(0.3f, 0.65f, normal.z + 0.3f * ragged);
    color = glm::mix(color, sock, ear * from(0.745f, 0.775f, p.y + ragged));
    color = glm::mix(color, Vec3(0.47f, 0.3f, 0.215f), lining);
    if (is_tail) {
        const float tip = from(-0.585f, -0.62f, p.z + 1.5f * ragged);
        color = glm::mix(glm::mix(color, back, 0.35f), cream, tip);
    }
    if (!is_tail) {
        const float high = std::abs(p.z) > 0.02f ? (p.z > 0 ? 0.165f : 0.15f) : 0.0f;
        color = glm::mix(color, sock, from(high + 0.02f, high - 0.02f, p.y + 1.5f * ragged));
    }
    const float nose = glm::distance(p, Vec3(0, 0.609f, 0.482f));
    color = glm::mix(color, black, from(0.019f, 0.0145f, nose));
    return color * (1.0f + 0.16f * noise);
}

Vec3 creature_eye_color(float angle) {
    const Vec3 pupil(0.004f, 0.004f, 0.004f);
    const Vec3 inner(0.62f, 0.3f, 0.05f);
    const Vec3 outer(0.3f, 0.1f, 0.015f);
    const Vec3 iris = glm::mix(inner, outer, from(0.6f, 1.05f, angle));
    return glm::mix(pupil, iris, from(0.5f, 0.62f, angle)) * from(1.35f, 1.1f, angle);
}

int creature_chart(const Vec3& p) {
    const std::array<float, kCreatureJoints> flesh = creature_flesh(p);
    const auto nearest = std::min_element(flesh.begin(), flesh.end()) - flesh.begin();
    const auto first_leg = static_cast<std::ptrdiff_t>(LeftShoulder);
    return nearest < first_leg ? 0 : static_cast<int>((nearest - first_leg) / 4) + 1;
}

Vec2 creature_chart_uv(int chart, const Vec3& place) {
    const Vec3 p = is_right(chart) ? mirrored(place) : place;
    const std::span<const Vec3> bones = chart_bones(chart);
    float best = 1e9f;
    float along = 0;
    float total = 0;
    Vec3 away(0);
    Vec3 bone(0);
    for (std::size_t i = 0; i + 1 < bones.size(); ++i) {
        const Vec3 step = bones[i + 1] - bones[i];
        const float length = glm::length(step);
        // Beyond its ends the chain goes on straight.
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
    // Around the bone from below, or from the inside of a leg.
    const Vec3 side = chart == 0 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
    const Vec3 up = glm::cross(bone, side);
    const float angle = std::atan2(glm::dot(away, side), glm::dot(away, up));
    const float u = 0.5f + angle / (2.0f * kPi);
    const float v = glm::clamp((along + 0.03f) / (total + 0.06f), 0.0f, 1.0f);
    return {is_right(chart) ? 1.0f - u : u, v};
}

Vec2 place_in_atlas(int chart, const Vec2& uv) {
    // A little room beside each, for what goes around further than once.
    const float left = chart == 0 ? 0.02f : 0.52f + 0.12f * static_cast<float>(chart - 1);
    const float width = chart == 0 ? 0.46f : 0.1f;
    return {left + width * uv.x, uv.y};
}

}  // namespace limn
