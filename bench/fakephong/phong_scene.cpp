#include "bench/fakephong/phong_scene.h"

#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace limn::fakephong {
namespace {

bool is_finite(const dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check_range(const char* field, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
        return fail("scene: found {} {}, expected {} to {}", field, value, low, high);
    }
    return Done{};
}

Status check_mesh(const PhongMesh& mesh) {
    if (mesh.normals.size() != mesh.positions.size()
        || (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size())) {
        return fail(
            "scene: found {} normals and {} uvs, expected {}, one per position",
            mesh.normals.size(), mesh.uvs.size(), mesh.positions.size());
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const std::uint32_t vertex : mesh.triangles[i]) {
            if (vertex >= mesh.positions.size()) {
                return fail(
                    "scene: found vertex {} in triangle {}, expected less than {}", vertex, i,
                    mesh.positions.size());
            }
        }
    }
    return Done{};
}

}  // namespace

Status check_scene(const PhongScene& scene) {
    LIMN_TRY(check_mesh(scene.mesh));
    LIMN_TRY(check_range("exponent", scene.material.exponent, 0, 10000));
    LIMN_TRY(check_range("environment exponent", scene.environment_exponent, 0, 10000));
    LIMN_TRY(check_range("half size of the view", scene.camera.half_size, 1e-6, 1e3));
    LIMN_TRY(check_range("image size", scene.camera.size, 1, 4096));
    LIMN_TRY(check_range("texture size", scene.texture_size, 0, 4096));
    LIMN_TRY(check_range("lights", static_cast<double>(scene.lights.size()), 1, kMaxLights));
    for (const PhongLight& light : scene.lights) {
        if (!is_finite(light.at) || !is_finite(light.color)) {
            return fail("scene: found a light with NaN or infinity, expected finite numbers");
        }
    }
    const dvec3 forward = scene.camera.target - scene.camera.eye;
    const dvec3 right = glm::cross(forward, scene.camera.up);
    if (!is_finite(right) || !(glm::dot(right, right) > 1e-24)) {
        return fail("scene: found a camera that looks along its up vector, expected another");
    }
    return Done{};
}

}  // namespace limn::fakephong
