#include "content/make/models/body_part.h"
#include "content/make/models/even_triangles.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace limn::body_part_test {
namespace {

constexpr float kPlanarMiddle = 1.7f / 21.3f;  ///< of a hand, of its length

constexpr std::array<BodyPartKind, 3> kAll = {
    BodyPartKind::Hand, BodyPartKind::Foot, BodyPartKind::Arm};

/// Vertices at one position count as one.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges_of(const MeshData& mesh) {
    std::map<std::array<float, 3>, std::uint32_t> first;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    const auto index_of = [&](std::uint32_t v) {
        const Vec3& p = mesh.positions[v];
        return first.try_emplace({p.x, p.y, p.z}, v).first->second;
    };
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[{index_of(mesh.indices[t + k]), index_of(mesh.indices[t + (k + 1) % 3])}];
        }
    }
    return edges;
}

TEST_CASE("body part: it is closed, and as long as requested") {
    for (const BodyPartKind part : kAll) {
        CAPTURE(static_cast<int>(part));
        const MeshData mesh = make_body_part({.part = part, .length = 0.2f, .cells = 64});
        const auto edges = edges_of(mesh);
        int open = 0;
        for (const auto& [edge, count] : edges) {
            const auto other = edges.find({edge.second, edge.first});
            open += other == edges.end() || other->second != count ? 1 : 0;
        }
        CHECK(open == 0);
        const auto [low, high] = std::ranges::minmax(mesh.positions, {}, &Vec3::y);
        CHECK(high.y - low.y == test::near(0.2f).epsilon(0.06));
    }
}

TEST_CASE("body part: lengths and breadths of hand and foot are those of an adult") {
    const auto breadth = [](BodyPartKind part, float length, float from, float to) {
        const MeshData mesh = make_body_part({.part = part, .length = length, .cells = 64});
        constexpr float kThumb = 0.045f;  // begins there
        Vec2 range = {1, -1};
        for (const Vec3& p : mesh.positions) {
            const float along = p.y / length + 0.5f;
            if (along > from && along < to && (part != BodyPartKind::Hand || p.x < kThumb)) {
                range = {std::min(range.x, p.x), std::max(range.y, p.x)};
            }
        }
        return range.y - range.x;
    };
    // Gordon et al. 1989: hands of 194 mm are 90 (4) mm broad, feet of 270 mm 101 (5) mm.
    CHECK(breadth(BodyPartKind::Hand, 0.213f, 0.55f, 0.6f) == test::near(0.09f).epsilon(0.15));
    CHECK(breadth(BodyPartKind::Foot, 0.27f, 0.6f, 0.75f) == test::near(0.101f).epsilon(0.15));
}

TEST_CASE(
    "body part: the planar map is the view from the front"
    * technique("wrinkle.furrow.map-planar")) {
    const MeshData mesh = make_body_part({.part = BodyPartKind::Hand, .length = 0.2f, .cells = 48});
    bool inside = true;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const std::uint32_t* const v = &mesh.indices[t];
        const Vec3 normal = glm::cross(
            mesh.positions[v[1]] - mesh.positions[v[0]],
            mesh.positions[v[2]] - mesh.positions[v[0]]);
        const float side = normal.z < 0 ? -1.0f : 1.0f;
        for (int k = 0; k < 3; ++k) {
            const Vec2 uv = mesh.uvs[v[k]];
            const Vec3 p = mesh.positions[v[k]] / 0.2f;
            const float middle = 0.5f - 0.25f * side;
            CHECK(
                uv.x
                == test::near(middle + side * kBodyChartScale * (p.x - kPlanarMiddle))
                       .epsilon(1e-3));
            CHECK(uv.y == test::near(0.5f - kBodyChartScale * p.y).epsilon(1e-3));
            inside = inside && uv.y > 0 && uv.y < 1 && std::abs(uv.x - middle) < 0.25f;
        }
    }
    CHECK(inside);
}

TEST_CASE(
    "body part: the chart of a foot stays in its halves of the image"
    * technique("wrinkle.furrow.map-planar")) {
    const MeshData mesh = make_body_part({.part = BodyPartKind::Foot, .cells = 48});
    Vec2 low = {1, 1};
    Vec2 high = {0, 0};
    for (const Vec2& uv : mesh.uvs) {
        low = glm::min(low, uv);
        high = glm::max(high, uv);
    }
    CHECK(low.x > 0);
    CHECK(low.y > 0);
    CHECK(high.x < 1);
    CHECK(high.y < 1);
}

TEST_CASE(
    "body part: the arm is unrolled without a triangle across its seam"
    * technique("wrinkle.furrow.map-cylinder")) {
    const MeshData mesh = make_body_part({.part = BodyPartKind::Arm, .cells = 48});
    float widest = 0;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const auto u = [&](std::size_t k) { return mesh.uvs[mesh.indices[t + k]].x; };
        const auto y = [&](std::size_t k) { return mesh.positions[mesh.indices[t + k]].y; };
        const bool side = std::max({std::abs(y(0)), std::abs(y(1)), std::abs(y(2))}) < 0.09f;
        const float width = std::max({u(0), u(1), u(2)}) - std::min({u(0), u(1), u(2)});
        widest = std::max(widest, side ? width : 0.0f);
    }
    CHECK(widest < 0.1f);
}

TEST_CASE("body part: its triangles are no slivers, and its normals are those of its faces") {
    for (const BodyPartKind part : kAll) {
        CAPTURE(static_cast<int>(part));
        const MeshData mesh = make_body_part({.part = part, .length = 0.2f, .cells = 64});
        double sum = 0;
        int poor = 0;
        double facing = 0;
        for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
            const auto at = [&](std::size_t k) { return mesh.positions[mesh.indices[t + k]]; };
            const float quality = triangle_quality(at(0), at(1), at(2));
            sum += static_cast<double>(quality);
            poor += quality < 0.5f ? 1 : 0;
            const Vec3 normal = glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0)));
            facing += static_cast<double>(glm::dot(normal, mesh.normals[mesh.indices[t]]));
        }
        const double count = static_cast<double>(mesh.indices.size() / 3);
        CHECK(sum / count > 0.95);  // 0.85 without flips and collapses
        CHECK(poor <= static_cast<int>(count / 2000));
        CHECK(facing / count > 0.98);
    }
}

TEST_CASE("body part: fingers taper, and each has a nail that lies on its skin") {
    const MeshData hand = make_body_part({.part = BodyPartKind::Hand, .length = 0.2f, .cells = 64});
    const MeshData nails = make_body_part({.part = BodyPartKind::HandNails, .length = 0.2f});
    const std::size_t per_nail = nails.positions.size() / 5;
    CHECK(per_nail * 5 == nails.positions.size());
    for (std::size_t i = 0; i < nails.positions.size(); ++i) {
        float nearest = 1;
        for (const Vec3& p : hand.positions) {
            nearest = std::min(nearest, glm::distance(p, nails.positions[i]));
        }
        CHECK(nearest < 0.004f);  // on the skin, or free of it by the length of a free edge
    }
    // Width of the middle finger at its base, and close to its tip.
    const auto width = [&](float from, float to) {
        Vec2 range = {1, -1};
        for (const Vec3& p : hand.positions) {
            if (p.y > from && p.y < to && p.x > -0.003f && p.x < 0.02f) {
                range = {std::min(range.x, p.x), std::max(range.y, p.x)};
            }
        }
        return range.y - range.x;
    };
    CHECK(width(0.09f, 0.096f) < 0.85f * width(0.04f, 0.046f));
}

TEST_CASE("body part: each toe has a nail on its back, and that of the big toe is the widest") {
    const MeshData foot =
        make_body_part({.part = BodyPartKind::Foot, .length = 0.27f, .cells = 96});
    const MeshData nails = make_body_part({.part = BodyPartKind::FootNails, .length = 0.27f});
    const std::size_t per_nail = nails.positions.size() / 5;
    CHECK(per_nail * 5 == nails.positions.size());
    std::array<float, 5> widths{};
    for (std::size_t i = 0; i < nails.positions.size(); ++i) {
        float nearest = 1;
        for (const Vec3& p : foot.positions) {
            nearest = std::min(nearest, glm::distance(p, nails.positions[i]));
        }
        CHECK(nearest < 0.004f);
        CHECK(nails.positions[i].y > 0.03f);  // the toes are the end that points up
    }
    for (std::size_t n = 0; n < 5; ++n) {
        Vec2 range = {1, -1};
        for (std::size_t i = n * per_nail; i < (n + 1) * per_nail; ++i) {
            range = {
                std::min(range.x, nails.positions[i].x), std::max(range.y, nails.positions[i].x)};
        }
        widths[n] = range.y - range.x;
        CHECK((n == 0 || widths[n] < 0.8f * widths[0]));
    }
    CHECK(widths[0] > 0.012f);
    CHECK(widths[0] < 0.024f);
}

TEST_CASE("body part: the bend of the elbow is shallow: a lamp above lights most of it") {
    const MeshData arm = make_body_part({.part = BodyPartKind::Arm, .length = 0.34f, .cells = 64});
    const Vec3 to_lamp = glm::normalize(Vec3(-0.67f, 1.8f, 0.75f));
    int all = 0;
    int dark = 0;
    for (std::size_t v = 0; v < arm.positions.size(); ++v) {
        const Vec3& p = arm.positions[v];
        const float along = p.y / 0.34f;
        if (along > -0.4f && along < -0.15f && std::abs(p.x) < 0.02f && p.z > 0) {
            ++all;
            dark += glm::dot(arm.normals[v], to_lamp) < 0.2f ? 1 : 0;
        }
    }
    CHECK(all > 100);
    CHECK(dark < 0.15 * all);  // 0.2 with a deep hollow
}

}  // namespace
}  // namespace limn::body_part_test
