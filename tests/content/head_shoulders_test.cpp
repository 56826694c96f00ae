#include "content/make/head/head.h"
#include "content/make/head/head_layout.h"
#include "content/make/head/head_shoulders.h"
#include "content/make/head/head_surface.h"
#include "content/make/head/head_wrap.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace limn::head_shoulders_test {
namespace {

HeadShape bust(float sex = 0, float build = 0) {
    HeadShape shape;
    shape.sex = sex;
    shape.build = build;
    shape.shoulders = true;
    return shape;
}

const HeadLayout& layout() {
    return head_layout(true);
}

const std::vector<Vec3>& wrapped() {
    static const std::vector<Vec3> positions = wrap_head(bust());
    return positions;
}

const MeshData& skin() {
    static const MeshData mesh = [] {
        HeadShape shape = bust();
        shape.grows_old = true;
        return make_head(shape);
    }();
    return mesh;
}

/// Breadth from left to right, below the neck or of the head above the brows [cm].
float breadth(const std::vector<Vec3>& positions, bool below) {
    float widest = 0;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const bool counts =
            below ? positions[v].y < -14
                  : positions[v].y > 5 && layout().vertices[v].loops == HeadLoops::None;
        widest = std::max(widest, counts ? 2 * positions[v].x : 0.0f);
    }
    return widest;
}

constexpr float kBelowChin = -0.1f;  ///< [m]

using PositionKey = std::array<long, 3>;

/// `p` rounded to a micrometer.
PositionKey key_of(const Vec3& p) {
    return {std::lround(p.x * 1e6f), std::lround(p.y * 1e6f), std::lround(p.z * 1e6f)};
}

TEST_CASE("shoulders: the skin ends in one closed planar ring, where a body begins") {
    std::map<std::pair<PositionKey, PositionKey>, int> edges;
    const std::vector<Vec3>& positions = skin().positions;
    for (std::size_t i = 0; i < skin().indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& from = positions[skin().indices[i + k]];
            const Vec3& to = positions[skin().indices[i + (k + 1) % 3]];
            if (std::min(from.y, to.y) < kBelowChin) {  // lips touch
                ++edges[{key_of(from), key_of(to)}];
            }
        }
    }
    std::map<PositionKey, PositionKey> border;
    for (const auto& [edge, count] : edges) {
        CHECK(count == 1);
        if (!edges.contains({edge.second, edge.first})) {
            CHECK(border.emplace(edge.first, edge.second).second);
            CHECK(static_cast<float>(edge.first[1]) == test::near(1e4f * kShouldersEnd));
        }
    }
    REQUIRE(border.size() == kHeadColumns);
    std::size_t walked = 0;
    PositionKey at = border.begin()->first;
    do {
        at = border.at(at);
        ++walked;
    } while (at != border.begin()->first && walked < border.size());
    CHECK(walked == border.size());
}

TEST_CASE("shoulders: both sides of the texture seam have equal positions, normals and weights") {
    std::map<PositionKey, std::uint32_t> first;
    int doubled = 0;
    for (std::uint32_t v = 0; v < skin().positions.size(); ++v) {
        const auto [found, added] = first.emplace(key_of(skin().positions[v]), v);
        if (!added && skin().positions[v].y < kBelowChin) {
            ++doubled;
            const std::uint32_t other = found->second;
            CHECK(glm::distance(skin().normals[v], skin().normals[other]) < 1e-4f);
            CHECK(
                skin().skin.weights[skin().skin.first[v]]
                == skin().skin.weights[skin().skin.first[other]]);
        }
    }
    CHECK(doubled > kShoulderRows);
}

TEST_CASE("shoulders: vertices of a head without them come first, and its face is the same") {
    const HeadLayout& head = head_layout(false);
    const std::vector<Vec3> alone = wrap_head(HeadShape{});
    REQUIRE(layout().vertices.size() == head.vertices.size() + kHeadColumns * kShoulderRows);
    CHECK(layout().vertices.size() <= 20000);
    float farthest = 0;
    for (std::size_t v = 0; v < head.vertices.size(); ++v) {
        CHECK(layout().vertices[v].chart == head.vertices[v].chart);
        if (alone[v].y > -7 && alone[v].z > 2) {
            farthest = std::max(farthest, glm::distance(alone[v], wrapped()[v]));
        }
    }
    CHECK(farthest < 0.01f);
}

TEST_CASE("shoulders: left and right are mirror images, however much the face is skewed") {
    HeadShape skewed = bust();
    skewed.asymmetry = 1;
    const std::vector<Vec3> positions = wrap_head(skewed);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Vec3 other = positions[layout().mirror[v]];
        const bool must = positions[v].y < -20;
        CHECK((!must || glm::distance(positions[v], Vec3(-other.x, other.y, other.z)) < 1e-3f));
    }
}

TEST_CASE("shoulders: breadth over the muscles is that of men and women, within a deviation") {
    // Gordon et al. 1989 [cm]: 49.2 +- 2.6 and 43.2 +- 2.3; over the head 15.2 and 14.4.
    const std::vector<Vec3> man = wrap_head(bust(1));
    const std::vector<Vec3> woman = wrap_head(bust(-1));
    CHECK(std::abs(breadth(man, true) - 49.2f) < 2.6f);
    CHECK(std::abs(breadth(woman, true) - 43.2f) < 2.3f);
    CHECK(breadth(man, true) / breadth(man, false) > 3.1f);
    CHECK(breadth(woman, true) / breadth(woman, false) < 3.1f);
    CHECK(breadth(wrap_head(bust(0, 1)), true) > breadth(wrap_head(bust(0, -1)), true) + 1.5f);
}

TEST_CASE("shoulders: tips lie 8 to 11 cm below the chin, and the trapezius rises from them to the "
          "neck") {
    const auto top_at = [](float x, bool front) {
        float y = -100;
        for (const Vec3& p : wrapped()) {
            const bool counts = std::abs(p.x - x) < 0.5f && p.y < -8 && (!front || p.z > 0);
            y = counts ? std::max(y, p.y) : y;
        }
        return y;
    };
    CHECK(top_at(18, false) < -15.5f);
    CHECK(top_at(18, false) > -18.5f);
    CHECK(top_at(11, false) > top_at(18, false) + 0.5f);  // trapezius
}

TEST_CASE("shoulders: skin is on the surface, no quad is inverted, and none is stretched far") {
    const std::array<HeadShape, 3> bodies = {bust(), bust(1, 1), bust(-1, -1)};
    for (const HeadShape& body : bodies) {
        const std::vector<Vec3> positions = wrap_head(body);
        float least = 1;
        float longest = 0;
        for (const auto& quad : layout().quads) {
            const Vec3& corner = positions[quad[0]];
            if (corner.y > -9 || corner.y < kShouldersEnd + 1) {
                continue;
            }
            const Vec3 a = positions[quad[2]] - corner;
            const Vec3 b = positions[quad[3]] - positions[quad[1]];
            const Vec3 normal = glm::normalize(glm::cross(a, b));
            least =
                std::min(least, glm::dot(normal, glm::normalize(head_gradient(corner, body, 1))));
            longest = std::max({longest, glm::length(a), glm::length(b)});
            CHECK(std::abs(head_distance(corner, body, 1)) < 0.05f);
        }
        CHECK(least > 0.8f);
        CHECK(longest < 3);
    }
}

TEST_CASE("shoulders: neither expressions nor age move their skin, and it does not fold") {
    for (std::uint32_t v = 0; v < skin().positions.size(); ++v) {
        const bool stays = turns_with_head(100.0f * skin().positions[v]) == 0;
        for (const VertexRegion& region : skin().regions) {
            CHECK((!stays || region.weights[v] == 0));
        }
    }
    for (const MorphTarget& target : skin().morphs) {
        for (const std::uint32_t v : target.vertices) {
            CHECK(skin().positions[v].y > 0.01f * -18);
        }
    }
}

TEST_CASE("shoulders: weights sum to 1; the face turns with the head, shoulders stay") {
    const MeshRig rig = make_head_rig(bust());
    REQUIRE(rig.skeleton.joints.back() == "shoulders");
    CHECK(rig.skeleton.parents.back() == -1);
    const auto last = static_cast<std::uint16_t>(rig.skeleton.joints.size() - 1);
    int between = 0;
    for (std::uint32_t v = 0; v < skin().positions.size(); ++v) {
        float sum = 0;
        float stays = 0;
        for (std::uint32_t i = skin().skin.first[v]; i < skin().skin.first[v + 1]; ++i) {
            sum += skin().skin.weights[i];
            stays += skin().skin.joints[i] == last ? skin().skin.weights[i] : 0.0f;
        }
        const float y = 100 * skin().positions[v].y;
        CHECK(sum == test::near(1.0f));
        const bool behind = skin().positions[v].z < 0.02f;
        CHECK((y < (behind ? -5.5f : -7.5f) || stays == 0));
        CHECK((y > -17 || stays == 1));
        between += stays > 0.2f && stays < 0.8f ? 1 : 0;
    }
    CHECK(between > 300);
}

TEST_CASE("shoulders: they have their own tile of the texture, without overlap") {
    for (std::size_t i = 0; i < skin().indices.size(); i += 3) {
        const std::array<Vec2, 3> uv = {
            skin().uvs[skin().indices[i]], skin().uvs[skin().indices[i + 1]],
            skin().uvs[skin().indices[i + 2]]};
        const float low = std::min({uv[0].y, uv[1].y, uv[2].y});
        if (low >= 1 - 1e-5f) {
            const Vec2 a = uv[1] - uv[0];
            const Vec2 b = uv[2] - uv[0];
            CHECK(a.x * b.y - a.y * b.x < 0);
            CHECK(std::max({uv[0].y, uv[1].y, uv[2].y}) < 2);
        }
    }
}

TEST_CASE("shoulders: pores have one size on most of their skin") {
    int edges = 0;
    int even = 0;
    for (std::size_t i = 0; i < skin().indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = skin().indices[i + k];
            const std::uint32_t b = skin().indices[i + (k + 1) % 3];
            if (skin().positions[a].y < -0.16f) {
                const float length =
                    glm::distance(skin().positions[a], skin().positions[b]) / 0.33f;
                const float ratio = glm::distance(skin().uvs1[a], skin().uvs1[b]) / length;
                ++edges;
                even += ratio > 0.75f && ratio < 1.33f ? 1 : 0;
            }
        }
    }
    CHECK(even > 0.75f * static_cast<float>(edges));
}

/// How far the center of the throat protrudes from above and below [cm].
float larynx(float sex) {
    const float tall = 1 + 0.025f * sex;
    const auto depth = [&](float y) { return project_forwards({0, tall * y, 0}, bust(sex), 1).z; };
    return depth(-11.8f) - 0.5f * (depth(-10.3f) + depth(-13.3f));
}

TEST_CASE("shoulders: a man has an Adam's apple, a woman hardly one") {
    CHECK(larynx(1) > larynx(-1) + 0.12f);
    CHECK(larynx(1) > larynx(0));
}

/// Distances of points of a shirt from the skin [cm].
struct ShirtFit {
    float nearest = 100;
    float farthest = -100;
    float behind = -100;  ///< of the edge of the collar behind it
};

ShirtFit shirt_fit(HeadShape shape) {
    constexpr std::size_t kRow = kHeadColumns + 1;
    constexpr std::size_t kBehindRows = 5;
    shape.part = HeadPartKind::Shirt;
    const MeshData shirt = make_head(shape);
    shape.shoulders = true;
    ShirtFit fit;
    for (std::size_t v = 0; v < shirt.positions.size(); ++v) {
        const Vec3 p = 100.0f * shirt.positions[v];
        const float distance = head_distance(p, shape, 1);
        if (v < kRow) {
            fit.behind = std::max(fit.behind, distance);
        } else if (v >= kBehindRows * kRow && p.y > kShouldersEnd + 0.5f) {
            fit.nearest = std::min(fit.nearest, distance);
            fit.farthest = std::max(fit.farthest, distance);
        }
    }
    return fit;
}

TEST_CASE("shoulders: a shirt lies on the skin of every body, and its collar leaves no gap") {
    const std::array<HeadShape, 3> bodies = {bust(), bust(1, 1), bust(-1, -1)};
    for (const HeadShape& body : bodies) {
        const ShirtFit fit = shirt_fit(body);
        CHECK(fit.nearest > 0.15f);
        CHECK(fit.farthest < 2.5f);
        CHECK(fit.behind < 0.05f);
    }
}

TEST_CASE("shoulders: a shirt moves like the shoulders, without shapes, and is symmetric") {
    HeadShape shape;
    shape.part = HeadPartKind::Shirt;
    const MeshData shirt = make_head(shape);
    for (const MorphTarget& target : shirt.morphs) {
        CHECK(target.vertices.empty());
    }
    const auto stays = [&](std::size_t v) {
        float weight = 0;
        for (std::uint32_t i = shirt.skin.first[v]; i < shirt.skin.first[v + 1]; ++i) {
            weight += shirt.skin.joints[i] == 4 ? shirt.skin.weights[i] : 0.0f;
        }
        return weight;
    };
    const std::size_t row = kHeadColumns + 1;
    REQUIRE(shirt.positions.size() % row == 0);
    for (std::size_t v = 0; v < shirt.positions.size(); ++v) {
        const std::size_t column = v % row;
        const Vec3 other = shirt.positions[v - column + kHeadColumns - column];
        CHECK(glm::distance(shirt.positions[v], Vec3(-other.x, other.y, other.z)) < 1e-3f);
        CHECK(stays(v) > 0.5f);
    }
}

}  // namespace
}  // namespace limn::head_shoulders_test
