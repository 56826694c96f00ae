#include "bench/quality/fakephong_file.h"
#include "content/load/gltf/gltf_write.h"
#include "content/make/models/shapes.h"
#include "ecs/components/surface.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace limn::fakephong_file_test {
namespace {

using test::TemporaryFolder;

/// What is measured of a glTF file with one mesh.
QualityReport measured(const TemporaryFolder& folder, const MeshData& mesh) {
    GltfScene scene;
    scene.name = "model";
    scene.meshes = {mesh};
    scene.materials = {Material{}};
    GltfNode& node = scene.nodes.emplace_back();
    node.name = "model";
    node.parts = {{0, 0}};
    const Status saved = save_glb(folder.file("model.glb"), scene);
    REQUIRE_MESSAGE(saved.ok(), (saved ? std::string() : saved.error().message));
    QualityReport report;
    const Status status = measure_fakephong_file(folder.file("model.glb"), report);
    REQUIRE_MESSAGE(status.ok(), (status ? std::string() : status.error().message));
    for (const QualityRow& row : report.rows) {
        CAPTURE(row.name);
        CHECK(std::isfinite(row.found));
        CHECK(holds(row));
    }
    return report;
}

double found(const QualityReport& report, const std::string& name) {
    const auto row =
        std::find_if(report.rows.begin(), report.rows.end(), [&](const QualityRow& one) {
            return one.name == name;
        });
    REQUIRE_MESSAGE(row != report.rows.end(), name);
    return row->found;
}

MeshData triangle() {
    MeshData mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.tangents.assign(3, {1, 0, 0, 1});
    mesh.uvs.assign(3, {0, 0});
    mesh.indices = {0, 1, 2};
    return mesh;
}

}  // namespace

TEST_CASE("fakephong file: facets of a glTF without area are counted and skipped") {
    const TemporaryFolder folder;
    MeshData mesh = triangle();
    mesh.indices = {0, 1, 2, 0, 0, 1, 2, 2, 2};
    const QualityReport report = measured(folder, mesh);
    CHECK(found(report, "triangles") == 3);
    CHECK(found(report, "  without an area, left out") == 2);
    CHECK(found(report, "pixels covered") > 1000);
}

TEST_CASE(
    "fakephong file: facets of a glTF that face away cover nothing, and nothing is wrong there") {
    const TemporaryFolder folder;
    MeshData mesh = triangle();
    mesh.indices = {0, 2, 1};
    const QualityReport report = measured(folder, mesh);
    CHECK(found(report, "pixels covered") == 0);
    CHECK(found(report, "quadratic: color correctness") == 1);
}

TEST_CASE("fakephong file: opposite and missing normals of a glTF are replaced by facet normals") {
    const TemporaryFolder folder;
    MeshData mesh = triangle();
    mesh.normals[1] = {0, 0, -1};
    CHECK(found(measured(folder, mesh), "pixels covered") > 1000);
    mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
    CHECK(found(measured(folder, mesh), "pixels covered") > 1000);
}

TEST_CASE("fakephong file: a glTF of a million facets is measured by every method") {
    const TemporaryFolder folder;
    const QualityReport report =
        measured(folder, make_sphere({.radius = 1, .segments = 1000, .rings = 501}));
    CHECK(found(report, "triangles") == 1'000'000);
    for (const char* method : {"Gouraud", "cubic", "quadratic Blinn map", "Blinn map"}) {
        CHECK(found(report, std::string(method) + ": color correctness") > 0.999);
    }
}

}  // namespace limn::fakephong_file_test
