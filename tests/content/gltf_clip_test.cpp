#include "content/load/files/atomic_file.h"
#include "content/load/gltf/gltf_clip.h"
#include "content/load/gltf/gltf_load.h"
#include "tests/content/gltf_samples.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <vector>

namespace limn::gltf_clip_test {
namespace {

// One red pixel.
constexpr const char* kPixel =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC";

std::vector<std::byte> from_base64(std::string_view text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::byte> bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') {
            break;
        }
        bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(c));
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::byte>(bits >> count & 0xff));
        }
    }
    return bytes;
}

void write_floats(const std::string& path, const std::vector<float>& values) {
    std::vector<std::byte> bytes;
    test::append_values(bytes, values);
    REQUIRE(write_file(path, bytes).ok());
}

/// A face in pieces: a .gltf with two buffers and an image in files of their own, and an extension
/// that nobody knows.
std::string write_face(const std::string& folder) {
    write_floats(folder + "/a.bin", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1});
    write_floats(folder + "/b.bin", {0, 0, 0, 0, 1, 0, 0, 0, 0});
    REQUIRE(write_file(folder + "/skin.png", from_base64(kPixel)).ok());
    const std::string path = folder + "/face.gltf";
    REQUIRE(write_file(path, std::string(R"({
        "asset": {"version": "2.0"}, "extensionsUsed": ["X_unknown"],
        "scene": 0, "scenes": [{"nodes": [1]}],
        "nodes": [{"name": "mask", "mesh": 0, "extensions": {"X_unknown": {"a": [1, 2]}}},
                  {"name": "root", "children": [0, 2], "rotation": [0, 1, 0, 0]}, {"name": "none"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0,
                                    "targets": [{"POSITION": 2}, {"POSITION": 2}]}],
                    "extras": {"targetNames": ["open", "shut"], "actionUnits": ["AU26"]}}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"uri": "skin.png"}],
        "buffers": [{"byteLength": 60, "uri": "a.bin"}, {"byteLength": 36, "uri": "b.bin"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
                        {"buffer": 1, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
                      {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3"}]
    })"))
                .ok());
    return path;
}

GltfFaceClip make_clip() {
    return {
        .name = "speech",
        .times = {0.0f, 0.5f, 2.0f},
        .weights = {{0, 1, 0.25f, 0.5f, 0.75f, 0}},
        .head_rotations = {Quat(1, 0, 0, 0), Quat(0, 1, 0, 0), Quat(0, 0, 1, 0)}};
}

}  // namespace

TEST_CASE("gltf clip: a file tells its shapes, their action units, and what turns the head") {
    const test::TemporaryFolder folder;
    const Result<GltfFace> face = read_gltf_face(write_face(folder.path()));
    REQUIRE(face.ok());
    REQUIRE(face->nodes.size() == 1);
    CHECK(face->nodes[0].node == 0);
    REQUIRE(face->nodes[0].shapes.size() == 2);
    CHECK(face->nodes[0].shapes[0].name == "open");
    CHECK(face->nodes[0].shapes[0].action_unit == "AU26");
    CHECK(face->nodes[0].shapes[1].action_unit == "");
    REQUIRE(face->head.has_value());
    CHECK(*face->head == 1);
    CHECK(face->head_rotation == Quat(0, 0, 1, 0));
}

TEST_CASE(
    "gltf clip: the clip is added, and everything else is as it was, in one file"
    * technique("face.talking-head")) {
    const test::TemporaryFolder folder;
    const std::string path = write_face(folder.path());
    const GltfFace face = read_gltf_face(path).value();
    const Result<std::vector<std::byte>> bytes = add_face_clip(path, face, make_clip());
    REQUIRE(bytes.ok());
    // Without a folder nothing outside the file can be read.
    const Result<GltfScene> after = parse_gltf(*bytes, "face.gltf", "");
    REQUIRE(after.ok());
    const GltfScene before = load_gltf(path).value();
    REQUIRE(after->meshes.size() == 1);
    CHECK(after->meshes[0].positions == before.meshes[0].positions);
    CHECK(after->meshes[0].uvs == before.meshes[0].uvs);
    CHECK(after->meshes[0].morphs[0].positions == before.meshes[0].morphs[0].positions);
    REQUIRE(after->images.size() == 1);
    CHECK(after->images[0].pixels == before.images[0].pixels);
    REQUIRE(after->clips.size() == 1);
    CHECK(after->clips[0].name == "speech");
    CHECK(after->clips[0].duration == 2.0f);
    bool has_weights = false;
    for (const ClipSheet& sheet : after->clips[0].sheets) {
        if (!sheet.morphing.empty()) {
            has_weights = true;
            CHECK(sheet.times == make_clip().times);
            CHECK(sheet.weights == make_clip().weights[0]);
        }
    }
    CHECK(has_weights);
    const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    CHECK(text.find("X_unknown") != std::string::npos);
}

TEST_CASE("gltf clip: the new clip comes before those of the file") {
    const test::TemporaryFolder folder;
    const std::string path = write_face(folder.path());
    const GltfFace face = read_gltf_face(path).value();
    const std::string once = folder.path() + "/once.glb";
    REQUIRE(write_file(once, *add_face_clip(path, face, make_clip())).ok());
    GltfFaceClip second = make_clip();
    second.name = "second";
    const GltfScene scene =
        parse_gltf(*add_face_clip(once, read_gltf_face(once).value(), second), "x.glb", "").value();
    REQUIRE(scene.clips.size() == 2);
    CHECK(scene.clips[0].name == "second");
    CHECK(scene.clips[1].name == "speech");
}

TEST_CASE("gltf clip: files without shapes, broken or missing ones are refused in a line") {
    const test::TemporaryFolder folder;
    const std::string path = folder.path() + "/x.gltf";
    CHECK(read_gltf_face(path).error().message == path + ": no such file");
    REQUIRE(write_file(path, std::string("{\"asset\": {\"version\": \"2.0\"}}")).ok());
    CHECK(
        read_gltf_face(path).error().message
        == path + ": found no morph targets, expected a face with shapes");
    REQUIRE(write_file(path, std::string("{\"asset\": ")).ok());
    CHECK(read_gltf_face(path).error().message.starts_with(path + ":1:"));
}

}  // namespace limn::gltf_clip_test
