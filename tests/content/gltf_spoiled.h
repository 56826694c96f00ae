#pragma once

// The square of gltf_samples.h, spoiled by an edit: what is refused, and what costs a part.

#include "content/load/files/atomic_file.h"
#include "content/load/gltf/gltf_load.h"
#include "tests/content/gltf_samples.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::test {

inline bool mentions(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// One edit of the square and what the message must say.
struct Spoiled {
    std::string from;
    std::string to;
    std::string expected;
};

inline void check_refused(const Result<GltfScene>& scene, const std::string& expected) {
    CAPTURE(expected);
    REQUIRE_FALSE(scene.ok());
    const std::string& message = scene.error().message;
    CAPTURE(message);
    CHECK(mentions(message, expected));
    CHECK(mentions(message, "square."));  // the file
    CHECK_FALSE(mentions(message, "\n"));
    CHECK(message.size() < 600);
}

inline void check_all_refused(const std::vector<Spoiled>& cases) {
    for (const Spoiled& spoiled : cases) {
        CAPTURE(spoiled.to);
        const std::string json = replace_once(kSquareJson, spoiled.from, spoiled.to);
        check_refused(
            parse_gltf(make_glb(json, square_binary()), "square.glb", ""), spoiled.expected);
    }
}

/// The square as a .gltf in `folder`, with `uri` for its buffer.
inline std::string write_gltf(const TemporaryFolder& folder, const std::string& uri) {
    const std::string json = replace_once(
        kSquareJson, R"({"byteLength": 92})", R"({"byteLength": 92, "uri": ")" + uri + "\"}");
    REQUIRE(write_file(folder.file("square.gltf"), json).ok());
    return folder.file("square.gltf");
}

/// The square with a base color from the image `uri`.
inline std::string textured_json(const std::string& image) {
    return replace_once(
        kSquareJson, R"({"name": "paint"}])",
        R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
           "textures": [{"source": 0}], "images": [)"
            + image + "]");
}

/// What is drawn of the square, with a warning for each edit.
inline void
check_square(const Result<GltfScene>& scene, const std::string& expected, std::size_t count) {
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    REQUIRE(scene->meshes.size() == 1);
    CHECK(scene->meshes[0].positions.size() == 4);
    CHECK(scene->meshes[0].normals[0] == Vec3(0, 0, 1));
    CHECK(scene->nodes.size() == 2);
    REQUIRE(!scene->warnings.empty());
    CHECK_MESSAGE(scene->warnings.size() == count, scene->warnings[0]);
    CHECK_MESSAGE(mentions(scene->warnings[0], "square.glb: " + expected), scene->warnings[0]);
    CHECK_FALSE(mentions(scene->warnings[0], "\n"));
}

inline void check_all_drawn(const std::vector<Spoiled>& cases, std::size_t count = 1) {
    for (const Spoiled& spoiled : cases) {
        CAPTURE(spoiled.to);
        const std::string json = replace_once(kSquareJson, spoiled.from, spoiled.to);
        check_square(
            parse_gltf(make_glb(json, square_binary()), "square.glb", ""), spoiled.expected, count);
    }
}

}  // namespace limn::test
