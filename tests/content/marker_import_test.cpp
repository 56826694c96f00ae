#include "content/load/faces/marker_file.h"
#include "content/load/faces/marker_import.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace limn::marker_import_test {

using test::near;

namespace {

const std::string kTake = "PathFileType\t4\t(X/Y/Z)\ttake.trc\n"
                          "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
                          "50\t50\t3\t2\tmm\n"
                          "Frame#\tTime\tbrow\t\t\tlip\t\t\r\n"
                          "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
                          "\n"
                          "1\t0.00\t10\t20\t30\t1\t2\t3\n"
                          "2\t0.02\t\t\t\t4\t5\t6\n"
                          "3\t0.04\t11\t21\t31\t-7.5\t8e1\t9\n";

std::string error_of(const std::string& text, const MarkerLimits& limits = {}) {
    const auto motion = parse_trc(text, "take.trc", limits);
    return motion ? "none" : motion.error().message;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

/// Markers on a face that smiles and nods: four on the head, the others on a bulge.
MarkerMotion make_take() {
    MarkerMotion take;
    take.rate = 25;
    std::vector<Vec3> rest = {
        {-0.08f, 0.15f, 0}, {0.08f, 0.15f, 0}, {0, 0.2f, 0}, {0, 0.15f, 0.1f}};
    take.names = {"Head1", "head2", "HEAD_3", "head4"};
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 5; ++x) {
            const Vec2 at = 0.03f * Vec2(x - 2, y - 2);
            rest.emplace_back(at, 0.1f - 4 * glm::dot(at, at));
            take.names.push_back("face" + std::to_string(5 * y + x));
        }
    }
    for (int f = 0; f < 10; ++f) {
        const auto frame = static_cast<float>(f);
        const Affine nod = affine_from(
            {0, 0.01f * frame, 0}, glm::angleAxis(0.05f * frame, Vec3(1, 0, 0)), Vec3(1));
        for (std::size_t m = 0; m < rest.size(); ++m) {
            const Vec3 smile = m < 4 ? Vec3(0) : Vec3(0.02f * rest[m].x * frame, 0, 0);
            take.positions.push_back(transform_point(nod, rest[m] + smile));
        }
    }
    return take;
}

}  // namespace

TEST_CASE(
    "marker file: names, rate and positions in meters, with hidden markers"
    * technique("face.mocap-drive")) {
    const MarkerMotion motion = *parse_trc(kTake, "take.trc");
    CHECK(motion.names == std::vector<std::string>{"brow", "lip"});
    CHECK(motion.rate == 50);
    REQUIRE(motion.frames() == 3);
    CHECK(glm::distance(motion.positions[0], Vec3(0.010f, 0.020f, 0.030f)) < 1e-7f);
    CHECK_FALSE(is_finite(motion.positions[2]));
    CHECK(glm::distance(motion.positions[3], Vec3(0.004f, 0.005f, 0.006f)) < 1e-7f);
    CHECK(glm::distance(motion.positions[5], Vec3(-0.0075f, 0.08f, 0.009f)) < 1e-7f);
    const MarkerMotion meters = *parse_trc(replaced(kTake, "\tmm", "\tm"), "take.trc");
    CHECK(meters.positions[0] == Vec3(10, 20, 30));
}

TEST_CASE(
    "marker file: a byte order mark, units in capitals and the subject that Vicon names are read"
    * technique("face.mocap-drive")) {
    const MarkerMotion plain = *parse_trc(kTake, "take.trc");
    const std::string vicon =
        replaced(replaced(replaced(kTake, "\tmm", "\tMM"), "brow", "Anna:brow"), "lip", "Anna:lip");
    const auto motion = parse_trc("\xef\xbb\xbf" + vicon, "take.trc");
    REQUIRE(motion);
    CHECK(motion->names == plain.names);
    CHECK(motion->positions[0] == plain.positions[0]);
    // Two subjects stay apart, and a name that is only a subject is one.
    const std::string two = replaced(vicon, "Anna:lip", "Bob:lip");
    CHECK(parse_trc(two, "take.trc")->names == std::vector<std::string>{"Anna:brow", "Bob:lip"});
    CHECK(
        parse_trc(replaced(vicon, "Anna:lip", "Anna:"), "take.trc")->names
        == std::vector<std::string>{"Anna:brow", "Anna:"});
}

TEST_CASE("marker file: errors name the line") {
    CHECK(
        error_of("hello")
        == "take.trc: found no TRC file, expected one that begins with PathFileType");
    CHECK(
        error_of("") == "take.trc: found no TRC file, expected one that begins with PathFileType");
    CHECK(
        error_of(replaced(kTake, "\tmm", "\tin"))
        == "take.trc:3: found the unit \"in\", expected mm, cm or m");
    CHECK(
        error_of(replaced(kTake, "50\t50\t3", "0\t50\t3"))
        == "take.trc:3: found the rate \"0\", expected 0 to 100000 frames per second");
    CHECK(
        error_of(replaced(kTake, "8e1", "nan"))
        == "take.trc:9: found \"nan\" at the marker \"lip\", expected a number");
    CHECK(
        error_of(replaced(kTake, "8e1", "8e9x"))
        == "take.trc:9: found \"8e9x\" at the marker \"lip\", expected a number");
    CHECK(error_of(kTake.substr(0, kTake.find("1\t0.00"))) == "take.trc: found no frames");
    CHECK(error_of(kTake, {.max_markers = 1}) == "take.trc:4: found 2 markers, expected 1 to 1");
    CHECK(error_of(kTake, {.max_positions = 5}) == "take.trc:9: found more than 5 positions");
    // Cut anywhere, it is read or refused.
    for (std::size_t i = 0; i < kTake.size(); ++i) {
        (void)parse_trc(kTake.substr(0, i), "take.trc");
    }
}

TEST_CASE(
    "marker import: triangles cover the face once, and no marker is in a triangle's circle"
    * technique("face.mocap-drive")) {
    std::vector<Vec3> points;
    Random random(4, 3, 2, 1);
    for (int i = 0; i < 60; ++i) {
        const float y = 2 * random.uniform() - 1;
        const float x = 2 * random.uniform() - 1;
        const Vec2 at = 0.08f * Vec2(x, y);
        points.emplace_back(at, 0.1f - 3 * glm::dot(at, at));
    }
    points.push_back(points[7]);  // twice
    const std::vector<std::uint32_t> indices = triangulate_markers(points);
    REQUIRE(indices.size() > 3 * 60);
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::set<std::uint32_t> used;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const std::uint32_t next = indices[i % 3 == 2 ? i - 2 : i + 1];
        CHECK(edges.insert({indices[i], next}).second);
        used.insert(indices[i]);
    }
    CHECK(used.size() == 60);
    std::size_t border = 0;
    for (const auto& [a, b] : edges) {
        border += edges.contains({b, a}) ? 0 : 1;
    }
    CHECK(indices.size() / 3 == 2 * 60 - 2 - border);  // Euler: one piece without holes
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const Vec3 normal = glm::cross(
            points[indices[i + 1]] - points[indices[i]],
            points[indices[i + 2]] - points[indices[i]]);
        CHECK(normal.z > 0);
    }
    CHECK(triangulate_markers({}).empty());
    CHECK(triangulate_markers(std::vector<Vec3>(5, Vec3(1))).empty());
    CHECK(triangulate_markers(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).empty());
}

TEST_CASE(
    "marker import: the file has the face's motion without the head's"
    * technique("face.head-stabilise")) {
    MarkerMotion take = make_take();
    const std::size_t count = take.markers();
    take.positions[3 * count + 12] = Vec3(NAN);  // hidden for a frame
    const GltfScene scene = *make_marker_scene("take", take);
    const std::string path =
        (std::filesystem::temp_directory_path() / "limn_marker_take.glb").string();
    REQUIRE(save_glb(path, scene).ok());
    const GltfScene read = *load_gltf(path);
    std::filesystem::remove(path);
    REQUIRE(read.clips.size() == 1);
    CHECK(read.clips[0].duration == near(9.0 / 25));
    REQUIRE(read.meshes.size() == 1);
    const MeshData& surface = read.meshes[0];
    CHECK(surface.positions.size() == 25);
    // It mirrors no lamp either, as a transparent one would.
    REQUIRE(read.materials.size() == 1);
    CHECK(read.materials[0].alpha_mode == AlphaMode::Mask);
    CHECK(read.materials[0].base_color.w < read.materials[0].alpha_cutoff);
    CHECK(surface.indices.size() >= 3 * 32);  // more: slivers along the hull
    CHECK(read.skeleton.joints.size() >= 26);
    REQUIRE(read.clips[0].sheets.size() == 1);
    const ClipSheet& sheet = read.clips[0].sheets[0];
    REQUIRE(sheet.translating.size() == 25);
    for (std::size_t f = 0; f < 10; ++f) {
        for (std::size_t m = 0; m < 25; ++m) {
            const Vec3 rest = make_take().positions[m + 4];
            const Vec3 want = rest + Vec3(0.02f * rest.x * static_cast<float>(f), 0, 0);
            const float bound = m + 4 == 12 && f == 3 ? 2e-3f : 2e-6f;  // of its neighbors' motion
            CHECK(glm::distance(sheet.translations[25 * f + m], want) < bound);
        }
    }
}

TEST_CASE("marker import: a take that is not a face is rejected with one line") {
    const auto error = [](const auto& change) {
        MarkerMotion take = make_take();
        change(take);
        const auto scene = make_marker_scene("take", take);
        return scene ? std::string("none") : scene.error().message;
    };
    CHECK(error([](MarkerMotion&) {}) == "none");
    CHECK(
        error([](MarkerMotion& take) { take.positions[9] = Vec3(NAN); })
        == "take: the first frame, the face at rest, lacks the marker \"face5\"");
    CHECK(
        error([](MarkerMotion& take) { take.names[0] = take.names[1] = "ear"; })
        == "take: found 2 markers on the head, expected at least 3");
    CHECK(
        error([](MarkerMotion& take) {
            for (std::string& name : take.names) {
                name = "head";
            }
        })
        == "take: found no three markers of the face that span a triangle");
}

}  // namespace limn::marker_import_test
