#include "systems/animation/patch_binding.h"
#include "systems/animation/surface_patches.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace limn::surface_patches_border_test {
namespace {

struct Net {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> corners;
    std::vector<Vec4> patches;

    void update() { make_patches(positions, corners, patches); }
    [[nodiscard]] std::span<const Vec4> patch(std::size_t f) const {
        return std::span(patches).subspan(f * kPatchTexels, kPatchTexels);
    }
    [[nodiscard]] std::size_t faces() const { return corners.size() / 3; }
};

}  // namespace

TEST_CASE(
    "patches: beside a coarse net, too, a vertex follows the nearest point, its neighbors as much"
    * technique("face.bids-project")) {
    // Sixteen markers of a face [m], where the borders of chin and cheek meet at sharp corners.
    constexpr std::array<Vec3, 16> kMarkers = {{
        {0, -3.9f, 11.6f},
        {0, -6.9f, 10.9f},
        {0.8f, -3.8f, 11.5f},
        {-5.1f, 0, 9},
        {-2.6f, -3.4f, 10.3f},
        {5.1f, 0, 9},
        {2.6f, -3.4f, 10.3f},
        {-0.8f, -3.8f, 11.5f},
        {-0.8f, -2.9f, 11.6f},
        {0.8f, -2.9f, 11.6f},
        {-4.5f, 5.9f, 9.5f},
        {0, 0.4f, 13.1f},
        {4.5f, 5.9f, 9.5f},
        {1.2f, 6.7f, 10.6f},
        {-1.2f, 6.7f, 10.6f},
        {0, -3.1f, 11.7f},
    }};
    Net net;
    for (const Vec3& marker : kMarkers) {
        net.positions.push_back(0.01f * marker);
    }
    net.corners = {0,  1,  2,  3,  1,  4,  1,  5, 6,  2, 1,  6,  1,  0,  7,  8,  4,  7,
                   4,  1,  7,  2,  6,  9,  10, 3, 11, 3, 4,  11, 5,  12, 11, 12, 13, 11,
                   13, 14, 11, 14, 10, 11, 4,  8, 11, 6, 5,  11, 9,  6,  11, 0,  2,  15,
                   8,  7,  15, 2,  9,  15, 7,  0, 15, 9, 11, 15, 11, 8,  15};
    net.update();
    // Beside each edge of the border, up to 45 mm.
    constexpr std::array<std::pair<std::size_t, std::size_t>, 7> kBorder = {
        {{1, 5}, {3, 1}, {10, 3}, {5, 12}, {12, 13}, {13, 14}, {14, 10}}};
    std::vector<Vec3> samples;
    for (std::size_t f = 0; f < net.faces(); ++f) {
        for (int i = 0; i <= 40; ++i) {
            for (int k = 0; i + k <= 40; ++k) {
                samples.push_back(
                    evaluate_patch(
                        net.patch(f), static_cast<float>(i) / 40, static_cast<float>(k) / 40)
                        .position);
            }
        }
    }
    constexpr int kOut = 15;
    std::vector<Vec3> points;
    for (const auto& [a, b] : kBorder) {
        const Vec3 along = net.positions[b] - net.positions[a];
        const Vec3 middle = (net.positions[a] + net.positions[b]) / 2.0f;
        const Vec3 radial = Vec3(middle.x, middle.y, 0);
        const Vec3 out =
            glm::normalize(radial - along * (glm::dot(radial, along) / glm::dot(along, along)));
        for (float t = 0.0f; t <= 1.0f; t += 0.02f) {
            for (int step = 1; step <= kOut; ++step) {
                points.push_back(
                    net.positions[a] + t * along + 0.003f * static_cast<float>(step) * out);
            }
        }
    }
    std::vector<Vec3> normals;
    for (const Vec3& point : points) {
        normals.push_back(glm::normalize(point - Vec3(0, 0, 0.02f)));
    }
    const std::vector<Vec4> tangents(points.size(), Vec4(1, 0, 0, 1));
    const std::vector<SurfaceAnchor> anchors =
        bind_to_patches({points, normals, tangents}, net.positions, net.corners, 0.05f);
    std::vector<float> shares;
    for (std::size_t i = 0; i < points.size(); ++i) {
        shares.push_back(anchors[i].share);
        for (std::size_t a = anchors[i].next; a != 0; a = anchors[a].next) {
            shares[i] += anchors[a].share;
        }
    }
    float farther = 0;
    float unequal = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (anchors[i].patch == kNoPatch) {
            continue;
        }
        if (i % 31 == 0) {
            float nearest = 1;
            for (const Vec3& sample : samples) {
                nearest = std::min(nearest, glm::distance(sample, points[i]));
            }
            farther = std::max(farther, glm::length(anchors[i].offset) - nearest);
        }
        if (i + kOut < points.size() && glm::distance(points[i], points[i + kOut]) < 0.003f) {
            unequal = std::max(unequal, std::abs(shares[i] - shares[i + kOut]));
        }
    }
    CHECK(farther < 0.002f);  // of 45 mm: Newton stops beside some feet
    CHECK(unequal < 0.15f);
}

}  // namespace limn::surface_patches_border_test
