#include "systems/animation/marker_paths.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn::marker_paths_test {
namespace {

using test::near;

constexpr int kSide = 9;  // vertices

/// A square of 1 m, with a slit along x = 0.5 from y = 0 up to `slit`, whose sides touch.
struct Sheet {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> triangles;

    explicit Sheet(float slit = 0.0f) {
        constexpr int kMiddle = kSide / 2;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                positions.push_back(Vec3(x, y, 0) / static_cast<float>(kSide - 1));
            }
        }
        std::vector<std::uint32_t> left(kSide);
        for (int y = 0; y < kSide; ++y) {
            left[static_cast<std::size_t>(y)] = at(kMiddle, y);
            if (static_cast<float>(y) / (kSide - 1) < slit) {
                left[static_cast<std::size_t>(y)] = static_cast<std::uint32_t>(positions.size());
                positions.push_back(positions[at(kMiddle, y)] - Vec3(1e-3f, 0, 0));
            }
        }
        for (int y = 0; y + 1 < kSide; ++y) {
            for (int x = 0; x + 1 < kSide; ++x) {
                const auto corner = [&](int i, int j) {
                    return i == kMiddle && x < kMiddle ? left[static_cast<std::size_t>(j)]
                                                       : at(i, j);
                };
                for (const std::uint32_t v :
                     {corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y),
                      corner(x + 1, y + 1), corner(x, y + 1)}) {
                    triangles.push_back(v);
                }
            }
        }
    }
    static std::uint32_t at(int x, int y) { return static_cast<std::uint32_t>(y * kSide + x); }
    [[nodiscard]] MarkerPaths paths(const std::vector<Vec3>& markers, float limit = 10) const {
        return find_marker_paths(
            positions, triangles, markers, std::vector<float>(markers.size(), limit));
    }
};

}  // namespace

TEST_CASE(
    "marker paths: they are the shortest ways along edges, as all pairs in turn find them"
    * technique("face.bids-project")) {
    const Sheet sheet(0.7f);
    const std::size_t n = sheet.positions.size();
    // R. W. Floyd, "Algorithm 97: Shortest Path", 1962.
    std::vector<double> all(n * n, INFINITY);
    for (std::size_t v = 0; v < n; ++v) {
        all[v * n + v] = 0;
    }
    for (std::size_t i = 0; i < sheet.triangles.size(); ++i) {
        const std::size_t a = sheet.triangles[i];
        const std::size_t b = sheet.triangles[i % 3 == 2 ? i - 2 : i + 1];
        const auto length =
            static_cast<double>(glm::distance(sheet.positions[a], sheet.positions[b]));
        all[a * n + b] = all[b * n + a] = length;
    }
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t a = 0; a < n; ++a) {
            for (std::size_t b = 0; b < n; ++b) {
                all[a * n + b] = std::min(all[a * n + b], all[a * n + k] + all[k * n + b]);
            }
        }
    }
    const std::vector<std::size_t> starts{0, 13, 40, n - 1};
    std::vector<Vec3> markers;
    for (const std::size_t v : starts) {
        markers.push_back(sheet.positions[v] + Vec3(0, 0, 0.01f));
    }
    const MarkerPaths paths = sheet.paths(markers);
    for (std::size_t m = 0; m < markers.size(); ++m) {
        for (std::size_t v = 0; v < n; ++v) {
            CHECK(paths.at(m, v) == near(all[starts[m] * n + v] + 0.01));
        }
    }
}

TEST_CASE(
    "marker paths: the sides of a slit are far from each other, and a net across it spans an "
    "opening"
    * technique("face.bids-project")) {
    const std::vector<Vec3> markers{{0.375f, 0, 0}, {0.625f, 0, 0}, {0.375f, 1, 0}, {0.5f, 0, 3}};
    const Sheet whole;
    const Sheet slit(0.9f);
    CHECK_FALSE(spans_opening(whole.paths(markers), markers, 0, 1));
    const MarkerPaths paths = slit.paths(markers);
    CHECK(paths.at(0, Sheet::at(5, 0)) > 1.5f);
    CHECK(spans_opening(paths, markers, 0, 1));
    CHECK(spans_opening(paths, markers, 1, 0));
    CHECK_FALSE(spans_opening(paths, markers, 0, 2));
    CHECK_FALSE(spans_opening(paths, markers, 0, 3));  // one is far from the mesh
}

TEST_CASE(
    "marker paths: seams are no slits, parts that are apart begin at their nearest vertices, and "
    "ways end at the limit"
    * technique("face.bids-project")) {
    Sheet sheet;
    // Every triangle with vertices of its own, and a triangle beside it.
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> triangles;
    for (const std::uint32_t v : sheet.triangles) {
        triangles.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.push_back(sheet.positions[v]);
    }
    for (const Vec3& corner : {Vec3(3, 0, 0), Vec3(4, 0, 0), Vec3(3, 1, 0)}) {
        triangles.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.push_back(corner);
    }
    const std::vector<Vec3> markers{Vec3(0)};
    const MarkerPaths whole = sheet.paths(markers);
    const MarkerPaths split = find_marker_paths(positions, triangles, markers, std::vector{10.0f});
    for (std::size_t i = 0; i < sheet.triangles.size(); ++i) {
        CHECK(split.at(0, i) == near(static_cast<double>(whole.at(0, sheet.triangles[i]))));
    }
    CHECK(split.at(0, positions.size() - 3) == near(3));
    CHECK(split.at(0, positions.size() - 1) == near(4));
    const MarkerPaths near_ones = sheet.paths(markers, 0.5f);
    CHECK(near_ones.at(0, 4) == near(0.5));
    CHECK(std::isinf(near_ones.at(0, 5)));
}

}  // namespace limn::marker_paths_test
