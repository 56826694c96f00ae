// Meshes that are broken into pieces.

#include "content/load/level/level_load.h"
#include "content/make/models/fragments.h"
#include "content/make/models/shapes.h"
#include "ecs/components/all.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <vector>

namespace limn::fragments_test {

using namespace test;

namespace {

using Point = std::tuple<float, float, float>;

Point point_of(const Vec3& p) {
    return {p.x, p.y, p.z};
}

Assets with_ball() {
    Assets assets;
    assets.meshes.push_back(make_sphere({.radius = 1, .segments = 48, .rings = 24}));
    return assets;
}

double area_of(const MeshData& mesh, std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; i += 3) {
        sum += 0.5 * static_cast<double>(glm::length(double_area(mesh, i / 3)));
    }
    return sum;
}

}  // namespace

TEST_CASE(
    "fragments: as sheets, the pieces are the triangles of the whole, each once"
    * technique("particle.mesh-particles")) {
    const Assets assets = with_ball();
    const MeshData& ball = assets.meshes[0];
    const MeshData pieces = make_fragments({.mesh = {0}, .count = 20, .thickness = 0}, assets);
    CHECK(pieces.pieces.size() == 20);
    std::multiset<std::set<Point>> left;
    for (std::size_t i = 0; i < ball.indices.size(); i += 3) {
        left.insert(
            {point_of(corner(ball, i)), point_of(corner(ball, i + 1)),
             point_of(corner(ball, i + 2))});
    }
    REQUIRE(pieces.indices.size() == ball.indices.size());
    std::uint32_t next = 0;
    for (const MeshPiece& piece : pieces.pieces) {
        CHECK(piece.first == next);
        next += piece.count;
        for (std::uint32_t i = piece.first; i < next; i += 3) {
            const auto found = left.find(
                {point_of(corner(pieces, i)), point_of(corner(pieces, i + 1)),
                 point_of(corner(pieces, i + 2))});
            REQUIRE(found != left.end());
            left.erase(found);
        }
        const double share =
            area_of(pieces, piece.first, next) / area_of(pieces, 0, pieces.indices.size());
        CHECK(share > 0.3 / 20);
        CHECK(share < 2.5 / 20);
    }
    CHECK(left.empty());
}

TEST_CASE("fragments: each piece is connected and, with a thickness, closed") {
    Assets assets = with_ball();
    const MeshData pieces = make_fragments({.mesh = {0}, .count = 30, .thickness = 0.1f}, assets);
    double volume = 0;
    for (const MeshPiece& piece : pieces.pieces) {
        std::map<std::pair<Point, Point>, int> edges;  // of each, as often there as back
        std::map<Point, Point> parent;
        const auto root = [&](Point p) {
            while (parent.try_emplace(p, p).first->second != p) {
                p = parent[p];
            }
            return p;
        };
        for (std::uint32_t i = piece.first; i < piece.first + piece.count; i += 3) {
            const Vec3 a = corner(pieces, i);
            volume += static_cast<double>(
                          glm::dot(a, glm::cross(corner(pieces, i + 1), corner(pieces, i + 2))))
                      / 6;
            for (std::uint32_t k = 0; k < 3; ++k) {
                const Point from = point_of(corner(pieces, i + k));
                const Point to = point_of(corner(pieces, i + (k + 1) % 3));
                edges[{from, to}] += 1;
                edges[{to, from}] -= 1;
                parent[root(from)] = root(to);
            }
        }
        for (const auto& [edge, balance] : edges) {
            CHECK(balance == 0);
        }
        std::set<Point> roots;
        for (const auto& [point, above] : std::map(parent)) {
            roots.insert(root(point));
        }
        CHECK(roots.size() == 1);
    }
    CHECK(volume == near(4 * 3.14159265 / 3 * (1 - 0.9 * 0.9 * 0.9)).epsilon(0.02));
}

TEST_CASE("fragments: faces and normals point outward, those of the inside inward") {
    const Assets assets = with_ball();
    const MeshData pieces = make_fragments({.mesh = {0}, .count = 12, .thickness = 0.2f}, assets);
    for (std::size_t i = 0; i < pieces.indices.size(); i += 3) {
        const Vec3 front = glm::normalize(double_area(pieces, i / 3));
        float depth = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(glm::dot(front, pieces.normals[pieces.indices[i + k]]) > 0.7f);
            depth += (1 - glm::length(corner(pieces, i + k))) / 3;
        }
        const float outward = glm::dot(front, glm::normalize(corner(pieces, i)));
        if (depth < 0.01f) {
            CHECK(outward > 0.9f);
        } else if (depth > 0.19f) {
            CHECK(outward < -0.9f);
        } else {
            CHECK(std::abs(outward) < 0.1f);
        }
    }
}

TEST_CASE(
    "fragments: each piece is a mesh about its center, which keeps its position in the whole"
    * technique("particle.mesh-particles")) {
    Assets assets = with_ball();
    assets.meshes.push_back(make_fragments({.mesh = {0}, .count = 9}, assets));
    assets.meshes[1].name = "shards";
    add_piece_meshes(assets, {1});
    const MeshData& whole = assets.meshes[1];
    REQUIRE(assets.meshes.size() == 2 + 9);
    CHECK(assets.meshes[4].name == "shards.2");
    Vec3 sum(0);
    for (const MeshPiece& piece : whole.pieces) {
        const MeshData& own = assets.meshes[piece.mesh.index];
        REQUIRE(own.indices.size() == piece.count);
        for (std::uint32_t i = 0; i < piece.count; ++i) {
            const Vec3 back = corner(own, i) + piece.center;
            CHECK(glm::distance(back, corner(whole, piece.first + i)) < 1e-6f);
        }
        CHECK(glm::length(piece.center) > 0.5f);
        CHECK(glm::length(piece.center) < 1);
        sum += piece.center;
        Bounds bounds;
        for (const Vec3& position : own.positions) {
            grow(bounds, position);
        }
        CHECK(bounds.min == own.bounds.min);
        CHECK(bounds.max == own.bounds.max);
    }
    CHECK(glm::length(sum) / 9 < 0.2f);
}

TEST_CASE("fragments: the same seed breaks it alike, other seeds elsewhere") {
    const Assets assets = with_ball();
    const MeshData one = make_fragments({.mesh = {0}, .seed = 1}, assets);
    const MeshData again = make_fragments({.mesh = {0}, .seed = 1}, assets);
    const MeshData other = make_fragments({.mesh = {0}, .seed = 2}, assets);
    CHECK(one.positions == again.positions);
    CHECK(one.indices == again.indices);
    CHECK(one.indices != other.indices);
}

TEST_CASE("fragments: an empty mesh has none, and there are at most as many as triangles") {
    Assets assets = with_ball();
    CHECK(make_fragments({.mesh = {7}}, assets).pieces.empty());
    CHECK(make_fragments({}, assets).positions.empty());
    MeshData bad = make_box({});
    bad.positions.assign(bad.positions.size(), Vec3(std::numeric_limits<float>::quiet_NaN()));
    assets.meshes.push_back(bad);
    CHECK(make_fragments({.mesh = {1}}, assets).pieces.empty());
    assets.meshes.push_back(make_plane({}));
    assets.meshes[2].indices.insert(assets.meshes[2].indices.end(), {0, 0, 1});  // no area
    CHECK(make_fragments({.mesh = {2}, .count = 50}, assets).pieces.size() == 2);
    assets.meshes.push_back(make_plane({.divisions = 4}));
    CHECK(make_fragments({.mesh = {3}, .count = 1}, assets).pieces.size() == 1);
}

TEST_CASE("fragments: in a level, of a mesh before them, and other meshes keep their ids") {
    register_all_components();
    Result<Level> level = parse_level(
        R"({"meshes": {"ball": {"make": "sphere"},
            "shards": {"make": "fragments", "mesh": "ball", "count": 5}, "last": {"make": "box"}}})",
        "a.level.json");
    REQUIRE_MESSAGE(level.ok(), (level ? std::string() : level.error().message));
    REQUIRE(load_level_assets(*level, "").ok());
    REQUIRE(level->assets.meshes.size() == 3 + 5);
    CHECK(level->assets.meshes[2].name == "last");
    CHECK(level->assets.meshes[1].pieces[0].mesh.index == 3);
    const Result<Level> wrong = parse_level(
        R"({"meshes": {"shards": {"make": "fragments", "mesh": "ball"}, "ball": {"make": "sphere"}}})",
        "a.level.json");
    REQUIRE_FALSE(wrong.ok());
    CHECK(wrong.error().message.find("ball") != std::string::npos);
}

}  // namespace limn::fragments_test
