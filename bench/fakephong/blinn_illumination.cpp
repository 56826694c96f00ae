#include "bench/fakephong/blinn_illumination.h"

#include <glm/geometric.hpp>

// Techniques: fakephong.blinn-axis, fakephong.illum-blinn, fakephong.vectors

namespace limn::fakephong {
namespace {

const Vec3r kZero = {0, 0, 0};

/// fakephong.blinn-axis: unit, in the plane orthogonal to unit `normal`.
Vec3r plane_axis(const PhongScene& scene, const Vec3r& normal, const Vec3r& projected) {
    const CameraFrame camera = camera_frame(scene.camera);
    Vec3r global = Vec3r(camera.up);
    if (scene.axis == BlinnAxis::WorldUp) {
        global = {0, 1, 0};
    } else if (scene.axis == BlinnAxis::WorstCase) {
        global = projected;
    } else if (scene.axis == BlinnAxis::Custom) {
        global = normalize_or(Vec3r(scene.axis_vector), kZero);
    }
    // If the global vector is parallel to the plane's normal, the camera's right vector is not.
    const Vec3r right = Vec3r(camera.right);
    const Vec3r other = normalize_or(right - dot(right, normal) * normal, kZero);
    return normalize_or(global - dot(global, normal) * normal, other);
}

/// Coordinates of unit `v` in the plane orthogonal to unit `normal`; on the rim if it points away
/// from `normal`.
Vec2r plane_coordinates(const PhongScene& scene, const Vec3r& v, const Vec3r& normal) {
    const Real cosine = dot(v, normal);
    Vec3r projected = v - cosine * normal;
    const Vec3r u = plane_axis(scene, normal, projected);
    if (!(cosine > 0.0)) {
        projected = normalize_or(projected, u);
    }
    return {dot(u, projected), dot(cross(normal, u), projected)};
}

}  // namespace

Vec3r to_light(const PhongLight& light, const Vec3r& position) {
    return normalize_or(light.directional ? Vec3r(light.at) : Vec3r(light.at) - position, kZero);
}

Vec3r to_eye(const PhongScene& scene, const Vec3r& position) {
    return normalize_or(Vec3r(scene.camera.eye) - position, kZero);
}

Vec3r reflect(const Vec3r& direction, const Vec3r& normal) {
    return (2.0 * dot(normal, direction)) * normal - direction;
}

Vec3r half_vector(const Vec3r& to_light, const Vec3r& to_eye) {
    return normalize_or(to_light + to_eye, kZero);
}

Real blinn_highlight(Real n_h, Real exponent) {
    return n_h > 0.0 ? power(n_h, exponent) : Real(0);
}

Lit illuminate(const PhongScene& scene, const PhongLight& light, const SurfacePoint& point) {
    ++counted_work.lightings;
    const PhongMaterial& material = scene.material;
    const Vec3r l = to_light(light, point.position);
    Lit lit;
    if (scene.channels != Channels::Specular) {
        lit.tinted = material.diffuse * at_least_zero(dot(point.normal, l)) * Vec3r(light.color);
    }
    if (scene.channels != Channels::Diffuse) {
        const Vec3r h = half_vector(l, to_eye(scene, point.position));
        lit.highlight = material.specular * blinn_highlight(dot(point.normal, h), material.exponent)
                        * Vec3r(light.color);
    }
    return lit;
}

Lit illuminate(const PhongScene& scene, const SurfacePoint& point) {
    Lit sum;
    if (scene.channels != Channels::Specular) {
        sum.tinted = Vec3r(dvec3(scene.material.ambient));
    }
    for (const PhongLight& light : scene.lights) {
        sum = sum + illuminate(scene, light, point);
    }
    return sum;
}

Vec2r blinn_coordinates(
    const PhongScene& scene, const PhongLight& light, const SurfacePoint& point) {
    ++counted_work.lightings;
    const Vec3r h = half_vector(to_light(light, point.position), to_eye(scene, point.position));
    if (h.x.value == 0 && h.y.value == 0 && h.z.value == 0) {
        return {1, 0};  // no half vector: on the rim, where the map is black
    }
    return plane_coordinates(scene, point.normal, h);
}

Vec2r diffuse_coordinates(
    const PhongScene& scene, const PhongLight& light, const SurfacePoint& point) {
    ++counted_work.lightings;
    const Vec3r l = to_light(light, point.position);
    if (l.x.value == 0 && l.y.value == 0 && l.z.value == 0) {
        return {1, 0};
    }
    return plane_coordinates(scene, point.normal, l);
}

Vec2r blinn_coordinates_as_printed(
    const PhongScene& scene, const PhongLight& light, const SurfacePoint& point) {
    ++counted_work.lightings;
    const Vec3r up = {0, 1, 0};
    const Vec3r h = half_vector(to_light(light, point.position), to_eye(scene, point.position));
    const Vec3r projected = point.normal - dot(point.normal, h) * h;
    const Vec3r u = up - dot(up, h) * h;
    return {dot(u, projected), dot(cross(h, u), projected)};
}

Vec2r phong_map_coordinates(
    const PhongScene& scene, const PhongLight& light, const SurfacePoint& point) {
    ++counted_work.lightings;
    return plane_coordinates(scene, to_light(light, point.position), point.normal);
}

Vec2r sphere_map_coordinates(const PhongScene& scene, const SurfacePoint& point) {
    ++counted_work.lightings;
    const Vec3r w = reflect(to_eye(scene, point.position), point.normal);
    const CameraFrame camera = camera_frame(scene.camera);
    const Vec3r eye_space = {
        dot(w, Vec3r(camera.right)), dot(w, Vec3r(camera.up)), dot(w, Vec3r(camera.back))};
    const Real z1 = eye_space.z + 1.0;
    const Real m = root(eye_space.x * eye_space.x + eye_space.y * eye_space.y + z1 * z1);
    if (!(m > 1e-12)) {
        return {0, 0};
    }
    const Real scale = 1.0 / m;
    return {scale * eye_space.x, scale * eye_space.y};
}

CameraFrame camera_frame(const PhongCamera& camera) {
    const dvec3 back = glm::normalize(camera.eye - camera.target);
    const dvec3 right = glm::normalize(glm::cross(camera.up, back));
    return {right, glm::cross(back, right), back};
}

}  // namespace limn::fakephong
