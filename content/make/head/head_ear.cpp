#include "content/make/head/head_ear.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

/// A ridge along a quadratic Bezier curve; backwards and up from the concha [cm].
struct Ridge {
    Vec2 a, b, c;
    float radius;  ///< half width, where exp(-1) of it remains
    float height;  ///< at a; < 0: a groove
    float end;     ///< at c
};

constexpr std::array<Ridge, 10> kRidges = {{
    // crus of the helix, out of the concha, and the helix as far as the top
    {{0.5f, 0.1f}, {-0.4f, 0.2f}, {-0.85f, 0.75f}, 0.2f, 0.06f, 0.26f},
    {{-0.85f, 0.75f}, {-1.0f, 1.6f}, {-0.55f, 2.25f}, 0.19f, 0.26f, 0.22f},
    // antihelix from the antitragus upwards; its two crura
    {{0.5f, -1.15f}, {1.15f, -0.6f}, {1.12f, 0.35f}, 0.27f, 0.2f, 0.36f},
    {{1.12f, 0.35f}, {1.1f, 1.1f}, {0.6f, 1.8f}, 0.27f, 0.36f, 0.14f},
    {{1.08f, 0.5f}, {0.75f, 1.12f}, {-0.5f, 1.12f}, 0.2f, 0.2f, 0.24f},
    // triangular fossa between them
    {{0.7f, 1.25f}, {0.35f, 1.5f}, {-0.2f, 1.6f}, 0.25f, -0.1f, -0.2f},
    // tragus, antitragus, the notch between
    {{-0.62f, -0.1f}, {-0.5f, -0.35f}, {-0.6f, -0.65f}, 0.28f, 0.24f, 0.26f},
    {{0.2f, -1.2f}, {0.35f, -1.2f}, {0.5f, -1.1f}, 0.25f, 0.2f, 0.24f},
    {{-0.3f, -0.75f}, {-0.3f, -0.95f}, {-0.34f, -1.12f}, 0.2f, -0.2f, -0.14f},
    // lobe
    {{-0.35f, -2.0f}, {0.0f, -2.15f}, {0.3f, -1.9f}, 0.62f, 0.16f, 0.16f},
}};

float ridge_height(const Ridge& ridge, const Vec2& at) {
    constexpr int kChords = 8;
    float nearest2 = 1e6f;
    float along = 0;
    Vec2 from = ridge.a;
    for (int i = 1; i <= kChords; ++i) {
        const float t = static_cast<float>(i) / kChords;
        const Vec2 to = glm::mix(glm::mix(ridge.a, ridge.b, t), glm::mix(ridge.b, ridge.c, t), t);
        const Vec2 chord = to - from;
        const float s = glm::clamp(glm::dot(at - from, chord) / glm::dot(chord, chord), 0.0f, 1.0f);
        const Vec2 offset = at - from - s * chord;
        if (glm::dot(offset, offset) < nearest2) {
            nearest2 = glm::dot(offset, offset);
            along = (static_cast<float>(i) - 1 + s) / kChords;
        }
        from = to;
    }
    return glm::mix(ridge.height, ridge.end, along) * std::exp(-nearest2 / square(ridge.radius));
}

/// 1 within an ellipse, 0 well beyond it.
float bowl(const Vec2& at, const Vec2& center, const Vec2& radii) {
    return 1 - glm::smoothstep(0.55f, 1.15f, glm::length((at - center) / radii));
}

struct EarProfile {
    float out;     ///< fraction of the outline's radius
    float height;  ///< above the plane of the ear [cm]
};

// From the head up the back of the ear; and from the cheek in front of it.
constexpr std::array<EarProfile, 6> kBack = {{
    {0.56f, -1.0f},
    {0.64f, -0.66f},
    {0.77f, -0.40f},
    {0.89f, -0.24f},
    {0.97f, -0.10f},
    {1.0f, 0.06f},
}};
constexpr std::array<float, kBack.size()> kBeforeEar = {1.36f, 1.28f, 1.2f, 1.13f, 1.06f, 1.0f};
constexpr int kFrontLoops = kEarLoops - static_cast<int>(kBack.size());

/// Fraction of the outline's radius of a loop on the front: closer together over the helix.
float front_radius(int loop) {
    const float t = static_cast<float>(loop - static_cast<int>(kBack.size())) / kFrontLoops;
    return 1 - 0.9f * t * (0.62f + 0.38f * t);
}

/// How much the ear at `angle` merges into the cheek, 0 .. 1.
float cheek_weight(float angle) {
    const float up = std::sin(angle);
    return glm::smoothstep(-0.1f, -0.7f, std::cos(angle))
           * (1 - 0.8f * glm::smoothstep(0.55f, 0.9f, up))
           * (1 - 0.8f * glm::smoothstep(-0.6f, -0.97f, up));
}

}  // namespace

float ear_outline(float angle) {
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    const Vec2 radii = {c > 0 ? 1.95f : 1.2f, s > 0 ? 2.85f : 2.95f};
    const float lobe =
        1 - 0.2f * glm::smoothstep(-0.2f, -0.75f, s) * glm::smoothstep(0.0f, 0.6f, c);
    return lobe / std::sqrt(square(c / radii.x) + square(s / radii.y));
}

float ear_relief(const Vec2& at) {
    const float angle = std::atan2(at.y, at.x);
    const float radius = glm::length(at) / ear_outline(angle);
    // The helix follows the outline from the top to the lobe; the scapha runs inside it.
    const float lobe = glm::smoothstep(-0.35f, -0.8f, std::sin(angle));
    const float front = glm::smoothstep(-0.2f, -0.75f, std::cos(angle))
                        * (1 - glm::smoothstep(0.75f, 0.95f, std::sin(angle)));
    const float free = (1 - lobe) * (1 - front);
    float height = 0.26f * free * std::exp(-square((radius - 0.955f) / 0.055f));
    height -= 0.12f * free * std::exp(-square((radius - 0.82f) / 0.075f));
    height += 0.06f * lobe;
    height -= 0.62f * bowl(at, {0.18f, -0.32f}, {0.95f, 0.95f});
    height -= 0.42f * bowl(at, {0.35f, 0.62f}, {0.85f, 0.5f});
    // A smooth maximum of the ridges: where they meet, as at the top of the antihelix, a sum would
    // spike.
    float raised = 0;
    for (const Ridge& ridge : kRidges) {
        const float own = ridge_height(ridge, at);
        height += std::min(own, 0.0f);
        raised += square(square(std::max(own, 0.0f)));
    }
    return height + std::sqrt(std::sqrt(raised));
}

Vec3 ear_point(const HeadVertex& vertex, const Vec3& root) {
    constexpr float kLean = 0.28f;  // [rad]
    const Vec3 up = glm::normalize(Vec3(0.10f, std::cos(kLean), -std::sin(kLean)));
    const Vec3 back =
        glm::normalize(Vec3(0.48f, -std::sin(kLean) * 0.88f, -std::cos(kLean) * 0.88f));
    const Vec3 out = glm::normalize(glm::cross(back, up));
    const Vec2 direction = {std::cos(vertex.angle), std::sin(vertex.angle)};
    const auto loop = static_cast<std::size_t>(vertex.loop);
    const bool behind = loop <= kBack.size();
    const float cheek = behind ? cheek_weight(vertex.angle) : 0;
    const float out_radius = behind ? glm::mix(kBack[loop - 1].out, kBeforeEar[loop - 1], cheek)
                                    : front_radius(vertex.loop);
    const Vec2 at = out_radius * ear_outline(vertex.angle) * direction;
    const float height = behind ? glm::mix(kBack[loop - 1].height, 0.1f, cheek) : ear_relief(at);
    return root + at.x * back + at.y * up + height * out;
}

float ear_on_cheek(const HeadVertex& vertex) {
    const float inner = vertex.loop <= static_cast<int>(kBack.size())
                            ? 1
                            : glm::smoothstep(0.72f, 0.95f, front_radius(vertex.loop));
    return inner * cheek_weight(vertex.angle);
}

}  // namespace limn
