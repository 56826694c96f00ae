#include "content/make/head/head_shoulders.h"

#include "content/make/head/head_clay.h"
#include "content/make/head/head_surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace limn {

namespace {

constexpr Vec3 kShoulderAxis = {0, 0, -3};

constexpr float kTop = -2;  ///< y above which shoulders have no effect

constexpr std::array<Solid, 8> kSolids = {{
    // chest, from the root of the neck
    {{0, -31, -2.5f}, {0, -31, -2.5f}, {15.5f, 15, 10.5f}, {15.5f, 15, 10.5f}, 3},
    // trapezius, from the neck to the tip of the shoulder
    {{2, -12, -5}, {9, -17, -4.6f}, {2.8f, 3.2f, 2.6f}, {3, 2.9f, 3.2f}, 3},
    {{9, -17, -4.6f}, {16.5f, -19, -3.6f}, {3, 2.9f, 3.2f}, {2.2f, 2, 2.6f}, 2},
    // between collar bone and shoulder blade
    {{5, -20.7f, -3}, {16.5f, -21, -3.2f}, {4, 3.6f, 5}, {4, 3.5f, 4.6f}, 3},
    // shoulder and upper arm
    {{18, -21.4f, -3}, {19.2f, -30, -3}, {4.6f, 4.3f, 5}, {4.4f, 4.5f, 4.8f}, 3.5f},
    // chest muscle
    {{5.5f, -28.5f, 3.6f}, {15.5f, -24, 0.8f}, {5, 5.5f, 3.8f}, {3, 3.6f, 3}, 3},
    // shoulder blade
    {{7, -23.5f, -8.6f}, {13.5f, -22, -6.6f}, {4, 5.5f, 3}, {3.4f, 4.5f, 3}, 3},
    // back of the neck
    {{0, -12, -4.3f}, {0, -21, -8}, {2.8f, 3, 2.9f}, {5, 5, 4.2f}, 4},
}};

// Curves near the surface, onto which they are moved.
constexpr std::array<Stroke, 16> kStrokes = {{
    // collar bone: bent forward, then back; its end beside the notch; the notch
    {{1.6f, -18.2f, 3.4f}, {10.5f, -18.8f, 5}, {17, -17.2f, -1.2f}, 0.8f, 0.38f, 0.03f, -0.25f},
    {{1.5f, -18.2f, 3.4f}, {1.7f, -18.2f, 3.4f}, {2.1f, -18.2f, 3.4f}, 0.9f, 0.12f, 0, -0.1f},
    {{0, -17.2f, 3}, {0, -17.5f, 3}, {0, -17.8f, 3}, 0.95f, -0.42f, 0, 0.2f},
    // hollows above and below it
    {{4.4f, -16.8f, 2}, {7, -16.6f, 2}, {10, -16.4f, 1}, 1.5f, -0.4f, 0, 0.3f},
    {{12.8f, -20, 2.4f}, {13.8f, -20.5f, 2.2f}, {14.4f, -21.5f, 2}, 1.6f, -0.3f, 0, 0.2f},
    // sternocleidomastoid: from behind the ear, its end on the breastbone, and on the collar bone
    {{5.8f, -6, -1.4f}, {4.7f, -10.5f, 1}, {1.5f, -15.4f, 2.8f}, 0.8f, 0.24f, 0.08f, -0.15f},
    {{1.3f, -15.8f, 2.9f}, {1.2f, -16.6f, 3}, {1, -17.4f, 3.2f}, 0.75f, 0.3f, 0.05f, -0.15f},
    {{3, -12.4f, 2}, {3.6f, -15, 2}, {3.9f, -17.2f, 2.4f}, 0.8f, 0.15f, 0.04f, -0.1f},
    // Adam's apple
    {{0, -11.2f, 4.4f}, {0, -11.8f, 4.2f}, {0, -12.3f, 4}, 0.7f, 0.2f, 0.22f, -0.05f},
    // tip of the shoulder
    {{18, -16.4f, -3}, {18.2f, -16.5f, -3}, {18.6f, -16.7f, -3}, 1.3f, 0.06f, 0, -0.06f},
    // shoulder muscle: its front edge
    {{15.5f, -18.5f, 1}, {17, -22, 2}, {18.4f, -27, 1.6f}, 1.8f, 0.2f, 0.15f, 0},
    // breastbone between the chest muscles
    {{0, -20.5f, 4.5f}, {0, -24, 6}, {0, -30, 8}, 1.3f, -0.25f, -0.1f, 0.1f},
    // vertebra at the root of the neck, and the furrow of the spine
    {{0, -11.6f, -8.4f}, {0, -11.9f, -8.5f}, {0, -12.2f, -8.6f}, 1, 0.25f, 0, -0.15f},
    {{0, -16, -10}, {0, -21, -11.5f}, {0, -30, -13}, 1.4f, -0.35f, -0.1f, 0.1f},
    // spine of the shoulder blade, and its inner edge
    {{15.5f, -18, -6}, {12, -18.5f, -8.5f}, {7, -20.5f, -11}, 1.1f, 0.22f, 0, -0.15f},
    {{6, -20.5f, -11}, {5.6f, -24, -12}, {6.4f, -29, -13}, 1.2f, 0.15f, 0, -0.1f},
}};

const std::vector<StrokePath>& stroke_paths() {
    static const std::vector<StrokePath> paths = make_stroke_paths(kStrokes, [](const Vec3& p) {
        HeadShape neutral;
        neutral.shoulders = true;
        return project_to_head(p, neutral, 0, 8);
    });
    return paths;
}

/// Size of shoulders relative to neutral ones: men's are broader.
Vec3 shoulder_size(float y, const HeadShape& shape) {
    const float low = glm::smoothstep(-10.0f, -17.0f, y);
    const float breadth = 1 + low * (0.04f * shape.sex + 0.01f * shape.build);
    const float depth = 1 + low * (0.03f * shape.sex + 0.07f * shape.build);
    return {breadth, 1, depth};
}

}  // namespace

Vec3 to_neutral_shoulders(const Vec3& p, const HeadShape& shape) {
    return kShoulderAxis + (p - kShoulderAxis) / shoulder_size(p.y, shape);
}

Vec3 from_neutral_shoulders(const Vec3& p, const HeadShape& shape) {
    return kShoulderAxis + (p - kShoulderAxis) * shoulder_size(p.y, shape);
}

template <typename Number>
Number join_shoulders(const Number& distance, const PointOf<Number>& p) {
    const auto below = p.y < kTop;
    return any_of(below) ? (below ? join<Number>(distance, kSolids, p) : distance) : distance;
}

template float join_shoulders(const float&, const PointOf<float>&);
template Four join_shoulders(const Four&, const PointOf<Four>&);

template <typename Number>
Number shoulder_relief(const PointOf<Number>& p, const HeadShape& shape) {
    const auto below = p.y < kTop;
    const Number none = same_for_all<Number>(0);
    return any_of(below) ? (below ? relief<Number>(kStrokes, stroke_paths(), p, shape) : none)
                         : none;
}

template float shoulder_relief(const PointOf<float>&, const HeadShape&);
template Four shoulder_relief(const PointOf<Four>&, const HeadShape&);

Vec3 shoulder_start(const Vec3& neck, float turn, float down) {
    // The end is an ellipse with nearly even spacing, a little closer in front.
    const float closer = turn - 0.2f * std::sin(turn);
    const float angle = closer - 0.2f * std::sin(2 * closer);
    const float s = std::sin(angle);
    const float c = std::cos(angle);
    const Vec3 end = {23 * s, kShouldersEnd, -2.5f + (c > 0 ? 9.5f : 10.5f) * c};
    const Vec3 above = {0.85f * end.x, glm::mix(neck.y - 1, -16.0f, s * s), 0.8f * end.z};
    return glm::mix(glm::mix(neck, above, down), glm::mix(above, end, down), down);
}

float turns_with_head(const Vec3& p) {
    const float higher = 2.2f * glm::smoothstep(2.0f, -6.0f, p.z);  // behind, up to the hair
    const float height = glm::smoothstep(-16.5f, -8.0f, p.y - higher);
    const float aside = glm::length(Vec2(p.x, std::min(p.z + 2, 0.0f)));
    return height * (1 - glm::smoothstep(7.5f, 12.0f, aside) * glm::smoothstep(-7.0f, -10.0f, p.y));
}

}  // namespace limn
