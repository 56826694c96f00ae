#include "ecs/base/rng.h"
#include "systems/animation/patch_normals.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace limn::patch_normals_test {
namespace {

using test::near;

float least_cosine(const Vec3& axis, const std::vector<Vec3>& directions) {
    float least = 1.0f;
    for (const Vec3& direction : directions) {
        least = std::min(least, glm::dot(axis, direction));
    }
    return least;
}

/// Large triangles that face along z around the first marker, and a sliver in a gap between them
/// that turns by `angle` about x.
struct Corner {
    std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    std::vector<std::uint32_t> corners = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 5, 6};
    std::vector<Vec3> normals;

    explicit Corner(float angle) {
        positions.emplace_back(0.05f, 0, 0);
        positions.emplace_back(0, 0.05f * std::cos(angle), 0.05f * std::sin(angle));
        make_patch_normals(positions, corners, normals);
    }
};

}  // namespace

TEST_CASE(
    "patch normals: no direction of ten thousand has a narrower cone than the axis"
    * technique("face.bids-surface")) {
    Random random(3, 1, 4, 1);
    for (int round = 0; round < 20; ++round) {
        std::vector<Vec3> directions;
        for (int i = 0; i < 3 + round % 6; ++i) {
            directions.push_back(glm::normalize(
                Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3f, 1))));
        }
        const Vec3 axis = axis_of_cone(directions);
        CHECK(glm::length(axis) == near(1));
        const float reached = least_cosine(axis, directions);
        float best = -1;
        for (int i = 0; i < 10000; ++i) {
            const float z = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / 10000.0f;
            const float turn = 2.399963f * static_cast<float>(i);
            const float radius = std::sqrt(1.0f - z * z);
            best = std::max(
                best,
                least_cosine({radius * std::cos(turn), radius * std::sin(turn), z}, directions));
        }
        CHECK(best <= reached + 1e-5f);
        CHECK(best >= reached - 0.05f);  // the spiral's points lie some 0.03 apart
    }
    CHECK(axis_of_cone({}) == Vec3(0));
}

TEST_CASE(
    "patch normals: means by area where all triangles face along them"
    * technique("face.bids-surface")) {
    const Corner gentle(0.5f);
    Vec3 sum = Vec3(0, 0, 3) + 0.0025f * Vec3(0, -std::sin(0.5f), std::cos(0.5f));
    CHECK(glm::distance(gentle.normals[0], glm::normalize(sum)) < 1e-6f);
}

TEST_CASE(
    "patch normals: a small triangle that turns away from large ones still faces along its normal"
    * technique("face.bids-surface")) {
    for (const float degrees : {100.0f, 130.0f, 160.0f}) {
        const Corner steep(radians(degrees));
        const Vec3 sliver(0, -std::sin(radians(degrees)), std::cos(radians(degrees)));
        // By hand: halfway between both directions.
        const Vec3 halfway = glm::normalize(sliver + Vec3(0, 0, 1));
        CHECK(glm::dot(steep.normals[0], sliver) > 0.1f);
        CHECK(glm::dot(steep.normals[0], Vec3(0, 0, 1)) > 0.1f);
        CHECK(glm::distance(steep.normals[0], halfway) < 1e-3f);
    }
    // Two sides of a fold that touch: no direction is faced by both.
    CHECK(Corner(radians(179.9f)).normals[0].z > 0.99f);
}

TEST_CASE(
    "patch normals: they turn without a jump as a triangle turns"
    * technique("face.bids-surface")) {
    float fastest = 0;
    for (int i = 0; i < 1800; ++i) {
        const Vec3 before = Corner(radians(0.1f * static_cast<float>(i))).normals[0];
        const Vec3 after = Corner(radians(0.1f * static_cast<float>(i + 1))).normals[0];
        fastest = std::max(fastest, glm::distance(before, after));
    }
    CHECK(fastest < 0.03f);  // per 0.1 degrees
}

}  // namespace limn::patch_normals_test
