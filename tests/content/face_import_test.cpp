#include "content/bake/face_regions.h"
#include "content/load/faces/face_import.h"
#include "content/load/faces/ict_facekit.h"
#include "content/load/faces/makehuman.h"
#include "content/load/faces/makehuman_files.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "systems/faces/skin_strain.h"
#include "tests/near.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace limn::face_import_test {

using limn::test::near;

namespace {

void no_progress(int /*done*/, int /*total*/) {}

/// The error message of an import that must fail.
template <typename Import>
std::string refusal(Import&& import, const std::string& folder) {
    const Result<GltfScene> scene = import(folder, no_progress);
    return scene ? "it is imported" : scene.error().message;
}

/// The skin of an imported face, at rest and with expressions.
class ImportedSkin {
  public:
    explicit ImportedSkin(const MeshData& mesh)
        : mesh_(mesh), skin_(make_skin_triangles(mesh.positions, mesh.indices)) {}

    /// Strain of all triangles with the targets of this name, or of both its halves, at weight 1.
    [[nodiscard]] std::vector<SkinStrain> strain(const std::vector<std::string>& names) const {
        std::vector<Vec3> deformed = mesh_.positions;
        for (const std::string& name : names) {
            bool found = false;
            for (const MorphTarget& morph : mesh_.morphs) {
                if (morph.name == name || morph.name == name + "_L" || morph.name == name + "_R") {
                    found = true;
                    for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
                        deformed[morph.vertices[i]] += morph.positions[i];
                    }
                }
            }
            CAPTURE(name);
            CHECK(found);
        }
        std::vector<SkinStrain> strain(skin_.area.size());
        find_strain(skin_, deformed, strain);
        return strain;
    }

    struct Mean {
        double compression = 0;  ///< mean shortening of area weighted by the region
        double left = 0;         ///< the same of x > 0
        double right = 0;
    };
    [[nodiscard]] Mean
    measure(const std::vector<SkinStrain>& strain, const std::string& region_name) const {
        const auto region =
            std::find_if(mesh_.regions.begin(), mesh_.regions.end(), [&](const VertexRegion& r) {
                return r.name == region_name;
            });
        REQUIRE(region != mesh_.regions.end());
        double sums[2] = {};
        double areas[2] = {};
        for (std::size_t t = 0; t < strain.size(); ++t) {
            float weight = 0;
            Vec3 center = Vec3(0);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t v = skin_.corners[3 * t + k];
                weight += region->weights[v] / 3;
                center += mesh_.positions[v] / 3.0f;
            }
            const PrincipalStrain p = principal_strain(strain[t]);
            const double shortening = std::max(-p.lower, 0.0f);
            const std::size_t side = center.x > 0 ? 0 : 1;
            const double area = static_cast<double>(weight * skin_.area[t]);
            sums[side] += area * shortening;
            areas[side] += area;
        }
        return {
            (sums[0] + sums[1]) / (areas[0] + areas[1]), sums[0] / areas[0], sums[1] / areas[1]};
    }

  private:
    const MeshData& mesh_;
    SkinTriangles skin_;
};

/// An expression with the regions that fold in it, and some that must not.
struct Expression {
    std::vector<std::string> targets;
    std::vector<std::string> folds;
    std::vector<std::string> quiet;
};

/// At least five times as much shortening in each region that folds as in those that do not, and
/// the same on both sides within 2 %.
void check_expression(const ImportedSkin& skin, const Expression& expression, double mirror) {
    const std::vector<SkinStrain> strain = skin.strain(expression.targets);
    double quiet = 0;
    for (const std::string& region : expression.quiet) {
        quiet = std::max(quiet, skin.measure(strain, region).compression);
    }
    for (const std::string& region : expression.folds) {
        const ImportedSkin::Mean mean = skin.measure(strain, region);
        const std::string where = expression.targets[0] + " " + region;
        CAPTURE(where);
        CAPTURE(quiet);
        CAPTURE(mean.compression);
        CHECK(mean.compression > 0.02);
        CHECK(mean.compression >= 5 * quiet);
        CHECK(mean.left == near(mean.right).epsilon(mirror));
    }
}

/// Of the triangles that may fold [m].
double mean_folding_edge(const MeshData& mesh) {
    double sum = 0;
    double count = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t a = mesh.indices[i];
        const std::uint32_t b = mesh.indices[i % 3 < 2 ? i + 1 : i - 2];
        const bool folds = std::ranges::any_of(
            mesh.regions, [&](const VertexRegion& region) { return region.weights[a] > 0; });
        sum += folds ? static_cast<double>(glm::distance(mesh.positions[a], mesh.positions[b])) : 0;
        count += folds ? 1 : 0;
    }
    return sum / count;
}

void check_regions(const MeshData& mesh) {
    REQUIRE(mesh.regions.size() == face_region_names().size());
    for (const VertexRegion& region : mesh.regions) {
        CAPTURE(region.name);
        double sides[2] = {};
        std::size_t full = 0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            CHECK_UNARY(region.weights[v] >= 0 && region.weights[v] <= 1);
            if (std::abs(mesh.positions[v].x) > 1e-5f) {
                sides[mesh.positions[v].x > 0 ? 0 : 1] += region.weights[v];
            }
            full += region.weights[v] > 0.99f ? 1 : 0;
        }
        CHECK(full >= 8);
        CHECK(sides[0] == near(sides[1]).epsilon(0.02));
    }
}

}  // namespace

TEST_CASE("face import: normals around a position are those of its polygons, however it is split") {
    // A roof of two quads, whose ridge has two texture coordinates.
    const ObjFile obj = *parse_obj(
        "v -1 0 0\nv -1 0 1\nv 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\nvt 0 0\nvt 1 1\n"
        "f 1/1 2/1 4/1 3/1\nf 3/2 4/2 6/2 5/2\n",
        "roof.obj");
    const std::vector<std::uint32_t> faces = {0, 1};
    const std::vector<Vec3> normals = smooth_normals(obj, obj.positions, faces);
    CHECK(glm::distance(normals[2], Vec3(0, 1, 0)) < 1e-6f);
    CHECK(glm::distance(normals[0], glm::normalize(Vec3(-1, 1, 0))) < 1e-6f);

    const FacePart part = {.material = skin_material(), .faces = faces};
    FaceShape lift = {"lift", "AU1", std::vector<Vec3>(6, Vec3(0))};
    lift.offsets[0].y = 1;  // the left eaves rise to the ridge
    lift.offsets[1].y = 1;
    const std::vector<Vec3> reference(6, Vec3(0));
    const std::vector<FaceShape> shapes = {lift};
    const GltfScene scene =
        make_face_scene("roof", obj, 0.5f, std::span(&part, 1), shapes, reference);
    const MeshData& mesh = scene.meshes[0];
    REQUIRE(mesh.positions.size() == 8);
    const MorphTarget& morph = mesh.morphs[0];
    CHECK(morph.action_unit == "AU1");
    REQUIRE(morph.vertices.size() == 6);  // the eaves move, and the ridge turns on both sides
    for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
        const std::uint32_t v = morph.vertices[i];
        const Vec3 normal = mesh.normals[v] + morph.normals[i];
        CHECK(glm::length(normal) == near(1).epsilon(1e-5));
        if (mesh.positions[v].x < 0) {
            CHECK(morph.positions[i] == Vec3(0, 0.5f, 0));
            CHECK(glm::distance(normal, Vec3(0, 1, 0)) < 1e-6f);
        } else {
            CHECK(glm::distance(normal, glm::normalize(Vec3(1, 1 + std::sqrt(2.0f), 0))) < 1e-5f);
        }
    }
}

TEST_CASE("face import: every position finds its mirror image") {
    std::vector<Vec3> positions;
    for (int i = 0; i < 200; ++i) {
        const auto t = static_cast<float>(i);
        const Vec3 p = {1 + std::sin(t), std::cos(3 * t), std::sin(7 * t)};
        positions.push_back(p);
        positions.push_back(p * Vec3(-1, 1, 1));
    }
    const std::vector<std::uint32_t> mirror = mirror_positions(positions);
    for (std::uint32_t i = 0; i < mirror.size(); ++i) {
        CHECK(mirror[i] == (i ^ 1u));
    }
    std::vector<Vec3> offsets(positions.size(), Vec3(0));
    offsets[4] = {1, 2, 3};
    CHECK(mirror_offsets(offsets, mirror)[5] == Vec3(-1, 2, 3));
}

TEST_CASE("face import: lips are red between their borders and nowhere else") {
    CHECK(lip_amount({0, -3.4f, 11.5f}) == 1.0f);
    CHECK(lip_amount({-1.5f, -3.4f, 11}) == 1.0f);
    CHECK(lip_amount({0, -1.9f, 11.5f}) == 0.0f);
    CHECK(lip_amount({0, -4.8f, 11}) == 0.0f);
    CHECK(lip_amount({3.2f, -3.5f, 10}) == 0.0f);
    CHECK(lip_amount({0, -3.4f, 0}) == 0.0f);
}

TEST_CASE("face import: expressions have the action unit that they show") {
    CHECK(ict_action_unit("mouthSmile_L") == "AU12_L");
    CHECK(ict_action_unit("jawOpen") == "AU27");
    CHECK(ict_action_unit("eyeLookIn_L") == "AU62_L");  // the left eye looks to its right
    CHECK(ict_action_unit("eyeLookOut_L") == "AU61_L");
    CHECK(ict_action_unit("mouthLeft").empty());
    CHECK(makehuman_action_unit("nose-left-elevation") == "AU9_L");
    CHECK(makehuman_action_unit("eyebrows-left-up").empty());  // two units
}

TEST_CASE("face import: missing and wrong files are rejected by name") {
    const test::TemporaryFolder folder;
    CHECK(
        refusal(import_ict_facekit, folder.path())
        == folder.path()
               + ": found no generic_neutral_mesh.obj, expected the folder FaceXModel of ICT "
                 "FaceKit");
    std::ofstream(folder.file("generic_neutral_mesh.obj")) << "v 0 0 0\n";
    CHECK(
        refusal(import_ict_facekit, folder.path()).find("found no expressions")
        != std::string::npos);
    std::ofstream(folder.file("mouthSmile_L.obj")) << "v 0 0 0\n";
    CHECK(
        refusal(import_ict_facekit, folder.path())
            .find("generic_neutral_mesh.obj: found 1 vertices, expected the 26719 of ICT FaceKit")
        != std::string::npos);
    CHECK(
        refusal(import_makehuman, folder.path()).find("base.obj: no such file")
        != std::string::npos);
    std::ofstream(folder.file("base.obj")) << "v 0 0 0\n";
    CHECK(
        refusal(import_makehuman, folder.path())
            .find("found 1 vertices, expected the 19158 of the base mesh hm08")
        != std::string::npos);
}

TEST_CASE("face import: a MakeHuman target or proxy with a bad line is refused with its number") {
    const auto target = [](const std::string& text) {
        const auto offsets = parse_makehuman_target(text, "a.target", 10);
        return offsets ? "it is read" : offsets.error().message;
    };
    CHECK(target("# comment\n\n9 .5 -1 0\n3 1 2 3\n") == "it is read");
    CHECK(
        target("# comment\n10 0 0 0\n") == "a.target:2: found \"10\", expected a vertex below 10");
    CHECK(target("-1 0 0 0\n").find("a.target:1: found \"-1\"") == 0);
    CHECK(target("1 0 0\n").find("a.target:1: found \"\", expected a number") == 0);
    CHECK(target("1 0 nan 0\n").find("a.target:1: found \"nan\"") == 0);
    CHECK(target("1 0 1e9 0\n").find("a.target:1: found \"1e9\"") == 0);
    CHECK(parse_makehuman_target("3 1 2 3\n", "a", 10)->at(0).offset == Vec3(1, 2, 3));

    CHECK_FALSE(parse_makehuman_proxy("name eyes\n", "a.mhclo", 10).ok());
    CHECK_FALSE(parse_makehuman_proxy("0 1 10 1 0 0 0 0 0\n", "a.mhclo", 10).ok());
    const auto proxy =
        parse_makehuman_proxy("x_scale 0 1 2\nverts 0\n0 1 2 0.5 0.5 0 1 0 0\n", "a.mhclo", 10);
    REQUIRE(proxy.ok());
    const std::vector<Vec3> base = {
        {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};  // half as wide as when the offsets were made
    CHECK(fit_proxy(*proxy, base)[0] == Vec3(1, 0, 0));
    CHECK(fit_offsets(*proxy, base)[0] == Vec3(0.5f, 0, 0));
}

TEST_CASE("face import: the faces of ICT FaceKit come with their shapes, mirrored where half is "
          "missing") {
    const auto folder = test::shared_asset("ict-facekit");
    if (!folder) {
        return;
    }
    const Result<GltfScene> imported = import_ict_facekit(*folder, no_progress);
    REQUIRE_MESSAGE(imported.ok(), imported.error().message);
    const MeshData& skin = imported->meshes[0];
    CHECK(imported->meshes.size() == 7);
    CHECK(skin.morphs.size() == 19);
    std::set<std::string> names;
    for (const MorphTarget& morph : skin.morphs) {
        CAPTURE(morph.name);
        names.insert(morph.name);
        CHECK_FALSE(morph.action_unit.empty());
        CHECK(morph.normals.size() == morph.vertices.size());
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            const Vec3 normal = skin.normals[morph.vertices[i]] + morph.normals[i];
            CHECK_UNARY(std::abs(glm::length(normal) - 1.0f) < 1e-3f);
        }
    }
    CHECK(names.contains("browDown_R"));
    CHECK(skin.bounds.max.y - skin.bounds.min.y == near(0.338).epsilon(0.01));
    check_regions(skin);

    const ImportedSkin face(skin);
    for (const Expression& expression : std::vector<Expression>{
             {{"browInnerUp", "browOuterUp"},
              {"forehead"},
              {"cheek", "nasolabial", "upper_lip", "mouth_corner", "mentolabial", "chin"}},
             {{"browDown"},
              {"glabella"},
              {"nose_side", "lower_lid", "cheek", "nasolabial", "upper_lip", "chin"}},
             {{"eyeBlink"}, {"lower_lid"}, {"forehead", "cheek", "nasolabial", "chin"}},
             {{"eyeSquint"},
              {"crows_feet", "lower_lid"},
              {"forehead", "glabella", "nose_root", "nasolabial", "upper_lip", "chin"}},
             {{"mouthSmile"},
              {"nasolabial", "cheek", "lower_lid", "crows_feet", "mouth_corner", "upper_lip"},
              {"forehead", "glabella", "nose_root", "upper_lid"}},
             {{"noseSneer"}, {"nose_side", "nose_root"}, {"chin", "mentolabial"}},
             {{"mouthPucker"},
              {"upper_lip", "mentolabial", "nasolabial"},
              {"forehead", "glabella", "nose_root", "upper_lid", "crows_feet"}},
             {{"jawOpen"},
              {"chin", "mouth_corner"},
              {"forehead", "glabella", "nose_root", "nose_side", "lower_lid", "crows_feet"}}}) {
        check_expression(face, expression, 0.02);
    }
}

TEST_CASE("face import: imported faces are written and read back within a micrometer") {
    const auto folder = test::shared_asset("ict-facekit");
    if (!folder) {
        return;
    }
    const GltfScene scene = *import_ict_facekit(*folder, no_progress);
    const Result<GltfScene> read = parse_gltf(*write_glb(scene), "face.glb", "");
    REQUIRE_MESSAGE(read.ok(), read.error().message);
    REQUIRE(read->meshes.size() == scene.meshes.size());
    for (std::size_t part = 0; part < scene.meshes.size(); ++part) {
        const MeshData& a = scene.meshes[part];
        const MeshData& b = read->meshes[part];
        REQUIRE(b.positions.size() >= a.positions.size());  // split where uvs are mirrored
        CHECK(std::equal(a.positions.begin(), a.positions.end(), b.positions.begin()));
        REQUIRE(a.morphs.size() == b.morphs.size());
        for (std::size_t m = 0; m < a.morphs.size(); ++m) {
            CHECK(a.morphs[m].name == b.morphs[m].name);
            CHECK(a.morphs[m].action_unit == b.morphs[m].action_unit);
            CHECK(std::equal(
                a.morphs[m].positions.begin(), a.morphs[m].positions.end(),
                b.morphs[m].positions.begin()));
        }
        REQUIRE(a.regions.size() == b.regions.size());
        for (const VertexRegion& region : a.regions) {  // a file has them in alphabetical order
            const auto found = std::ranges::find(b.regions, region.name, &VertexRegion::name);
            REQUIRE(found != b.regions.end());
            CHECK(std::equal(region.weights.begin(), region.weights.end(), found->weights.begin()));
        }
    }
}

TEST_CASE(
    "face import: the human of MakeHuman stands on the ground, with rig, shapes and regions") {
    const auto folder = test::shared_asset("makehuman");
    if (!folder) {
        return;
    }
    const Result<GltfScene> imported = import_makehuman(*folder, no_progress);
    REQUIRE_MESSAGE(imported.ok(), imported.error().message);
    const MeshData& skin = imported->meshes[0];
    CHECK(skin.morphs.size() == 37);
    CHECK(skin.bounds.min.y == near(0).scale(1).epsilon(1e-5));
    CHECK(skin.bounds.max.y > 1.5f);
    CHECK(skin.bounds.max.y < 1.9f);
    CHECK(imported->skins[0].joints.size() == 163);
    check_regions(skin);
    CHECK(mean_folding_edge(skin) < 0.003);  // 4.8 mm in the cage
    // At rest every joint is where its inverse bind matrix says.
    const std::vector<Affine> joints = find_rest_joints(imported->skeleton);
    const SkinData& rig = imported->skins[0];
    for (std::size_t i = 0; i < rig.joints.size(); ++i) {
        const Affine identity = joints[rig.joints[i]] * rig.joint_from_mesh[i];
        CHECK_UNARY(glm::length(transform_point(identity, Vec3(0))) < 1e-5f);
    }
    const Result<GltfScene> read = parse_gltf(*write_glb(*imported), "person.glb", "");
    REQUIRE_MESSAGE(read.ok(), read.error().message);
    CHECK(read->joints == imported->joints);

    const ImportedSkin face(skin);
    for (const Expression& expression : std::vector<Expression>{
             {{"eyebrows-left-down", "eyebrows-right-down"},
              {"glabella"},
              {"cheek", "nasolabial", "upper_lip", "chin"}},
             {{"eyebrows-left-inner-up", "eyebrows-right-inner-up", "eyebrows-left-extern-up",
               "eyebrows-right-extern-up"},
              {"forehead"},
              {"cheek", "nasolabial", "upper_lip", "chin"}},
             {{"nose-left-elevation", "nose-right-elevation"}, {"nose_side"}, {"forehead", "chin"}},
             {{"mouth-corner-puller"}, {"nasolabial", "mouth_corner"}, {"forehead", "glabella"}}}) {
        check_expression(face, expression, 0.02);
    }
}

}  // namespace limn::face_import_test
