#include "content/make/models/masonry.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <string>

namespace limn::masonry_test {

using namespace limn::test;

namespace {

constexpr double kPiD = 3.14159265358979323846;

/// A closed two-manifold, as shadow volumes need it, and all that holds for every mesh.
void check_solid(const MeshData& mesh) {
    check_arrays(mesh);
    CHECK(open_edges(mesh) == 0);
    CHECK(signed_volume(mesh) > 0);
    CHECK(worst_facing(mesh) > 0.2f);  // of few segments
    CHECK(crowded_edges(mesh) == 0);
}

/// Area under half an arc of radius r spans that is stretched to span and rise, by the arc's
/// closed form: the integral of sqrt(r^2 - (x - c)^2) from 0 to 1 half span.
double area_below(double span, double rise, double radius) {
    const double r = 2.0 * radius;
    const double c = 1.0 - r;
    const auto primitive = [&](double x) {
        const double u = x - c;
        return 0.5 * (u * std::sqrt(std::max(r * r - u * u, 0.0)) + r * r * std::asin(u / r));
    };
    return span * rise * (primitive(1.0) - primitive(0.0)) / std::sqrt(2.0 * r - 1.0);
}

}  // namespace

TEST_CASE("masonry: the curve runs from the springing to the point, and starts upright") {
    for (const float radius : {0.0f, 0.5f, 0.8f, 1.0f, 3.0f}) {
        const std::vector<CurvePoint> curve = pointed_curve(3.0f, 2.5f, radius, 9);
        REQUIRE(curve.size() == 10);
        CHECK(curve.front().position == Vec2(1.5f, 0));
        CHECK(curve.front().normal == Vec2(1, 0));
        CHECK(curve.back().position == Vec2(0, 2.5f));
        for (std::size_t i = 1; i < curve.size(); ++i) {
            CHECK(curve[i].position.x < curve[i - 1].position.x);
            CHECK(curve[i].position.y > curve[i - 1].position.y);
            const Vec2 chord = glm::normalize(curve[i].position - curve[i - 1].position);
            const Vec2 between = glm::normalize(curve[i].normal + curve[i - 1].normal);
            CHECK(std::abs(glm::dot(chord, between)) < 0.02f);
        }
    }
}

TEST_CASE("masonry: the arcs of an equilateral arch are centered at the opposite springing") {
    const float rise = std::sqrt(3.0f);
    for (const float radius : {0.0f, 1.0f}) {  // by its rise, or by its name
        for (const CurvePoint& point : pointed_curve(2.0f, rise, radius, 16)) {
            CHECK(glm::distance(point.position, Vec2(-1, 0)) == test::near(2.0f));
        }
    }
    // What is too low for two arcs is half an ellipse; half a circle has no point.
    for (const CurvePoint& point : pointed_curve(4.0f, 1.0f, 0.0f, 16)) {
        CHECK(glm::length(point.position * Vec2(0.5f, 1)) == test::near(1.0f));
    }
    CHECK(pointed_curve(2.0f, 1.0f, 0.5f, 4).back().normal == Vec2(0, 1));
}

TEST_CASE("masonry: arches are closed, with legs and chamfers or without") {
    check_solid(make_arch({}));
    check_solid(make_arch({.legs = 2.0f, .chamfer = 0.1f}));
    check_solid(make_arch({.span = 1, .rise = 3, .radius = 4, .chamfer = 9, .segments = 3}));
    check_solid(make_arch({.span = 8, .rise = 1, .radius = 0.5f, .segments = 1}));
}

TEST_CASE("masonry: the volume of half a ring is that of the ring") {
    const MeshData ring =
        make_arch({.span = 2, .rise = 1, .thickness = 0.5f, .depth = 0.4f, .segments = 64});
    CHECK(signed_volume(ring) == test::near(0.4 * 0.5 * kPiD * (2.25 - 1)).epsilon(2e-3));
    const MeshData legs = make_arch(
        {.span = 2, .rise = 1, .legs = 3, .thickness = 0.5f, .depth = 0.4f, .segments = 64});
    CHECK(signed_volume(legs) - signed_volume(ring) == test::near(2 * 3 * 0.5 * 0.4).epsilon(1e-4));
    CHECK(legs.bounds.min.y == -3.0f);
    CHECK(legs.bounds.max == Vec3(1.5f, 1.5f, 0.2f));
}

TEST_CASE("masonry: walls are closed, whatever their opening") {
    check_solid(make_wall({}));
    check_solid(make_wall({.spring = 2.0f, .sill = 1.0f}));
    check_solid(make_wall({.spring = 1.0f, .sill = 5.0f}));  // begins where the curve does
    check_solid(make_wall({.size = {8, 9, 1}, .span = 6, .spring = 5, .round = true}));
    check_solid(make_wall({.size = {1, 1, 1}, .span = 50, .spring = 50, .rise = 50}));
    check_solid(make_wall({.size = {1, 3, 1}, .span = 50, .spring = 50, .round = true}));
    check_solid(make_wall({.spring = 0.0f}));
}

TEST_CASE("masonry: frames agree with position and texture") {
    CHECK(worst_facing(make_arch({.chamfer = 0.1f, .segments = 64})) > 0.99f);
    CHECK(worst_facing(make_vault({.segments = 32})) > 0.95f);
    CHECK(worst_tangent(make_vault({.segments = 32})) > 0.95f);
    CHECK(worst_tangent(make_wall({.sill = 1, .segments = 32})) > 0.95f);
}

TEST_CASE("masonry: the volume of a wall is that of its box without the opening") {
    const MeshData door = make_wall(
        {.size = {4, 6, 0.5f}, .span = 2, .spring = 3, .rise = 2, .radius = 1, .segments = 64});
    CHECK(
        signed_volume(door)
        == test::near(0.5 * (4 * 6 - 2 * 3 - area_below(2, 2, 1))).epsilon(1e-3));
    const MeshData rose =
        make_wall({.size = {8, 9, 1}, .span = 6, .spring = 5, .round = true, .segments = 64});
    CHECK(signed_volume(rose) == test::near(72 - 9 * kPiD).epsilon(1e-3));
    CHECK(rose.bounds.min == Vec3(-4, 0, -0.5f));
    CHECK(rose.bounds.max == Vec3(4, 9, 0.5f));
}

TEST_CASE("masonry: vaults are closed over squares and oblongs") {
    check_solid(make_vault({}));
    check_solid(make_vault({.size = {8, 4}, .rise = 4.5f, .segments = 7}));
    check_solid(make_vault({.size = {3, 5}, .radius = 0.5f, .segments = 1}));
}

TEST_CASE("masonry: a vault has constant thickness, and fits the arch over its diagonal") {
    const VaultShape shape{.size = {6, 4}, .rise = 3, .radius = 0.8f, .thickness = 0.2f};
    const MeshData vault = make_vault(shape);
    CHECK(signed_volume(vault) == test::near(6 * 4 * 0.2).epsilon(1e-4));
    CHECK(vault.bounds.min == Vec3(-3, 0, -2));
    CHECK(vault.bounds.max == Vec3(3, 3.2f, 2));
    const float diagonal = std::sqrt(52.0f);
    for (const CurvePoint& rib : pointed_curve(diagonal, 3, 0.8f, shape.segments)) {
        const Vec3 position = {
            rib.position.x * 6 / diagonal, rib.position.y, rib.position.x * 4 / diagonal};
        float nearest = 1;
        for (const Vec3& p : vault.positions) {
            nearest = std::min(nearest, glm::distance(p, position));
        }
        CHECK(nearest < 1e-5f);
    }
    // Seen from below: its lower normals point down, and toward the middle.
    for (std::size_t i = 0; i < vault.positions.size(); ++i) {
        if (vault.normals[i].y < -1e-3f) {
            CHECK(glm::dot(vault.normals[i] * Vec3(1, 0, 1), vault.positions[i]) < 1e-5f);
        }
    }
}

}  // namespace limn::masonry_test
