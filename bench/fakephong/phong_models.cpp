#include "bench/fakephong/phong_models.h"

#include "content/make/models/shapes.h"
#include "content/make/models/simplify_mesh.h"
#include "content/make/models/teapot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

// Techniques: fakephong.scenes

namespace limn::fakephong {
namespace {

/// A view of the unit sphere at the origin, lit by `light`.
PhongScene ball_scene(const char* name, PhongMesh mesh, const PhongLight& light) {
    PhongScene scene = {.name = name, .mesh = std::move(mesh), .lights = {light}};
    scene.material.color = {0.2, 0.4, 1};
    scene.row = 105;
    return scene;
}

constexpr PhongLight kBallLight = {.at = {-1.5, 1.5, 3}};

}  // namespace

PhongMesh phong_mesh(const MeshData& mesh) {
    PhongMesh result;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        result.positions.emplace_back(mesh.positions[i]);
        result.normals.emplace_back(i < mesh.normals.size() ? mesh.normals[i] : Vec3(0));
        if (i < mesh.uvs.size()) {
            result.uvs.emplace_back(mesh.uvs[i]);
        }
    }
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        result.triangles.push_back({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
    }
    return result;
}

PhongMesh make_coarse_sphere(int slices, int stacks) {
    PhongMesh mesh = phong_mesh(make_sphere({.radius = 1, .segments = slices, .rings = stacks}));
    for (dvec3& p : mesh.positions) {
        p = {-p.x, p.y, -p.z};
    }
    for (dvec3& n : mesh.normals) {
        n = {-n.x, n.y, -n.z};
    }
    return mesh;
}

PhongScene triangle_scene() {
    PhongScene scene = {.name = "triangle"};
    scene.mesh = phong_mesh(make_triangle({.radius = 1}));
    scene.material.color = {0, 0, 1};
    scene.lights = {{.at = {0, -0.2, 0.6}}};
    scene.camera = {.eye = {0, 0, 20}, .target = dvec3(0), .half_size = 0.052, .size = 256};
    scene.row = 151;
    return scene;
}

PhongScene printed_triangle_scene() {
    PhongScene scene = triangle_scene();
    scene.name = "triangle, fitted";
    scene.mesh.positions = {{0.33, 1, 0}, {-2.2, -0.5, 0}, {2.2, -0.5, 0}};
    scene.material.exponent = 10;
    scene.environment_exponent = 90;
    scene.lights = {{.at = {0.707, -0.67, 1.098}}};
    scene.camera.eye = {0, 0, 27};
    scene.camera.half_size = 0.085;
    scene.row = 150;
    return scene;
}

PhongScene printed_teapot_scene() {
    PhongScene scene = teapot_scene();
    scene.name = "teapot, fitted";
    scene.texture_size = 11;
    scene.material.exponent = 16;
    scene.environment_exponent = 4;
    scene.camera.half_size = 0.25;
    scene.row = 140;
    return scene;
}

PhongScene teapot_scene() {
    PhongScene scene = {.name = "teapot"};
    MeshData pot = make_teapot({.divisions = 8, .height = 1.5f});
    simplify_mesh(pot, 3750);  // its flat bottom, first of all
    scene.mesh = phong_mesh(pot);
    for (dvec3& p : scene.mesh.positions) {
        p.y -= 0.75;
    }
    scene.material.color = {0.7, 0.3, 0.2};
    scene.lights = {{.directional = true, .at = {-1, 1, 1}}};
    scene.camera = {.eye = {0, 1.2, 5}, .target = dvec3(0), .half_size = 0.32, .size = 256};
    scene.row = 138;
    return scene;
}

PhongScene dodecahedron_scene() {
    return ball_scene(
        "dodecahedron", phong_mesh(make_dodecahedron({.radius = 1, .faces = 10})), kBallLight);
}

PhongScene sphere_scene() {
    return ball_scene("sphere", make_coarse_sphere(5, 5), kBallLight);
}

PhongScene fine_sphere_scene() {
    PhongScene scene = ball_scene(
        "fine sphere", make_coarse_sphere(75, 26), {.directional = true, .at = {-1, 1, 1}});
    scene.row = 92;
    return scene;
}

std::span<const PrintedRow> printed_table() {
    static constexpr PrintedRow kTable[] = {
        {"teapot", {0.9870, 0.9939, 0.9949, 0.9872, 0.9886, 0.9888}},
        {"triangle", {0.7644, 0.8970, 0.9058, 0.5589, 0.8205, 0.9311}}};
    return kTable;
}

}  // namespace limn::fakephong
