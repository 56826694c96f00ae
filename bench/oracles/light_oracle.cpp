#include "bench/oracles/light_oracle.h"

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

// Techniques: char.skin-shade, engine.light-falloff, light.attenuation, light.halfway-vector,
//     light.phong-model, light.spot-falloff

namespace limn::oracle {
namespace {

double window_karis(double d, double radius) {
    if (radius <= 0) {
        return 1;
    }
    return square(std::clamp(1 - std::pow(d / radius, 4), 0.0, 1.0));
}

DVec3 reflect_about(const DVec3& v, const DVec3& normal) {
    return 2 * glm::dot(normal, v) * normal - v;
}

}  // namespace

double attenuation(const Attenuation& a, double radius, double d) {
    switch (a.falloff) {
    case Falloff::InverseSquare:
        return window_karis(d, radius) / std::max(d * d, 1e-4);
    case Falloff::Polynomial:
        return window_karis(d, radius)
               / std::max(a.constant + a.linear * d + a.quadratic * d * d, 1e-4);
    case Falloff::Smooth:
        return radius <= 0 ? 1 : std::clamp(a.multiplier * (1 - square(d / radius)), 0.0, 1.0);
    case Falloff::None:
        return radius <= 0 || d < radius ? 1 : 0;
    }
    return 0;
}

double cutoff_distance(const Attenuation& a, double cutoff) {
    const double c = a.constant - 1 / cutoff;
    return (-a.linear + std::sqrt(square(double(a.linear)) - 4 * a.quadratic * c))
           / (2 * a.quadratic);
}

double spot_factor(SpotProfile profile, double inner, double outer, double angle) {
    if (profile == SpotProfile::LinearAngle) {
        return std::clamp((outer - angle) / std::max(outer - inner, 1e-4), 0.0, 1.0);
    }
    const double s = std::clamp(
        (std::cos(angle) - std::cos(outer)) / std::max(std::cos(inner) - std::cos(outer), 1e-4),
        0.0, 1.0);
    return profile == SpotProfile::Smoothstep ? s * s * (3 - 2 * s) : s;
}

LitCoefficients lit(double n_l, double n_h, double shininess) {
    return {
        .diffuse = std::max(n_l, 0.0),
        .specular = n_l > 0 && n_h > 0 ? std::pow(n_h, shininess) : 0.0};
}

DVec3 phong(
    const ClassicMaterial& material, const DVec3& ambient_light, std::span<const Arriving> lights,
    const DVec3& normal, const DVec3& to_camera) {
    DVec3 color = material.ambient * ambient_light;
    for (const Arriving& light : lights) {
        const double r_v = glm::dot(reflect_about(light.to_light, normal), to_camera);
        const LitCoefficients c = lit(glm::dot(normal, light.to_light), r_v, material.shininess);
        color += light.color * (material.diffuse * c.diffuse + material.specular * c.specular);
    }
    return color;
}

DVec3 blinn(
    const ClassicMaterial& material, const DVec3& ambient_light, std::span<const Arriving> lights,
    const DVec3& normal, const DVec3& to_camera) {
    DVec3 color = material.ambient * ambient_light;
    for (const Arriving& light : lights) {
        const DVec3 sum = light.to_light + to_camera;
        const double length = glm::length(sum);
        const double n_h = length > 1e-12 ? glm::dot(normal, sum / length) : 0.0;
        const LitCoefficients c = lit(glm::dot(normal, light.to_light), n_h, material.shininess);
        color += light.color * (material.diffuse * c.diffuse + material.specular * c.specular);
    }
    return color;
}

DVec3 skin(
    const ClassicMaterial& material, const DVec3& skin_color, bool wide,
    std::span<const Arriving> lights, const DVec3& normal, const DVec3& to_camera) {
    DVec3 color = blinn(material, DVec3(0), lights, normal, to_camera);
    const double n_v = std::clamp(glm::dot(normal, to_camera), 0.0, 1.0);
    const double rim = wide ? 1 - n_v * n_v : (1 - n_v) * (1 - n_v);
    for (const Arriving& light : lights) {
        color += light.color * material.diffuse * (rim * skin_color);
    }
    return color;
}

Arriving arrive(
    const PointLight& light, const DVec3& light_position, const DVec3& position,
    const DVec3& normal) {
    const DVec3 offset = light_position - position;
    const double d = glm::length(offset);
    const double candela = light.enabled ? light.intensity : 0;
    return {
        .to_light = d > 0 ? offset / d : normal,
        .color = DVec3(light.color) * candela * attenuation(light.attenuation, light.radius, d)
                 / std::numbers::pi};
}

Arriving arrive(
    const SpotLight& light, const DVec3& light_position, const DVec3& axis, const DVec3& position,
    const DVec3& normal) {
    const DVec3 offset = light_position - position;
    const double d = glm::length(offset);
    const double candela = light.enabled ? light.intensity : 0;
    const double cosine = d > 0 ? std::clamp(glm::dot(axis, -offset / d), -1.0, 1.0) : 1.0;
    const double spot =
        spot_factor(light.profile, light.inner_angle, light.outer_angle, std::acos(cosine));
    return {
        .to_light = d > 0 ? offset / d : normal,
        .color = DVec3(light.color) * candela * spot
                 * attenuation(light.attenuation, light.radius, d) / std::numbers::pi};
}

Arriving arrive(const DirectionalLight& light, const DVec3& axis) {
    const double lux = light.enabled ? light.illuminance : 0;
    return {.to_light = -axis, .color = DVec3(light.color) * lux / std::numbers::pi};
}

}  // namespace limn::oracle
