#pragma once

#include <glm/vec3.hpp>

namespace limn::oracle {

// The metal-rough model in double precision: GGX with height-correlated Smith masking, Schlick's
// Fresnel term, multiple-scattering compensation (Turquin 2019), and a Lambertian diffuse lobe with
// the energy that the specular lobe leaves. Hemisphere integrals are plain sums: slow and exact.

/// n.l times distribution times visibility, without Fresnel; alpha = perceptual roughness squared.
[[nodiscard]] double ggx_lobe(double n_l, double n_v, double n_h, double alpha);

/// Reflectance of single-scattering GGX under uniform light: `scale` f0 + `bias` integrates
/// Schlick's Fresnel term (Karis 2013). scale + bias is the directional albedo E for f0 = 1.
struct DirectionalAlbedo {
    double scale = 0;
    double bias = 0;
};
[[nodiscard]] DirectionalAlbedo
directional_albedo(double n_v, double roughness, int samples = 4096);

struct PbrMaterial {
    glm::dvec3 albedo = glm::dvec3(0.8);
    double metalness = 0;
    double roughness = 0.5;
};

/// Radiance towards `to_camera` for a unit irradiance on a plane facing `to_light`; `lobe` is a
/// parameter because a sum over lights needs it only once.
[[nodiscard]] glm::dvec3 reflect_pbr(
    const PbrMaterial& material, const DirectionalAlbedo& lobe, const glm::dvec3& normal,
    const glm::dvec3& to_camera, const glm::dvec3& to_light);

/// White furnace test: radiance of a surface under uniform radiance 1, by summing reflect_pbr over
/// the hemisphere. `steps` intervals in elevation, twice as many around.
[[nodiscard]] glm::dvec3 furnace(const PbrMaterial& material, double n_v, int steps = 512);

}  // namespace limn::oracle
