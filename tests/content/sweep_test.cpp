#include "content/load/level/level_load.h"
#include "content/make/models/sweep.h"
#include "ecs/components/all.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn::sweep_test {

using namespace test;

namespace {

Assets assets_with(const PathShape& shape) {
    Assets assets;
    assets.paths.push_back(*make_path(shape));
    return assets;
}

/// A circle of radius 10 that faces up.
Assets ring() {
    constexpr float k = 10 * 0.5522847f;
    PathShape shape;
    shape.closed = true;
    shape.knots = {
        {{10, 0, 0}, {0, 0, k}, {0, 0, -k}, 0},
        {{0, 0, -10}, {k, 0, 0}, {-k, 0, 0}, 0},
        {{-10, 0, 0}, {0, 0, -k}, {0, 0, k}, 0},
        {{0, 0, 10}, {-k, 0, 0}, {k, 0, 0}, 0}};
    return assets_with(shape);
}

double area(const MeshData& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vec3& a = mesh.positions[mesh.indices[i]];
        sum +=
            0.5
            * static_cast<double>(glm::length(glm::cross(
                mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a)));
    }
    return sum;
}

}  // namespace

TEST_CASE(
    "sweep: a road round a circle has the area of the ring, faces up and is measured in meters") {
    SweepShape shape;
    shape.path = {0};
    shape.profile = {{-2, 0}, {0, 0}, {2, 0}};
    shape.step = 0.1f;
    const MeshData mesh = make_sweep(shape, ring());
    check_arrays(mesh);
    CHECK(worst_facing(mesh) > 0.999f);
    CHECK(area(mesh) == test::near(kPi * (12 * 12 - 8 * 8)).epsilon(2e-3));
    for (const Vec3& normal : mesh.normals) {
        CHECK(normal.y == test::near(1));
    }
    float longest = 0;
    for (const Vec2& uv : mesh.uvs) {
        CHECK((uv.x >= 0 && uv.x <= 4.0001f));
        longest = std::max(longest, uv.y);
    }
    CHECK(longest == test::near(2 * kPi * 10).epsilon(1e-3));
    CHECK(mesh.bounds.max.x == test::near(12).epsilon(1e-3));
}

TEST_CASE("sweep: a tube is closed and has the volume of a torus or a cylinder") {
    SweepShape shape;
    shape.path = {0};
    shape.radius = 1;
    shape.segments = 48;
    shape.step = 0.25f;
    const MeshData torus = make_sweep(shape, ring());
    CHECK(signed_volume(torus) == test::near(2 * kPi * kPi * 10).epsilon(0.01));
    CHECK(open_edges(torus) == 0);
    const MeshData cylinder = make_sweep(shape, {});  // no path: 10 m along +z
    CHECK(open_edges(cylinder) == 0);
    CHECK(signed_volume(cylinder) == test::near(kPi * 10).epsilon(0.01));
    CHECK(cylinder.bounds.max.z == test::near(10));
    CHECK(worst_facing(cylinder) > 0.99f);
}

TEST_CASE("sweep: edges sharper than the crease stay edges") {
    SweepShape shape;
    shape.profile = {{-1, 0}, {-1, 1}, {1, 1}, {1, 0}};
    const MeshData sharp = make_sweep(shape, {});
    shape.crease = 3;
    const MeshData smooth = make_sweep(shape, {});
    CHECK(sharp.positions.size() > smooth.positions.size());
    CHECK(worst_facing(sharp) > 0.999f);
    CHECK(worst_facing(smooth) < 0.8f);
    CHECK(area(sharp) == test::near(10 * 4));
}

TEST_CASE("sweep: dashes cover their fraction of the path, between begin and end") {
    SweepShape shape;
    shape.profile = {{-0.1f, 0}, {0.1f, 0}};
    shape.begin = 1;
    shape.end = 9;
    CHECK(area(make_sweep(shape, {})) == test::near(0.2 * 8));
    shape.dash = 1.5f;
    shape.gap = 0.5f;
    const MeshData mesh = make_sweep(shape, {});
    CHECK(area(mesh) == test::near(0.2 * 6));
    CHECK(mesh.bounds.min.z == test::near(1));
    CHECK(mesh.bounds.max.z == test::near(8.5));
}

TEST_CASE("sweep: a tube that climbs straight up does not twist") {
    PathShape path;
    path.knots.resize(4);
    path.knots[1].position = {0, 1, 1};
    path.knots[2].position = {0, 4, 1};
    path.knots[3].position = {1, 5, 1};
    SweepShape shape;
    shape.path = {0};
    shape.radius = 0.1f;
    shape.step = 0.05f;
    shape.upright = false;
    const MeshData mesh = make_sweep(shape, assets_with(path));
    CHECK(open_edges(mesh) == 0);
    CHECK(worst_facing(mesh) > 0.9f);
}

TEST_CASE("sweep: levels name their paths, and a bad one is reported with its position") {
    register_all_components();
    const Result<Level> level = parse_level(
        R"json({
      "paths": {"loop": {"closed": true, "knots": [
        {"position": [0, 0, 0]}, {"position": [10, 0, 0]}, {"position": [5, 0, 8]}]}},
      "meshes": {"road": {"make": "sweep", "path": "loop"}},
      "entities": [{"path_follower": {"path": "loop", "speed": 3}}]
    })json",
        "a.level.json");
    REQUIRE(level.ok());
    CHECK(level->assets.paths[0].name == "loop");
    CHECK(level->assets.paths[0].segments.size() == 3);
    const auto error = [](const char* text) {
        return parse_level(text, "a.level.json").error().message;
    };
    CHECK(
        error(R"({"paths": {"loop": {"knots": [{"position": [0, 0, 0]}]}}})")
        == "a.level.json:1:20: paths.loop: found 1 knots, expected at least 2");
    CHECK(
        error(R"({"meshes": {"road": {"make": "sweep", "path": "lop"}}})").find("\"lop\"")
        != std::string::npos);
}

}  // namespace limn::sweep_test
