#include "content/make/head/complexion_pattern.h"

#include "content/make/head/head_layout.h"
#include "content/make/patterns/pattern_maps.h"
#include "content/make/patterns/pattern_tools.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace limn {

namespace {

// Absorbance of a unit of pigment, as of Pigments::Density.
constexpr Vec3 kMelanin = {1.52f, 1.73f, 1.87f};
constexpr Vec3 kBlood = {0.10f, 0.53f, 0.42f};
constexpr Vec3 kStubble = {1.0f, 0.9f, 0.78f};  ///< dark hair below the surface looks bluish

/// An ellipse in columns, mirrored, and rows of the head.
struct Spot {
    Vec2 center, radius;
    float weight;
};

constexpr std::array<Spot, 4> kSunny = {{
    {{13, 15}, {13, 8}, 0.8f},   // forehead
    {{22, 24}, {7, 9}, 1},       // temple
    {{17, 38}, {8, 8}, 0.9f},    // cheekbone
    {{27, 52}, {9, 10}, 0.35f},  // jaw
}};
constexpr std::array<Spot, 2> kFreckled = {{{{0, 35}, {5, 8}, 1}, {{11, 38}, {8, 7}, 1}}};
constexpr std::array<Spot, 1> kBesideNose = {{{{4.5f, 41}, {4.5f, 5}, 1}}};
constexpr std::array<Spot, 2> kOily = {{{{0, 17}, {13, 9}, 0.7f}, {{0, 36}, {5, 9}, 1}}};
constexpr std::array<Spot, 5> kBearded = {{
    {{0, 45}, {9, 3}, 0.8f},     // above the lip
    {{0, 59}, {11, 6}, 1},       // chin
    {{14, 56}, {7, 10}, 0.9f},   // beside the mouth
    {{23, 58}, {9, 7}, 0.8f},    // jaw
    {{26, 46}, {3.5f, 8}, 0.5f}  // in front of the ear
}};
constexpr std::array<Spot, 2> kBare = {{
    {{10, 29}, {7.5f, 6}, 1},    // lids
    {{0, 50}, {10.5f, 4}, 1.2f}  // lips
}};

float weight_at(std::span<const Spot> spots, const Vec2& p) {
    float weight = 0;
    for (const Spot& spot : spots) {
        const float off = glm::length((p - spot.center) / spot.radius);
        weight = std::max(weight, spot.weight * glm::smoothstep(1.15f, 0.7f, off));
    }
    return std::min(weight, 1.0f);
}

/// Round spots, one in a cell at most, in `share` of them: 1 in their center. `ragged`: how much
/// their outline wanders.
float spots_at(const Vec2& uv, int cells, float share, float ragged, std::uint32_t seed) {
    const Vec2 wander = {fbm(uv, 5 * cells, seed + 1, 2), fbm(uv, 5 * cells, seed + 2, 2)};
    const CellSample cell =
        cell_noise(uv * static_cast<float>(cells) + ragged * wander, seed, 0.8f, IVec2(cells));
    const float chance = static_cast<float>(cell.cell & 0xffffu) / 65536;
    const float size = static_cast<float>(cell.cell >> 16) / 65536;
    const float radius = glm::mix(0.13f, 0.36f, square(size));
    return chance < share ? glm::smoothstep(radius, 0.55f * radius, cell.nearest) : 0.0f;
}

}  // namespace

PatternMaps make_complexion(const ComplexionPattern& pattern) {
    constexpr int kBlotch = 16;   // per image: 2 cm
    constexpr int kPore = 230;    // 1.3 mm
    constexpr int kFreckle = 90;  // 3.4 mm
    constexpr int kAgeSpot = 30;  // 1 cm
    constexpr int kStubbles = 300;
    constexpr float kMeanBlood = 0.25f;
    constexpr float kMeanMelanin = 0.02f;
    constexpr int kBumps = 110;           // 3 mm
    constexpr float kBumpHeight = 3e-4f;  // of the width of the image: 0.1 mm
    constexpr float kCreaseHeight = 9e-4f;
    const std::uint32_t seed = seed_of(pattern.image);
    const float old = glm::smoothstep(0.25f, 1.0f, pattern.age);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 p = {std::abs(uv.x - 0.5f) * kHeadColumns, uv.y * (kHeadRows + 13) - 13};
        const float open = 1 - weight_at(kBare, p);
        const float coarse = fbm(uv, kBlotch, seed, 4, 0.6f);
        const float fine = fbm(uv, 4 * kBlotch, seed + 10, 3, 0.6f);
        const float pore = glm::smoothstep(
            0.4f, 0.1f,
            cell_noise(uv * static_cast<float>(kPore), seed + 20, 1, IVec2(kPore)).nearest);
        const float uneven = pattern.unevenness * (1 + 0.5f * old);
        float blood = std::max(kMeanBlood + uneven * (0.36f * coarse + 0.25f * fine), 0.0f);
        const float tan = 0.035f * fbm(uv, kBlotch, seed + 30, 5, 0.65f);
        float melanin = std::max(kMeanMelanin + uneven * (tan + 0.02f * open * pore), 0.0f);
        if (pattern.freckles > 0) {
            const float share = 0.75f * pattern.freckles * open * weight_at(kFreckled, p);
            melanin += 0.13f * spots_at(uv, kFreckle, share, 0.15f, seed + 40);
        }
        if (old > 0) {
            const float share = 0.42f * old * open * weight_at(kSunny, p);
            melanin += 0.2f * spots_at(uv, kAgeSpot, share, 0.4f, seed + 50)
                       + 0.1f * spots_at(uv, 2 * kAgeSpot, 0.6f * share, 0.3f, seed + 60);
            const float vessel = glm::smoothstep(0.06f, 0.0f, std::abs(fbm(uv, 40, seed + 70, 3)));
            blood += 0.7f * old * weight_at(kBesideNose, p) * vessel;
        }
        float stubble = 0;
        if (pattern.beard > 0) {
            const CellSample hair =
                cell_noise(uv * static_cast<float>(kStubbles), seed + 80, 1, IVec2(kStubbles));
            stubble = pattern.beard * open * weight_at(kBearded, p)
                      * (0.28f + 0.6f * glm::smoothstep(0.45f, 0.15f, hair.nearest))
                      * (0.8f + 0.4f * coarse);
        }
        PatternTexel t;
        t.color = glm::exp(-melanin * kMelanin - blood * kBlood - stubble * kStubble);
        const float oily = weight_at(kOily, p);
        t.roughness = std::clamp(
            0.92f + 0.06f * old - 0.14f * oily + 0.09f * fine + 0.04f * coarse, 0.0f, 1.0f);
        // Bumps of 1 to 3 mm, which break up highlights, and shallow creases of old skin.
        const float bumps = fbm(uv, kBumps, seed + 90, 3, 0.5f);
        const float creases = std::abs(fbm(uv, kBumps / 2, seed + 100, 3, 0.6f));
        t.height = (0.15f + 0.85f * open) * (kBumpHeight * bumps + old * kCreaseHeight * creases);
        return t;
    });
}

}  // namespace limn
