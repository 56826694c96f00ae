#include "content/bake/tangents.h"
#include "content/load/gltf/gltf_load.h"
#include "systems/animation/clip_sampling.h"
#include "tests/content/gltf_samples.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <limits>

namespace limn::gltf_deform_test {

using namespace limn::test;

namespace {

/// A square of four vertices on two joints, with two morph targets that a clip moves. All of it may
/// be spoiled.
struct Flag {
    std::vector<std::uint8_t> joints = {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 9, 9};
    std::vector<float> weights = {1,    0,     0,     0, 0.25f, 0.75f, 0, 0,
                                  0.5f, 0.25f, 0.25f, 0, 0.5f,  0.5f,  0, 0};
    std::vector<std::uint16_t> more_joints = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    std::vector<std::uint16_t> more_weights = std::vector<std::uint16_t>(16, 0);
    std::vector<float> rise = {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
    std::vector<float> times = {0, 2};
    std::vector<float> amounts = {0, 1, 0.5f, 0};  // of two targets at two times
    std::string interpolation = "LINEAR";
    std::string attributes = R"("POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2)";
    std::string normals = R"(, "NORMAL": 5)";
    std::string targets = R"([{"POSITION": 6}, {"POSITION": 9}])";
    std::string mesh_weights = R"("weights": [0.25, 0.5],)";
    std::string node_weights;
    std::string extras = R"("extras": {"targetNames": ["rise", "pull"]},)";

    [[nodiscard]] Result<GltfScene> load() const {
        Numbers numbers;
        numbers.add("VEC3", 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        numbers.add_typed("VEC4", 4, 5121, false, joints);
        numbers.add("VEC4", 4, weights);
        numbers.add_typed("VEC4", 4, 5123, false, more_joints);
        numbers.add_typed("VEC4", 4, 5123, true, more_weights);
        numbers.add("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
        numbers.add("VEC3", 3, rise);
        numbers.add("SCALAR", 1, times);
        numbers.add("SCALAR", 1, amounts);
        numbers.add_typed<std::uint16_t>("SCALAR", 1, 5123, false, {1, 3});  // view 9
        numbers.add("VEC3", 3, {0.5f, 0, 0, 0, 0, 0.25f});                   // view 10
        numbers.add_typed<std::uint16_t>("SCALAR", 1, 5123, false, {0, 1, 2, 0, 2, 3});
        const std::string sparse = R"({"componentType": 5126, "count": 4, "type": "VEC3",
            "sparse": {"count": 2, "indices": {"bufferView": 9, "componentType": 5123},
                       "values": {"bufferView": 10}}})";
        std::string json = numbers.json();
        // The sparse accessor takes the place of the one of its indices.
        json = replace_once(
            json,
            R"({"bufferView": 9, "componentType": 5123, "normalized": false, "count": 2, "type": "SCALAR"})",
            sparse);
        json = fmt::format(
            R"({{"asset": {{"version": "2.0"}}, {},
            "meshes": [{{{}{} "name": "cloth", "primitives": [{{
                "attributes": {{{}{}}}, "indices": 11, "targets": {}}}]}}],
            "skins": [{{"joints": [1, 2]}}],
            "nodes": [{{"name": "cloth", {} "mesh": 0, "skin": 0}},
                      {{"name": "pole", "children": [2]}}, {{"name": "top"}}],
            "scenes": [{{"nodes": [0, 1]}}],
            "animations": [{{"name": "blow",
                "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "weights"}}}}],
                "samplers": [{{"input": 7, "output": 8, "interpolation": "{}"}}]}}]}})",
            json, mesh_weights, extras, attributes, normals, targets, node_weights, interpolation);
        return parse_gltf(make_glb(json, numbers.bytes()), "flag.glb", "");
    }
};

GltfScene loaded(const std::function<void(Flag&)>& change = [](Flag&) {}) {
    Flag flag;
    change(flag);
    Result<GltfScene> scene = flag.load();
    REQUIRE_MESSAGE(scene.ok(), scene.error().message);
    return *std::move(scene);
}

std::string error_of(const std::function<void(Flag&)>& spoil) {
    Flag flag;
    spoil(flag);
    const Result<GltfScene> scene = flag.load();
    return scene ? "" : scene.error().message;
}

struct Influence {
    int joint;
    float weight;
    bool operator==(const Influence&) const = default;
};

std::vector<Influence> influences(const SkinWeights& skin, std::size_t vertex) {
    std::vector<Influence> all;
    for (std::uint32_t i = skin.first[vertex]; i < skin.first[vertex + 1]; ++i) {
        all.push_back({skin.joints[i], skin.weights[i]});
    }
    return all;
}

void use_second_set(Flag& flag) {
    flag.attributes += R"(, "JOINTS_1": 3, "WEIGHTS_1": 4)";
    flag.weights[0] = 0.5f;
    flag.more_weights[0] = 32768;  // a half, nearly
}

}  // namespace

TEST_CASE("gltf deform: weights are sorted by joint, those of 0 dropped, equal joints added") {
    const GltfScene scene = loaded();
    CHECK(scene.warnings.empty());
    REQUIRE(scene.meshes.size() == 1);
    const SkinWeights& skin = scene.meshes[0].skin;
    REQUIRE(skin.first.size() == 5);
    CHECK(influences(skin, 0) == std::vector<Influence>{{0, 1.0f}});
    CHECK(influences(skin, 1) == std::vector<Influence>{{0, 0.75f}, {1, 0.25f}});
    CHECK(influences(skin, 2) == std::vector<Influence>{{0, 0.25f}, {1, 0.75f}});
    CHECK(influences(skin, 3) == std::vector<Influence>{{0, 0.5f}, {1, 0.5f}});
}

TEST_CASE("gltf deform: further sets of weights, of other types, count as the first does") {
    const GltfScene scene = loaded(use_second_set);
    CHECK(scene.warnings.empty());
    const std::vector<Influence> all = influences(scene.meshes[0].skin, 0);
    REQUIRE(all.size() == 2);
    CHECK(all[0].joint == 0);
    CHECK(all[1].joint == 1);
    CHECK(all[1].weight == test::near(0.5).epsilon(1e-4));
    CHECK(all[0].weight + all[1].weight == test::near(1.0).epsilon(1e-6));
}

TEST_CASE(
    "gltf deform: weights that do not sum to 1 are scaled, with a warning"
    * technique("char.skin-limits")) {
    const GltfScene scene = loaded([](Flag& f) {
        f.weights[0] = 0.5f;
        f.weights[4] = 0.05f;
        f.weights[5] = 0.15f;
    });
    const SkinWeights& skin = scene.meshes[0].skin;
    CHECK(influences(skin, 0) == std::vector<Influence>{{0, 1.0f}});
    CHECK(influences(skin, 1)[0].weight == test::near(0.75));
    REQUIRE(scene.warnings.size() == 1);
    CHECK(
        scene.warnings[0]
        == "flag.glb: meshes[0].primitives[0].attributes.WEIGHTS_0: the weights of 2 vertices do "
           "not sum to 1 and were scaled; of element 0 the sum is 0.5");

    const GltfScene loose = loaded([](Flag& f) { f.weights[0] = 0; });
    CHECK(influences(loose.meshes[0].skin, 0) == std::vector<Influence>{{0, 1.0f}});
    REQUIRE(loose.warnings.size() == 1);
    CHECK(loose.warnings[0].find("1 vertices have no weight") != std::string::npos);
}

TEST_CASE("gltf deform: bad joints and weights are left out") {
    const std::string place = "flag.glb: meshes[0].primitives[0].attributes";
    const GltfScene joint = loaded([](Flag& f) { f.joints[4] = 2; });
    REQUIRE(!joint.warnings.empty());
    CHECK(
        joint.warnings[0]
        == place
               + ".JOINTS_0: found joint 2 of a skin of 2 in element 1; 1 such influences are "
                 "left out");
    CHECK(influences(joint.meshes[0].skin, 1).size() == 1);
    CHECK(influences(joint.meshes[0].skin, 1)[0].weight == 1);
    for (const float bad : {-0.75f, std::numeric_limits<float>::quiet_NaN()}) {
        const GltfScene weight = loaded([&](Flag& f) { f.weights[5] = bad; });
        REQUIRE(!weight.warnings.empty());
        CHECK(weight.warnings[0].starts_with(place + ".WEIGHTS_0: found the weight "));
        CHECK(weight.warnings[0].ends_with(" in element 1; 1 such influences are left out"));
        CHECK(influences(weight.meshes[0].skin, 1).size() == 1);
        CHECK(influences(weight.meshes[0].skin, 2) == influences(joint.meshes[0].skin, 2));
    }
}

TEST_CASE("gltf deform: without joints or weights the skin of the primitive is left out") {
    const std::string place = "flag.glb: meshes[0].primitives[0].attributes";
    const auto warning_of = [](const std::function<void(Flag&)>& spoil) {
        const GltfScene scene = loaded(spoil);
        CHECK(scene.meshes[0].skin.empty());
        return scene.warnings.at(0);
    };
    CHECK(
        warning_of([](Flag& f) { f.attributes = R"("POSITION": 0, "JOINTS_0": 1)"; })
        == place
               + ": found JOINTS_0 alone, expected JOINTS_0 and WEIGHTS_0; it is drawn without "
                 "its skin");
    CHECK(
        warning_of(
            [](Flag& f) { f.attributes = R"("POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 2)"; })
        == place
               + ".JOINTS_0: accessors[2].componentType: found 5126, expected 5121 or 5123; it "
                 "is drawn without its skin");
    CHECK(
        warning_of([](Flag& f) { f.weights.resize(12); })
        == place
               + ".WEIGHTS_0: found 3 elements, expected as many as POSITION has, 4; it is drawn "
                 "without its skin");
}

TEST_CASE(
    "gltf deform: morph targets hold the vertices that move, dense or sparse, by name"
    * technique("char.morph-target")) {
    const GltfScene scene = loaded();
    const std::vector<MorphTarget>& morphs = scene.meshes[0].morphs;
    REQUIRE(morphs.size() == 2);
    CHECK(morphs[0].name == "rise");
    CHECK(morphs[0].vertices == std::vector<std::uint32_t>{2});
    CHECK(morphs[0].positions == std::vector<Vec3>{Vec3(0, 0, 1)});
    CHECK(morphs[1].name == "pull");
    CHECK(morphs[1].vertices == std::vector<std::uint32_t>{1, 3});
    CHECK(morphs[1].positions == std::vector<Vec3>{Vec3(0.5f, 0, 0), Vec3(0, 0, 0.25f)});
    CHECK(morphs[0].normals.empty());  // the file says that they stay
    CHECK(scene.morph_weights == std::vector<float>{0.25f, 0.5f});
    const GltfNode& drawn = scene.nodes.back();
    CHECK(drawn.first_morph == 0);
    CHECK(drawn.skin == 0);

    const GltfScene unnamed = loaded([](Flag& f) { f.extras.clear(); });
    CHECK(unnamed.meshes[0].morphs[1].name == "target 1");
    const GltfScene own = loaded([](Flag& f) { f.node_weights = R"("weights": [1, 2],)"; });
    CHECK(own.morph_weights == std::vector<float>{1, 2});
    const GltfScene none = loaded([](Flag& f) { f.mesh_weights.clear(); });
    CHECK(none.morph_weights == std::vector<float>{0, 0});
}

TEST_CASE("gltf deform: a morph target has the drivers that the file names") {
    const auto drivers = [](const std::string& list) {
        return R"("extras": {"targetNames": ["rise", "pull"], "targetDrivers": {)" + list + "}},";
    };
    const GltfScene scene = loaded([&](Flag& f) {
        f.normals.clear();  // targets are recomputed with their normals
        f.extras = drivers(R"("pull": [{"target": "rise", "peak": 0.5}, {"target": "rise"}])");
    });
    CHECK(scene.meshes[0].morphs[0].drivers.empty());
    const std::vector<ShapeDriver>& read = scene.meshes[0].morphs[1].drivers;
    REQUIRE(read.size() == 2);
    CHECK(read[0].target == 0);
    CHECK(read[0].peak == 0.5f);
    CHECK(read[1].peak == 1);

    const auto error = [&](const std::string& list) {
        return error_of([&](Flag& f) { f.extras = drivers(list); });
    };
    const std::string place = "flag.glb: meshes[0].extras.targetDrivers";
    CHECK(error(R"("push": [])") == place + ": found \"push\", expected names of morph targets");
    CHECK(
        error(R"("pull": [{"target": "sink"}])")
        == place
               + ".pull[0].target: found the string \"sink\", expected the name of a morph target");
    CHECK(
        error(R"("pull": [{"target": "pull"}])")
        == place
               + ".pull[0].target: found the string \"pull\", expected a morph target without "
                 "drivers");
    for (const char* const peak : {"0", "-1", "1.5", "\"all\""}) {
        CAPTURE(peak);
        const std::string found =
            error(fmt::format(R"("pull": [{{"target": "rise", "peak": {}}}])", peak));
        CHECK(found.find(place + ".pull[0].peak: found") == 0);
        CHECK(found.find("expected a number above 0 and at most 1") != std::string::npos);
    }
}

TEST_CASE(
    "gltf deform: normals that were made turn with their morph targets, tangents follow"
    * technique("char.morph-target")) {
    const GltfScene scene = loaded([](Flag& f) { f.normals.clear(); });
    const MeshData& mesh = scene.meshes[0];
    for (const MorphTarget& morph : mesh.morphs) {
        REQUIRE(morph.normals.size() == morph.vertices.size());
        REQUIRE(morph.tangents.size() == morph.vertices.size());
        // The normals of the mesh in that shape, recomputed, are those of the target.
        MeshData shape = mesh;
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            shape.positions[morph.vertices[i]] += morph.positions[i];
        }
        generate_normals(shape);
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            const std::uint32_t v = morph.vertices[i];
            const Vec3 normal = mesh.normals[v] + morph.normals[i];
            CHECK(glm::length(normal - shape.normals[v]) < 1e-5f);
            const Vec3 tangent = Vec3(mesh.tangents[v]) + morph.tangents[i];
            CHECK(std::abs(glm::dot(tangent, normal)) < 1e-5f);
            CHECK(glm::length(tangent) == test::near(1.0));
        }
    }
    CHECK(mesh.morphs[0].vertices.size() == 4);  // one corner lifted turns all four normals
    CHECK(mesh.morphs[0].positions[0] == Vec3(0));
}

TEST_CASE("gltf deform: a vertex that is split keeps its joints and its morph targets") {
    // A roof of two slopes at a right angle: the vertices of the ridge are split.
    MeshData roof;
    roof.positions = {{-1, 0, 0}, {0, 1, 0}, {0, 1, 1}, {1, 0, 0}};
    roof.indices = {0, 2, 1, 1, 2, 3};
    roof.skin.first = {0, 1, 3, 4, 5};
    roof.skin.joints = {0, 1, 2, 3, 4};
    roof.skin.weights = {1, 0.25f, 0.75f, 1, 1};
    roof.morphs.push_back({"ridge", "", {1}, {Vec3(0, 2, 0)}, {}, {}});
    generate_normals(roof, radians(30));
    REQUIRE(roof.positions.size() == 6);
    REQUIRE(roof.skin.first.size() == 7);
    CHECK(roof.morphs[0].vertices.size() == 2);
    for (std::size_t v = 4; v < 6; ++v) {
        const bool is_first = roof.positions[v] == roof.positions[1];
        CHECK(influences(roof.skin, v) == influences(roof.skin, is_first ? 1 : 2));
        if (is_first) {
            CHECK(roof.morphs[0].vertices[1] == v);
            CHECK(roof.morphs[0].positions[1] == Vec3(0, 2, 0));
        }
    }
}

TEST_CASE(
    "gltf deform: clips move morph weights, straight and cubic" * technique("char.morph-anim")) {
    const GltfScene scene = loaded();
    CHECK(scene.skeleton.joints.size() == 3);  // the file, the pole and its top; not the cloth
    REQUIRE(scene.clips.size() == 1);
    REQUIRE(scene.clips[0].sheets.size() == 1);
    CHECK(scene.clips[0].duration == 2);
    CHECK(scene.clips[0].sheets[0].morphing == std::vector<std::uint16_t>{0, 1});
    std::vector<float> weights = {9, 9};
    LocalPose pose = scene.skeleton.rest;
    sample_clip(scene.clips[0], 1, pose, weights);
    CHECK(weights == std::vector<float>{0.25f, 0.5f});

    const GltfScene cubic = loaded([](Flag& f) {
        f.interpolation = "CUBICSPLINE";
        f.amounts = {9, 9, 0, 1, 1, 0, 1, 0, 2, 1, 9, 9};  // slopes of the first 1, straight
    });
    sample_clip(cubic.clips[0], 1, pose, weights);
    CHECK(weights[0] == test::near(1));
    CHECK(weights[1] == test::near(1));
}

TEST_CASE("gltf deform: a bad part of a morph target or its weights costs that part") {
    const std::string mesh = "flag.glb: meshes[0]";
    const auto warning_of = [](const std::function<void(Flag&)>& spoil) {
        const GltfScene scene = loaded(spoil);
        CHECK(scene.meshes[0].morphs.size() == 2);
        return scene.warnings.at(0);
    };
    CHECK(
        warning_of([](Flag& f) { f.rise.resize(9); })
        == mesh
               + ".primitives[0].targets[0].POSITION: found 3 elements, expected as many as "
                 "POSITION has, 4; it is left out");
    CHECK(
        warning_of([](Flag& f) { f.targets = R"([{"POSITION": 99}, {"POSITION": 9}])"; })
        == mesh
               + ".primitives[0].targets[0].POSITION: found the number 99, expected an index "
                 "below 12; it is left out");
    const GltfScene infinite =
        loaded([](Flag& f) { f.rise[3] = std::numeric_limits<float>::infinity(); });
    CHECK(
        infinite.warnings.at(0)
        == mesh
               + ".primitives[0].targets[0].POSITION: found inf in element 1, expected at most "
                 "1000000000; such elements do not move");
    CHECK(infinite.meshes[0].morphs[0].positions == std::vector<Vec3>{{0, 0, 1}});
    CHECK(
        warning_of([](Flag& f) { f.mesh_weights = R"("weights": [1],)"; })
        == mesh + ".weights: found 1, expected one for each of 2 targets; missing ones are 0");
    CHECK(
        warning_of([](Flag& f) { f.node_weights = R"("weights": [1, 2, 3],)"; })
        == "flag.glb: nodes[0].weights: found 3, expected one for each of 2 targets; missing ones "
           "are 0");
    CHECK(
        warning_of([](Flag& f) { f.amounts.resize(2); })
        == "flag.glb: animations[0].channels[0]: samplers[0].output: found 2 values, expected 4 "
           "for 2 keys of 2 morph targets; the channel is left out");
}

TEST_CASE("gltf deform: normals of a morph target that are not finite are recomputed") {
    // The flag's normals are the file's, so that only those of this target are made.
    const auto with = [](float x) {
        return loaded([&](Flag& f) {
            f.rise = {0, 0, 0, 0, 0, 0, x, 0, 1, 0, 0, 0};
            f.targets = R"([{"POSITION": 9, "NORMAL": 6}, {"POSITION": 9}])";
        });
    };
    const GltfScene good = with(0);
    const GltfScene bad = with(std::numeric_limits<float>::quiet_NaN());
    CHECK(good.warnings.empty());
    REQUIRE(bad.warnings.size() == 1);
    CHECK(
        bad.warnings[0]
        == "flag.glb: meshes[0].primitives[0].targets[0].NORMAL: found NaN or infinity in element "
           "2, expected finite numbers; its normals are recomputed");
    const std::vector<MorphTarget>& morphs = bad.meshes[0].morphs;
    REQUIRE(morphs[0].normals.size() == morphs[0].vertices.size());
    for (const Vec3& normal : morphs[0].normals) {
        CHECK(is_finite(normal));
    }
    CHECK(morphs[1].normals.empty());
}

}  // namespace limn::gltf_deform_test
