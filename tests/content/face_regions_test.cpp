#include "content/bake/face_regions.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

namespace limn::face_regions_test {

using limn::test::near;

namespace {

/// The region of that name at one point of the reference face with this `normal`.
struct Sample {
    float weight = 0;
    Vec3 across = Vec3(0);
};
Sample sample(std::string_view name, const Vec3& p, const Vec3& normal = {0, 0, 1}) {
    const std::vector<Vec3> points = {p};
    const std::vector<Vec3> normals = {glm::normalize(normal)};
    for (const VertexRegion& region : make_face_regions(points, normals)) {
        if (region.name == name) {
            return {region.weights[0], region.across.empty() ? Vec3(0) : region.across[0]};
        }
    }
    FAIL("no such region");
    return {};
}

double angle_of(const Vec3& across) {
    return std::remainder(degrees(std::atan2(across.y, across.x)), 180.0f);
}

}  // namespace

TEST_CASE("face regions: weights are 1 within the rule, half at its border and 0 beyond") {
    CHECK(sample("forehead", {1, 8.5f, 10}).weight == 1.0f);
    CHECK(sample("forehead", {1, 6.8f, 10}).weight == near(0.5));
    CHECK(sample("forehead", {5, 8.5f, 10}).weight == near(0.5));
    CHECK(sample("forehead", {1, 6.5f, 10}).weight == 0.0f);
    CHECK(sample("forehead", {5.3f, 8.5f, 10}).weight == 0.0f);
    CHECK(sample("upper_lip", {0, -1.9f, 9.2f}).weight == 0.0f);  // inside the mouth
    CHECK(sample("nasolabial", {2.4f, -1.65f, 10}).weight == 1.0f);
    CHECK(sample("nasolabial", {0, -1.65f, 10}).weight == 0.0f);
}

TEST_CASE("face regions: skin that does not face the front belongs only to the canthus") {
    CHECK(sample("forehead", {1, 8.5f, 10}, {1, 0, 0.05f}).weight == 0.0f);
    CHECK(sample("crows_feet", {5.5f, 3.4f, 8}, {1, 0, 0}).weight == 1.0f);
}

TEST_CASE("face regions: both sides mirror each other") {
    for (const Vec3& p : std::vector<Vec3>{
             {0.5f, 8, 10},
             {1, 5, 10},
             {5.4f, 3, 8},
             {1.2f, 1.5f, 11},
             {2.5f, -1.8f, 10},
             {1.3f, -2, 11},
             {3.2f, -4, 10},
             {1.5f, -5.1f, 10},
             {3.2f, 4.8f, 9},
             {4.5f, 0, 9}}) {
        const Vec3 flip = {-1, 1, 1};
        const Vec3 normal = glm::normalize(Vec3(0.4f, 0.2f, 0.9f));
        for (const std::string_view name : face_region_names()) {
            const Sample left = sample(name, p, normal);
            const Sample right = sample(name, p * flip, normal * flip);
            CAPTURE(name);
            CHECK(left.weight == near(right.weight));
            // A direction and its opposite are the same.
            CHECK(
                std::abs(glm::dot(left.across, right.across * flip))
                == near(glm::dot(left.across, left.across)).epsilon(1e-5));
        }
    }
}

TEST_CASE("face regions: directions are unit and in the skin, where the region has some weight") {
    const Vec3 normal = glm::normalize(Vec3(0.3f, -0.2f, 0.8f));
    for (const std::string_view name : face_region_names()) {
        for (float x = -6; x <= 6; x += 0.7f) {
            for (float y = -7; y <= 10; y += 0.9f) {
                const Sample found = sample(name, {x, y, 10}, normal);
                const bool has = found.weight > 0 && name != "chin";
                CHECK(glm::length(found.across) == near(has ? 1 : 0).epsilon(1e-5));
                CHECK(std::abs(glm::dot(found.across, normal)) < 1e-5f);
            }
        }
    }
}

TEST_CASE("face regions: folds of the canthus and the lips radiate, the nasolabial one is a line") {
    // The line from the corner of the eye outwards is a fold.
    const Vec3 outwards = glm::normalize(Vec3(1, 0.5f, 0));
    const Sample canthus = sample("crows_feet", Vec3(4.459f, 3.432f, 8.603f) + outwards);
    CHECK(std::abs(glm::dot(canthus.across, outwards)) < 1e-5f);
    CHECK(std::abs(angle_of(sample("upper_lip", {0, -1.9f, 11.5f}).across)) < 1e-3);
    CHECK(angle_of(sample("upper_lip", {1.4f, -1.9f, 11}).across) == near(-26).epsilon(0.2));
    const Vec3 along = glm::normalize(Vec3(3.1f - 1.75f, -3 + 0.3f, 0));
    CHECK(std::abs(glm::dot(sample("nasolabial", {2.4f, -1.65f, 10}).across, along)) < 0.02f);
    CHECK(angle_of(sample("forehead", {3, 8, 10}).across) == near(83).epsilon(1e-3));
    CHECK(std::abs(angle_of(sample("forehead", {0, 8, 10}).across)) == near(90).epsilon(1e-3));
    CHECK(angle_of(sample("glabella", {1, 5, 10}).across) == near(20).epsilon(1e-3));
}

TEST_CASE("face regions: vertices outside the face are in no region") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const std::string_view name : face_region_names()) {
        CHECK(sample(name, {nan, 8, 10}).weight == 0.0f);
        CHECK(sample(name, {0, -30, 10}).weight == 0.0f);
    }
}

}  // namespace limn::face_regions_test
