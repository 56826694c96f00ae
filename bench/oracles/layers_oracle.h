#pragma once

#include "bench/oracles/pbr_oracle.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace limn::oracle {

// The extensions of glTF's metal-rough material in double precision, written from their
// specifications (KHR_materials_specular, _clearcoat, _sheen, _anisotropy, _iridescence) and the
// papers that these name, not from the shaders: anisotropic GGX by its ellipsoid and Smith's
// Lambda, sheen with its fitted Lambda, thin films by their Airy sum. As in the sample renderer of
// glTF, films and clear coats depend on the angle to the camera alone. Energy as in
// pbr_oracle.h: what a layer reflects does not reach those below.

struct LayeredMaterial {
    glm::dvec3 albedo = glm::dvec3(0.8);
    double metalness = 0;
    double roughness = 0.5;
    double index = 1.5;
    double specular_weight = 1;
    glm::dvec3 specular_tint = glm::dvec3(1);
    double coat = 0;
    double coat_roughness = 0;
    glm::dvec3 sheen = glm::dvec3(0);
    double sheen_roughness = 0;
    double anisotropy = 0;
    glm::dvec3 along = {1, 0, 0};  ///< unit, in the surface
    double iridescence = 0;
    double film_index = 1.3;
    double film_thickness = 400;  ///< [nm]
};

/// Anisotropic GGX, times n.l, without Fresnel; all vectors unit and in the frame (along, across,
/// normal); alphas along and across.
[[nodiscard]] double
stretched_lobe(const glm::dvec3& to_light, const glm::dvec3& to_camera, const glm::dvec2& alphas);

/// Sheen times n.l.
[[nodiscard]] double sheen_lobe(double n_l, double n_v, double n_h, double alpha);

/// Reflectance of white sheen under uniform light.
[[nodiscard]] double sheen_albedo(double n_v, double roughness, int steps = 512);

/// Reflectance of a thin film, for light at this cosine to the normal.
[[nodiscard]] glm::dvec3
thin_film(double cosine, double film_index, double thickness, const glm::dvec3& base);

/// What depends on the direction to the camera alone.
struct LayerAlbedos {
    DirectionalAlbedo base;
    double sheen = 0;
};
[[nodiscard]] LayerAlbedos layer_albedos(const LayeredMaterial& material, double n_v, int samples);

/// Radiance towards `to_camera` for a unit irradiance on a plane facing `to_light`. `sheen_light`:
/// sheen_albedo() toward the light.
[[nodiscard]] glm::dvec3 reflect_layers(
    const LayeredMaterial& material, const LayerAlbedos& albedos, double sheen_light,
    const glm::dvec3& normal, const glm::dvec3& coat_normal, const glm::dvec3& to_camera,
    const glm::dvec3& to_light);

/// White furnace test, as furnace() of pbr_oracle.h, on the plane z = 0.
[[nodiscard]] glm::dvec3 layers_furnace(const LayeredMaterial& material, double n_v, int steps);

}  // namespace limn::oracle
