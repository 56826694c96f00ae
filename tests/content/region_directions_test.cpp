#include "content/bake/region_directions.h"
#include "ecs/base/math.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace limn::region_directions_test {

using limn::test::near;

namespace {

constexpr int kSide = 21;           // vertices
constexpr float kSpacing = 0.004f;  // [m]

/// A square of skin in front of z = 0, all in a region whose folds lie across x, and a target that
/// moves it.
MeshData make_skin(
    const std::string& region, const char* unit, const std::function<Vec3(const Vec3&)>& move) {
    MeshData mesh;
    for (int i = 0; i < kSide * kSide; ++i) {
        const Vec3 p = {
            kSpacing * static_cast<float>(i % kSide - kSide / 2),
            kSpacing * static_cast<float>(i / kSide - kSide / 2), 0};
        mesh.positions.push_back(p);
        mesh.normals.emplace_back(0, 0, 1);
    }
    for (std::uint32_t i = 0; i < kSide * (kSide - 1); ++i) {
        if (i % kSide + 1 < kSide) {
            mesh.indices.insert(
                mesh.indices.end(), {i, i + 1, i + kSide, i + 1, i + kSide + 1, i + kSide});
        }
    }
    const std::size_t vertices = mesh.positions.size();
    mesh.regions.push_back(
        {region, std::vector<float>(vertices, 1.0f), std::vector<Vec3>(vertices, {1, 0, 0})});
    MorphTarget& morph = mesh.morphs.emplace_back();
    morph.name = "shape";
    morph.action_unit = unit;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        morph.vertices.push_back(v);
        morph.positions.push_back(move(mesh.positions[v]));
    }
    return mesh;
}

/// Shortens by a tenth along that angle, mirrored in x = 0.
std::function<Vec3(const Vec3&)> shorten(float angle_deg) {
    return [=](const Vec3& p) {
        const float angle = radians(angle_deg);
        const Vec3 d = {std::copysign(std::cos(angle), p.x), std::sin(angle), 0};
        return -0.1f * glm::dot(p, d) * d;
    };
}

/// On the left, from x towards y; on the right mirrored.
double angle_at(const MeshData& mesh, float x) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (std::abs(mesh.positions[v].x - x) < 1e-5f && mesh.positions[v].y == 0) {
            const Vec3 across = mesh.regions[0].across[v];
            return degrees(std::atan2(across.y, across.x));
        }
    }
    FAIL("no such vertex");
    return 0;
}

}  // namespace

TEST_CASE("region directions: a region turns to where its own expression shortens the skin most") {
    MeshData mesh = make_skin("glabella", "AU4", shorten(24));
    fit_region_directions(mesh);
    // The central column, which both sides pull, turns the mean a little.
    CHECK(angle_at(mesh, 0.02f) == near(24).epsilon(0.1));
    CHECK(angle_at(mesh, -0.02f) == near(-angle_at(mesh, 0.02f)).epsilon(1e-4));
    CHECK(std::abs(angle_at(mesh, 0)) < 1e-4);
    for (const Vec3& across : mesh.regions[0].across) {
        CHECK_UNARY(std::abs(glm::length(across) - 1) < 1e-5f && across.z == 0);
    }

    MeshData down = make_skin("glabella", "AU4_L", shorten(-24));
    fit_region_directions(down);
    CHECK(angle_at(down, 0.02f) == near(-24).epsilon(0.1));
}

TEST_CASE("region directions: none turns by more than 35 degrees") {
    MeshData mesh = make_skin("glabella", "AU4", shorten(70));
    fit_region_directions(mesh);
    CHECK(angle_at(mesh, 0.02f) == near(35).epsilon(1e-3));
}

TEST_CASE("region directions: other expressions and skin that shrinks evenly change nothing") {
    for (MeshData mesh :
         {make_skin("glabella", "AU12", shorten(24)), make_skin("chin", "AU4", shorten(24)),
          make_skin("glabella", "", shorten(24)),
          make_skin("glabella", "AU4", [](const Vec3& p) { return -0.1f * p; }),
          make_skin("glabella", "AU4", [](const Vec3& p) { return Vec3(-p.y, p.x, 0) - p; })}) {
        fit_region_directions(mesh);
        CHECK(std::abs(angle_at(mesh, 0.02f)) < 1e-3);
    }
}

TEST_CASE("region directions: triangles without area are ignored, collapsed skin is not") {
    MeshData mesh = make_skin("glabella", "AU4", shorten(24));
    mesh.indices.insert(mesh.indices.end(), {3, 3, 3});
    fit_region_directions(mesh);
    CHECK(angle_at(mesh, 0.02f) == near(24).epsilon(0.1));

    const auto collapse = [](const Vec3& p) { return Vec3(0, p.y, 0) - p; };
    MeshData line = make_skin("glabella", "AU4", collapse);
    fit_region_directions(line);
    CHECK(std::abs(angle_at(line, 0.02f)) < 1e-3);
}

}  // namespace limn::region_directions_test
