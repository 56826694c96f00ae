#include "content/load/level/level_load.h"
#include "content/make/models/joined.h"
#include "content/make/models/shapes.h"
#include "ecs/components/all.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/gtc/quaternion.hpp>

#include <string>

namespace limn::joined_test {

using namespace test;

namespace {

/// A box of 1 x 2 x 3 m and a tube of 1 m with a radius of 0.5 m.
Assets box_and_tube() {
    Assets assets;
    assets.meshes.push_back(make_box({.size = {1, 2, 3}}));
    assets.meshes.push_back(make_cylinder({.radius = 0.5f, .height = 1, .segments = 24}));
    return assets;
}

}  // namespace

TEST_CASE("joined: parts keep their volume, normals and tangents under any rotation") {
    const Assets assets = box_and_tube();
    JoinedShape shape;
    shape.parts = {
        {.mesh = {0},
         .position = {1, 2, 3},
         .rotation = glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, -1)))},
        {.mesh = {1}, .position = {-5, 0, 0}, .scale = {2, 0.1f, 1}},
        {.mesh = {7}}};
    const MeshData mesh = make_joined(shape, assets);
    check_arrays(mesh);
    CHECK(open_edges(mesh) == 0);
    CHECK(
        signed_volume(mesh)
        == near(signed_volume(assets.meshes[0]) + 0.2 * signed_volume(assets.meshes[1]))
               .epsilon(1e-5));
    CHECK(worst_facing(mesh) > 0.96f);
    CHECK(worst_tangent(mesh) > 0.96f);
}

TEST_CASE("joined: a part is scaled, turned, then moved, and has the color it is given") {
    const Assets assets = box_and_tube();
    JoinedShape shape;
    const Quat quarter = glm::angleAxis(0.5f * kPi, Vec3(0, 0, 1));  // x to y
    shape.parts = {
        {.mesh = {0},
         .position = {10, 0, 0},
         .rotation = quarter,
         .scale = {4, 1, 1},
         .color = {1, 0.5f, 0.25f}}};
    const MeshData mesh = make_joined(shape, assets);
    CHECK(mesh.bounds.min.x == near(9));
    CHECK(mesh.bounds.max.y == near(2));
    CHECK(mesh.bounds.max.z == near(1.5));
    CHECK(mesh.colors.size() == mesh.positions.size());
    CHECK(mesh.colors[0] == Vec4(1, 0.5f, 0.25f, 1));
}

TEST_CASE("joined: a level names its parts; without any, it is empty") {
    register_all_components();
    const auto load = [](const char* parts) {
        return parse_level(
            std::string(R"({"meshes": {"a": {"make": "box"}, "b": {"make": "joined", "parts": [)")
                + parts + "]}}}",
            "t.level.json");
    };
    Result<Level> level = load(R"({"mesh": "a"}, {"mesh": "a", "position": [3, 0, 0]})");
    REQUIRE_MESSAGE(level.ok(), (level ? std::string() : level.error().message));
    REQUIRE(load_level_assets(*level, ".").ok());
    REQUIRE(level->assets.meshes.size() == 2);
    CHECK(level->assets.meshes[1].positions.size() == 2 * level->assets.meshes[0].positions.size());
    CHECK(make_joined({}, {}).positions.empty());
    const Result<Level> unknown = load(R"({"mesh": "c"})");
    REQUIRE(!unknown.ok());
    CHECK(unknown.error().message.find("meshes.b.parts[0].mesh") != std::string::npos);
    const Result<Level> flat = load(R"({"mesh": "a", "scale": [1, 0, 1]})");
    REQUIRE(!flat.ok());
    CHECK(flat.error().message.find("scale") != std::string::npos);
}

}  // namespace limn::joined_test
