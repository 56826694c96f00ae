#include "content/load/gltf/gltf_load.h"
#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "tests/content/gltf_samples.h"
#include "tests/near.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace limn::gltf_animation_test {

using namespace limn::test;

namespace {

std::vector<float> turn_about_z(float angle, float length = 1.0f) {
    const Quat q = rotation_about({0, 0, 1}, radians(angle));
    return {length * q.x, length * q.y, length * q.z, length * q.w};
}

std::vector<float> joined(const std::vector<std::vector<float>>& parts) {
    std::vector<float> all;
    for (const std::vector<float>& part : parts) {
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

/// An arm of three joints on a stand, skinned, with a lamp's mesh in its hand. All of it may be
/// spoiled.
struct Arm {
    std::vector<float> times = {0, 1, 3};
    std::vector<float> angles = {0, 90, 100};
    std::vector<float> rotations = joined(
        {turn_about_z(0), turn_about_z(90, -2.0f), turn_about_z(100)});  // turned around, not unit
    std::vector<float> places = {0, 1, 0, 0, 2, 0, 0, 4, 0};
    std::vector<float> sizes = joined(
        {{9, 9, 9},
         {1, 1, 1},
         {0, 0, 0},
         {0, 0, 0},
         {2, 1, 1},
         {6, 0, 0},
         {6, 0, 0},
         {14, 1, 1},
         {9, 9, 9}});
    std::vector<float> inverse_binds = joined(
        {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},    // of "lower", which stands at y = 1
         {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}});  // of "upper", turned;
    std::string nodes = R"([
        {"name": "stand", "children": [1, 4], "translation": [5, 0, 0]},
        {"name": "upper", "children": [2]},
        {"name": "lower", "children": [3], "translation": [0, 1, 0]},
        {"name": "lamp", "mesh": 0},
        {"name": "sleeve", "mesh": 0, "skin": 0},
        {"name": "table"}])";
    std::string channels = R"([
        {"sampler": 0, "target": {"node": 1, "path": "rotation"}},
        {"sampler": 1, "target": {"node": 2, "path": "translation"}},
        {"sampler": 2, "target": {"node": 2, "path": "scale"}}])";
    std::string samplers = R"([
        {"input": 1, "output": 2},
        {"input": 1, "output": 3, "interpolation": "LINEAR"},
        {"input": 1, "output": 4, "interpolation": "CUBICSPLINE"}])";
    std::string joints = "[2, 1]";
    std::string roots = "[0, 5]";

    [[nodiscard]] Result<GltfScene> load() const {
        Numbers numbers;
        numbers.add("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
        numbers.add("SCALAR", 1, times);
        numbers.add("VEC4", 4, rotations);
        numbers.add("VEC3", 3, places);
        numbers.add("VEC3", 3, sizes);
        numbers.add("MAT4", 16, inverse_binds);
        const std::string json = fmt::format(
            R"({{"asset": {{"version": "2.0"}}, {},
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "skins": [{{"name": "cloth", "joints": {}, "inverseBindMatrices": 5}}],
            "nodes": {}, "scenes": [{{"nodes": {}}}],
            "animations": [{{"name": "wave", "channels": {}, "samplers": {}}}]}})",
            numbers.json(), joints, nodes, roots, channels, samplers);
        return parse_gltf(make_glb(json, numbers.bytes()), "arm.glb", "");
    }
};

float apart(const Vec3& a, const Vec3& b) {
    return glm::length(a - b);
}

}  // namespace

TEST_CASE("gltf animation: joints without names get one each, by which poses can refer to them") {
    Arm arm;
    arm.nodes = R"([
        {"children": [1, 4]}, {"name": "upper", "children": [2]}, {"children": [3]},
        {"name": "lamp", "mesh": 0}, {"name": "sleeve", "mesh": 0, "skin": 0}, {"name": "table"}])";
    const Result<GltfScene> scene = arm.load();
    REQUIRE_MESSAGE(scene.ok(), scene.error().message);
    CHECK(scene->skeleton.joints == std::vector<std::string>{"arm", "joint 1", "upper", "joint 3"});
}

TEST_CASE("gltf animation: joints are what moves and what is above it, parents first") {
    const Result<GltfScene> scene = Arm().load();
    REQUIRE_MESSAGE(scene.ok(), scene.error().message);
    CHECK(scene->warnings.empty());
    const SkeletonData& skeleton = scene->skeleton;
    CHECK(skeleton.joints == std::vector<std::string>{"arm", "stand", "upper", "lower"});
    CHECK(skeleton.parents == std::vector<std::int32_t>{-1, 0, 1, 2});
    CHECK(skeleton.rest.translations[1] == Vec3(5, 0, 0));
    CHECK(skeleton.rest.translations[3] == Vec3(0, 1, 0));
    for (std::size_t i = 0; i < scene->nodes.size(); ++i) {
        const std::string& name = scene->nodes[i].name;
        const auto joint = std::find(skeleton.joints.begin(), skeleton.joints.end(), name);
        CHECK(
            scene->joints[i]
            == (joint == skeleton.joints.end() ? -1 : joint - skeleton.joints.begin()));
    }
    REQUIRE(scene->skins.size() == 1);
    CHECK(scene->skins[0].name == "cloth");
    CHECK(scene->skins[0].joints == std::vector<std::uint16_t>{3, 2});
    CHECK(scene->skins[0].joint_from_mesh[0].row[1] == Vec4(0, 1, 0, -1));
    CHECK(scene->skins[0].joint_from_mesh[1].row[0] == Vec4(0, -1, 0, 0));
    const auto sleeve =
        std::find_if(scene->nodes.begin(), scene->nodes.end(), [](const GltfNode& node) {
            return node.skin >= 0;
        });
    REQUIRE(sleeve != scene->nodes.end());
    CHECK(sleeve->parts.size() == 1);
}

TEST_CASE("gltf animation: channels of the same times are one sheet, rotations unit and aligned") {
    const Arm arm;
    const Result<GltfScene> scene = arm.load();
    REQUIRE(scene.ok());
    REQUIRE(scene->clips.size() == 1);
    const ClipData& clip = scene->clips[0];
    CHECK(clip.name == "wave");
    CHECK(clip.duration == 3);
    REQUIRE(clip.sheets.size() == 2);  // straight ones and the cubic
    const ClipSheet& straight = clip.sheets[0];
    CHECK(straight.rotating == std::vector<std::uint16_t>{2});
    CHECK(straight.translating == std::vector<std::uint16_t>{3});
    CHECK(straight.rotations[1].w > 0);
    LocalPose pose = scene->skeleton.rest;
    for (std::size_t key = 0; key < 3; ++key) {
        sample_clip(clip, arm.times[key], pose, {});
        CHECK(glm::length(straight.rotations[key]) == test::near(1));
        CHECK(
            degrees(axis_angle(pose.rotations[2]).angle)
            == test::near(arm.angles[key]).epsilon(1e-4));
        CHECK(pose.translations[3].y == arm.places[3 * key + 1]);
    }
    CHECK(pose.scales[3] == Vec3(14, 1, 1));
    // 2 + 6 (t - 1) after 1 s, as its slopes say.
    sample_clip(clip, 2, pose, {});
    CHECK(apart(pose.scales[3], Vec3(8, 1, 1)) < 1e-5f);
    CHECK(pose.translations[3].y == 3);
}

TEST_CASE("gltf animation: a cubic rotation of the other sign takes its slopes with it") {
    Arm arm;
    arm.samplers = R"([{"input": 1, "output": 2, "interpolation": "CUBICSPLINE"}])";
    arm.channels = R"([{"sampler": 0, "target": {"node": 1, "path": "rotation"}}])";
    arm.times = {0, 1};
    const std::vector<float> slope = {0, 0, 0.5f, 0};
    const std::vector<float> minus = {0, 0, -0.5f, 0};
    std::vector<float> flipped = turn_about_z(20, -1);
    arm.rotations = joined({slope, turn_about_z(0), slope, minus, flipped, minus});
    const Result<GltfScene> scene = arm.load();
    REQUIRE_MESSAGE(scene.ok(), scene.error().message);
    const ClipSheet& sheet = scene->clips[0].sheets[0];
    REQUIRE(sheet.rotations.size() == 6);
    CHECK(sheet.rotations[4].w > 0.9f);
    CHECK(sheet.rotations[3].z == test::near(0.5));
    CHECK(sheet.rotations[5].z == test::near(0.5));
}

TEST_CASE("gltf animation: a clip of a single key holds it, at any time") {
    for (const float time : {0.0f, 0.5f}) {
        Arm arm;
        arm.times = {time};
        arm.rotations = turn_about_z(30);
        arm.places = {0, 3, 0};
        arm.sizes = {9, 9, 9, 2, 1, 1, 9, 9, 9};
        const Result<GltfScene> scene = arm.load();
        REQUIRE_MESSAGE(scene.ok(), scene.error().message);
        REQUIRE(scene->clips.size() == 1);
        CHECK(scene->clips[0].duration == time);
        for (const float at : {-1.0f, 0.0f, 0.3f, 7.0f}) {
            LocalPose pose = scene->skeleton.rest;
            sample_clip(scene->clips[0], clip_time(time, at, true), pose, {});
            CHECK(degrees(axis_angle(pose.rotations[2]).angle) == test::near(30).epsilon(1e-4));
            CHECK(pose.translations[3] == Vec3(0, 3, 0));
            CHECK(pose.scales[3] == Vec3(2, 1, 1));
        }
    }
}

TEST_CASE("gltf animation: what is in no scene or without a node moves nothing, weights are told") {
    Arm arm;
    arm.roots = "[5]";
    arm.nodes = replace_once(arm.nodes, R"(, "skin": 0)", "");
    const Result<GltfScene> scene = arm.load();
    REQUIRE_MESSAGE(scene.ok(), scene.error().message);
    CHECK(scene->skeleton.joints.empty());
    REQUIRE(scene->clips.size() == 1);
    CHECK(scene->clips[0].sheets.empty());
    CHECK(scene->skins.empty());

    Arm weights;
    weights.channels = R"([{"sampler": 0, "target": {"node": 3, "path": "weights"}},
                           {"sampler": 0, "target": {"path": "rotation"}}])";
    const Result<GltfScene> without = weights.load();
    REQUIRE(without.ok());
    REQUIRE(without->warnings.size() == 1);
    CHECK(
        without->warnings[0]
        == R"(arm.glb: animations[0].channels[0].target.path: "weights" is ignored)");
}

TEST_CASE("gltf animation: a bad channel costs that channel") {
    const auto spoiled = [](const std::function<void(Arm&)>& spoil, const std::string& warning,
                            std::size_t channels) {
        Arm arm;
        spoil(arm);
        const Result<GltfScene> scene = arm.load();
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        REQUIRE(!scene->warnings.empty());
        CHECK(scene->warnings[0] == "arm.glb: " + warning);
        std::size_t found = 0;
        for (const ClipData& clip : scene->clips) {
            for (const ClipSheet& sheet : clip.sheets) {
                found += sheet.rotating.size() + sheet.translating.size() + sheet.scaling.size();
            }
        }
        CHECK(found == channels);
        CHECK(scene->skins.size() == 1);
    };
    spoiled(
        [](Arm& a) {
            a.times = {0, 2, 1};
        },
        "animations[0].channels[0]: samplers[0].input: accessors[1]: found 1 after 2 at key 2, "
        "expected increasing times; the channel is left out",
        0);
    spoiled(
        [](Arm& a) { a.times[1] = std::nanf(""); },
        "animations[0].channels[0]: samplers[0].input: accessors[1]: found NaN or infinity in "
        "element 1, expected finite numbers; the channel is left out",
        0);
    spoiled(
        [](Arm& a) { a.sizes.resize(9); },
        "animations[0].channels[2]: samplers[2].output: found 3 values, expected 9 for 3 keys, "
        "with in- and out-tangents; the channel is left out",
        2);
    spoiled(
        [](Arm& a) { a.places.resize(6); },
        "animations[0].channels[1]: samplers[1].output: found 2 values, expected 3 for 3 keys; the "
        "channel is left out",
        2);
    spoiled(
        [](Arm& a) { std::ranges::fill(a.rotations, 0.0f); },
        "animations[0].channels[0]: samplers[0].output: accessors[2]: found no key that is a "
        "rotation; the channel is left out",
        2);
    spoiled(
        [](Arm& a) { a.channels = replace_once(a.channels, R"("sampler": 2)", R"("sampler": 3)"); },
        "animations[0].channels[2]: sampler: found the number 3, expected an index below 3; the "
        "channel is left out",
        2);
    spoiled(
        [](Arm& a) {
            a.channels = replace_once(
                a.channels, R"("node": 2, "path": "scale")", R"("node": 9, "path": "scale")");
        },
        "animations[0].channels[2].target.node: found the number 9, expected an index below 6; "
        "animations[0].channels[2] is left out",
        2);
    spoiled(
        [](Arm& a) {
            a.channels = replace_once(
                a.channels, R"({"sampler": 1, "target": {"node": 2, "path": "translation"}})",
                R"({"sampler": 0, "target": {"node": 1, "path": "rotation"}})");
        },
        "animations[0].channels[1]: target: found the rotation of node 1 twice; the channel is "
        "left out",
        2);
    spoiled(
        [](Arm& a) { a.samplers = replace_once(a.samplers, "CUBICSPLINE", "CUBIC"); },
        "animations[0].samplers[2].interpolation: found the string \"CUBIC\", expected one of "
        "LINEAR STEP CUBICSPLINE; animations[0].samplers[2] is left out",
        2);
    spoiled(
        [](Arm& a) { a.samplers = replace_once(a.samplers, R"("output": 3)", R"("output": 44)"); },
        "animations[0].samplers[1].output: found the number 44, expected an index below 6; "
        "animations[0].samplers[1] is left out",
        2);
}

TEST_CASE("gltf animation: a key without a value is as the one before it, the first as the next") {
    const auto loaded = [](const std::function<void(Arm&)>& spoil) {
        Arm arm;
        spoil(arm);
        const Result<GltfScene> scene = arm.load();
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        REQUIRE(scene->warnings.size() == 1);
        return *scene;
    };
    const auto rotations = [](const GltfScene& scene) {
        std::vector<float> angles;
        for (const Quat& key : scene.clips[0].sheets[0].rotations) {
            angles.push_back(degrees(2 * std::atan2(key.z, key.w)));
        }
        return angles;
    };
    const float nan = std::nanf("");
    for (const float bad : {0.0f, nan}) {
        const GltfScene second =
            loaded([&](Arm& a) { std::fill_n(a.rotations.begin() + 4, 4, bad); });
        CHECK(rotations(second)[0] == test::near(0));
        CHECK(rotations(second)[1] == test::near(0));
        CHECK(rotations(second)[2] == test::near(100));
        const GltfScene first = loaded([&](Arm& a) { std::fill_n(a.rotations.begin(), 4, bad); });
        CHECK(std::abs(std::remainder(rotations(first)[0], 360.0f)) == test::near(90));
        CHECK(
            first.warnings[0].find("arm.glb: animations[0].samplers[0].output: accessors[2]: ")
            == 0);
        CHECK(first.warnings[0].find("in key 0, expected a rotation") != std::string::npos);
    }
    const GltfScene moved = loaded([&](Arm& a) { a.places[4] = nan; });
    CHECK(
        moved.clips[0].sheets[0].translations
        == std::vector<Vec3>{{0, 1, 0}, {0, 1, 0}, {0, 4, 0}});
    // Of a cubic key with a slope that is not finite the slope is 0; with a bad value both are.
    const GltfScene slope = loaded([&](Arm& a) { a.sizes[15] = nan; });
    const std::vector<Vec3>& scales = slope.clips[0].sheets[1].scales;
    CHECK(scales[4] == Vec3(2, 1, 1));
    CHECK(scales[5] == Vec3(0));
    const GltfScene value = loaded([&](Arm& a) { a.sizes[12] = nan; });
    CHECK(value.clips[0].sheets[1].scales[3] == Vec3(0));
    CHECK(value.clips[0].sheets[1].scales[4] == Vec3(1, 1, 1));
}

TEST_CASE("gltf animation: a skin that cannot be costs the skin, its mesh stands with its node") {
    const auto spoiled = [](const std::function<void(Arm&)>& spoil, const std::string& warning) {
        Arm arm;
        spoil(arm);
        const Result<GltfScene> scene = arm.load();
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        REQUIRE(!scene->warnings.empty());
        CHECK(scene->warnings[0] == "arm.glb: " + warning);
        CHECK(scene->skins.empty());
        const GltfNode& sleeve = scene->nodes.back();
        REQUIRE(sleeve.name == "sleeve.skin");
        CHECK(sleeve.skin == -1);
        REQUIRE(sleeve.parent >= 0);
        CHECK(scene->nodes[static_cast<std::size_t>(sleeve.parent)].name == "sleeve");
    };
    spoiled(
        [](Arm& a) { a.inverse_binds.resize(16); },
        "skins[0].inverseBindMatrices: found 1 matrices, expected one for each of 2 joints; its "
        "meshes are drawn without it");
    spoiled(
        [](Arm& a) { a.inverse_binds[0] = 0; },
        "skins[0]: skin cloth: the matrix of joint 0 has no inverse; its meshes are drawn without "
        "it");
    spoiled(
        [](Arm& a) {
            a.joints = "[2, 5]";
            a.roots = "[0]";
        },
        "skins[0].joints: found node 5, which is not in the scene; its meshes are drawn without "
        "it");
}

TEST_CASE("gltf animation: of keys at the same time the later counts from then on") {
    Arm arm;
    arm.times = {1, 1, 1};
    arm.samplers = replace_once(arm.samplers, "CUBICSPLINE", "STEP");
    arm.channels = R"([{"sampler": 1, "target": {"node": 2, "path": "translation"}}])";
    const Result<GltfScene> scene = arm.load();
    REQUIRE(scene.ok());
    REQUIRE(scene->warnings.size() == 1);
    CHECK(
        scene->warnings[0]
        == "arm.glb: animations[0].samplers[1].input: accessors[1]: found 1 again at key 1, "
           "expected increasing times; from then on the later key counts");
    const ClipSheet& sheet = scene->clips[0].sheets[0];
    CHECK(sheet.times == std::vector<float>{std::nextafter(1.0f, 0.0f), 1});
    CHECK(sheet.translations == std::vector<Vec3>{{0, 1, 0}, {0, 4, 0}});

    arm.times = {0, 0, 2};
    const ClipSheet start = arm.load()->clips[0].sheets[0];
    CHECK(start.times == std::vector<float>{0, 2});
    CHECK(start.translations == std::vector<Vec3>{{0, 2, 0}, {0, 4, 0}});
}

TEST_CASE("gltf animation: the reports of key times are where they should be at each time") {
    struct Sample {
        std::string file;
        std::size_t warnings;
        float time;
        float x;
    };
    for (const Sample& sample : std::vector<Sample>{
             {"duplicate", 1, 0, -1},   {"duplicate", 1, 0.999f, -1},
             {"duplicate", 1, 1, 1},    {"duplicate", 1, 1.5f, 1},
             {"decreasing", 1, 0, 0},  // at rest
             {"single", 0, 0, 1},       {"single", 0, 5, 1},
             {"single-cubic", 0, 0, 1}, {"single-cubic", 0, 5, 1},
             {"late", 0, 0, 1},         {"late", 0, 1.9f, 1},
             {"late", 0, 3, -1},        {"negative", 0, 0, 0},
             {"negative", 0, 1, 1},     {"step", 0, 0.999f, -1},
             {"step", 0, 1, 1},         {"step3", 0, 0.999f, -1},
             {"step3", 0, 1, 1},        {"cubic", 0, 0.5f, -0.6875f},
         }) {
        CAPTURE(sample.file);
        CAPTURE(sample.time);
        const std::optional<std::string> path =
            shared_report("11-key-times/" + sample.file + ".gltf");
        if (!path) {
            return;
        }
        const Result<GltfScene> scene = load_gltf(*path);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        CHECK(scene->warnings.size() == sample.warnings);
        LocalPose pose = scene->skeleton.rest;
        for (const ClipData& clip : scene->clips) {
            sample_clip(clip, sample.time, pose, {});
        }
        REQUIRE(scene->joints[0] >= 0);
        CHECK(
            pose.translations[static_cast<std::size_t>(scene->joints[0])].x
            == test::near(sample.x).epsilon(1e-3));
    }
}

TEST_CASE("gltf animation: Fox has 24 joints in a row of parents, and three ways to go") {
    const std::optional<std::string> path = shared_asset("gltf/Fox.glb");
    if (!path) {
        return;
    }
    const Result<GltfScene> scene = load_gltf(*path);
    REQUIRE(scene.ok());
    REQUIRE(scene->skins.size() == 1);
    CHECK(scene->skins[0].joints.size() == 24);
    REQUIRE(scene->clips.size() == 3);
    CHECK(scene->clips[0].name == "Survey");
    CHECK(scene->clips[1].name == "Walk");
    CHECK(scene->clips[2].name == "Run");
    const SkeletonData& skeleton = scene->skeleton;
    const auto bone_lengths = [&](const LocalPose& pose) {
        std::vector<Affine> matrices(skeleton.joints.size());
        compute_joint_matrices(skeleton, pose, matrices);
        std::vector<float> lengths = {0};
        for (std::size_t i = 1; i < matrices.size(); ++i) {
            const std::size_t parent = static_cast<std::size_t>(skeleton.parents[i]);
            lengths.push_back(apart(
                transform_point(matrices[i], Vec3(0)), transform_point(matrices[parent], Vec3(0))));
        }
        return lengths;
    };
    const std::vector<float> at_rest = bone_lengths(skeleton.rest);
    for (const ClipData& clip : scene->clips) {
        CHECK(clip.duration > 0.5f);
        REQUIRE(clip.sheets.size() == 1);
        const std::vector<std::uint16_t>& moved = clip.sheets[0].translating;
        CHECK(moved.size() < 4);
        for (const float share : {0.0f, 0.3f, 0.9f}) {
            LocalPose pose = skeleton.rest;
            sample_clip(clip, share * clip.duration, pose, {});
            const std::vector<float> lengths = bone_lengths(pose);
            for (std::size_t i = 1; i < lengths.size(); ++i) {
                if (std::find(moved.begin(), moved.end(), i) == moved.end()) {
                    CHECK(lengths[i] == test::near(at_rest[i]).epsilon(1e-4));
                }
            }
        }
    }
}

}  // namespace limn::gltf_animation_test
