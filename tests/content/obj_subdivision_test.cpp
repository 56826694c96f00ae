#include "content/load/obj/obj_subdivision.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace limn::obj_subdivision_test {
namespace {

using limn::test::near;

/// A grid of side x side quads with corners at whole numbers and a texture coordinate at each.
ObjFile make_grid(int side) {
    std::string text;
    for (int y = 0; y <= side; ++y) {
        for (int x = 0; x <= side; ++x) {
            text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
            text += "vt " + std::to_string(x) + " " + std::to_string(y) + "\n";
        }
    }
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            text += "f";
            for (const int corner : {0, 1, side + 2, side + 1}) {
                const std::string number = std::to_string(y * (side + 1) + x + corner + 1);
                text += " " + number;
                text += "/" + number;
            }
            text += "\n";
        }
    }
    return *parse_obj(text, "grid.obj");
}

ObjFile make_cube() {
    return *parse_obj(
        "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
        "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
        "cube.obj");
}

std::vector<char> all_of(const ObjFile& obj) {
    return std::vector<char>(obj.faces.size(), 1);
}

/// How often each edge is used in either direction.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> count_edges(const ObjFile& obj) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
    for (const ObjFace& face : obj.faces) {
        for (std::uint32_t k = 0; k < face.count; ++k) {
            const std::uint32_t a = obj.corners[face.first + k].position;
            const std::uint32_t b = obj.corners[face.first + (k + 1) % face.count].position;
            ++count[{a, b}];
        }
    }
    return count;
}

const Vec3& position_of(const ObjFile& obj, const ObjFace& face, std::uint32_t k) {
    return obj.positions[obj.corners[face.first + k % face.count].position];
}

/// Twice the area of the triangle of a corner and the two beside it, seen from +z.
double corner_area(const ObjFile& obj, const ObjFace& face, std::uint32_t k) {
    const Vec3& p = position_of(obj, face, k);
    const Vec3 next = position_of(obj, face, k + 1) - p;
    const Vec3 previous = position_of(obj, face, k + face.count - 1) - p;
    return static_cast<double>(glm::cross(next, previous).z);
}

TEST_CASE("obj subdivision: a cube has the points of Catmull and Clark, and ends as a round body") {
    ObjFile cube = make_cube();
    const PointMeans means = subdivide_obj(cube, all_of(cube));
    REQUIRE(cube.faces.size() == 24);
    REQUIRE(cube.positions.size() == 8 + 12 + 6);
    // Of a corner (1, 1, 1): faces have the mean 1/3, edges 2/3, and it keeps nothing of itself.
    CHECK(glm::distance(cube.positions[6], Vec3(5.0f / 9)) < 1e-6f);
    for (std::size_t p = 8; p < 20; ++p) {
        CHECK(glm::length(cube.positions[p]) == near(0.75 * std::sqrt(2.0)));
    }
    for (std::size_t p = 20; p < 26; ++p) {
        CHECK(glm::length(cube.positions[p]) == near(1));
    }
    CHECK(means.first.size() == 27);
    for (int i = 0; i < 3; ++i) {
        (void)subdivide_obj(cube, all_of(cube));
    }
    float nearest = 10;
    float farthest = 0;
    for (const Vec3& p : cube.positions) {
        nearest = std::min(nearest, glm::length(p));
        farthest = std::max(farthest, glm::length(p));
    }
    CHECK(farthest < 1.25f * nearest);  // sqrt(3) times as far at first
}

TEST_CASE("obj subdivision: weights sum to 1, so what is affine in the cage stays so") {
    for (ObjFile obj : {make_grid(5), make_cube()}) {
        std::vector<char> chosen = all_of(obj);
        chosen[0] = chosen[3] = 0;
        const std::vector<Vec3> cage = obj.positions;
        const PointMeans means = subdivide_obj(obj, chosen);
        const auto affine = [](const Vec3& p) {
            return Vec3(p.x + 2 * p.y - p.z, 3 * p.z - p.x, p.y) + Vec3(4, 5, 6);
        };
        std::vector<Vec3> moved(cage.size());
        std::ranges::transform(cage, moved.begin(), affine);
        const std::vector<Vec3> fine = apply_means<Vec3>(means, moved);
        REQUIRE(fine.size() == obj.positions.size());
        for (std::size_t p = 0; p < fine.size(); ++p) {
            CHECK(glm::distance(fine[p], affine(obj.positions[p])) < 1e-5f);
        }
    }
}

TEST_CASE("obj subdivision: a flat grid stays flat and even, with its border and its texture") {
    ObjFile grid = make_grid(4);
    (void)subdivide_obj(grid, all_of(grid));
    REQUIRE(grid.faces.size() == 64);
    for (const ObjCorner& corner : grid.corners) {
        const Vec3& p = grid.positions[corner.position];
        CHECK(p.z == 0.0f);
        // Corners of the grid become round; all else keeps its place, as its texture does.
        if (std::min(p.x, 4 - p.x) + std::min(p.y, 4 - p.y) > 0.3f) {
            CHECK(glm::distance(Vec2(p), grid.uvs[static_cast<std::size_t>(corner.uv)]) < 1e-6f);
        }
    }
    std::set<std::int32_t> used;
    for (const ObjCorner& corner : grid.corners) {
        used.insert(corner.uv);
    }
    CHECK(used.size() == grid.positions.size());  // no seam where there was none
}

TEST_CASE("obj subdivision: of a part no gap opens, nothing flips, and the rest stays in place") {
    ObjFile grid = make_grid(6);
    std::vector<char> chosen(grid.faces.size(), 0);
    for (const std::size_t f : {14u, 15u, 20u, 21u, 27u}) {
        chosen[f] = 1;
    }
    const std::vector<Vec3> cage = grid.positions;
    (void)subdivide_obj(grid, chosen);
    for (const auto& [edge, count] : count_edges(grid)) {
        CHECK(count == 1);
        const Vec3 middle = 0.5f * (grid.positions[edge.first] + grid.positions[edge.second]);
        const bool outside = std::min({middle.x, middle.y, 6 - middle.x, 6 - middle.y}) < 1e-6f;
        const auto back = count_edges(grid).contains({edge.second, edge.first});
        CHECK(back == !outside);
    }
    double area = 0;
    for (const ObjFace& face : grid.faces) {
        for (std::uint32_t k = 0; k < face.count; ++k) {
            CHECK(corner_area(grid, face, k) > 0.2);  // no three corners in a line
        }
        area +=
            0.5 * (corner_area(grid, face, 1) + (face.count == 4 ? corner_area(grid, face, 3) : 0));
    }
    CHECK(area == near(36).epsilon(1e-5));
    for (std::size_t p = 0; p < cage.size(); ++p) {
        CHECK(glm::distance(grid.positions[p], cage[p]) < 1e-6f);
    }
}

TEST_CASE("obj subdivision: both sides of a seam keep their own texture coordinates") {
    ObjFile obj = *parse_obj(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "f 1/1 2/2 3/3 4/4\nf 2/1 5/2 6/3 3/4\n",
        "seam.obj");
    (void)subdivide_obj(obj, all_of(obj));
    std::set<std::int32_t> at_seam;  // of the point in the middle of the common edge
    for (const ObjCorner& corner : obj.corners) {
        if (glm::distance(obj.positions[corner.position], Vec3(1, 0.5f, 0)) < 1e-6f) {
            at_seam.insert(corner.uv);
        }
    }
    REQUIRE(at_seam.size() == 2);
    CHECK(obj.uvs[static_cast<std::size_t>(*at_seam.begin())].y == near(0.5));
    CHECK(
        std::abs(
            obj.uvs[static_cast<std::size_t>(*at_seam.begin())].x
            - obj.uvs[static_cast<std::size_t>(*at_seam.rbegin())].x)
        == near(1));
}

}  // namespace
}  // namespace limn::obj_subdivision_test
