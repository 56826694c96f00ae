#include "content/load/gltf/gltf_load.h"
#include "tests/content/gltf_samples.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace limn::gltf_mutants_test {

using namespace limn::test;

namespace {

/// One of each: skin, morph targets, sparse values, clips, camera, light, textures, extensions.
std::string rich_json(const Numbers& numbers) {
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, {}, "scene": 0,
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_unlit"],
        "extensions": {{"KHR_lights_punctual": {{"lights": [
            {{"type": "spot", "color": [1, 0.5, 0], "range": 9, "spot": {{"outerConeAngle": 0.5}}}}]}}}},
        "images": [{{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC"}}],
        "samplers": [{{"magFilter": 9728, "wrapS": 33071}}],
        "textures": [{{"source": 0, "sampler": 0}}],
        "materials": [{{"name": "a", "alphaMode": "MASK", "emissiveFactor": [0, 1, 0.5],
            "pbrMetallicRoughness": {{"metallicFactor": 0.5, "baseColorTexture": {{"index": 0,
                "extensions": {{"KHR_texture_transform": {{"scale": [2, 3], "texCoord": 0}}}}}}}}}},
            {{"extensions": {{"KHR_materials_unlit": {{}},
                "KHR_materials_transmission": {{"transmissionFactor": 0.5}}}}}}],
        "cameras": [{{"type": "perspective", "perspective": {{"yfov": 1, "znear": 0.1}}}}],
        "meshes": [{{"name": "body", "weights": [0.5], "extras": {{"targetNames": ["x"]}},
            "primitives": [{{"attributes": {{"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}},
                "material": 0, "targets": [{{"POSITION": 6}}]}}]}},
            {{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 5, "material": 1}},
                             {{"attributes": {{"POSITION": 0}}, "mode": 3}}]}}],
        "skins": [{{"joints": [1, 2]}}],
        "nodes": [{{"name": "body", "mesh": 0, "skin": 0}},
            {{"name": "hip", "children": [2], "rotation": [0, 0, 0, 1]}},
            {{"children": [3], "camera": 0, "scale": [1, 2, 1],
              "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}},
            {{"mesh": 1, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]}}],
        "scenes": [{{"nodes": [0, 1]}}],
        "animations": [{{"name": "nod",
            "channels": [{{"sampler": 0, "target": {{"node": 1, "path": "translation"}}}},
                         {{"sampler": 1, "target": {{"node": 0, "path": "weights"}}}}],
            "samplers": [{{"input": 3, "output": 4}}, {{"input": 3, "output": 3}}]}}]}})",
        numbers.json());
}

struct RichFile {
    std::string json;
    std::vector<std::byte> binary;
};

RichFile make_rich_file() {
    Numbers numbers;
    numbers.add("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    numbers.add_typed<std::uint8_t>("VEC4", 4, 5121, false, {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    numbers.add("VEC4", 4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    numbers.add("SCALAR", 1, {0, 1});
    numbers.add("VEC3", 3, {0, 1, 0, 0, 3, 0});
    numbers.add_typed<std::uint16_t>("SCALAR", 1, 5123, false, {0, 1, 2});
    numbers.add_accessor(R"({"componentType": 5126, "count": 3, "type": "VEC3",
        "sparse": {"count": 2, "indices": {"bufferView": 5, "componentType": 5123},
                   "values": {"bufferView": 4}}})");
    return {rich_json(numbers), numbers.bytes()};
}

/// Begin and end of the number, string or word at or after `at`.
std::pair<std::size_t, std::size_t> token_at(const std::string& json, std::size_t at) {
    constexpr std::string_view kWord =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-+.";
    const std::size_t begin = std::min(json.find_first_of(kWord, at), json.size());
    return {begin, std::min(json.find_first_not_of(kWord, begin), json.size())};
}

/// One edit that leaves most of the JSON valid, or a flipped byte.
void mutate(RichFile& file, std::mt19937& random) {
    constexpr std::array<std::string_view, 20> kValues = {
        "0",          "-1",         "1",     "2",   "3",     "255",       "65536",
        "2147483648", "4294967296", "1e300", "0.5", "-0",    "null",      "true",
        "[]",         "{}",         "\"\"",  "1e0", "[[0]]", "{\"a\": 1}"};
    const auto below = [&random](std::size_t count) {
        return random() % std::max<std::size_t>(count, 1);
    };
    std::string& json = file.json;
    const auto [begin, end] = token_at(json, below(json.size()));
    switch (random() % 8) {
    case 0:
        file.binary[below(file.binary.size())] = static_cast<std::byte>(random());
        break;
    case 1:
        json[below(json.size())] ^= static_cast<char>(1u << random() % 7);
        break;
    case 2:  // a member, an item or parts of both
        json.erase(begin, std::min(json.find_first_of(",]}", begin), json.size()) + 1 - begin);
        break;
    case 3: {
        const auto [from, to] = token_at(json, below(json.size()));
        json.replace(begin, end - begin, json.substr(from, to - from));
        break;
    }
    case 4:
        json.insert(begin, json.substr(begin, below(60)));
        break;
    default:
        json.replace(begin, end - begin, kValues[below(kValues.size())]);
    }
}

bool is_sound(const GltfScene& scene) {
    bool sound = true;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        sound = sound && scene.nodes[i].parent < static_cast<std::int32_t>(i);
        for (const GltfPart& part : scene.nodes[i].parts) {
            sound = sound && part.mesh < scene.meshes.size();
            sound = sound && part.material < scene.materials.size();
        }
    }
    for (const MeshData& mesh : scene.meshes) {
        const std::size_t count = mesh.positions.size();
        sound = sound && mesh.normals.size() == count && mesh.tangents.size() == count;
        for (const std::uint32_t index : mesh.indices) {
            sound = sound && index < count;
        }
        for (const Vec3& position : mesh.positions) {
            sound = sound && is_finite(position);
        }
    }
    return sound;
}

}  // namespace

TEST_CASE("gltf: of ten thousand mutants each is a sound scene or one line") {
    const RichFile rich = make_rich_file();
    const auto good = parse_gltf(make_glb(rich.json, rich.binary), "rich.glb", "");
    REQUIRE_MESSAGE(good.ok(), good.error().message);
    std::mt19937 random(7);
    int loaded = 0;
    for (int i = 0; i < 10'000; ++i) {
        RichFile mutant = rich;
        for (int edits = 1 + static_cast<int>(random() % 2); edits > 0; --edits) {
            mutate(mutant, random);
        }
        const Result<GltfScene> scene =
            parse_gltf(make_glb(mutant.json, mutant.binary), "rich.glb", "");
        loaded += scene.ok() ? 1 : 0;
        const bool fine = scene ? is_sound(*scene)
                                : scene.error().message.starts_with("rich.glb")
                                      && scene.error().message.find('\n') == std::string::npos;
        INFO(mutant.json);
        REQUIRE(fine);
    }
    CHECK(loaded > 1000);  // not all are refused by the first check
    CHECK(loaded < 9000);
}

}  // namespace limn::gltf_mutants_test
