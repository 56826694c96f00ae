#include "content/make/models/boat.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn::boat_test {

using namespace test;

namespace {

constexpr BoatPart kParts[] = {BoatPart::Hull, BoatPart::Deck, BoatPart::Spars, BoatPart::Rig};

}  // namespace

TEST_CASE("boat: every part has orthogonal frames that face as its triangles do") {
    for (const BoatPart part : kParts) {
        CAPTURE(static_cast<int>(part));
        for (const int stations : {6, 24, 40}) {
            const MeshData mesh =
                make_boat({.part = part, .strakes = stations / 3, .stations = stations});
            check_arrays(mesh);
            CHECK(mesh.colors.size() == mesh.positions.size());
            // The edges of keel and rudder are sharper than their triangles.
            double away = 0;
            double area = 0;
            for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
                const Vec3 twice = double_area(mesh, i / 3);
                area += static_cast<double>(glm::length(twice));
                away += glm::dot(twice, mesh.normals[mesh.indices[i]]) < 0
                            ? static_cast<double>(glm::length(twice))
                            : 0.0;
            }
            CHECK(away < 5e-3 * area);
        }
    }
}

TEST_CASE("boat: hull and deck are mirror symmetric, of the requested length") {
    for (const BoatPart part : {BoatPart::Hull, BoatPart::Deck}) {
        const MeshData mesh = make_boat({.part = part, .length = 9});
        CHECK(mesh.bounds.max.x == test::near(-mesh.bounds.min.x).epsilon(1e-3));
        CHECK(mesh.bounds.max.x == test::near(1.5).epsilon(0.06));  // half its beam
        Vec3 sum(0);
        for (const Vec3& p : mesh.positions) {
            sum += p;
        }
        CHECK(std::abs(sum.x) < 1e-2f * static_cast<float>(mesh.positions.size()));
    }
    const MeshData deck = make_boat({.part = BoatPart::Deck, .length = 9});
    CHECK(deck.bounds.max.z - deck.bounds.min.z == test::near(9).epsilon(0.1));
}

TEST_CASE("boat: the deck lies inside the hull and closes it from above") {
    const MeshData hull = make_boat({.part = BoatPart::Hull});
    const MeshData deck = make_boat({.part = BoatPart::Deck});
    CHECK(deck.bounds.max.x < hull.bounds.max.x);
    CHECK(deck.bounds.max.z < hull.bounds.max.z);
    // Its planks look up; most of what is not a wall does.
    double up = 0;
    double down = 0;
    for (std::size_t t = 0; t < deck.indices.size() / 3; ++t) {
        const float y = double_area(deck, t).y;
        (y > 0 ? up : down) += static_cast<double>(std::abs(y)) / 2;
    }
    CHECK(up > 7);  // [m^2] of 2 m x 6 m
    CHECK(down < 0.1);
}

TEST_CASE("boat: the sail's belly is to port, its boom and gaff point astern") {
    const MeshData rig = make_boat({.part = BoatPart::Rig});
    CHECK(rig.bounds.max.x > 0.3f);
    CHECK(rig.bounds.min.x > -0.1f);
    CHECK(rig.bounds.min.z < -3.5f);
    CHECK(rig.bounds.max.z < 0.2f);
    // Both sides of the cloth have as much area.
    Vec3 sum(0);
    for (std::size_t t = 0; t < rig.indices.size() / 3; ++t) {
        sum += double_area(rig, t);
    }
    CHECK(std::abs(sum.x) < 0.5f);
    CHECK(mast_position(12).z == test::near(3.8));
}

}  // namespace limn::boat_test
