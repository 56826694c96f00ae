#include "bench/fakephong/shading_method.h"

#include <glm/common.hpp>

namespace limn::fakephong {
namespace {

constexpr ShadingMethod kMethods[] = {
    {"phong", "Phong", 0, 6, prepare_phong, shade_phong},
    {"gouraud", "Gouraud", 3, 3, prepare_gouraud, shade_gouraud, 1},
    {"gouraud-subdivided", "Gouraud, subdivided", 6, 6, prepare_subdivided, shade_subdivided},
    {"quadratic", "quadratic", 6, 6, prepare_quadratic, shade_quadratic, 2},
    {"envmap", "environment map", 3, 0, prepare_environment, shade_environment},
    {"blinn-map", "Blinn map", 3, 3, prepare_blinn_map, shade_blinn_map},
    {"quadratic-blinn", "quadratic Blinn map", 6, 6, prepare_quadratic_blinn,
     shade_quadratic_blinn},
    {"cubic", "cubic", 10, 3, prepare_cubic, shade_cubic, 3},
    {"taylor", "Taylor series", 0, 0, prepare_taylor, shade_taylor},
    {"phong-map", "Phong map", 3, 3, prepare_phong_map, shade_phong_map, 0, true},
    {"normals-quadratic", "normals, quadratic", 0, 6, prepare_quadratic_normals,
     shade_quadratic_normals},
    {"normals-spherical", "normals, spherical", 0, 6, prepare_spherical_normals,
     shade_spherical_normals},
    {"hw-quadratic", "quadratic, appendix A", 6, 6, prepare_hardware_quadratic,
     shade_hardware_quadratic},
    {"hw-blinn", "Blinn map, appendix B", 3, 0, prepare_hardware_blinn, shade_hardware_blinn},
};

dvec3 center_of(const PhongMesh& mesh) {
    dvec3 low(0);
    dvec3 high(0);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        low = i == 0 ? mesh.positions[i] : glm::min(low, mesh.positions[i]);
        high = i == 0 ? mesh.positions[i] : glm::max(high, mesh.positions[i]);
    }
    return 0.5 * (low + high);
}

}  // namespace

std::span<const ShadingMethod> shading_methods() {
    return kMethods;
}

const ShadingMethod* find_method(std::string_view id) {
    for (const ShadingMethod& method : kMethods) {
        if (method.id == id) {
            return &method;
        }
    }
    return nullptr;
}

ShadingContext make_shading_context(const PhongScene& scene) {
    const double exponent = scene.material.exponent;
    // A single triangle is lit from its centroid, which is not the center of its box.
    dvec3 center = center_of(scene.mesh);
    if (scene.mesh.triangles.size() == 1) {
        const auto& [a, b, c] = scene.mesh.triangles[0];
        center =
            (scene.mesh.positions[a] + scene.mesh.positions[b] + scene.mesh.positions[c]) / 3.0;
    }
    return {
        .scene = &scene,
        .blinn = bake_texture(
            scene.texture_size,
            [exponent](double x, double y) { return dvec3(blinn_texture_value(exponent, x, y)); }),
        .diffuse = bake_texture(
            scene.texture_size,
            [](double x, double y) { return dvec3(blinn_texture_value(1, x, y)); }),
        .environment = bake_texture(scene.texture_size, highlight_environment(scene, center))};
}

SurfacePoint point_at(const Facet& facet, Real s, Real t) {
    const auto& [a, b, c] = facet.corners;
    const Real r = 1.0 - s - t;
    return {
        r * a.position + s * b.position + t * c.position,
        normalize_or(r * a.normal + s * b.normal + t * c.normal, facet.face_normal)};
}

std::array<SurfacePoint, 6> six_points(const Facet& facet) {
    const auto midpoint = [&facet](const SurfacePoint& a, const SurfacePoint& b) {
        return SurfacePoint{
            0.5 * (a.position + b.position), normalize_or(a.normal + b.normal, facet.face_normal)};
    };
    const auto& [a, b, c] = facet.corners;
    return {a, midpoint(a, b), b, midpoint(b, c), c, midpoint(c, a)};
}

}  // namespace limn::fakephong
