#include "content/load/faces/face_model.h"
#include "systems/animation/driven_shapes_system.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace limn::face_model_test {
namespace {

using test::near;

/// A strip of four vertices 1 m apart along x.
ObjFile strip() {
    return *parse_obj("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 1 0\nf 1 2 4\nf 2 3 4\n", "strip.obj");
}

constexpr const char* kStrip = "mesh strip.obj\n"
                               "parameter turn\n"
                               "rotate 0 0 2 by 90 about 1 0 0\n"
                               "vertex 3 1\n"
                               "vertex 2 0.5\n"
                               "parameter lift   # the first vertex half as far\n"
                               "translate 0 0 2\n"
                               "vertex 1 0.5\n"
                               "vertex 3 1\n"
                               "parameter grow\n"
                               "scale 3 1 1 about 0 0 0\n"
                               "vertex 2 0.25\n"
                               "vertex 1 0\n";

FaceModel strip_model() {
    return *parse_face_model(kStrip, "strip.txt", strip());
}

/// Positions of the scene's mesh with its shapes at the weights that parameters `p` drive [m].
std::vector<Vec3> shaped(const MeshData& mesh, std::vector<float> p) {
    p.resize(mesh.morphs.size(), 0.0f);
    for (std::size_t i = 0; i < mesh.morphs.size(); ++i) {
        if (!mesh.morphs[i].drivers.empty()) {
            p[i] = driven_weight(mesh.morphs[i].drivers, p);
        }
    }
    std::vector<Vec3> positions = mesh.positions;
    for (std::size_t i = 0; i < mesh.morphs.size(); ++i) {
        const MorphTarget& morph = mesh.morphs[i];
        for (std::size_t k = 0; k < morph.vertices.size(); ++k) {
            positions[morph.vertices[k]] += p[i] * morph.positions[k];
        }
    }
    return positions;
}

/// Largest distance of shaped vertices from the nearest vertex of the model as it should be [m]:
/// the mesh of a scene has its vertices in another order.
double largest_error(const FaceModel& model, const MeshData& mesh, const std::vector<float>& p) {
    const std::vector<Vec3> exact = apply_face_model(model, p);
    const std::vector<Vec3> found = shaped(mesh, p);
    std::multimap<float, std::size_t> by_x;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        by_x.emplace(model.mesh.positions[i].x * model.unit, i);
    }
    double largest = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
        // Among the model's vertices at this place at rest.
        double least = 1e9;
        const auto [begin, end] = by_x.equal_range(mesh.positions[v].x);
        for (auto at = begin; at != end; ++at) {
            if (mesh.positions[v] == model.mesh.positions[at->second] * model.unit) {
                least = std::min(
                    least, double{glm::distance(found[v], model.unit * exact[at->second])});
            }
        }
        largest = std::max(largest, least);
    }
    return largest;
}

}  // namespace

TEST_CASE(
    "face model: at rest no bit changes, and vertices without weight never move"
    * technique("wrinkle.compression.face-model")) {
    const FaceModel model = strip_model();
    REQUIRE(model.parameters.size() == 3);
    CHECK(apply_face_model(model, std::vector<float>{0, 0, 0}) == model.mesh.positions);
    const std::vector<Vec3> moved = apply_face_model(model, std::vector<float>{0.3f, -2, 5});
    CHECK(moved[3] == model.mesh.positions[3]);
}

TEST_CASE(
    "face model: vertices follow by their weights: halfway, by half the angle, in the file's order"
    * technique("wrinkle.compression.face-model")) {
    const FaceModel model = strip_model();
    const std::vector<Vec3> lifted = apply_face_model(model, std::vector<float>{0, 1, 0});
    CHECK(lifted[0] == 0.5f * (lifted[2] - model.mesh.positions[2]));
    CHECK(lifted[2] == Vec3(2, 0, 2));
    // The third vertex is 1 m from the pivot.
    const std::vector<Vec3> turned = apply_face_model(model, std::vector<float>{1, 1, 0});
    CHECK(glm::distance(turned[2], Vec3(1, 1, 2)) < 1e-6f);  // turned first, then lifted
    const std::vector<Vec3> half = apply_face_model(model, std::vector<float>{0.5f, 0, 0});
    CHECK(half[2].x == near(1 + 0.70710678));
    CHECK(half[2].y == near(0.70710678));
    // A quarter of the way from 1 to 3.
    CHECK(apply_face_model(model, std::vector<float>{0, 0, 1})[1].x == near(1.5));
    CHECK(apply_face_model(model, std::vector<float>{0, 0, 0.5f})[1].x == near(1.25));
}

TEST_CASE(
    "face model: shapes follow arcs and pairs of parameters"
    * technique("wrinkle.compression.face-model")) {
    const FaceModel model = strip_model();
    const GltfScene scene = make_face_model_scene("strip", model);
    const MeshData& mesh = scene.meshes[0];
    REQUIRE(mesh.morphs.size() > 3);
    CHECK(mesh.morphs[0].name == "turn");
    CHECK(mesh.morphs[2].name == "grow");
    CHECK(mesh.morphs[0].drivers.empty());
    for (const float p : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        CHECK(largest_error(model, mesh, {p, 0, 0}) < 1e-6);
        CHECK(largest_error(model, mesh, {p, 1, 0}) < 1e-6);
    }
    // Between them, 1 / 16 of the height of an arc of 90 degrees.
    for (float p = 0; p <= 1; p += 0.03125f) {
        CHECK(largest_error(model, mesh, {p, 0.5f, 0}) < 0.293 / 14);
    }
}

TEST_CASE(
    "face model: shapes between parameters have names of their own, whatever those are called"
    * technique("wrinkle.compression.face-model")) {
    const FaceModel model = *parse_face_model(
        "parameter jaw\nrotate 0 0 1 by 90 about 0 0 0\nvertex 3 1\n"
        "parameter jaw_50\nscale 2 1 1 about 0 0 0\nvertex 3 1\n"
        "parameter jaw_jaw_50\ntranslate 0 0 1\nvertex 1 0.25\nvertex 1 0.75\nvertex 1 0.5\n",
        "face.txt", strip());
    CHECK(model.parameters[2].vertices.size() == 1);
    CHECK(model.parameters[2].weights == std::vector<float>{0.75f});
    const GltfScene scene = make_face_model_scene("strip", model);
    std::map<std::string, int> names;
    for (const MorphTarget& morph : scene.meshes[0].morphs) {
        CAPTURE(morph.name);
        CHECK(++names[morph.name] == 1);
    }
    CHECK(names.size() > 5);
    CHECK(largest_error(model, scene.meshes[0], {0.5f, 0, 1}) < 1e-6);
}

TEST_CASE("face model: a bad file is refused with its line") {
    const auto error_of = [](const std::string& text) {
        const Result<FaceModel> model = parse_face_model(text, "face.txt", strip());
        return model ? std::string() : model.error().message;
    };
    CHECK(
        error_of("parameter a\nvertex 1 1\n")
        == "face.txt:2: found no rotate, translate or scale of parameter a");
    CHECK(error_of("parameter a\nspin 1 0 0\n").starts_with("face.txt:2: found \"spin\""));
    CHECK(
        error_of("parameter a\ntranslate 0 0 1\nvertex 5 1\n")
        == "face.txt:3: found vertex 5, expected 1 .. 4");
    CHECK(error_of("parameter a\ntranslate 0 0 1\nvertex 1 2\n")
              .starts_with("face.txt:3: found the weight 2"));
    CHECK(error_of("vertex 1 1\n").starts_with("face.txt:1:"));
    CHECK(error_of("parameter a\nrotate 0 0 0 by 3 about 0 0 0\n")
              .starts_with("face.txt:2: found the axis"));
    CHECK(error_of("parameter a\ntranslate 0 0 1\nparameter a\n")
              .starts_with("face.txt:3: found a second"));
    CHECK(error_of("parameter a\ntranslate 0 0 1 1\n").starts_with("face.txt:2: found \"1\""));
    CHECK(error_of("# nothing\n") == "face.txt: found no parameter, expected some");
}

TEST_CASE("face model: faces of published libraries open a jaw and lift a brow to 0.3 mm") {
    struct Source {
        const char* mesh;
        const char* model;
    };
    for (const Source& source :
         {Source{
              "ict-facekit/FaceXModel/generic_neutral_mesh.obj",
              "unit 0.01\nparameter jaw\nrotate 1 0 0 by 25 about 0 -0.55 1.82\nball 0 -6 10 6\n"
              "parameter brow\ntranslate 0 0.6 0.1\nball 3 6 10 3\n"},
          Source{
              "makehuman/base.obj",
              "unit 0.1\nparameter jaw\nrotate 1 0 0 by 20 about 0 6.9 0.3\nball 0 6.6 1.2 0.6\n"
              "parameter brow\nscale 1.05 1.2 1 about 0 7.5 1\nball 0.3 7.5 1.2 0.4\n"}}) {
        const auto path = test::shared_asset(source.mesh);
        if (!path) {
            continue;
        }
        CAPTURE(source.mesh);
        const FaceModel model =
            *parse_face_model(source.model, "face.txt", *load_intact_obj(*path));
        CHECK(model.parameters[0].vertices.size() > 100);
        CHECK(model.parameters[1].vertices.size() > 50);
        const std::vector<float> p = {0.4f, 0.7f};
        const std::vector<Vec3> exact = apply_face_model(model, p);
        const std::vector<Vec3> rest = apply_face_model(model, std::vector<float>{0, 0});
        float farthest = 0;
        for (std::size_t v = 0; v < exact.size(); ++v) {
            farthest = std::max(farthest, model.unit * glm::distance(exact[v], rest[v]));
        }
        CHECK(farthest > 0.003f);
        const GltfScene scene = make_face_model_scene("face", model);
        const MeshData& mesh = scene.meshes[0];
        CHECK(largest_error(model, mesh, p) < 3e-4);
    }
}

}  // namespace limn::face_model_test
