#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "tests/content/gltf_samples.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace limn::gltf_write_test {
namespace {

/// A strip of five vertices with everything a mesh can have.
MeshData make_strip() {
    MeshData mesh;
    mesh.name = "strip";
    mesh.positions = {{0, 0, 0}, {0.1f, 0, 0}, {0, 1, 0}, {0.1f, 1, 0.3f}, {0, 2.7182818f, 0}};
    mesh.normals.assign(5, Vec3(0, 0, 1));
    mesh.tangents.assign(5, Vec4(1, 0, 0, -1));
    mesh.uvs = {{0, 1}, {1, 1}, {0, 0.5f}, {1, 0.5f}, {0, 0}};
    mesh.colors.assign(5, Vec4(0.25f, 0.5f, 0.75f, 1));
    mesh.indices = {0, 1, 2, 2, 1, 3, 2, 3, 4};
    MorphTarget rise;
    rise.name = "rise";
    rise.action_unit = "AU12_L";
    rise.vertices = {1, 3};
    rise.positions = {{0, 0.3333333f, 0}, {0, 0.1f, -1e-7f}};
    rise.normals = {{0, 0.1f, 0}, {0, 0, 0}};
    rise.tangents = {{0, 0, 0}, {0.1f, 0, 0}};
    MorphTarget nothing;
    nothing.name = "nothing";
    nothing.drivers = {{0, 0.3f}};
    mesh.morphs = {rise, nothing};
    VertexRegion brow;
    brow.name = "brow_2";
    brow.weights = {0, 0.3f, 0, 1, 0};
    brow.across = {Vec3(0), glm::normalize(Vec3(1, 2, 3)), Vec3(0), {0, 1, 0}, Vec3(0)};
    VertexRegion empty;
    empty.name = "empty";
    empty.weights.assign(5, 0.0f);
    mesh.regions = {brow, empty};
    mesh.bounds = {{0, 0, 0}, {0.1f, 2.7182818f, 0.3f}};
    return mesh;
}

GltfScene make_scene() {
    GltfScene scene;
    scene.name = "scene";
    scene.nodes.resize(2);
    scene.nodes[0].name = "root";
    scene.nodes[0].transform.position = {1, 2, 3};
    scene.nodes[1].name = "strip";
    scene.nodes[1].parent = 0;
    scene.nodes[1].parts = {{0, 0}};
    scene.nodes[1].first_morph = 0;
    scene.nodes[1].transform.rotation = glm::normalize(Quat(0.5f, 0.1f, 0.2f, 0.3f));
    scene.nodes[1].transform.scale = {1, 2, 0.5f};
    scene.meshes = {make_strip()};
    scene.materials.push_back(
        {.name = "paint",
         .alpha_mode = AlphaMode::Mask,
         .double_sided = true,
         .alpha_cutoff = 0.25f,
         .base_color = {0.1f, 0.2f, 0.3f, 0.4f},
         .metalness = 0.5f,
         .roughness = 0.7f,
         .emission = {4, 2, 1}});
    scene.morph_weights = {0.25f, 0};
    return scene;
}

GltfScene written_and_read(const GltfScene& scene) {
    const Result<std::vector<std::byte>> bytes = write_glb(scene);
    REQUIRE(bytes.ok());
    Result<GltfScene> read = parse_gltf(*bytes, scene.name + ".glb", "");
    REQUIRE_MESSAGE(read.ok(), read.error().message);
    CHECK(read->warnings.empty());
    return *std::move(read);
}

void check_equal(const std::vector<VertexRegion>& a, const std::vector<VertexRegion>& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(a[i].name == b[i].name);
        CHECK(a[i].weights == b[i].weights);
        CHECK(a[i].across == b[i].across);
    }
}

void check_equal(const MeshData& a, const MeshData& b) {
    CHECK(a.positions == b.positions);
    CHECK(a.normals == b.normals);
    CHECK(a.tangents == b.tangents);
    CHECK(a.uvs == b.uvs);
    CHECK(a.uvs1 == b.uvs1);
    CHECK(a.colors == b.colors);
    CHECK(a.indices == b.indices);
    CHECK(a.skin.first == b.skin.first);
    CHECK(a.skin.joints == b.skin.joints);
    CHECK(a.skin.weights == b.skin.weights);
    CHECK(a.bounds.min == b.bounds.min);
    CHECK(a.bounds.max == b.bounds.max);
    REQUIRE(a.morphs.size() == b.morphs.size());
    for (std::size_t i = 0; i < a.morphs.size(); ++i) {
        CHECK(a.morphs[i].name == b.morphs[i].name);
        CHECK(a.morphs[i].action_unit == b.morphs[i].action_unit);
        CHECK(a.morphs[i].vertices == b.morphs[i].vertices);
        CHECK(a.morphs[i].positions == b.morphs[i].positions);
        CHECK(a.morphs[i].normals == b.morphs[i].normals);
        CHECK(a.morphs[i].tangents == b.morphs[i].tangents);
        CHECK(a.morphs[i].drivers == b.morphs[i].drivers);
    }
    check_equal(a.regions, b.regions);
}

/// The file of the scene with `from` in its JSON replaced, as a message of the loader.
std::string message_with(const std::string& from, const std::string& to) {
    const std::vector<std::byte> bytes = *write_glb(make_scene());
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + 12, 4);
    std::string json(reinterpret_cast<const char*>(bytes.data() + 20), size);
    json = test::replace_once(json, from, to);
    const std::vector<std::byte> binary(bytes.begin() + 28 + size, bytes.end());
    const Result<GltfScene> scene = parse_gltf(test::make_glb(json, binary), "a.glb", "");
    return scene ? scene->warnings.empty() ? "it loads" : scene->warnings[0]
                 : scene.error().message;
}

}  // namespace

TEST_CASE("gltf write: a scene is read back as it was, to the bit") {
    const GltfScene scene = make_scene();
    const GltfScene read = written_and_read(scene);
    REQUIRE(read.nodes.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(read.nodes[i].name == scene.nodes[i].name);
        CHECK(read.nodes[i].parent == scene.nodes[i].parent);
        CHECK(read.nodes[i].transform.position == scene.nodes[i].transform.position);
        CHECK(
            glm::length(read.nodes[i].transform.rotation - scene.nodes[i].transform.rotation)
            < 1e-6f);
        CHECK(read.nodes[i].transform.scale == scene.nodes[i].transform.scale);
    }
    CHECK(read.morph_weights == scene.morph_weights);
    REQUIRE(read.meshes.size() == 1);
    CHECK(read.meshes[0].name == "strip");
    check_equal(read.meshes[0], scene.meshes[0]);
    REQUIRE(read.materials.size() == 1);
    const Material& paint = read.materials[0];
    CHECK(paint.name == "paint");
    CHECK(paint.alpha_mode == AlphaMode::Mask);
    CHECK(paint.alpha_cutoff == 0.25f);
    CHECK(paint.double_sided);
    CHECK(paint.base_color == scene.materials[0].base_color);
    CHECK(paint.metalness == 0.5f);
    CHECK(paint.roughness == 0.7f);
    CHECK(paint.emission == Vec3(4, 2, 1));
}

TEST_CASE("gltf write: a skinned mesh keeps its joints, with more than four per vertex") {
    GltfScene scene = make_scene();
    MeshData& mesh = scene.meshes[0];
    mesh.skin.first = {0, 1, 2, 3, 8, 9};
    mesh.skin.joints = {0, 1, 2, 0, 1, 2, 3, 4, 0};
    mesh.skin.weights = {1, 1, 1, 0.5f, 0.25f, 0.125f, 0.0625f, 0.0625f, 1};
    // As the loader has it: joints as nodes, the skinned mesh as a root after them.
    scene.nodes.resize(1);
    scene.nodes.emplace_back().name = "strip";
    scene.nodes.back().parent = 0;
    SkinData skin;
    skin.name = "bones";
    for (int i = 1; i <= 5; ++i) {
        GltfNode joint;
        joint.name = "joint" + std::to_string(i);
        joint.parent = i == 1 ? -1 : static_cast<std::int32_t>(scene.nodes.size()) - 1;
        joint.transform.position = {0, 0.5f, 0};
        scene.nodes.push_back(joint);
        skin.joints.push_back(static_cast<std::uint16_t>(i));
        const Vec3 from_rest = {0, -0.5f * static_cast<float>(i), 0};
        skin.joint_from_mesh.push_back(affine_from(from_rest, Quat(1, 0, 0, 0), Vec3(1)));
    }
    scene.joints = {-1, -1, 1, 2, 3, 4, 5, -1};
    scene.skins = {skin};
    GltfNode body;
    body.name = "strip.skin";
    body.parts = {{0, 0}};
    body.skin = 0;
    body.first_morph = 0;
    scene.nodes.push_back(body);
    scene.skeleton.freedoms = {
        {.joint = 2,
         .axis = {1, 0, 0},
         .min = -0.1f,
         .max = 2.5f,
         .middle = 0.4f,
         .stiffness = 0.25f},
        {.joint = 4, .axis = {0, 1, 0}, .min = -0.7f, .max = 0.7f},
        {.joint = 4, .axis = {0, 0.6f, 0.8f}, .min = -0.2f, .max = 0.3f}};

    const GltfScene read = written_and_read(scene);
    REQUIRE(read.nodes.size() == scene.nodes.size());
    CHECK(read.joints == scene.joints);
    REQUIRE(read.skeleton.freedoms.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const JointFreedom& was = scene.skeleton.freedoms[i];
        const JointFreedom& is = read.skeleton.freedoms[i];
        CHECK(is.joint == was.joint);
        CHECK(is.axis == was.axis);
        CHECK(is.min == was.min);
        CHECK(is.max == was.max);
        CHECK(is.middle == was.middle);
        CHECK(is.stiffness == was.stiffness);
    }
    CHECK(read.nodes.back().name == "strip.skin");
    CHECK(read.nodes.back().skin == 0);
    CHECK(read.nodes[4].parent == 3);
    REQUIRE(read.skins.size() == 1);
    CHECK(read.skins[0].name == "bones");
    CHECK(read.skins[0].joints == skin.joints);
    for (std::size_t i = 0; i < 5; ++i) {
        CHECK(read.skins[0].joint_from_mesh[i].row[1] == skin.joint_from_mesh[i].row[1]);
    }
    CHECK(read.skeleton.joints[3] == "joint3");
    check_equal(read.meshes[0], mesh);

    scene.skeleton.freedoms = {{.joint = 5, .axis = {0, 0, 0}, .min = 1, .max = -1}};
    const Result<std::vector<std::byte>> bytes = write_glb(scene);
    REQUIRE(bytes.ok());
    const Result<GltfScene> spoiled = parse_gltf(*bytes, "spoiled.glb", "");
    REQUIRE(spoiled.ok());
    CHECK(spoiled->warnings.size() == 1);
    CHECK(spoiled->skeleton.freedoms.empty());
}

TEST_CASE("gltf write: parts of one node share their morph targets") {
    GltfScene scene = make_scene();
    scene.meshes.push_back(make_strip());
    MorphTarget& rise = scene.meshes[1].morphs[0];
    rise.vertices.clear();
    rise.positions.clear();
    rise.normals.clear();
    rise.tangents.clear();
    scene.materials.push_back({.name = "other", .shading = ShadingModel::Unlit});
    scene.nodes[1].parts.push_back({1, 1});
    const GltfScene read = written_and_read(scene);
    REQUIRE(read.meshes.size() == 2);
    CHECK(read.meshes[1].name == "strip.1");
    check_equal(read.meshes[1], scene.meshes[1]);
    CHECK(read.materials[1].shading == ShadingModel::Unlit);
    CHECK(read.morph_weights == scene.morph_weights);
}

TEST_CASE("gltf write: sparse targets and regions take the room of what they move") {
    GltfScene scene = make_scene();
    const std::size_t size = write_glb(scene)->size();
    for (int i = 0; i < 50; ++i) {
        scene.meshes[0].morphs.emplace_back().name = "still";
    }
    scene.morph_weights.resize(52, 0.0f);
    const std::vector<std::byte> bytes = *write_glb(scene);
    std::uint32_t json = 0;
    std::uint32_t before = 0;
    std::memcpy(&json, bytes.data() + 12, 4);
    std::memcpy(&before, write_glb(make_scene())->data() + 12, 4);
    CHECK(bytes.size() - json == size - before);  // not a byte of buffer more
}

TEST_CASE("gltf write: what is not written is refused") {
    const auto message = [](const std::function<void(GltfScene&)>& change) {
        GltfScene scene = make_scene();
        change(scene);
        const auto bytes = write_glb(scene);
        return bytes ? "it writes" : bytes.error().message;
    };
    CHECK(
        message([](GltfScene& s) { s.images.resize(1); }).find("0 x 0 pixels")
        != std::string::npos);
    CHECK(
        message([](GltfScene& s) {
            s.images.emplace_back().name = "sky";
            s.images[0].format = PixelFormat::Rgba16F;
        })
        == "scene: found floats in the image \"sky\", expected 8 bits: glTF has no others");
    CHECK(
        message([](GltfScene& s) { s.nodes[1].has_camera = true; }).find("\"strip\"")
        != std::string::npos);
    CHECK(
        message([](GltfScene& s) {
            s.materials[0].shading = ShadingModel::Skin;
        }).find("expected pbr or unlit")
        != std::string::npos);
    CHECK(
        message([](GltfScene& s) { s.meshes[0].regions[0].name = "Brow!"; })
        == "scene: found the region \"Brow!\", expected a name of a-z, 0-9 and _");
    CHECK(message([](GltfScene&) {}) == "it writes");
}

TEST_CASE("gltf write: images, textures and how they are placed come back") {
    GltfScene scene = make_scene();
    for (int i = 0; i < 2; ++i) {
        ImageData& image = scene.images.emplace_back();
        image.name = i == 0 ? "paint" : "bumps";
        image.width = 2;
        image.height = 1;
        image.srgb = i == 0;
        const auto code = static_cast<std::uint8_t>(100 * i);
        image.pixels = {code, 1, 2, 255, 3, 4, code, 128};
    }
    Material& material = scene.materials[0];
    material.base_color_texture.image = {0};
    material.normal_texture.image = {1};
    material.normal_texture.wrap_u = Wrap::Mirror;
    material.normal_texture.scale = {2, 3};
    material.normal_texture.rotation = 0.5f;
    material.normal_scale = 0.75f;
    material.occlusion_texture.image = {1};
    material.occlusion_texture.nearest = true;
    material.occlusion_strength = 0.5f;
    const auto bytes = write_glb(scene);
    REQUIRE_MESSAGE(bytes.ok(), (bytes ? std::string() : bytes.error().message));
    const auto parsed = parse_gltf(*bytes, "scene.glb", "");
    REQUIRE_MESSAGE(parsed.ok(), (parsed ? std::string() : parsed.error().message));
    const Material& read = parsed->materials[0];
    REQUIRE(parsed->images.size() == 2);
    const ImageData& paint = parsed->images[read.base_color_texture.image.index];
    const ImageData& bumps = parsed->images[read.normal_texture.image.index];
    CHECK(paint.srgb);
    CHECK(paint.pixels == scene.images[0].pixels);
    CHECK_FALSE(bumps.srgb);
    CHECK(bumps.pixels == scene.images[1].pixels);
    CHECK(read.normal_texture.wrap_u == Wrap::Mirror);
    CHECK(read.normal_texture.scale == Vec2(2, 3));
    CHECK(read.normal_texture.rotation == 0.5f);
    CHECK(read.normal_scale == 0.75f);
    CHECK(read.occlusion_texture.image.index == read.normal_texture.image.index);
    CHECK(read.occlusion_texture.nearest);
    CHECK(read.occlusion_strength == 0.5f);
}

TEST_CASE("gltf write: skin and hair come back as shading models of extras") {
    GltfScene scene = make_scene();
    Material& material = scene.materials[0];
    material.shading = ShadingModel::Subsurface;
    material.scatter = {0.003f, 0.002f, 0.001f};
    material.specular = Vec3(0.03f);
    material.gloss = 0.25f;
    material.gloss_roughness = 0.3f;
    const auto read = [&] {
        const auto bytes = write_glb(scene);
        REQUIRE_MESSAGE(bytes.ok(), (bytes ? std::string() : bytes.error().message));
        const auto parsed = parse_gltf(*bytes, "scene.glb", "");
        REQUIRE(parsed.ok());
        REQUIRE(parsed->warnings.empty());
        return parsed->materials[0];
    };
    const Material skin = read();
    CHECK(skin.shading == ShadingModel::Subsurface);
    CHECK(skin.scatter == material.scatter);
    CHECK(skin.specular == material.specular);
    CHECK(skin.gloss == 0.25f);
    CHECK(skin.gloss_roughness == 0.3f);
    material.shading = ShadingModel::Hair;
    material.hair_scatter = 0.7f;
    material.roughness_across = 0.4f;
    const Material hair = read();
    CHECK(hair.shading == ShadingModel::Hair);
    CHECK(hair.hair_scatter == 0.7f);
    CHECK(hair.roughness_across == 0.4f);
    material.shading = ShadingModel::Pbr;
    CHECK(read().scatter == Material{}.scatter);
}

TEST_CASE("gltf write: relief comes back, in extras that other programs ignore") {
    GltfScene scene = make_scene();
    ImageData& image = scene.images.emplace_back();
    image.name = "relief";
    image.width = 2;
    image.height = 1;
    image.pixels = {128, 128, 255, 0, 100, 120, 250, 77};
    Material& material = scene.materials[0];
    material.detail = SurfaceDetail::Silhouette;
    material.relief_depth = 0.0123f;
    material.relief_steps = 40;
    material.relief_shadow = ReliefShadow::Ray;
    material.relief_texture.image = {0};
    material.relief_texture.scale = {2, 3};
    const auto bytes = write_glb(scene);
    REQUIRE(bytes.ok());
    const auto parsed = parse_gltf(*bytes, "scene.glb", "");
    REQUIRE(parsed.ok());
    REQUIRE(parsed->warnings.empty());
    const Material& read = parsed->materials[0];
    CHECK(read.detail == SurfaceDetail::Silhouette);
    CHECK(read.relief_depth == 0.0123f);
    CHECK(read.relief_steps == 40);
    CHECK(read.relief_shadow == ReliefShadow::Ray);
    CHECK(read.relief_refinements == Material{}.relief_refinements);
    CHECK(read.relief_texture.scale == Vec2(2, 3));
    CHECK(parsed->images[read.relief_texture.image.index].pixels == image.pixels);
}

TEST_CASE("gltf write: a file is complete or not there") {
    const test::TemporaryFolder folder;
    CHECK_FALSE(save_glb(folder.file("none/a.glb"), make_scene()).ok());
    CHECK(save_glb(folder.file("a.glb"), make_scene()).ok());
    CHECK(load_gltf(folder.file("a.glb")).ok());
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        files += entry.exists() ? 1 : 0;
    }
    CHECK(files == 1);
}

TEST_CASE("gltf: weights of a region are clamped, and directions become unit vectors") {
    GltfScene scene = make_scene();
    scene.meshes[0].regions[0].weights[3] = 1.5f;
    scene.meshes[0].regions[0].across[3] = {0, 4, 0};
    const VertexRegion region = written_and_read(scene).meshes[0].regions[0];
    CHECK(region.weights[3] == 1.0f);
    CHECK(region.across[3] == Vec3(0, 1, 0));
}

TEST_CASE("gltf: NaN in a region is refused with its place") {
    GltfScene scene = make_scene();
    scene.meshes[0].regions[0].across[3].x = std::numeric_limits<float>::quiet_NaN();
    const Result<GltfScene> read = parse_gltf(*write_glb(scene), "a.glb", "");
    REQUIRE_FALSE(read.ok());
    CHECK(
        read.error().message.find(
            "a.glb: meshes[0].primitives[0].attributes._ACROSS_BROW_2: accessors[")
        == 0);
    CHECK(read.error().message.find("found NaN or infinity in element 3") != std::string::npos);
}

TEST_CASE("gltf: a region of another size is refused, and a direction without one is a warning") {
    CHECK(message_with("\"_NONE\"", "") == "it loads");
    // Accessor 0 has the positions: three components.
    CHECK(
        message_with("\"_REGION_EMPTY\":", "\"_REGION_EMPTY\":0,\"_OTHER\":")
            .find("_REGION_EMPTY: accessors[0].type: found 3 components")
        != std::string::npos);
    CHECK(
        message_with("\"_REGION_BROW_2\"", "\"_OTHER\"")
        == "a.glb: meshes[0].primitives[0].attributes._ACROSS_BROW_2 is ignored: there is no "
           "region "
           "of that name");
}

}  // namespace limn::gltf_write_test
