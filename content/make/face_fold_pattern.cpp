#include "content/make/face_fold_pattern.h"

#include "content/make/head_layout.h"
#include "content/make/noise.h"
#include "content/make/pattern_tools.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr float kMm = 1 / 3.0f;  ///< a millimeter in columns or rows of the layout, in front

/// A crease: a quadratic Bezier curve in columns and rows, on the left half of the face.
struct Crease {
    Vec2 a, b, c;
    float width;  ///< from its valley to its crests
    float depth;
};

// Places, spacings and widths after anatomy: face_regions.h.
constexpr Crease kCreases[] = {
    // forehead: over the brows towards the temples, unevenly spaced; shorter ones between, and
    // branches that leave a long one
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
    {{0, 27.6f}, {1.2f, 27.8f}, {2.9f, 29.4f}, 0.8f, 0.12f},
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
    // side of the nose
    {{1.9f, 33.6f}, {3.0f, 32.8f}, {4.3f, 31.2f}, 0.45f, 0.14f},
    {{1.9f, 35.4f}, {3.1f, 34.6f}, {4.5f, 33.0f}, 0.45f, 0.14f},
    // nasolabial fold, outside the corner of the mouth, marionette line
    {{5.0f, 37.0f}, {8.8f, 42.0f}, {9.0f, 51.6f}, 1.1f, 0.55f},
    {{10.6f, 45.0f}, {11.8f, 48.0f}, {11.4f, 52.0f}, 0.7f, 0.18f},
    {{7.4f, 51.0f}, {8.6f, 54.0f}, {8.0f, 59.0f}, 0.8f, 0.28f},
    // upper lip, of uneven lengths and distances
    {{0.9f, 44.3f}, {0.8f, 45.0f}, {0.8f, 45.9f}, 0.4f, 0.06f},
    {{2.1f, 43.2f}, {2.0f, 44.4f}, {1.8f, 45.8f}, 0.45f, 0.10f},
    {{3.7f, 44.2f}, {3.4f, 45.0f}, {3.1f, 45.9f}, 0.35f, 0.07f},
    {{5.0f, 43.6f}, {4.6f, 44.9f}, {4.0f, 46.2f}, 0.45f, 0.11f},
    {{6.6f, 44.8f}, {6.0f, 45.6f}, {5.3f, 46.5f}, 0.4f, 0.07f},
    // below the lower lip: short ones that radiate from the mouth, and the furrow above the chin
    {{1.2f, 53.5f}, {1.3f, 54.6f}, {1.2f, 55.6f}, 0.55f, 0.08f},
    {{2.9f, 53.2f}, {3.2f, 54.8f}, {3.2f, 56.4f}, 0.7f, 0.13f},
    {{4.9f, 52.7f}, {5.3f, 53.8f}, {5.5f, 55.0f}, 0.55f, 0.10f},
    {{0, 55.2f}, {3.4f, 55.4f}, {6.6f, 53.6f}, 1.1f, 0.06f},
};

/// The distance to a crease, 0 .. 1 along it at the nearest place.
Vec2 nearest_on(const Crease& crease, const Vec2& p) {
    constexpr int kChords = 8;
    Vec2 nearest = {1e6f, 0};
    Vec2 from = crease.a;
    for (int i = 1; i <= kChords; ++i) {
        const float t = static_cast<float>(i) / kChords;
        const Vec2 to =
            glm::mix(glm::mix(crease.a, crease.b, t), glm::mix(crease.b, crease.c, t), t);
        const Vec2 chord = to - from;
        const float s = glm::clamp(glm::dot(p - from, chord) / glm::dot(chord, chord), 0.0f, 1.0f);
        const float distance = glm::length(p - from - s * chord);
        if (distance < nearest.x) {
            nearest = {distance, (static_cast<float>(i - 1) + s) / kChords};
        }
        from = to;
    }
    return nearest;
}

/// 0 at the ends of a crease, 1 in its middle; one that crosses the middle of the face has no end
/// there.
float crease_taper(const Crease& crease, float along) {
    const float start = crease.a.x == 0 ? 1 : glm::smoothstep(0.0f, 0.35f, along);
    return start * (1 - glm::smoothstep(0.45f, 1.0f, along));
}

/// A share of the depth of a crease: no face has long ones in one piece.
float crease_pieces(const Vec2& uv, std::uint32_t seed) {
    return glm::mix(0.3f, 1.0f, glm::smoothstep(-0.5f, 0.1f, fbm(uv, 9, seed, 2)));
}

/// A narrow valley between round crests, which thins out and fades towards its ends.
float crease_height(const Crease& crease, const Vec2& p) {
    constexpr float kReach = 3.2f;  // widths
    const Vec2 low = glm::min(crease.a, glm::min(crease.b, crease.c)) - kReach * crease.width;
    const Vec2 high = glm::max(crease.a, glm::max(crease.b, crease.c)) + kReach * crease.width;
    if (p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y) {
        return 0;
    }
    const Vec2 at = nearest_on(crease, p);
    const float taper = crease_taper(crease, at.y);
    const float d = at.x / (crease.width * (0.55f + 0.45f * taper));
    return crease.depth * taper
           * (0.45f * std::exp(-square(d - 1.0f)) - std::exp(-square(1.6f * d)));
}

}  // namespace

PatternMaps make_face_folds(const FaceFoldsPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 chart = {(uv.x - 0.5f) * kHeadColumns, uv.y * (kHeadRows + 13) - 13};
        const Vec2 bend = {fbm(uv, 23, seed), fbm(uv, 23, seed + 1)};
        const Vec2 sway = {fbm(uv, 7, seed + 3, 2), fbm(uv, 7, seed + 4, 2)};
        Vec2 p = chart + pattern.wander * kMm * (2.0f * bend + 3.0f * sway);
        p.x = std::abs(p.x);
        float height = 0;
        std::uint32_t number = seed + 6;
        for (const Crease& crease : kCreases) {
            const float own = crease_height(crease, p);
            height += own != 0 ? own * crease_pieces(uv, number) : 0.0f;
            ++number;
        }
        // No fold is as deep all along, or as deep as that of the other side.
        height *= height != 0 ? 1 + 0.9f * fbm(uv, 13, seed + 5, 2) : 1;
        // Dimples of the chin, 2 to 4 mm wide.
        const float chin =
            1 - glm::smoothstep(0.4f, 1.0f, glm::length((p - Vec2(0, 59)) / Vec2(6, 3.4f)));
        height += chin * 0.12f * fbm(uv, 96, seed + 2, 2);
        PatternTexel t;
        t.height = pattern.depth * height / kHeadColumns;
        return t;
    });
}

}  // namespace limn
