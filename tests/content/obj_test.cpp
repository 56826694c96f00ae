#include "content/load/obj/obj_file.h"
#include "content/load/obj/obj_scene.h"
#include "content/load/scene_load.h"
#include "ecs/base/srgb.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "tests/near.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <fstream>
#include <string>
#include <utility>
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
    const Result<ObjFile> obj = parse_obj("v 0 0 0\nsurf 1 1\nsurf 1 1\ncurv 1\n", "a.obj");
    REQUIRE(obj.ok());
    CHECK(
        obj->warnings
        == std::vector<std::string>{
            "a.obj:2: \"surf\" is ignored", "a.obj:4: \"curv\" is ignored"});
}

TEST_CASE("obj: a bad line costs what it says, and names what was found and what was expected") {
    const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto error_of = [](const std::string& text) {
        const Result<ObjFile> obj = parse_obj(text, "a.obj");
        REQUIRE_MESSAGE(obj.ok(), (obj ? "" : obj.error().message));
        REQUIRE(obj->errors.size() == 1);
        return obj->errors[0];
    };
    CHECK(
        error_of("v 0 0\n")
        == "a.obj:1: v: found nothing, expected a number of at most 1000000000; vertex 1 is left "
           "out");
    CHECK(error_of("v 0 0 nan\n").find("a.obj:1: v: found \"nan\", expected") == 0);
    CHECK(error_of("v -1.#IND 0 0\n").find("a.obj:1: v: found \"-1.#IND\", expected") == 0);
    CHECK(error_of("v 0 0 1e10\n").find("a.obj:1: v: found \"1e10\", expected") == 0);
    CHECK(error_of("\nvt x\n").find("a.obj:2: vt: found \"x\"") == 0);
    CHECK(error_of("\nvn 0 0\n").find("a.obj:2: vn: found nothing") == 0);
    CHECK(
        error_of(v + "f 1 2 4\n")
        == "a.obj:4: found 4, expected an index into the 3 vertices; the face is left out");
    CHECK(
        error_of(v + "f 1 2 0\n")
        == "a.obj:4: found \"0\", expected an index of v, from 1 or from -1 back to -3; the face "
           "is "
           "left out");
    CHECK(error_of(v + "f 1 2 -4\n").find("a.obj:4: found \"-4\"") == 0);
    CHECK(error_of(v + "f 1 2 x\n").find("a.obj:4: found \"x\"") == 0);
    CHECK(error_of(v + "f 1 2 99999999999999999999\n").find("a.obj:4: found") == 0);
    CHECK(error_of(v + "f 1/1 2 3\n").find("beyond the 0 texture coordinates") < 40);
    CHECK(error_of(v + "f 1//1 2 3\n").find("beyond the 0 normals") < 40);
    CHECK(error_of(v + "f 1/2/3/4 2 3\n").find("at most three indices") < 40);
    CHECK(
        error_of(v + "f 1 2\n")
        == "a.obj:4: found 2 corners, expected at least 3; the face is left out");
}

TEST_CASE("obj: what is bad does not move the indices of what is good") {
    const Result<ObjFile> obj = parse_obj(
        "v 9 9 nan\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt x\nvt 0.5 0.25\nvn 0 0 oops\nvn 0 0 1\n"
        "f 1 2 3\nf 2/2/2 3/2/2 4/2/2\nf 2 3 4 1\nf 2/9 3/2 4/2\n",
        "a.obj");
    REQUIRE(obj.ok());
    CHECK(obj->errors.size() == 6);
    REQUIRE(obj->faces.size() == 2);  // those that do not have the bad vertex
    const ObjCorner& corner = obj->corners[obj->faces[0].first];
    CHECK(obj->positions[corner.position] == Vec3(0));
    CHECK(obj->uvs[static_cast<std::size_t>(corner.uv)] == Vec2(0.5f, 0.25f));
    CHECK(obj->normals[static_cast<std::size_t>(corner.normal)] == Vec3(0, 0, 1));
    for (std::uint32_t k = 0; k < 3; ++k) {
        CHECK(obj->corners[obj->faces[1].first + k].uv == -1);
    }
}

TEST_CASE("obj: of a file with a million bad lines, a hundred are named and the others counted") {
    std::string text;
    for (int i = 0; i < 3000; ++i) {
        text += "f 0 0 0\n";
    }
    const Result<ObjFile> obj = parse_obj(text, "a.obj");
    REQUIRE(obj.ok());
    REQUIRE(obj->errors.size() == 101);
    CHECK(obj->errors.back() == "a.obj: 2900 more warnings");
}

TEST_CASE("obj: a face may stand before its vertices") {
    const Result<ObjFile> obj =
        parse_obj("f 1/1/1 2/1/1 3/1/1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n", "a.obj");
    REQUIRE(obj.ok());
    CHECK(obj->errors.empty());
    REQUIRE(obj->faces.size() == 1);
    CHECK(obj->corners[2].position == 2);
}

TEST_CASE("obj: byte order mark, tabs, and any end of line leave the same file") {
    const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a b\nf 1 2 3\n";
    const auto replaced = [&](char from, const std::string& to) {
        std::string text;
        for (const char c : plain) {
            text += c == from ? to : std::string(1, c);
        }
        return text;
    };
    const std::string without_end = plain.substr(0, plain.size() - 1);
    for (const std::string& text :
         {"\xef\xbb\xbf" + plain, replaced('\n', "\r\n"), replaced('\n', "\r"),
          replaced('\n', " \n"), without_end, "\xef\xbb\xbf" + replaced('\n', "\r\n"),
          "# a path \\\n" + plain, "v\t0\t0\t0" + plain.substr(7)}) {
        CAPTURE(text);
        const Result<ObjFile> obj = parse_obj(text, "a.obj");
        REQUIRE(obj.ok());
        CHECK(obj->errors.empty());
        CHECK(obj->warnings.empty());
        CHECK(obj->positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        CHECK(obj->faces.size() == 1);
        CHECK(obj->materials == std::vector<std::string>{"", "a b"});
    }
    CHECK(
        refusal(std::string("\xff\xfe") + "v\0")
        == "a.obj: found a text in UTF-16, expected UTF-8 or ASCII");
}

TEST_CASE("obj: a # begins a comment between numbers, and is a part of names") {
    const Result<ObjFile> obj = parse_obj(
        "o box #2\nv 0 0 0 # the first\nv 1 0 0#the second\nv 0 1 0\ng a#b\nusemtl Material #25\n"
        "f 1 2 3 # 4\n",
        "a.obj");
    REQUIRE(obj.ok());
    CHECK(obj->errors.empty());
    CHECK(obj->objects.back() == "box #2");
    CHECK(obj->groups.back() == "a#b");
    CHECK(obj->materials.back() == "Material #25");
    CHECK(obj->corners.size() == 3);
    CHECK(obj->colors.empty());
}

TEST_CASE("obj: colors of vertices are sRGB, with a weight before or an opacity behind them") {
    const auto colors_of = [](const std::string& text) {
        const Result<ObjFile> obj = parse_obj(text, "a.obj");
        REQUIRE(obj.ok());
        return obj->colors;
    };
    const float half = linear_from_srgb(0.5f);
    const std::vector<Vec3> expected = {{1, half, 0}, {0, 0, half}};
    CHECK(colors_of("v 0 0 0 1 0.5 0\nv 0 0 0 0 0 0.5\n") == expected);
    CHECK(colors_of("v 0 0 0 1 1 0.5 0\nv 0 0 0 1 0 0 0.5\n") == expected);
    CHECK(colors_of("v 0 0 0 1 0.5 0 1\nv 0 0 0 0 0 0.5 1\n") == expected);
    CHECK(colors_of("v 0 0 0 1 1 0.5 0 1\nv 0 0 0 1 0 0 0.5 1\n") == expected);
    // Codes, vertices without a color, and values beyond 1.
    CHECK(colors_of("v 0 0 0 255 0 51\nv 0 0 0\n")[0] == Vec3(1, 0, linear_from_srgb(0.2f)));
    CHECK(colors_of("v 0 0 0 255 0 51\nv 0 0 0\n")[1] == Vec3(1));
    CHECK(colors_of("v 0 0 0 1.5 0.5 -1\n")[0] == Vec3(1, half, 0));
    CHECK(colors_of("v 0 0 0\nv 0 0 0 1\n").empty());
    const Result<ObjFile> bad = parse_obj("v 0 0 0 nan 0 0\nv 0 0 0 0 0 0\n", "a.obj");
    REQUIRE(bad.ok());
    CHECK(bad->colors == std::vector<Vec3>{Vec3(1), Vec3(0)});
    REQUIRE(bad->errors.size() == 1);
    CHECK(bad->errors[0].find("a.obj:1: v: found \"nan\"") == 0);
    CHECK(bad->errors[0].find("the color of vertex 1 is left out") != std::string::npos);
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

TEST_CASE("obj: a zero or bad normal is made anew from the triangles, and the others stay") {
    const ObjFile obj = *parse_obj(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0.6 0 0.8\nvn 0 0 0\nvn nan 0 0\n"
        "f 1//1 2//2 3//3\nf 1//9 2//1 3//1\n",
        "a.obj");
    const std::vector<std::uint32_t> all = {0, 1};
    const MeshData mesh = make_obj_mesh(obj, all).mesh;
    CHECK(
        mesh.normals
        == std::vector<Vec3>{
            {0.6f, 0, 0.8f}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
}

TEST_CASE("obj: an importer that needs every vertex is refused a file with a bad one") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("a.obj")) << "v 0 0 0\nv 1 0 nan\nv 0 1 0\n";
    const Result<ObjFile> obj = load_intact_obj(folder.file("a.obj"));
    REQUIRE_FALSE(obj.ok());
    CHECK(obj.error().message.find("a.obj:2: v: found \"nan\"") != std::string::npos);
}

TEST_CASE("obj: what strict refuses names every part that is left out") {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("a.obj");
    std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1 2 3\nf 0 1 2\n";
    const std::vector<std::string> messages = test::messages_of([&] {
        const Result<GltfScene> scene = load_obj_scene(path);
        REQUIRE(scene.ok());
        CHECK(scene->meshes[0].indices.size() == 3);
        CHECK(scene->warnings.size() == 2);
    });
    REQUIRE(messages.size() == 2);
    const Result<GltfScene> strict = load_obj_scene(path, {}, {.strict = true});
    REQUIRE_FALSE(strict.ok());
    CHECK(strict.error().message == messages[0] + "\n" + messages[1]);
    const Result<GltfScene> counted = load_obj_scene(path, {}, {.strict = true, .max_warnings = 1});
    CHECK(counted.error().message == messages[0] + "\n" + path + ": 1 more warnings");
}

TEST_CASE("obj: the reports of byte order marks, colors and polygons are read as expected") {
    const auto load = [](const std::string& path, std::size_t warnings) {
        const Result<GltfScene> scene = load_obj_scene(path);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        CHECK_MESSAGE(scene->warnings.size() == warnings, path);
        return *scene;
    };
    const std::vector<std::pair<std::string, std::size_t>> squares = {
        {"06-obj-bom/plain.obj", 0},
        {"06-obj-bom/bom-v.obj", 0},
        {"06-obj-bom/crlf.obj", 0},
        {"06-obj-bom/bom-mtl.obj", 0},
        {"06-obj-bom/mtl-bom.obj", 0},
        {"36-obj-polygons/forward.obj", 0},
        {"36-obj-polygons/slashes.obj", 0},
        {"36-obj-polygons/two-corners.obj", 1},
        {"36-obj-polygons/zero-index.obj", 1},
        {"36-obj-polygons/nan.obj", 1},
        {"36-obj-polygons/ind.obj", 1}};
    for (const auto& [name, warnings] : squares) {
        const std::string& file = name;  // a binding cannot be captured
        const auto path = test::shared_report(file);
        if (!path) {
            return;
        }
        CAPTURE(file);
        const GltfScene scene = load(*path, warnings);
        REQUIRE(scene.meshes.size() == 1);
        CHECK(scene.meshes[0].indices.size() == 6);
        CHECK(scene.meshes[0].bounds.min == Vec3(-1, -1, 0));
        CHECK(scene.meshes[0].bounds.max == Vec3(1, 1, 0));
        const bool is_red =
            file.find("mtl") != std::string::npos || file.find("crlf") < file.size();
        const Vec4 color = scene.materials[scene.nodes[0].parts[0].material].base_color;
        CHECK(color == (is_red ? Vec4(1, 0, 0, 1) : Vec4(0.8f, 0.8f, 0.8f, 1)));
    }
    if (const auto path = test::shared_report("07-obj-vertex-colors/colors.obj")) {
        const GltfScene scene = load(*path, 0);
        const MeshData& mesh = scene.meshes[0];
        CHECK(scene.materials[0].base_color == Vec4(1));
        REQUIRE(mesh.colors.size() == mesh.positions.size());
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            const bool is_left = i < 6;
            CHECK(mesh.colors[mesh.indices[i]] == (is_left ? Vec4(1, 0, 0, 1) : Vec4(0, 1, 0, 1)));
        }
    }
    const auto area = [](const MeshData& mesh) {
        double sum = 0;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const std::uint32_t* const v = &mesh.indices[i];
            const Vec3 p = mesh.positions[v[0]];
            sum += static_cast<double>(
                glm::length(glm::cross(mesh.positions[v[1]] - p, mesh.positions[v[2]] - p)));
        }
        return 0.5 * sum;
    };
    for (const std::string star : {"star20", "star40", "star100"}) {
        const auto path = test::shared_report("36-obj-polygons/" + star + ".obj");
        const auto reference = test::shared_report("36-obj-polygons/" + star + "-ref.obj");
        if (path && reference) {
            CHECK(
                area(load(*path, 0).meshes[0])
                == near(area(load(*reference, 0).meshes[0])).epsilon(1e-5));
        }
    }
}

TEST_CASE("obj: lines and points are drawn, and a file with vertices alone is a cloud of points") {
    const test::TemporaryFolder folder;
    const auto load = [&](const std::string& text) {
        std::ofstream(folder.file("a.obj")) << text;
        Result<GltfScene> scene = Error{};
        static_cast<void>(test::messages_of([&] { scene = load_obj_scene(folder.file("a.obj")); }));
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        return *std::move(scene);
    };
    const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const GltfScene lines = load(v + "usemtl red\nl 1 2/1 -1\nl 1\nl 1 9\nl 2 3\n");
    REQUIRE(lines.meshes.size() == 1);
    CHECK(lines.meshes[0].name == "lines");
    CHECK(lines.meshes[0].indices.size() == 3 * 3 * 6);  // three prisms
    CHECK(lines.materials[lines.nodes[0].parts[0].material].name == "red");
    CHECK(lines.warnings.size() == 2);
    const GltfScene points = load(v + "p 1 3\nf 1 2 3\n");
    REQUIRE(points.meshes.size() == 2);
    CHECK(points.meshes[1].indices.size() == 2 * 24);
    const GltfScene cloud = load("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\n");
    REQUIRE(cloud.meshes.size() == 1);
    CHECK(cloud.meshes[0].indices.size() == 2 * 24);
    CHECK(cloud.meshes[0].colors.front() == Vec4(1, 0, 0, 1));
    CHECK(cloud.meshes[0].colors.back() == Vec4(0, 1, 0, 1));
}

TEST_CASE("obj: a file without anything to draw is refused") {
    const test::TemporaryFolder folder;
    for (const char* const text : {"", "vn 0 0 1\n", "v 0 0 0\nf 1 1\n", "v nan 0 0\n"}) {
        std::ofstream(folder.file("a.obj")) << text;
        static_cast<void>(test::messages_of([&] {
            World world;
            const Result<LoadedScene> scene = load_scene(world, folder.file("a.obj"));
            REQUIRE_FALSE(scene.ok());
            CHECK(
                scene.error().message.find("found no faces, lines or points, expected at least one")
                != std::string::npos);
        }));
    }
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
