#include "content/make/head/head_parts.h"
#include "content/make/head/head_surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

constexpr Vec3 kEnamel = {1.0f, 0.97f, 0.9f};
constexpr Vec3 kGum = {0.80f, 0.36f, 0.34f};
constexpr Vec3 kTongue = {0.85f, 0.42f, 0.40f};

/// From the midline backwards [cm]: incisors, canine, premolars, molars (R. Nelson, "Wheeler's
/// Dental Anatomy", 2015).
struct Tooth {
    float width, height, depth;
};
constexpr std::array<Tooth, 7> kUpperTeeth = {{
    {0.85f, 1.05f, 0.55f},
    {0.65f, 0.92f, 0.5f},
    {0.75f, 1.0f, 0.65f},
    {0.7f, 0.85f, 0.85f},
    {0.7f, 0.8f, 0.85f},
    {1.0f, 0.75f, 1.0f},
    {0.9f, 0.72f, 1.0f},
}};
constexpr std::array<Tooth, 7> kLowerTeeth = {{
    {0.52f, 0.9f, 0.5f},
    {0.58f, 0.92f, 0.5f},
    {0.68f, 1.02f, 0.62f},
    {0.7f, 0.85f, 0.75f},
    {0.7f, 0.82f, 0.8f},
    {1.1f, 0.75f, 1.0f},
    {1.05f, 0.72f, 1.0f},
}};

struct Jaw {
    const std::array<Tooth, 7>& teeth;
    float edge;   ///< y of the cutting edge
    float side;   ///< 1: upper teeth, -1: lower teeth
    float front;  ///< z of the first teeth
    float width;  ///< half the width of the arch
    float depth;  ///< semi-axis of its ellipse along z
    float bound;  ///< 0: to the skull, 1: to the jaw
};
const std::array<Jaw, 2> kJaws = {{
    {kUpperTeeth, -3.72f, 1, 10.40f, 2.75f, 4.3f, 0},
    {kLowerTeeth, -3.55f, -1, 10.10f, 2.55f, 4.1f, 1},
}};

/// A point of the arch at the parameter `turn` of its ellipse.
Vec3 arch_point(const Jaw& jaw, float turn, float inwards) {
    return {
        (jaw.width - inwards) * std::sin(turn), 0,
        jaw.front - inwards - (jaw.depth - inwards) * (1 - std::cos(turn))};
}

/// The parameter of the arch's ellipse at this arc length from the midline.
float arch_turn(const Jaw& jaw, float length) {
    float turn = 0;
    Vec3 from = arch_point(jaw, 0, 0);
    for (float arc = 0; arc < length && turn < 1.5f; turn += 0.004f) {
        const Vec3 to = arch_point(jaw, turn + 0.004f, 0);
        arc += glm::distance(from, to);
        from = to;
    }
    return turn;
}

float rounded(float x, float power) {
    return std::copysign(std::pow(std::abs(x), power), x);
}

void append(
    HeadPart& part, const HeadPoint& point, const Vec3& color, const Vec2& uv, float alpha = 1) {
    part.mesh.positions.push_back(point.rest);
    part.mesh.colors.emplace_back(color, alpha);
    part.mesh.uvs.push_back(uv);
    part.points.push_back(point);
}

/// Share of the surroundings that a point of a tooth sees in an open mouth: the front teeth most,
/// at their edges; cheeks hide the molars, lips the roots.
float tooth_opening(const Jaw& jaw, const Vec3& p, float root) {
    const float back = glm::smoothstep(0.2f, 2.4f, jaw.front - p.z);
    return glm::mix(0.95f, 0.08f, back) * glm::mix(1.0f, 0.55f, glm::smoothstep(0.3f, 1.0f, root));
}

/// A box with rounded edges, narrower and thicker at its root.
void append_tooth(HeadPart& part, const Jaw& jaw, const Tooth& tooth, float along, float side) {
    constexpr std::uint32_t kAround = 16;
    constexpr std::uint32_t kRows = 9;
    const float turn = arch_turn(jaw, along);
    const Vec3 center = arch_point(jaw, turn, 0.5f * tooth.depth);
    const Vec3 ahead =
        glm::normalize(Vec3((jaw.width) * std::cos(turn), 0, -jaw.depth * std::sin(turn)));
    const Vec3 out = {-ahead.z, 0, ahead.x};
    for (std::uint32_t row = 0; row < kRows; ++row) {
        const float polar = kPi * static_cast<float>(row) / (kRows - 1);
        const float down = rounded(std::cos(polar), 0.55f);
        const float ring = std::max(rounded(std::sin(polar), 0.25f), 0.01f);
        const float root = 0.5f + 0.5f * down;
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / kAround;
            const float across = 0.502f * tooth.width * ring * rounded(std::cos(angle), 0.4f)
                                 * (1 - 0.16f * square(root));
            const float through = 0.5f * tooth.depth * ring * rounded(std::sin(angle), 0.45f)
                                  * (0.55f + 0.45f * root);
            Vec3 p = center + across * ahead + through * out;
            p.y = jaw.edge + jaw.side * tooth.height * root;
            p.x *= side;
            const Vec3 tint = glm::mix(kEnamel, kEnamel * Vec3(0.92f, 0.84f, 0.68f), root);
            const float open = tooth_opening(jaw, p, root);
            // What lights a tooth from behind lips and cheeks is red.
            const Vec3 light = {1, glm::mix(0.8f, 1.0f, open), glm::mix(0.72f, 1.0f, open)};
            append(
                part, bone_point(p, jaw.bound), tint * light * glm::mix(0.35f, 1.0f, open),
                {static_cast<float>(i) / kAround, static_cast<float>(row) / kRows},
                kSkinCavity * open);
        }
    }
    append_grid(part.mesh, kRows, kAround, true, side * jaw.side < 0);
}

/// How much higher the gum is at this arc length from the midline than at the middle of a tooth:
/// between two teeth it fills the gap.
float papilla(const Jaw& jaw, float length) {
    constexpr float kRise = 0.2f;  // [cm]
    float from = 0;
    for (const Tooth& tooth : jaw.teeth) {
        if (length < from + tooth.width) {
            return kRise * square(square(2 * (length - from) / tooth.width - 1));
        }
        from += tooth.width;
    }
    return 0;
}

/// A ridge along the roots of the teeth, with a bulge at each.
void append_gum(HeadPart& part, const Jaw& jaw) {
    constexpr std::uint32_t kColumns = 121;
    constexpr std::uint32_t kRows = 9;
    std::array<float, kColumns> rise{};
    for (std::uint32_t i = 0; i < kColumns; ++i) {
        const float turn = 1.42f * std::abs(2 * static_cast<float>(i) / (kColumns - 1) - 1);
        float length = 0;
        for (int step = 0; step < 64; ++step) {
            length += glm::distance(
                arch_point(jaw, turn * static_cast<float>(step) / 64, 0),
                arch_point(jaw, turn * static_cast<float>(step + 1) / 64, 0));
        }
        rise[i] = papilla(jaw, length);
    }
    for (std::uint32_t row = 0; row < kRows; ++row) {
        // From the root outside over the edge of the gum to the inside.
        const float around = kPi * static_cast<float>(row) / (kRows - 1);
        for (std::uint32_t i = 0; i < kColumns; ++i) {
            const float along = 2 * static_cast<float>(i) / (kColumns - 1) - 1;
            const float thick = 0.36f - 0.02f * std::abs(along);
            Vec3 p = arch_point(jaw, 1.42f * along, 0.33f - thick * std::cos(around));
            p.y = jaw.edge
                  + jaw.side
                        * (1.45f
                           - (0.56f + rise[i]) * std::pow(std::max(std::sin(around), 0.0f), 0.6f)
                           - 0.1f * std::abs(along));
            append(part, bone_point(p, jaw.bound), kGum, {along, around});
        }
    }
    append_grid(part.mesh, kRows, kColumns, false, jaw.side > 0);
}

void append_tongue(HeadPart& part) {
    constexpr std::uint32_t kAround = 24;
    constexpr std::uint32_t kRows = 20;
    for (std::uint32_t row = 0; row < kRows; ++row) {
        const float t = static_cast<float>(row) / (kRows - 1);
        const float taper = std::sqrt(std::max(1 - square(square(t)), 0.0001f));
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / kAround;
            const float groove = 0.09f * std::exp(-square(std::cos(angle) / 0.25f));
            Vec3 p = {1.75f * taper * rounded(std::cos(angle), 0.8f), 0, 5.2f + 4.45f * t};
            p.y = -4.05f - 0.2f * t + 0.35f * std::sin(kPi * t)
                  + taper * (std::sin(angle) > 0 ? 0.42f - groove : 0.6f) * std::sin(angle);
            HeadPoint point = bone_point(p, 1);
            point.tongue = t;
            append(part, point, kTongue, {static_cast<float>(i) / kAround, t});
        }
    }
    append_grid(part.mesh, kRows, kAround, true);
}

}  // namespace

HeadPart make_teeth() {
    HeadPart part;
    part.mesh.name = "teeth";
    for (const Jaw& jaw : kJaws) {
        for (const float side : {1.0f, -1.0f}) {
            float along = 0;
            for (const Tooth& tooth : jaw.teeth) {
                append_tooth(part, jaw, tooth, along + 0.5f * tooth.width, side);
                along += tooth.width;
            }
        }
    }
    return part;
}

HeadPart make_mouth() {
    HeadPart part;
    part.mesh.name = "mouth";
    for (const Jaw& jaw : kJaws) {
        append_gum(part, jaw);
    }
    append_tongue(part);
    return part;
}

}  // namespace limn
