#include "content/make/head.h"
#include "content/make/head_layout.h"
#include "content/make/head_surface.h"
#include "content/make/head_wrap.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace limn {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Directed edges of all quads, and how often each occurs.
std::map<Edge, int> directed_edges() {
    std::map<Edge, int> edges;
    for (const auto& quad : head_layout().quads) {
        for (int k = 0; k < 4; ++k) {
            ++edges[{quad[k], quad[(k + 1) % 4]}];
        }
    }
    return edges;
}

const std::vector<Vec3>& wrapped() {
    static const std::vector<Vec3> positions = wrap_head(HeadShape{});
    return positions;
}

TEST_CASE("head: the skin is a disc whose border is the ring of the neck") {
    const std::map<Edge, int> edges = directed_edges();
    int border = 0;
    int both = 0;
    for (const auto& [edge, count] : edges) {
        CHECK(count == 1);  // neighbors agree which side is outside
        if (edges.contains({edge.second, edge.first})) {
            ++both;
        } else {
            ++border;
            CHECK(head_layout().vertices[edge.first].chart.y == kHeadRows);
        }
    }
    CHECK(border == kHeadColumns);
    const int euler = static_cast<int>(head_layout().vertices.size()) - (both / 2 + border)
                      + static_cast<int>(head_layout().quads.size());
    CHECK(euler == 1);
    CHECK(head_layout().vertices.size() >= 10000);
    CHECK(head_layout().vertices.size() <= 20000);
}

TEST_CASE("head: each vertex has a mirror image, and without asymmetry the halves agree") {
    const HeadLayout& layout = head_layout();
    for (std::uint32_t v = 0; v < layout.vertices.size(); ++v) {
        const std::uint32_t other = layout.mirror[v];
        CHECK(layout.mirror[other] == v);
        const Vec3 p = wrapped()[other];
        CHECK(glm::length(wrapped()[v] - Vec3(-p.x, p.y, p.z)) < 1e-4f);
    }
}

TEST_CASE("head: width and length are within two deviations of an adult's") {
    Vec3 low = Vec3(100);
    Vec3 high = Vec3(-100);
    for (std::size_t v = 0; v < wrapped().size(); ++v) {
        if (head_layout().vertices[v].loops == HeadLoops::None && wrapped()[v].y > 5) {
            low = glm::min(low, wrapped()[v]);
            high = glm::max(high, wrapped()[v]);
        }
    }
    CHECK(high.x - low.x > 13.4f);  // Zhuang and Bradtmiller 2005 [cm]
    CHECK(high.x - low.x < 16.5f);
    CHECK(high.z - low.z > 17.3f);
    CHECK(high.z - low.z < 21.2f);
}

TEST_CASE("head: lids do not enter the ball of the eye") {
    for (std::size_t v = 0; v < wrapped().size(); ++v) {
        Vec3 p = wrapped()[v];
        p.x = std::abs(p.x);
        CHECK(glm::length(p - kEyeCenter) > kEyeRadius);
    }
}

/// Vertices of the left part that loops `from` to `to` make up.
std::vector<std::uint32_t> left_loops(HeadLoops loops, int from, int to) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t v = 0; v < wrapped().size(); ++v) {
        const HeadVertex& vertex = head_layout().vertices[v];
        if (vertex.left && vertex.loops == loops && vertex.loop >= from && vertex.loop <= to) {
            found.push_back(v);
        }
    }
    return found;
}

Vec3 mean_place(const std::vector<std::uint32_t>& vertices) {
    Vec3 sum = Vec3(0);
    for (const std::uint32_t v : vertices) {
        sum += wrapped()[v];
    }
    return sum / static_cast<float>(vertices.size());
}

/// Of the quads between `vertices`: their areas times their normals.
Vec3 facing(const std::vector<std::uint32_t>& vertices) {
    Vec3 sum = Vec3(0);
    for (const auto& quad : head_layout().quads) {
        if (std::ranges::all_of(
                quad, [&](std::uint32_t v) { return std::ranges::binary_search(vertices, v); })) {
            sum += glm::cross(
                wrapped()[quad[2]] - wrapped()[quad[0]], wrapped()[quad[3]] - wrapped()[quad[1]]);
        }
    }
    return glm::normalize(sum);
}

TEST_CASE("head: a nostril opens downwards and ends 8 mm or more up, within the nose") {
    const auto rim = left_loops(HeadLoops::Nostril, kNostrilRim, kNostrilRim);
    const auto cavity = left_loops(HeadLoops::Nostril, kNostrilRim, kNostrilLoops);
    const auto end = left_loops(HeadLoops::Nostril, kNostrilLoops, kNostrilLoops);
    REQUIRE(rim.size() >= 16);
    CHECK(facing(cavity).y < -0.8f);
    CHECK(mean_place(end).y - mean_place(rim).y > 0.8f);
    for (const std::uint32_t v : left_loops(HeadLoops::Nostril, kNostrilRim + 2, kNostrilLoops)) {
        CHECK(head_distance(wrapped()[v], HeadShape{}, 1) < 0);
    }
    for (const std::uint32_t v : rim) {  // a column stays between the nostrils
        CHECK(wrapped()[v].x > 0.2f);
    }
}

TEST_CASE(
    "head: an ear is as long and wide as an adult's, and its concha a hollow that faces out") {
    constexpr int kConcha = 22;
    const auto front = left_loops(HeadLoops::Ear, 6, kEarLoops);
    Vec3 low = Vec3(100);
    Vec3 high = Vec3(-100);
    for (const std::uint32_t v : front) {
        low = glm::min(low, wrapped()[v]);
        high = glm::max(high, wrapped()[v]);
    }
    CHECK(high.y - low.y > 5.5f);  // 62.4 mm, two deviations 7.4
    CHECK(high.y - low.y < 7.0f);
    CHECK(facing(front).x > 0.7f);
    const Vec3 concha = mean_place(left_loops(HeadLoops::Ear, kConcha, kEarLoops));
    CHECK(high.x - concha.x > 0.8f);  // the helix stands out from it
    const Vec3 head = project_to_head(concha, HeadShape{}, 1);
    CHECK(glm::distance(head, concha) < 0.6f);
}

TEST_CASE("head: no number of a made mesh is NaN at the ends of all parameters") {
    for (const float end : {0.0f, 1.0f}) {
        const MeshData mesh =
            make_head({.age = end, .sex = 2 * end - 1, .build = 1 - 2 * end, .asymmetry = end});
        CHECK(std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite<3>));
        CHECK(std::all_of(mesh.normals.begin(), mesh.normals.end(), is_finite<3>));
        CHECK(mesh.regions.size() == 13);
    }
}

}  // namespace
}  // namespace limn
