#include "content/make/head/face_fold_pattern.h"

#include "content/make/head/head_layout.h"
#include "content/make/patterns/noise.h"
#include "content/make/patterns/pattern_tools.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

// Techniques: wrinkle.dimples

namespace limn {

namespace {

constexpr float kMm = 1 / 3.0f;  ///< a millimeter in columns or rows of the layout, in front

/// A crease: a quadratic Bezier curve in columns and rows, on the left half of the face.
struct Crease {
    Vec2 a, b, c;
    float width;  ///< from its valley to its crests
    float depth;
};

// Positions, spacings and widths after anatomy: face_regions.h.
constexpr Crease kCreases[] = {
    // forehead: over the brows towards the temples, unevenly spaced; shorter ones in between, and
    // branches of a long one
    {{0, 11.5f}, {7.0f, 10.9f}, {13.0f, 13.0f}, 0.7f, 0.15f},
    {{0, 15.0f}, {8.0f, 13.9f}, {16.5f, 17.6f}, 0.95f, 0.29f},
    {{0, 17.4f}, {7.5f, 16.4f}, {16.5f, 20.9f}, 0.8f, 0.23f},
    {{3.4f, 19.9f}, {7.6f, 18.6f}, {14.5f, 22.3f}, 0.75f, 0.20f},
    {{3.4f, 12.8f}, {6.4f, 12.2f}, {9.2f, 13.0f}, 0.45f, 0.08f},
    {{4.4f, 14.5f}, {9.0f, 12.9f}, {14.5f, 14.6f}, 0.55f, 0.13f},
    {{6.4f, 17.0f}, {10.0f, 18.2f}, {14.0f, 18.6f}, 0.5f, 0.11f},
    // glabella and root of the nose
    {{2.7f, 20.6f}, {1.2f, 23.2f}, {2.0f, 27.4f}, 1.0f, 0.26f},
    {{4.6f, 22.2f}, {3.6f, 23.6f}, {3.7f, 25.8f}, 0.7f, 0.11f},
    {{0, 27.6f}, {1.2f, 27.8f}, {2.9f, 29.4f}, 1.1f, 0.09f},
    {{0, 29.4f}, {1.1f, 29.5f}, {2.3f, 30.8f}, 0.6f, 0.08f},
    // crow's feet: a fan from the outer corner of the eye
    {{14.6f, 27.8f}, {16.4f, 26.0f}, {18.8f, 23.2f}, 0.8f, 0.15f},
    {{14.9f, 28.9f}, {17.2f, 28.3f}, {20.6f, 27.2f}, 0.9f, 0.20f},
    {{14.7f, 30.1f}, {16.8f, 31.1f}, {19.6f, 33.0f}, 0.85f, 0.17f},
    {{16.6f, 30.0f}, {18.4f, 30.2f}, {20.6f, 30.4f}, 0.5f, 0.07f},
    // lower lid
    {{6.4f, 31.4f}, {9.8f, 33.2f}, {13.0f, 31.6f}, 0.35f, 0.10f},
    {{6.0f, 32.2f}, {9.4f, 34.9f}, {13.4f, 32.8f}, 0.4f, 0.13f},
    {{6.0f, 33.4f}, {8.6f, 36.4f}, {12.4f, 35.4f}, 0.5f, 0.12f},
    // inner corner of the eye
    {{5.8f, 31.0f}, {4.9f, 31.9f}, {3.8f, 33.6f}, 0.5f, 0.12f},
    {{6.3f, 32.0f}, {5.7f, 33.2f}, {4.9f, 35.0f}, 0.55f, 0.08f},
    {{5.3f, 30.1f}, {4.5f, 30.6f}, {3.5f, 31.7f}, 0.4f, 0.06f},
    // side of the nose
    {{1.8f, 33.6f}, {3.0f, 32.8f}, {4.3f, 31.2f}, 0.6f, 0.14f},
    {{1.8f, 35.6f}, {3.0f, 34.8f}, {4.3f, 33.3f}, 0.75f, 0.12f},
    // outside the corner of the mouth
    {{14.6f, 45.6f}, {16.2f, 49.2f}, {14.9f, 53.4f}, 1.5f, 0.06f},
    // upper lip, from its border upwards, with uneven lengths and spacing
    {{0.8f, 46.4f}, {0.8f, 45.3f}, {0.9f, 44.1f}, 0.5f, 0.06f},
    {{1.8f, 46.6f}, {2.0f, 44.8f}, {2.1f, 42.8f}, 0.6f, 0.07f},
    {{3.1f, 46.6f}, {3.4f, 45.3f}, {3.7f, 44.0f}, 0.5f, 0.06f},
    {{4.0f, 47.0f}, {4.6f, 45.1f}, {5.0f, 43.2f}, 0.65f, 0.06f},
    {{5.3f, 47.2f}, {6.0f, 45.8f}, {6.6f, 44.6f}, 0.55f, 0.06f},
    // below the lower lip: short ones that radiate from the mouth, and the furrow above the chin
    {{0.9f, 53.6f}, {1.0f, 54.8f}, {0.9f, 56.2f}, 0.8f, 0.045f},
    {{2.7f, 52.6f}, {3.1f, 54.6f}, {3.1f, 57.0f}, 1.0f, 0.085f},
    {{4.6f, 52.5f}, {5.1f, 54.0f}, {5.4f, 55.4f}, 0.8f, 0.055f},
    {{0, 55.2f}, {3.4f, 55.4f}, {6.6f, 53.6f}, 1.2f, 0.06f},
};

constexpr std::size_t kForehead = 7;      ///< of the creases, which come first
constexpr std::size_t kBesideMouth = 23;  ///< index of the crease outside the corner of the mouth

bool has_crease(FaceFoldSet set, std::size_t crease) {
    return set == FaceFoldSet::All
           || (set == FaceFoldSet::Stretched) == (crease < kForehead || crease == kBesideMouth);
}

/// Nasolabial fold and marionette line: the cheek hangs over them.
constexpr Crease kOverhangs[] = {
    {{4.8f, 36.4f}, {9.2f, 41.2f}, {10.6f, 53.0f}, 1.4f, 0.32f},
    {{4.8f, 51.8f}, {7.6f, 53.5f}, {10.4f, 55.0f}, 1.4f, 0.14f},
};

/// The nearest point of a crease.
struct CreasePoint {
    float distance = 1e6f;
    float along = 0;     ///< 0 .. 1
    bool right = false;  ///< right of the curve from `a` to `c`, with rows downwards
};

/// On the curve itself, not on chords, whose corners would show as lines across the crease.
CreasePoint nearest_on(const Crease& crease, const Vec2& p) {
    constexpr int kGuesses = 8;
    constexpr int kNewtonSteps = 3;
    const Vec2 to_b = crease.b - crease.a;
    const Vec2 bend = crease.c - crease.b - to_b;
    const auto offset_at = [&](float t) { return p - crease.a - t * (2.0f * to_b + t * bend); };
    float t = 0;
    float least = 1e12f;
    for (int i = 0; i <= kGuesses; ++i) {
        const float guess = static_cast<float>(i) / kGuesses;
        const Vec2 offset = offset_at(guess);
        if (glm::dot(offset, offset) < least) {
            least = glm::dot(offset, offset);
            t = guess;
        }
    }
    // A crease that crosses the midline of the face continues beyond it.
    const float start = crease.a.x == 0 ? -0.2f : 0.0f;
    for (int i = 0; i < kNewtonSteps; ++i) {
        const Vec2 tangent = 2.0f * (to_b + t * bend);
        const Vec2 offset = offset_at(t);
        const float slope = glm::dot(tangent, tangent) - 2 * glm::dot(offset, bend);
        const float step =
            glm::dot(offset, tangent) / std::max(slope, 0.25f * glm::dot(tangent, tangent));
        t = glm::clamp(t + step, start, 1.0f);
    }
    const Vec2 tangent = to_b + t * bend;
    const Vec2 offset = offset_at(t);
    return {glm::length(offset), std::max(t, 0.0f), tangent.x * offset.y > tangent.y * offset.x};
}

/// 0 at the ends of a crease, 1 at its center; one that crosses the midline of the face has no end
/// there.
float crease_taper(const Crease& crease, float along) {
    const float start = crease.a.x == 0 ? 1 : glm::smoothstep(0.0f, 0.35f, along);
    return start * (1 - glm::smoothstep(0.45f, 1.0f, along));
}

/// Factor of the depth of a crease: on real faces, long creases are broken into pieces.
float crease_pieces(const Vec2& uv, std::uint32_t seed) {
    return glm::mix(0.3f, 1.0f, glm::smoothstep(-0.5f, 0.1f, fbm(uv, 9, seed, 2)));
}

/// |x|, but smooth: lines that cross the midline of the face have no kink there.
float mirrored(float x) {
    constexpr float kWidth = 2;  // columns
    const float left = std::abs(x);
    return left < kWidth ? left * left * (2 * kWidth - left) / square(kWidth) : left;
}

constexpr float kCreaseExtent = 4.5f;  ///< of a crease in widths

bool is_near(const Crease& crease, const Vec2& p) {
    const Vec2 low =
        glm::min(crease.a, glm::min(crease.b, crease.c)) - kCreaseExtent * crease.width;
    const Vec2 high =
        glm::max(crease.a, glm::max(crease.b, crease.c)) + kCreaseExtent * crease.width;
    return p.x >= low.x && p.y >= low.y && p.x <= high.x && p.y <= high.y;
}

/// The height at `p` of a crease with the profile `height(d, right)`, d: distance in widths. It
/// gets thinner and fades towards its ends.
template <typename Profile>
float height_of(const Crease& crease, const Vec2& p, Profile&& height) {
    if (!is_near(crease, p)) {
        return 0;
    }
    const CreasePoint at = nearest_on(crease, p);
    const float taper = crease_taper(crease, at.along);
    const float d = at.distance / (crease.width * (0.55f + 0.45f * taper));
    return crease.depth * taper * height(d, at.right);
}

/// A narrow valley between round crests.
float crease_height(const Crease& crease, const Vec2& p) {
    return height_of(crease, p, [](float d, bool) {
        return 0.45f * std::exp(-square(d - 1.0f)) - std::exp(-square(1.6f * d));
    });
}

/// A step from a broad bulge down to flat skin on its right side, by a valley. Both sides meet.
float overhang_height(const Crease& crease, const Vec2& p) {
    return height_of(crease, p, [](float d, bool right) {
        const float bulge = right ? 0.0f : 0.62f * square(d) * std::exp(-square(d / 1.4f));
        return bulge - std::exp(-square(1.2f * d));
    });
}

/// Pits 2 to 4 mm wide, as of a golf ball, where skin is drawn inwards in points.
float dimple_height(const Vec2& p, std::uint32_t seed) {
    constexpr float kSpacing = 1.15f;  // columns
    const Vec2 at =
        p / kSpacing + 0.5f * Vec2(fbm(p / 40.0f, 40, seed), fbm(p / 40.0f, 40, seed + 1));
    const CellSample cell = cell_noise(at, seed, 1);
    const float depth = 0.25f + 0.75f * static_cast<float>(cell.cell & 255u) / 255;
    return -depth * std::exp(-square(cell.nearest / (0.3f + 0.2f * depth)));
}

}  // namespace

PatternMaps make_face_folds(const FaceFoldsPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_wrinkle_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 chart = {(uv.x - 0.5f) * kHeadColumns, uv.y * (kHeadRows + 13) - 13};
        // No octave near the size of a texel, which would show as hatching.
        const Vec2 bend = {fbm(uv, 23, seed, 2), fbm(uv, 23, seed + 1, 2)};
        const Vec2 sway = {fbm(uv, 7, seed + 3, 2), fbm(uv, 7, seed + 4, 2)};
        Vec2 p = chart + pattern.wander * kMm * (2.0f * bend + 3.0f * sway);
        p.x = mirrored(p.x);
        float height = 0;
        std::uint32_t number = seed + 6;
        for (std::size_t i = 0; i < std::size(kCreases); ++i) {
            const bool has = has_crease(pattern.folds, i);
            const float own = has ? crease_height(kCreases[i], p) : 0.0f;
            height += own != 0 ? own * crease_pieces(uv, number) : 0.0f;
            ++number;
        }
        for (const Crease& crease : kOverhangs) {
            height += pattern.folds != FaceFoldSet::Stretched ? overhang_height(crease, p) : 0.0f;
        }
        // The depth of a fold varies along it, and between both sides of the face.
        height *= height != 0 ? 1 + 0.9f * fbm(uv, 13, seed + 5, 2) : 1;
        const float chin =
            pattern.folds == FaceFoldSet::Stretched
                ? 0.0f
                : 1
                      - glm::smoothstep(
                          0.4f, 1.0f, glm::length((p - Vec2(0, 59)) / Vec2(6.5f, 3.8f)));
        height += chin > 0 ? chin * 0.16f * dimple_height(chart, seed + 2) : 0.0f;
        PatternTexel t;
        t.height = pattern.depth * height / kHeadColumns;
        return t;
    });
}

}  // namespace limn
