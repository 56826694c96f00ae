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
    // forehead
    {{0, 12.6f}, {5, 11.4f}, {9.5f, 13.2f}, 0.75f, 0.20f},
    {{0, 15.1f}, {5, 14.0f}, {10.2f, 15.8f}, 0.8f, 0.25f},
    {{0, 17.8f}, {5, 16.7f}, {10.6f, 18.4f}, 0.8f, 0.25f},
    {{0.8f, 20.6f}, {5, 19.4f}, {10.4f, 21.0f}, 0.7f, 0.20f},
    // glabella and root of the nose
    {{2.3f, 17.8f}, {1.1f, 22}, {2.0f, 27.2f}, 0.85f, 0.30f},
    {{4.4f, 21.0f}, {3.2f, 23}, {3.6f, 25.4f}, 0.7f, 0.08f},
    {{0, 27.6f}, {1.2f, 27.8f}, {2.9f, 29.4f}, 0.8f, 0.10f},
    // crow's feet
    {{14.1f, 28.2f}, {16, 26.6f}, {18.4f, 25.2f}, 0.4f, 0.13f},
    {{14.4f, 28.8f}, {16.5f, 28.0f}, {19.2f, 27.4f}, 0.4f, 0.15f},
    {{14.5f, 29.5f}, {16.5f, 29.5f}, {19.4f, 29.9f}, 0.4f, 0.15f},
    {{14.3f, 30.2f}, {16.3f, 31.0f}, {18.8f, 32.4f}, 0.4f, 0.13f},
    // lower lid
    {{6.4f, 31.4f}, {9.8f, 33.2f}, {13.0f, 31.6f}, 0.35f, 0.10f},
    {{6.0f, 32.2f}, {9.4f, 34.9f}, {13.4f, 32.8f}, 0.4f, 0.12f},
    {{6.0f, 33.4f}, {8.6f, 36.4f}, {12.4f, 35.4f}, 0.5f, 0.10f},
    // side of the nose
    {{1.9f, 33.6f}, {3.0f, 32.8f}, {4.3f, 31.2f}, 0.4f, 0.13f},
    {{1.9f, 35.4f}, {3.1f, 34.6f}, {4.5f, 33.0f}, 0.4f, 0.13f},
    // nasolabial fold, outside the corner of the mouth, marionette line
    {{6.2f, 40.4f}, {8.6f, 43.4f}, {8.8f, 50.4f}, 1.0f, 0.45f},
    {{10.6f, 45.6f}, {11.6f, 48.0f}, {11.6f, 51.2f}, 0.7f, 0.16f},
    {{7.2f, 51.6f}, {8.2f, 54.0f}, {7.8f, 57.2f}, 0.7f, 0.22f},
    // upper lip
    {{1.3f, 43.6f}, {1.2f, 44.6f}, {1.1f, 45.8f}, 0.3f, 0.08f},
    {{2.7f, 43.7f}, {2.5f, 44.7f}, {2.3f, 45.8f}, 0.3f, 0.09f},
    {{4.2f, 44.0f}, {3.9f, 44.9f}, {3.5f, 45.9f}, 0.3f, 0.09f},
    {{5.8f, 44.5f}, {5.3f, 45.4f}, {4.8f, 46.4f}, 0.3f, 0.08f},
    // below the lower lip
    {{0, 55.2f}, {3.4f, 55.4f}, {6.2f, 53.8f}, 1.1f, 0.30f},
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

/// A narrow valley between round crests, whose ends fade out.
float crease_height(const Crease& crease, const Vec2& p) {
    constexpr float kReach = 3.2f;  // widths
    const Vec2 low = glm::min(crease.a, glm::min(crease.b, crease.c)) - kReach * crease.width;
    const Vec2 high = glm::max(crease.a, glm::max(crease.b, crease.c)) + kReach * crease.width;
    if (p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y) {
        return 0;
    }
    const Vec2 at = nearest_on(crease, p);
    const float d = at.x / crease.width;
    const float start = crease.a.x == 0 ? 1 : glm::smoothstep(0.0f, 0.2f, at.y);
    const float ends = start * (1 - glm::smoothstep(0.75f, 1.0f, at.y));
    return crease.depth * ends
           * (0.45f * std::exp(-square(d - 1.0f)) - std::exp(-square(1.6f * d)));
}

}  // namespace

PatternMaps make_face_folds(const FaceFoldsPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 chart = {(uv.x - 0.5f) * kHeadColumns, uv.y * (kHeadRows + 13) - 13};
        const Vec2 bend = {fbm(uv, 23, seed), fbm(uv, 23, seed + 1)};
        Vec2 p = chart + pattern.wander * kMm * 2.0f * bend;
        p.x = std::abs(p.x);
        float height = 0;
        for (const Crease& crease : kCreases) {
            height += crease_height(crease, p);
        }
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
