#pragma once

#include "ecs/components/light.h"

#include <glm/vec3.hpp>

#include <span>

namespace limn::oracle {

// Lights and the classic reflection models in double precision, one formula per function, not
// optimized: the reference for the shaders and the light extraction. Sources are the named spec
// entries.
//
// In Limn a light's color Ii is the radiance of a white Lambertian surface facing it: irradiance /
// pi. With an irradiance of pi the formulas match the entries as printed.

using DVec3 = glm::dvec3;

/// light.attenuation, engine.light-falloff and the physical default: factor at distance `d` [m].
[[nodiscard]] double attenuation(const Attenuation& attenuation, double radius, double d);

/// Distance at which 1 / (c + l d + q d^2) has fallen to `cutoff`; needs q > 0.
[[nodiscard]] double cutoff_distance(const Attenuation& attenuation, double cutoff);

/// light.spot-falloff: 1 inside the inner cone, 0 outside the outer; `angle` off the axis [rad].
[[nodiscard]] double spot_factor(SpotProfile profile, double inner, double outer, double angle);

/// light.lit: (1, diffuse, specular, 1).
struct LitCoefficients {
    double diffuse = 0;
    double specular = 0;
};
[[nodiscard]] LitCoefficients lit(double n_l, double n_h, double shininess);

/// Coefficients of the reflection models; all in [0, 1] but the shininess n > 0.
struct ClassicMaterial {
    DVec3 ambient = DVec3(0.1);
    DVec3 diffuse = DVec3(0.6);
    DVec3 specular = DVec3(0.3);
    double shininess = 50;
};

/// Light arriving at a point from one source.
struct Arriving {
    DVec3 to_light;  ///< unit
    DVec3 color;     ///< Ii = irradiance on a facing plane / pi
};

/// light.phong-model: ka Ia + sum Ii (kd (L.N) + ks (R.V)^n).
[[nodiscard]] DVec3 phong(
    const ClassicMaterial& material, const DVec3& ambient_light, std::span<const Arriving> lights,
    const DVec3& normal, const DVec3& to_camera);

/// light.halfway-vector: the same with (N.H)^n.
[[nodiscard]] DVec3 blinn(
    const ClassicMaterial& material, const DVec3& ambient_light, std::span<const Arriving> lights,
    const DVec3& normal, const DVec3& to_camera);

/// char.skin-shade: blinn() and sum Ii kd s skin, s = (1 - n.v)^2, or 1 - (n.v)^2 if `wide`.
[[nodiscard]] DVec3 skin(
    const ClassicMaterial& material, const DVec3& skin_color, bool wide,
    std::span<const Arriving> lights, const DVec3& normal, const DVec3& to_camera);

/// light.interface: light of each type arriving at `position`. `axis`: unit, the light's direction.
[[nodiscard]] Arriving arrive(
    const PointLight& light, const DVec3& light_position, const DVec3& position,
    const DVec3& normal);
[[nodiscard]] Arriving arrive(
    const SpotLight& light, const DVec3& light_position, const DVec3& axis, const DVec3& position,
    const DVec3& normal);
[[nodiscard]] Arriving arrive(const DirectionalLight& light, const DVec3& axis);

}  // namespace limn::oracle
