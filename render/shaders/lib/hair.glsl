// Light that a strand of hair scatters: reflected (R), transmitted (TT), reflected inside (TRT), after Marschner et al.,
// "Light Scattering from Human Hair Fibers", 2003. Each lobe is a product of a function of the inclinations, which is
// that of d'Eon et al., "An Energy-Conserving Hair Reflectance Model", 2011, one of the azimuth, and an attenuation.
// Azimuths of TT and TRT are von Mises distributions as in Karis, "Physically Based Hair Shading in Unreal", 2016;
// absorption follows from the color as in Chiang et al., "A Practical and Controllable Hair and Fur Model", 2016.
// Part of TT is scattered by other strands: diffuse light that wraps around the body of hair. The more light grazes a
// dense body, the fewer of its visible strands it reaches.
//
// Vectors of three hold R, TT and TRT. Inclinations are from the plane across the strand toward its tip. Attenuations
// are those at the viewer's inclination, so that under light from all sides the lobes together reflect what is not
// absorbed; between different inclinations, reciprocity holds only if attenuations agree.
// Techniques: hair.shading
// Source of hair.shading: Marschner et al. 2003; d'Eon et al. 2011; Karis 2016; Chiang et al. 2016

#include "lib/brdf.glsl"

const float kHairIndex = 1.55;        // of refraction
const float kHairHeadOn = 0.0465;     // ((index - 1) / (index + 1))^2
const float kMinHairRoughness = 0.05;
const float kHairBody = 0.03;         // depth [m] of a dense body of hair; by eye
const float kHairWrap = 0.5;          // cosine beyond the horizon from which scattered light still arrives; by eye

struct HairLobes {
    vec3 strand;     // unit, toward the tip
    vec3 view_sine;  // of the viewer's inclination, turned by the tilt of the scales
    vec3 view_cosine;
    vec3 variance;   // of the longitudinal functions
    vec4 azimuth;    // HairBlock::azimuth
    float across;    // cosine of the viewer's inclination
    float along;     // its sine
    float reflected; // fraction of light in R
    vec3 tt;         // in TT
    vec3 trt;        // in TRT and all longer paths
    vec3 scattered;  // scattered by other strands
    float density;   // of the body of hair: 0 a single strand .. 1
};

// Schlick's Fresnel term, averaged over the width of a strand inclined by acos(c): for a ray at the fraction h of the
// half width the cosine is c sqrt(1 - h^2).
float strand_reflectance(float c) {
    float weight = 1.0 + c * (-3.926991 + c * (6.666667 + c * (-5.890486 + c * (2.666667 - c * 0.490874))));
    return mix(kHairHeadOn, 1.0, weight);
}

// I0(x) exp(-x) for x >= 0, to 0.8 %: the modified Bessel function.
vec3 scaled_bessel(vec3 x) {
    return sqrt((1.0 + x * (0.557 + x * 0.1631)) / (1.0 + x * (2.2723 + x * (3.7352 + x * 1.0248))));
}

// d'Eon's longitudinal functions: times the cosine of the light's inclination they integrate to 1 over it.
vec3 longitudinal(vec3 variance, float sine, float cosine, vec3 view_sine, vec3 view_cosine) {
    vec3 both = cosine * view_cosine;
    vec3 peak = variance * (1.0 - exp(-2.0 / variance));
    return exp((both - sine * view_sine - 1.0) / variance) * scaled_bessel(both / variance) / peak;
}

// Azimuthal functions, integral 1; R times its Fresnel term, integral strand_reflectance(across).
vec3 azimuthal(vec4 azimuth, float across, float cosine) {
    float half_cosine = sqrt(clamp(0.5 + 0.5 * cosine, 0.0, 1.0));
    float fresnel = mix(kHairHeadOn, 1.0, schlick_weight(across * half_cosine));
    return vec3(
        0.25 * half_cosine * fresnel, azimuth.y * exp(-azimuth.x * (1.0 + cosine)),
        azimuth.w * exp(azimuth.z * (cosine - 1.0)));
}

// Chiang's fit of the standard deviation of inclinations.
float longitudinal_variance(float roughness) {
    float r = max(roughness, kMinHairRoughness);
    float r4 = r * r * r * r;
    float deviation = r * (0.726 + 0.812 * r) + 3.7 * r4 * r4 * r4 * r4 * r4;
    return deviation * deviation;
}

// `strand`: unit, or 0 for one perpendicular to light and viewer.
HairLobes hair_lobes(vec4 azimuth, vec4 fiber, vec3 color, float roughness, vec3 strand, vec3 to_camera) {
    HairLobes hair;
    hair.strand = strand;
    hair.along = clamp(dot(strand, to_camera), -1.0, 1.0);
    hair.across = sqrt(max(1.0 - hair.along * hair.along, 1e-6));
    // R leans to the root by twice the tilt, TT to the tip by once, TRT by three times (Marschner's Table 1).
    vec2 once = fiber.zw;
    vec2 twice = vec2(once.x * once.x - once.y * once.y, 2.0 * once.x * once.y);
    vec2 thrice = vec2(once.x * twice.x - once.y * twice.y, once.x * twice.y + once.y * twice.x);
    vec3 turn_cosine = vec3(twice.x, once.x, thrice.x);
    vec3 turn_sine = vec3(twice.y, -once.y, -thrice.y);
    hair.view_sine = hair.along * turn_cosine + hair.across * turn_sine;
    hair.view_cosine = abs(hair.across * turn_cosine - hair.along * turn_sine);
    hair.variance = longitudinal_variance(roughness) * vec3(1.0, 0.25, 4.0);
    hair.azimuth = azimuth;

    hair.reflected = strand_reflectance(hair.across);
    float inside_cosine = sqrt(1.0 - hair.along * hair.along / (kHairIndex * kHairIndex));
    vec3 depth = log(max(color, vec3(1e-6)));
    vec3 passed = exp(-fiber.x / inside_cosine * depth * depth);
    float entered = (1.0 - hair.reflected) * (1.0 - hair.reflected);
    // In a dense body the light has passed through two other strands.
    hair.tt = (1.0 - fiber.y) * entered * passed * mix(vec3(1.0), passed * passed, fiber.y);
    hair.trt = entered * hair.reflected * passed * passed / (1.0 - hair.reflected * passed);
    hair.scattered = fiber.y * entered * color;
    hair.density = fiber.y;
    return hair;
}

// Light toward the viewer for an irradiance of 1 on a plane that faces the light.
struct HairLight {
    float reflected;
    vec3 transmitted;  // TT and TRT
    vec3 scattered;    // by other strands
};

// Fraction of the visible strands of a body of hair that light reaches past others, by cosines at its surface: single
// scattering in a half-space (Lommel and Seeliger; Chandrasekhar, "Radiative Transfer", 1950), 1 if the light is at
// least as high as the viewer.
float lit_strands(float density, float n_l, float n_v) {
    float reached = max(n_l, 0.0);
    return mix(1.0, min(2.0 * reached / max(reached + n_v, 1e-4), 1.0), density);
}

// Fraction of the light blocked by the nearest caster at this distance [m] that arrives nevertheless. lit_strands()
// covers occlusion by strands of the same dense body; their shadows would also be those of single cards.
float past_strands(HairLobes hair, float distance) {
    float depth = distance / kHairBody;
    return min(2.0 * hair.density, 1.0) * exp(-depth * depth);
}

// `normal`: of the body of hair.
HairLight hair_light(HairLobes hair, vec3 normal, vec3 to_light, float l_v) {
    float sine = clamp(dot(hair.strand, to_light), -1.0, 1.0);
    float cosine = sqrt(max(1.0 - sine * sine, 1e-6));
    float turn = clamp((l_v - sine * hair.along) / (cosine * hair.across), -1.0, 1.0);
    vec3 lobes = longitudinal(hair.variance, sine, cosine, hair.view_sine, hair.view_cosine)
                 * azimuthal(hair.azimuth, hair.across, turn);
    float wrapped = max(dot(normal, to_light) + kHairWrap, 0.0) / (kPi * (1.0 + kHairWrap) * (1.0 + kHairWrap));
    return HairLight(lobes.x, hair.tt * lobes.y + hair.trt * lobes.z, hair.scattered * wrapped);
}
