#include "content/make/person/person_cloth.h"

#include "content/make/person/person_parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {

namespace {

constexpr float kChestLine = 1.26f;  ///< cloth hangs from here
constexpr float kHipLine = 0.91f;

/// Between body and cloth [m].
float ease_of(PersonTop top) {
    switch (top) {
    case PersonTop::Jumper:
        return 0.016f;
    case PersonTop::Coat:
        return 0.024f;
    case PersonTop::Tee:
        return 0.011f;
    default:
        return 0.013f;
    }
}

BodySection shirt_section(const PersonFrame& frame, float height) {
    const PersonTop top = frame.look.shape.top;
    const BodySection body = trunk_section(frame, std::max(height, 0.86f));
    const float neck = glm::smoothstep(1.40f, 1.47f, height);
    const float ease = ease_of(top);
    const BodySection close = grown(body, std::lerp(ease, 0.003f, neck));
    if (height > kChestLine) {
        return close;
    }
    const float t = std::min((kChestLine - height) / (kChestLine - kHipLine), 1.0f);
    const BodySection straight =
        grown(mixed(trunk_section(frame, kChestLine), trunk_section(frame, kHipLine), t), ease);
    BodySection hanging = mixed(close, larger(close, straight), 0.65f);
    hanging = grown(hanging, 0.006f * glm::smoothstep(0.3f, 1.0f, t));
    if (frame.look.tucked) {  // drawn in below the waistband, full above it
        const float in = 1 - glm::smoothstep(0.99f, 1.035f, height);
        return mixed(hanging, grown(body, 0.003f), in);
    }
    const float hem = shirt_hem(frame);
    if (top == PersonTop::Jumper) {  // a band of ribs holds it
        const float band = 1 - glm::smoothstep(hem + 0.045f, hem + 0.065f, height);
        return mixed(hanging, grown(body, 0.015f), 0.8f * band);
    }
    return grown(hanging, 0.05f * std::max(0.90f - height, 0.0f));
}

}  // namespace

float cloth_angle(int column) {
    return kPi * static_cast<float>(column) / kHalfColumns;
}

Vec3 curve_point(const Vec3& a, const Vec3& da, const Vec3& b, const Vec3& db, float t) {
    const float t2 = t * t;
    const float t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * da + (3 * t2 - 2 * t3) * b
           + (t3 - t2) * db;
}

BodySection grown(const BodySection& section, float ease) {
    return {section.width + ease, section.front + ease, section.back + ease};
}

BodySection larger(const BodySection& a, const BodySection& b) {
    return {std::max(a.width, b.width), std::max(a.front, b.front), std::max(a.back, b.back)};
}

BodySection mixed(const BodySection& a, const BodySection& b, float t) {
    return {
        std::lerp(a.width, b.width, t), std::lerp(a.front, b.front, t),
        std::lerp(a.back, b.back, t)};
}

float shirt_hem(const PersonFrame& frame) {
    if (frame.look.tucked) {
        return 0.985f;
    }
    return frame.look.shape.top == PersonTop::Coat ? 0.70f - frame.look.shirt_length
                                                   : kHipLine + 0.012f - frame.look.shirt_length;
}

std::vector<float> shirt_rows(const PersonFrame& frame) {
    const float hem = shirt_hem(frame);
    std::vector<float> heights = {hem, hem + 0.008f};
    for (const float height :
         {0.69f, 0.745f, 0.80f,  0.86f,  0.925f, 0.955f, 0.985f, 1.012f,   1.04f,
          1.07f, 1.10f,  1.13f,  1.16f,  1.19f,  1.215f, 1.24f,  1.265f,   1.29f,
          1.32f, 1.352f, 1.384f, 1.412f, 1.432f, 1.449f, 1.464f, kShirtTop}) {
        if (height > heights.back() + 0.005f) {
            heights.push_back(height);
        }
    }
    return heights;
}

float neckline_drop(const PersonFrame& frame, float height, float angle) {
    const float ramp = glm::smoothstep(1.40f, 1.49f, height);
    const float front = square(0.5f + 0.5f * std::cos(angle));
    const float woman = 1 - frame.man;
    // Necks of children are short: all around below the jaw.
    const float low = 0.024f * frame.infant * ramp;
    switch (frame.look.shape.top) {
    case PersonTop::Tee:
        return low + (0.030f + 0.014f * woman) * ramp * front;
    case PersonTop::Shirt:
    case PersonTop::Coat:
        return low + 0.020f * ramp * front;
    default:
        return low + 0.014f * ramp * front;
    }
}

Vec3 shirt_point(const PersonFrame& frame, float height, float angle, float grow) {
    const float at = height - neckline_drop(frame, height, angle);
    Vec3 p =
        trunk_point(grown(shirt_section(frame, at), grow), frame, std::max(at, 0.86f), angle, 1);
    p.y -= std::max(0.86f - at, 0.0f);
    return p;
}

Vec3 waist_point(const PersonFrame& frame, float height, float angle, float grow) {
    const bool belted = frame.look.shape.legs != PersonLegwear::Dress;
    const float belt = height > 0.984f && belted ? 0.003f : 0.0f;
    const BodySection section = grown(trunk_section(frame, height), 0.0065f + belt + grow);
    return trunk_point(section, frame, height, angle, 0);
}

PersonHems person_hems(const PersonFrame& frame) {
    PersonHems hems;
    const bool is_long = frame.look.shape.sleeves == PersonSleeves::Long;
    const float wrist = frame.upper_arm_length + frame.forearm_length;
    hems.sleeve = is_long ? wrist + 0.004f : 0.225f;
    switch (frame.look.shape.legs) {
    case PersonLegwear::Shorts:
        hems.leg = 0.55f;
        break;
    case PersonLegwear::Skirt:
        hems.leg = 0.53f;
        break;
    case PersonLegwear::Dress:
        hems.leg = 0.44f;
        break;
    default:
        hems.leg = 0.036f;
    }
    return hems;
}

}  // namespace limn
