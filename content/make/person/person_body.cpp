#include "content/make/person/person_body.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace limn {

namespace {

/// A section of a woman and a man of 1.75 m.
struct SectionKey {
    float at;  ///< height, or length along the arm
    BodySection woman;
    BodySection man;
};

constexpr std::array<SectionKey, 18> kTrunk = {{
    {0.78f, {0.168f, 0.098f, 0.105f}, {0.160f, 0.100f, 0.102f}},
    {0.84f, {0.180f, 0.102f, 0.122f}, {0.168f, 0.104f, 0.116f}},
    {0.90f, {0.183f, 0.102f, 0.126f}, {0.171f, 0.106f, 0.118f}},
    {0.96f, {0.174f, 0.102f, 0.112f}, {0.166f, 0.108f, 0.106f}},
    {1.02f, {0.154f, 0.100f, 0.094f}, {0.157f, 0.110f, 0.094f}},
    {1.08f, {0.135f, 0.097f, 0.083f}, {0.149f, 0.110f, 0.088f}},
    {1.13f, {0.131f, 0.097f, 0.082f}, {0.149f, 0.111f, 0.090f}},
    {1.19f, {0.138f, 0.101f, 0.090f}, {0.155f, 0.114f, 0.098f}},
    {1.25f, {0.146f, 0.106f, 0.100f}, {0.163f, 0.120f, 0.109f}},
    {1.30f, {0.151f, 0.106f, 0.106f}, {0.169f, 0.121f, 0.117f}},
    {1.34f, {0.158f, 0.097f, 0.108f}, {0.176f, 0.112f, 0.119f}},
    {1.38f, {0.163f, 0.083f, 0.105f}, {0.182f, 0.096f, 0.116f}},
    {1.41f, {0.158f, 0.070f, 0.100f}, {0.178f, 0.080f, 0.109f}},
    {1.435f, {0.132f, 0.058f, 0.093f}, {0.153f, 0.066f, 0.101f}},
    {1.455f, {0.095f, 0.051f, 0.085f}, {0.110f, 0.057f, 0.093f}},
    {1.475f, {0.070f, 0.047f, 0.077f}, {0.081f, 0.051f, 0.084f}},
    {1.495f, {0.060f, 0.045f, 0.072f}, {0.067f, 0.048f, 0.078f}},
    {1.52f, {0.057f, 0.041f, 0.070f}, {0.066f, 0.046f, 0.077f}},
}};

constexpr std::array<SectionKey, 14> kLeg = {{
    {0.03f, {0.034f, 0.040f, 0.046f}, {0.037f, 0.042f, 0.048f}},
    {0.09f, {0.031f, 0.036f, 0.042f}, {0.034f, 0.039f, 0.044f}},
    {0.14f, {0.031f, 0.033f, 0.040f}, {0.034f, 0.036f, 0.042f}},
    {0.20f, {0.037f, 0.034f, 0.048f}, {0.040f, 0.037f, 0.050f}},
    {0.27f, {0.047f, 0.038f, 0.062f}, {0.050f, 0.041f, 0.063f}},
    {0.34f, {0.052f, 0.041f, 0.069f}, {0.056f, 0.045f, 0.070f}},
    {0.40f, {0.051f, 0.043f, 0.063f}, {0.055f, 0.047f, 0.064f}},
    {0.45f, {0.051f, 0.049f, 0.053f}, {0.054f, 0.053f, 0.055f}},
    {0.495f, {0.053f, 0.056f, 0.050f}, {0.056f, 0.060f, 0.052f}},
    {0.54f, {0.057f, 0.060f, 0.056f}, {0.060f, 0.064f, 0.057f}},
    {0.60f, {0.066f, 0.069f, 0.066f}, {0.067f, 0.073f, 0.066f}},
    {0.68f, {0.079f, 0.079f, 0.080f}, {0.078f, 0.083f, 0.079f}},
    {0.76f, {0.089f, 0.087f, 0.094f}, {0.086f, 0.091f, 0.091f}},
    {0.84f, {0.094f, 0.092f, 0.105f}, {0.089f, 0.095f, 0.102f}},
}};

/// Along the arm: width toward the thumb and toward the back of the hand; `back` is not used. For
/// an arm with the elbow at 0.29 and the wrist at 0.545.
constexpr std::array<SectionKey, 13> kArm = {{
    {0.00f, {0.052f, 0.052f, 0}, {0.063f, 0.062f, 0}},
    {0.06f, {0.049f, 0.050f, 0}, {0.060f, 0.059f, 0}},
    {0.12f, {0.044f, 0.044f, 0}, {0.054f, 0.051f, 0}},
    {0.18f, {0.041f, 0.039f, 0}, {0.051f, 0.046f, 0}},
    {0.24f, {0.037f, 0.036f, 0}, {0.045f, 0.042f, 0}},
    {0.29f, {0.035f, 0.036f, 0}, {0.041f, 0.042f, 0}},
    {0.33f, {0.038f, 0.037f, 0}, {0.045f, 0.043f, 0}},
    {0.37f, {0.037f, 0.035f, 0}, {0.044f, 0.041f, 0}},
    {0.43f, {0.031f, 0.029f, 0}, {0.037f, 0.034f, 0}},
    {0.49f, {0.026f, 0.022f, 0}, {0.030f, 0.026f, 0}},
    {0.525f, {0.0245f, 0.0185f, 0}, {0.0285f, 0.0215f, 0}},
    {0.545f, {0.0255f, 0.0180f, 0}, {0.0295f, 0.0205f, 0}},
    {0.57f, {0.028f, 0.0175f, 0}, {0.032f, 0.0200f, 0}},
}};
constexpr float kTableElbow = 0.29f;
constexpr float kTableWrist = 0.545f;

/// A smooth curve through the keys: cubic, with the slope at a key between its neighbors.
BodySection section_at(std::span<const SectionKey> keys, float man, float at) {
    const float x = std::clamp(at, keys.front().at, keys.back().at);
    std::size_t i = 0;
    while (i + 2 < keys.size() && keys[i + 1].at <= x) {
        ++i;
    }
    const auto value = [&](std::size_t k, float BodySection::*member) {
        return std::lerp(keys[k].woman.*member, keys[k].man.*member, man);
    };
    const auto slope = [&](std::size_t k, float BodySection::*member) {
        const std::size_t a = k == 0 ? 0 : k - 1;
        const std::size_t b = std::min(k + 1, keys.size() - 1);
        return (value(b, member) - value(a, member)) / (keys[b].at - keys[a].at);
    };
    const float length = keys[i + 1].at - keys[i].at;
    const float t = (x - keys[i].at) / length;
    const auto curve = [&](float BodySection::*member) {
        const float a = value(i, member);
        const float b = value(i + 1, member);
        const float da = slope(i, member) * length;
        const float db = slope(i + 1, member) * length;
        const float t2 = t * t;
        const float t3 = t2 * t;
        return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * da + (3 * t2 - 2 * t3) * b
               + (t3 - t2) * db;
    };
    return {curve(&BodySection::width), curve(&BodySection::front), curve(&BodySection::back)};
}

float bump(float x, float width) {
    return std::exp(-square(x / width));
}

/// x^power with the sign of x.
float signed_power(float x, float power) {
    return std::copysign(std::pow(std::abs(x), power), x);
}

}  // namespace

BodySection trunk_section(const PersonFrame& frame, float height) {
    BodySection section = section_at(kTrunk, frame.man, height);
    // Fat is stored around the waist, a man's in front; lean people are slimmer all over.
    const float waist = bump(height - 1.06f, 0.14f);
    const float neck = glm::smoothstep(1.40f, 1.46f, height);
    const float heavy = std::max(frame.build, 0.0f);
    section.width *= 1 + frame.build * (0.07f + 0.10f * waist) * (1 - 0.7f * neck);
    section.front += heavy * waist * glm::mix(0.045f, 0.075f, frame.man);
    section.front *= 1 + 0.06f * frame.build * (1 - neck);
    section.back *= 1 + 0.06f * frame.build * (1 - neck);
    return section;
}

Vec3 trunk_point(
    const BodySection& section, const PersonFrame& frame, float height, float angle, float drape) {
    constexpr float kRound = 2 / 2.3f;  // a little squarer than an ellipse
    const float s = signed_power(std::sin(angle), kRound);
    const float c = signed_power(std::cos(angle), kRound);
    const float lean = glm::smoothstep(1.30f, 1.5f, height);
    const float tilt = glm::smoothstep(1.37f, 1.48f, height);
    Vec3 p(section.width * s, height, c > 0 ? section.front * c : section.back * c);
    if (angle == 0.0f || std::abs(angle - kPi) < 1e-5f) {
        p.x = 0;
    }
    p.y -= 0.030f * tilt * std::cos(angle);
    p.z += 0.006f * lean;
    const float woman = (1 - frame.man) * (1 - frame.child);
    const float fullness = 1 + 0.25f * frame.build;
    const float fall = height < 1.245f ? 0.062f + 0.07f * drape : 0.062f;
    if (c > 0) {
        const float chest = woman * 0.040f * fullness * bump(height - 1.245f, fall)
                            + frame.man * 0.009f * bump(height - 1.285f, 0.06f);
        p.z += chest * bump(std::abs(p.x) - 0.075f, 0.062f);
    } else {
        const float seat = glm::mix(0.024f, 0.016f, frame.man) * bump(height - 0.865f, 0.075f);
        p.z -= seat * bump(std::abs(p.x) - 0.08f, 0.07f);
        const float blades = 0.008f * bump(height - 1.33f, 0.07f);
        p.z -= blades * bump(std::abs(p.x) - 0.085f, 0.045f);
        const float spine = (1 - drape) * 0.008f * bump(height - 1.12f, 0.12f);
        p.z += spine * bump(p.x, 0.025f);
    }
    return p;
}

Vec3 trunk_point(const PersonFrame& frame, float height, float angle, float ease) {
    BodySection section = trunk_section(frame, height);
    section.width += ease;
    section.front += ease;
    section.back += ease;
    return trunk_point(section, frame, height, angle, 0);
}

Vec3 leg_axis(const PersonFrame& frame, float height) {
    const Vec3& hip = frame.at(SideJoint::Thigh);
    const Vec3& knee = frame.at(SideJoint::Shin);
    const Vec3& ankle = frame.at(SideJoint::Foot);
    const auto between = [&](const Vec3& high, const Vec3& low) {
        const float t = (high.y - height) / (high.y - low.y);
        Vec3 p = glm::mix(high, low, t);
        p.y = height;
        return p;
    };
    const Vec3 upper = between(hip, knee);
    const Vec3 lower = between(knee, ankle);
    return glm::mix(lower, upper, glm::smoothstep(knee.y - 0.06f, knee.y + 0.06f, height));
}

BodySection leg_section(const PersonFrame& frame, float height) {
    BodySection section = section_at(kLeg, frame.man, height);
    const float thigh = glm::smoothstep(0.3f, 0.8f, height);
    const float factor = 1 + frame.build * glm::mix(0.06f, 0.12f, thigh);
    section.width *= factor;
    section.front *= factor;
    section.back *= factor;
    return section;
}

Vec3 leg_point(const BodySection& section, const PersonFrame& frame, float height, float angle) {
    const float s = std::sin(angle);
    const float c = std::cos(angle);
    return leg_axis(frame, height)
           + Vec3(section.width * s, 0, c > 0 ? section.front * c : section.back * c);
}

ArmPlace arm_place(const PersonFrame& frame, float along) {
    const float elbow = frame.upper_arm_length;
    const float wrist = elbow + frame.forearm_length;
    const float bend = glm::smoothstep(elbow - 0.04f, elbow + 0.04f, along);
    const float turn = glm::smoothstep(wrist - 0.03f, wrist + 0.03f, along);
    const auto mix = [&](const Vec3& upper, const Vec3& fore, const Vec3& hand) {
        return glm::normalize(glm::mix(glm::mix(upper, fore, bend), hand, turn));
    };
    ArmPlace place;
    place.axes.along = mix(frame.upper_arm.along, frame.forearm.along, frame.hand.along);
    place.axes.thumb = mix(frame.upper_arm.thumb, frame.forearm.thumb, frame.hand.thumb);
    place.axes.back = glm::normalize(glm::cross(place.axes.thumb, place.axes.along));
    if (along < elbow) {
        place.center = frame.at(SideJoint::UpperArm) + along * frame.upper_arm.along;
    } else if (along < wrist) {
        place.center = frame.at(SideJoint::Forearm) + (along - elbow) * frame.forearm.along;
    } else {
        place.center = frame.at(SideJoint::Hand) + (along - wrist) * frame.hand.along;
    }
    return place;
}

Vec2 arm_radii(const PersonFrame& frame, float along) {
    const float elbow = frame.upper_arm_length;
    const float at =
        along < elbow
            ? along / elbow * kTableElbow
            : kTableElbow + (along - elbow) / frame.forearm_length * (kTableWrist - kTableElbow);
    const BodySection section = section_at(kArm, frame.man, at);
    const float upper = 1 - glm::smoothstep(0.2f, 0.5f, at);
    const float factor = 1 + frame.build * glm::mix(0.05f, 0.13f, upper);
    return factor * Vec2(section.width, section.front);
}

Vec3 arm_point(const PersonFrame& frame, float along, float angle, const Vec2& radii) {
    const ArmPlace place = arm_place(frame, along);
    const float s = std::sin(angle);
    const float c = std::cos(angle);
    Vec3 p = place.center + radii.x * c * place.axes.thumb + radii.y * s * place.axes.back;
    const float biceps = 0.006f * bump(along - 0.17f, 0.06f) * std::max(c, 0.0f);
    const float triceps = 0.006f * bump(along - 0.13f, 0.06f) * std::max(-c, 0.0f);
    const float tip = 0.006f * bump(along - frame.upper_arm_length, 0.02f) * std::max(-c, 0.0f);
    return p + (biceps - triceps - tip) * place.axes.thumb;
}

}  // namespace limn
