#include "bench/oracles/face_folding.h"
#include "bench/quality/face_folds_file.h"
#include "content/load/faces/ict_facekit.h"
#include "content/load/faces/makehuman.h"
#include "content/load/gltf/gltf_write.h"
#include "content/make/head/head.h"
#include "content/make/models/shapes.h"
#include "tests/near.h"
#include "tests/one_mesh_glb.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn::face_folding_test {
namespace {

void no_progress(int /*done*/, int /*total*/) {}

/// The skin of a face of the folder of shared assets; none without the folder.
std::optional<GltfScene> import_shared(const char* name) {
    const auto folder = test::shared_asset(name);
    if (!folder) {
        return std::nullopt;
    }
    Result<GltfScene> scene = std::string(name) == "makehuman"
                                  ? import_makehuman(*folder, no_progress)
                                  : import_ict_facekit(*folder, no_progress);
    REQUIRE_MESSAGE(scene.ok(), scene.error().message);
    return std::move(*scene);
}

/// All rules that the face has shapes for, of which there are at least `count`.
void check_face(const MeshData& face, std::size_t count, bool has_dimples = false) {
    const oracle::FaceFolding folding(face);
    for (const oracle::RegionFolding& region : folding.measure({})) {
        CHECK(region.shortening < 1e-6);
    }
    std::size_t applied = 0;
    for (const oracle::FoldingRule& rule : oracle::folding_rules()) {
        oracle::FoldingResult result;
        if (rule.dimples && !has_dimples) {
            continue;
        }
        if (!oracle::apply_rule(rule, face, folding, result)) {
            continue;
        }
        const std::string name(rule.name);
        CAPTURE(name);
        CAPTURE(result.folding);
        CAPTURE(result.smooth);
        CHECK(result.folding > 0.02);
        CHECK(result.folding >= 5 * result.smooth);
        CHECK(result.difference < 0.02);
        ++applied;
    }
    CHECK(applied >= count);
}

TEST_CASE(
    "face folding: the generated head folds where anatomy says, five times as much as elsewhere") {
    check_face(make_head({}), 11, true);
}

TEST_CASE("face folding: a chin that is raised as a whole folds above and beside it, not within") {
    // As scans have it: skin below the mouth moves up as a whole, and the furrow above it shortens;
    // all skin above gives way by a hundredth.
    MeshData head = make_head({});
    for (MorphTarget& morph : head.morphs) {
        if (morph.name != "AU17") {
            continue;
        }
        morph.vertices.clear();
        morph.positions.clear();
        for (std::uint32_t v = 0; v < head.positions.size(); ++v) {
            const float above = head.positions[v].y + 0.05f;
            const float below = std::clamp(-above / 0.008f, 0.0f, 1.0f);
            morph.vertices.push_back(v);
            morph.positions.emplace_back(0, 0.004f * below - 0.01f * std::max(above, 0.0f), 0);
        }
    }
    const oracle::FaceFolding folding(head);
    for (const oracle::FoldingRule& rule : oracle::folding_rules()) {
        oracle::FoldingResult result;
        if (rule.units == std::vector<std::string_view>{"AU17"}
            && oracle::apply_rule(rule, head, folding, result)) {
            CAPTURE(result.folding);
            CAPTURE(result.smooth);
            CHECK((result.folding >= 5 * result.smooth) == !rule.dimples);
        }
    }
}

TEST_CASE("face folding: the head of ICT FaceKit folds there, too") {
    if (const auto scene = import_shared("ict-facekit")) {
        check_face(scene->meshes[0], 7);
    }
}

TEST_CASE("face folding: the head of MakeHuman folds there, too") {
    if (const auto scene = import_shared("makehuman")) {
        check_face(scene->meshes[0], 6);
    }
}

TEST_CASE(
    "face folding: a frown that pushes brows down folds the glabella, a smile beside the nose") {
    // MakeHuman's frown moves skin beside the midline of the face and nothing on it.
    if (const auto scene = import_shared("makehuman")) {
        const MeshData& face = scene->meshes[0];
        const oracle::FaceFolding folding(face);
        const auto shortening = [&](std::string_view unit, std::string_view region) {
            const auto expressions = oracle::find_face_expressions(face);
            const auto found = std::ranges::find(expressions, unit, &oracle::FaceExpression::unit);
            const auto at = std::ranges::find(face.regions, region, &VertexRegion::name);
            REQUIRE(found != expressions.end());
            REQUIRE(at != face.regions.end());
            return folding.measure(found->morphs)[at - face.regions.begin()].shortening;
        };
        CHECK(shortening("AU4", "glabella") > 0.04);
        CHECK(shortening("AU12", "nasolabial") > 0.08);
    }
}

TEST_CASE("face folding: at half weight an expression folds the same regions about half as much") {
    const MeshData head = make_head({});
    const oracle::FaceFolding folding(head);
    for (const oracle::FaceExpression& expression : oracle::find_face_expressions(head)) {
        if (expression.unit != "AU4" && expression.unit != "AU9") {
            continue;
        }
        const auto half = folding.measure(expression.morphs, 0.5f);
        const auto whole = folding.measure(expression.morphs);
        for (std::size_t i = 0; i < whole.size(); ++i) {
            if (whole[i].shortening > 0.05) {
                CHECK(half[i].shortening == test::near(0.5 * whole[i].shortening).epsilon(0.25));
            }
        }
    }
}

TEST_CASE("face folding: halves of a unit are one expression, by any names") {
    MeshData mesh = make_sphere({});
    for (const char* const name :
         {"mouthSmileLeft", "jawOpen", "mouthSmileRight", "jawLeft", "fat", "browInnerUp"}) {
        mesh.morphs.emplace_back().name = name;
    }
    const auto found = oracle::find_face_expressions(mesh);
    REQUIRE(found.size() == 5);
    CHECK(found[0].name == "mouthSmile");
    CHECK(found[0].unit == "AU12");
    CHECK(found[0].morphs == std::vector<std::uint32_t>{0, 2});
    CHECK(found[1].unit == "AU27");
    CHECK(found[3].unit.empty());
    CHECK(found[4].unit == "AU1");
}

TEST_CASE("face folding: a face file with other names is measured the same, or rejected") {
    const test::TemporaryFolder folder;
    GltfScene scene;
    scene.name = "face";
    MeshData& head = scene.meshes.emplace_back(make_head({}));
    for (MorphTarget& morph : head.morphs) {
        const std::map<std::string, std::string> names = {
            {"AU12_L", "mouthSmileLeft"},
            {"AU12_R", "mouthSmileRight"},
            {"AU4_L", "browDownLeft"},
            {"AU4_R", "browDownRight"}};
        const auto found = names.find(morph.name);
        morph.action_unit.clear();
        morph.name = found != names.end() ? found->second : "x" + morph.name;
    }
    const std::string file = folder.file("face.glb");
    test::write_one_mesh(file, scene, "face");
    QualityReport report;
    const Status status = measure_face_file(file, report);
    REQUIRE_MESSAGE(status.ok(), status.error().message);
    CHECK(report.html.find("mouthSmile") != std::string::npos);
    std::size_t rules = 0;
    for (const QualityRow& row : report.rows) {
        CAPTURE(row.name);
        CHECK(holds(row));
        rules += row.name.find("relative to smooth skin") != std::string::npos ? 1 : 0;
    }
    CHECK(rules == 2);

    GltfScene ball = scene;
    ball.meshes[0] = make_sphere({});
    ball.morph_weights.clear();
    ball.nodes[0].first_morph = -1;
    REQUIRE(save_glb(file, ball).ok());
    const Status refused = measure_face_file(file, report);
    REQUIRE_FALSE(refused.ok());
    CHECK(
        refused.error().message.find("found no morph target named as an action unit")
        != std::string::npos);
}

}  // namespace
}  // namespace limn::face_folding_test
