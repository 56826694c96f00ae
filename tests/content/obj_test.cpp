#include "content/load/obj_file.h"
#include "content/load/obj_scene.h"
#include "content/load/scene_load.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "tests/near.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace limn::obj_test {

using limn::test::near;

namespace {

/// Two walls of a house, of two materials, and a roof in another group.
const char* const kHouse = R"(# a house
mtllib house.mtl
o house
v 0 0 0
v 1 0 0 1.0
v 1 1 0
v 0 1 +0
v 0.5 1.5e0 0
vt 0 0
vt 1 0 0
vt 1 1
vt 0 1
vn 0 0 2
g front
usemtl brick
f 1/1/1 2/2/1 3/3/1 4/4/1
g roof
usemtl slate tile
s 1
f -2//-1 \
  -3//-1 -1//-1
)";

/// The message of a file that must not load.
std::string refusal(const std::string& text, const ObjLimits& limits = {}) {
    const Result<ObjFile> obj = parse_obj(text, "a.obj", limits);
    return obj ? "it loads" : obj.error().message;
}

/// Twice the area of a polygon, and of its triangles with a sum of absolute values.
float triangle_area(const std::vector<Vec3>& p, const std::vector<std::uint32_t>& triangles) {
    float sum = 0;
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
        sum += glm::length(glm::cross(
            p[triangles[i + 1]] - p[triangles[i]], p[triangles[i + 2]] - p[triangles[i]]));
    }
    return 0.5f * sum;
}

}  // namespace

TEST_CASE("obj: vertices, polygons and names are read, with negative indices and joined lines") {
    const Result<ObjFile> obj = parse_obj(kHouse, "house.obj");
    REQUIRE(obj.ok());
    CHECK(obj->positions.size() == 5);
    CHECK(obj->positions[4].y == 1.5f);
    CHECK(obj->uvs.size() == 4);
    CHECK(obj->faces.size() == 2);
    CHECK(obj->corners.size() == 7);
    CHECK(obj->objects == std::vector<std::string>{"", "house"});
    CHECK(obj->groups == std::vector<std::string>{"", "front", "roof"});
    CHECK(obj->materials == std::vector<std::string>{"", "brick", "slate tile"});
    CHECK(obj->libraries == std::vector<std::string>{"house.mtl"});
    const ObjFace& roof = obj->faces[1];
    CHECK(obj->groups[roof.group] == "roof");
    CHECK(obj->materials[roof.material] == "slate tile");
    CHECK(roof.count == 3);
    CHECK(obj->corners[roof.first].position == 3);
    CHECK(obj->corners[roof.first].uv == -1);
    CHECK(obj->corners[roof.first].normal == 0);
    CHECK(obj->warnings.empty());
}

TEST_CASE("obj: what is not read leaves one warning with its line") {
    const Result<ObjFile> obj = parse_obj("v 0 0 0\nl 1 1\nl 1 1\np 1\n", "a.obj");
    REQUIRE(obj.ok());
    CHECK(
        obj->warnings
        == std::vector<std::string>{"a.obj:2: \"l\" is ignored", "a.obj:4: \"p\" is ignored"});
}

TEST_CASE("obj: a bad file is refused with its line, what was found and what was expected") {
    const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    CHECK(
        refusal("v 0 0\n") == "a.obj:1: v: found nothing, expected a number of at most 1000000000");
    CHECK(refusal("v 0 0 nan\n").find("a.obj:1: v: found \"nan\", expected") == 0);
    CHECK(refusal("v 0 0 1e10\n").find("a.obj:1: v: found \"1e10\", expected") == 0);
    CHECK(refusal("\nvt x\n").find("a.obj:2: vt: found \"x\"") == 0);
    CHECK(
        refusal(v + "f 1 2 4\n")
        == "a.obj:4: found \"4\", expected an index into the 3 vertices so far");
    CHECK(refusal(v + "f 1 2 0\n").find("a.obj:4: found \"0\"") == 0);
    CHECK(refusal(v + "f 1 2 -4\n").find("a.obj:4: found \"-4\"") == 0);
    CHECK(refusal(v + "f 1 2 99999999999999999999\n").find("a.obj:4: found") == 0);
    CHECK(refusal(v + "f 1/1 2 3\n").find("0 texture coordinates so far") != std::string::npos);
    CHECK(refusal(v + "f 1//1 2 3\n").find("0 normals so far") != std::string::npos);
    CHECK(refusal(v + "f 1/2/3/4 2 3\n").find("at most three indices") != std::string::npos);
    CHECK(refusal(v + "f 1 2\n") == "a.obj:4: found 2 corners, expected at least 3");
    CHECK(refusal("f 1 2 3\n" + v).find("a.obj:1: found \"1\"") == 0);
}

TEST_CASE("obj: limits are kept") {
    ObjLimits limits;
    limits.max_vertices = 2;
    CHECK(
        refusal("v 0 0 0\nv 0 0 0\nv 0 0 0\n", limits)
        == "a.obj:3: found more v, expected at most 2");
    limits = {};
    limits.max_corners = 3;
    CHECK(refusal("v 0 0 0\nf 1 1 1\nf 1 1 1\n", limits).find("a.obj:3:") == 0);
    limits = {};
    limits.max_names = 2;
    CHECK(refusal("g a\ng b\n", limits).find("a.obj:2: found more names") == 0);
}

TEST_CASE("obj: a quad is split along the diagonal that lies inside") {
    const std::vector<Vec3> convex = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    CHECK(triangulate_polygon(convex) == std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
    const std::vector<Vec3> dart = {{0, 0, 0}, {2, 0, 0}, {0.4f, 0.4f, 0}, {0, 2, 0}};
    CHECK(triangle_area(dart, triangulate_polygon(dart)) == near(0.8));
    const std::vector<Vec3> other = {{2, 0, 0}, {0.4f, 0.4f, 0}, {0, 2, 0}, {0, 0, 0}};
    CHECK(triangle_area(other, triangulate_polygon(other)) == near(0.8));
}

TEST_CASE("obj: the triangles of a concave polygon cover its area once") {
    // A comb with three teeth, on a slope.
    std::vector<Vec3> comb;
    for (const Vec2 p : std::vector<Vec2>{
             {0, 0},
             {5, 0},
             {5, 3},
             {4, 3},
             {4, 1},
             {3, 1},
             {3, 3},
             {2, 3},
             {2, 1},
             {1, 1},
             {1, 3},
             {0, 3}}) {
        comb.emplace_back(p.x, 0.6f * p.y, 0.8f * p.y);
    }
    const std::vector<std::uint32_t> triangles = triangulate_polygon(comb);
    CHECK(triangles.size() == 3 * (comb.size() - 2));
    CHECK(triangle_area(comb, triangles) == near(11).epsilon(1e-5));
    CHECK(std::set<std::uint32_t>(triangles.begin(), triangles.end()).size() == comb.size());
}

TEST_CASE("obj: a polygon without area, or that crosses itself, still has its triangles") {
    const std::vector<Vec3> point(7, Vec3(1));
    CHECK(triangulate_polygon(point).size() == 15);
    const std::vector<Vec3> bow = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    CHECK(triangulate_polygon(bow).size() == 6);
    CHECK(triangulate_polygon(std::vector<Vec3>(300, Vec3(1))).size() == 3 * 298);
}

TEST_CASE("obj: a mesh has a vertex for each distinct corner, with the image's top at v = 0") {
    const ObjFile obj = *parse_obj(kHouse, "house.obj");
    const std::vector<std::uint32_t> all = {0, 1};
    const ObjMesh made = make_obj_mesh(obj, all);
    // Two of the roof's three corners are at corners of the wall, without its texture coordinates.
    CHECK(made.source == std::vector<std::uint32_t>{0, 1, 2, 3, 3, 2, 4});
    CHECK(made.mesh.indices.size() == 9);
    CHECK(made.mesh.uvs[0] == Vec2(0, 1));
    CHECK(made.mesh.uvs[2] == Vec2(1, 0));
    for (const Vec3& normal : made.mesh.normals) {
        CHECK(normal == Vec3(0, 0, 1));
    }
    CHECK(made.mesh.bounds.max == Vec3(1, 1.5f, 0));
}

TEST_CASE("obj: a file by itself is a scene with the colors of its materials") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("house.obj")) << kHouse;
    std::ofstream(folder.file("house.mtl")) << "# colors\nnewmtl brick\nKd 0.5 0.25 0.125\nNs 30\n"
                                               "newmtl slate tile\nKd 0.25\nd 0.5\nmap_Kd x.png\n";
    World world;
    const Result<LoadedScene> scene = load_scene(world, folder.file("house.obj"));
    REQUIRE(scene.ok());
    CHECK(scene->name == "house");
    const Assets& assets = world.resource<Assets>();
    CHECK(assets.meshes[0].name == "house.front");
    CHECK(assets.meshes[1].name == "house.roof");
    REQUIRE(assets.materials.size() >= 3);
    const Material& brick = assets.materials[1];
    CHECK(brick.name == "brick");
    CHECK(brick.base_color == Vec4(0.5f, 0.25f, 0.125f, 1));
    CHECK(brick.roughness == near(0.5));
    CHECK(assets.materials[2].base_color == Vec4(0.25f, 0.25f, 0.25f, 0.5f));
    CHECK(assets.materials[2].alpha_mode == AlphaMode::Blend);
}

TEST_CASE("obj: normals are made where the file has none, and a missing library is a warning") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("a.obj"))
        << "mtllib ../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    World world;
    const std::vector<std::string> messages =
        test::messages_of([&] { CHECK(load_scene(world, folder.file("a.obj")).ok()); });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("expected a path under the file's own folder") != std::string::npos);
    CHECK(world.resource<Assets>().meshes[0].normals[0] == Vec3(0, 0, 1));
    CHECK(world.resource<Assets>().meshes[0].tangents.size() == 3);
}

TEST_CASE("obj: a file without faces is refused") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("a.obj")) << "v 0 0 0\n";
    World world;
    const Result<LoadedScene> scene = load_scene(world, folder.file("a.obj"));
    REQUIRE_FALSE(scene.ok());
    CHECK(scene.error().message.find("found no faces, expected at least one") != std::string::npos);
}

TEST_CASE("obj: a bad value in a material library is refused with its line") {
    const auto message = [](const std::string& text) {
        const auto materials = parse_obj_materials(text, "a.mtl");
        return materials ? "it loads" : materials.error().message;
    };
    CHECK(message("Kd x\n") == "it loads");  // before the first material
    CHECK(message("newmtl a\nKd 2 0 0\n") == "a.mtl:2: Kd: found 2, expected 0 to 1");
    CHECK(message("newmtl a\nd -1\n") == "a.mtl:2: d: found -1, expected 0 to 1");
    CHECK(message("newmtl a\nNs 10 20\n") == "it loads");
}

TEST_CASE("obj: a real face has its quads, texture coordinates and materials") {
    const auto path = test::shared_asset("ict-facekit/FaceXModel/generic_neutral_mesh.obj");
    if (!path) {
        return;
    }
    const Result<ObjFile> obj = load_obj(*path);
    REQUIRE(obj.ok());
    CHECK(obj->positions.size() == 26719);
    CHECK(obj->uvs.size() == 28911);
    CHECK(obj->faces.size() == 26384);
    CHECK(obj->materials.size() == 13);
    CHECK(obj->materials[1] == "M_Face");
}

}  // namespace limn::obj_test
