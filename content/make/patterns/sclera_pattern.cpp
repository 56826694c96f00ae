#include "content/make/patterns/sclera_pattern.h"

#include "content/make/patterns/flipbook.h"
#include "content/make/patterns/pattern_maps.h"
#include "content/make/patterns/pattern_tools.h"
#include "ecs/base/rng.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {

namespace {

// Lengths in radii of the ball, from its center as seen from the front.
constexpr float kIris = 0.52f;  ///< that no vessel reaches
constexpr float kEdge = 0.99f;
constexpr Vec3 kBlood = Vec3(0.78f, 0.22f, 0.2f);
constexpr Vec3 kPink = Vec3(1.0f, 0.84f, 0.8f);

struct VesselPiece {
    Vec2 from, to;
    float width;
    float blood;  ///< 0 .. 1
};

/// A vessel that winds from `at` along `heading` [rad], and its branches, each finer and shorter.
void grow_vessel(
    std::vector<VesselPiece>& pieces, Random& random, Vec2 at, float heading, float width,
    int steps) {
    constexpr float kStep = 0.035f;
    float turn = 0;
    for (int i = 0; i < steps; ++i) {
        turn = 0.55f * turn + 0.55f * (random.uniform() - 0.5f);
        const float towards = std::atan2(-at.y, -at.x);
        heading += turn + 0.12f * std::remainder(towards - heading, 2 * kPi);
        const Vec2 next = at + kStep * Vec2(std::cos(heading), std::sin(heading));
        const float away = glm::length(next);
        if (away < kIris || away > kEdge) {
            return;
        }
        const float left = 1 - static_cast<float>(i) / static_cast<float>(steps);
        const float fading = glm::smoothstep(kIris, kIris + 0.2f, away);
        pieces.push_back(
            {at, next, width * (0.35f + 0.65f * left), fading * std::min(1.0f, 2 * left)});
        if (steps > 6 && random.uniform() < 0.16f) {
            const float side = random.uniform() < 0.5f ? -0.6f : 0.6f;
            grow_vessel(pieces, random, next, heading + side, 0.6f * width, (steps - i) / 2);
        }
        at = next;
    }
}

std::vector<VesselPiece> vessels_of(const ScleraPattern& pattern) {
    Random random(seed_of(pattern.image), 0, name_hash("sclera_pattern"), 0);
    std::vector<VesselPiece> pieces;
    for (int i = 0; i < 2 * pattern.vessels; ++i) {
        const float corner = i % 2 == 0 ? 0 : kPi;
        const float spread = random.uniform() + random.uniform() - 1;
        const float angle = corner + 1.1f * spread;
        const float away = glm::mix(0.84f, 0.97f, random.uniform());
        const float width = glm::mix(0.004f, 0.012f, square(random.uniform()));
        grow_vessel(
            pieces, random, away * Vec2(std::cos(angle), std::sin(angle)),
            angle + kPi + 1.2f * (random.uniform() - 0.5f), width,
            6 + static_cast<int>(10 * random.uniform()));
    }
    return pieces;
}

/// How much blood lies at each texel: vessels thinner than a texel are fainter instead.
std::vector<float> blood_map(const ScleraPattern& pattern) {
    const int size = pattern.image.size;
    const float texel = 2 / static_cast<float>(size);
    std::vector<float> blood(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0f);
    for (const VesselPiece& piece : vessels_of(pattern)) {
        const float reach = 0.5f * piece.width + texel;
        const auto first = [&](float a, float b) {
            return std::clamp(static_cast<int>((std::min(a, b) - reach + 1) / texel), 0, size - 1);
        };
        const auto last = [&](float a, float b) {
            return std::clamp(static_cast<int>((std::max(a, b) + reach + 1) / texel), 0, size - 1);
        };
        const float strength = piece.blood * std::min(1.0f, 2 * piece.width / texel);
        for (int y = first(piece.from.y, piece.to.y); y <= last(piece.from.y, piece.to.y); ++y) {
            for (int x = first(piece.from.x, piece.to.x); x <= last(piece.from.x, piece.to.x);
                 ++x) {
                const Vec2 p = texel * (Vec2(x, y) + 0.5f) - 1.0f;
                const float off = line_distance(p, piece.from, piece.to);
                float& here = blood[static_cast<std::size_t>(y * size + x)];
                here = std::max(here, strength * glm::smoothstep(reach, 0.0f, off));
            }
        }
    }
    return blood;
}

}  // namespace

PatternMaps make_sclera(const ScleraPattern& pattern) {
    const std::vector<float> blood = blood_map(pattern);
    const int size = pattern.image.size;
    const std::uint32_t seed = seed_of(pattern.image);
    return make_pattern_maps(size, [&](const Vec2& uv) {
        const Vec2 p = 2.0f * uv - 1.0f;
        const float away = glm::length(p);
        const auto x = std::min(static_cast<int>(uv.x * static_cast<float>(size)), size - 1);
        const auto y = std::min(static_cast<int>(uv.y * static_cast<float>(size)), size - 1);
        const float corner = glm::smoothstep(0.62f, 0.95f, std::abs(p.x))
                             * glm::smoothstep(1.1f, 0.98f, away)
                             * std::clamp(0.8f + 0.7f * fbm(3.0f * p, seed, {0, 0}, 3), 0.0f, 1.0f);
        PatternTexel t;
        t.color = glm::mix(Vec3(1), kPink, std::min(2 * pattern.redness, 1.0f) * corner);
        t.color = glm::mix(
            t.color, t.color * kBlood,
            pattern.redness * blood[static_cast<std::size_t>(y * size + x)]);
        t.roughness = 0.25f;
        return t;
    });
}

}  // namespace limn
