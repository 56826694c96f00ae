#include "render/geometry/triangle_order.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace limn::triangle_order_test {
namespace {

constexpr std::uint32_t kQuads = 64;  // on each side of the grid
constexpr std::size_t kVertices = std::size_t{kQuads + 1} * (kQuads + 1);

/// The grid in vertical strips of so many quads, each row by row.
std::vector<std::uint32_t> grid(std::uint32_t strip) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t begin = 0; begin < kQuads; begin += strip) {
        for (std::uint32_t y = 0; y < kQuads; ++y) {
            for (std::uint32_t x = begin; x < std::min(begin + strip, kQuads); ++x) {
                const std::uint32_t a = y * (kQuads + 1) + x;
                const std::uint32_t b = a + kQuads + 1;
                indices.insert(indices.end(), {a, a + 1, b, a + 1, b + 1, b});
            }
        }
    }
    return indices;
}

using Triangle = std::array<std::uint32_t, 3>;
std::vector<Triangle> sorted_triangles(const std::vector<std::uint32_t>& indices) {
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    std::ranges::sort(triangles);
    return triangles;
}

/// Counts with the cache itself, a queue.
double by_queue(const std::vector<std::uint32_t>& indices, std::size_t entries) {
    std::vector<std::uint32_t> queue;
    std::size_t misses = 0;
    for (const std::uint32_t index : indices) {
        if (std::ranges::find(queue, index) == queue.end()) {
            ++misses;
            queue.push_back(index);
            if (queue.size() > entries) {
                queue.erase(queue.begin());
            }
        }
    }
    return static_cast<double>(misses) / static_cast<double>(indices.size() / 3);
}

}  // namespace

TEST_CASE(
    "triangle order: transformed vertices of a grid in strips are those of the source"
    * technique("engine.opt-vertex")) {
    const auto of = [](std::uint32_t strip) {
        return transformed_per_triangle(grid(strip), kVertices);
    };
    CHECK(of(kQuads) == test::near(1.015625));
    CHECK(of(4) == test::near(0.635).epsilon(1e-3));
    CHECK(of(5) == test::near(0.611).epsilon(1e-3));
    CHECK(of(6) == test::near(0.595).epsilon(1e-3));
    CHECK(of(7) == test::near(0.587).epsilon(1e-3));
    CHECK(of(8) == test::near(1.002).epsilon(1e-3));
    for (const std::size_t entries : {1, 3, 16, 24, 100}) {
        for (const std::uint32_t strip : {3, 8, 64}) {
            CHECK(
                transformed_per_triangle(grid(strip), kVertices, entries)
                == test::near(by_queue(grid(strip), entries)));
        }
    }
    CHECK(transformed_per_triangle({}, 0) == 0);
}

TEST_CASE(
    "triangle order: the same triangles and corners, never more transformed vertices"
    * technique("engine.opt-vertex")) {
    std::vector<std::uint32_t> shuffled;
    std::vector<Triangle> triangles = sorted_triangles(grid(kQuads));
    std::shuffle(triangles.begin(), triangles.end(), std::mt19937(5));
    for (const Triangle& triangle : triangles) {
        shuffled.insert(shuffled.end(), triangle.begin(), triangle.end());
    }
    std::vector<std::uint32_t> apart;  // triangles without common vertices
    for (std::uint32_t i = 0; i < 300; ++i) {
        apart.push_back(i);
    }
    for (const std::vector<std::uint32_t>& one :
         {grid(kQuads), grid(6), grid(7), shuffled, apart}) {
        const std::vector<std::uint32_t> ordered = order_for_cache(one, kVertices);
        CHECK(sorted_triangles(ordered) == sorted_triangles(one));
        CHECK(
            transformed_per_triangle(ordered, kVertices)
            <= transformed_per_triangle(one, kVertices));
    }
    CHECK(transformed_per_triangle(shuffled, kVertices) > 2.5);
    CHECK(transformed_per_triangle(order_for_cache(shuffled, kVertices), kVertices) < 0.75);
    CHECK(transformed_per_triangle(order_for_cache(grid(kQuads), kVertices), kVertices) < 0.75);
    CHECK(order_for_cache({}, 0).empty());
}

}  // namespace limn::triangle_order_test
