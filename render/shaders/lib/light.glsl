// Attenuation of point and spot lights, branch-free so that every option costs the same. The same as
// bench/oracles/light_oracle.h in double precision.
// Techniques: engine.light-falloff, light.attenuation, light.interface, light.spot-cone,
//     light.spot-falloff

// Irradiance factor of a point or spot light at squared distance d2 [m^2], 1 cd unattenuated.
//   inv_radius2   1 / radius^2; 0: unbounded
//   polynomial    c, l, q of 1 / (c + l d + q d^2); the inverse square is (0, 0, 1); l needs LINEAR_FADE
//   multiplier    0: the window (1 - (d/r)^4)^2 of Karis 2013; else clamp(multiplier (1 - (d/r)^2), 0, 1)
float distance_attenuation(float d2, float inv_radius2, vec3 polynomial, float multiplier) {
    float x = d2 * inv_radius2;
    float karis = clamp(1.0 - x * x, 0.0, 1.0);
    float window = multiplier > 0.0 ? clamp(multiplier * (1.0 - x), 0.0, 1.0) : karis * karis;
    float fade = polynomial.x + polynomial.z * d2;
#ifdef LINEAR_FADE
    fade += polynomial.y * sqrt(d2);
#endif
    return window / max(fade, 1e-4);
}

// Spot profiles, as numbered by SpotProfile.
const float kSpotLinearCosine = 0.0;
const float kSpotSmoothstep = 1.0;
const float kSpotLinearAngle = 2.0;

// 1 inside the inner cone, 0 outside the outer one. `axis` is the light's direction times the profile's scale;
// scale and `offset` map the cosine (for kSpotLinearAngle: minus the angle) at the outer cone to 0 and at the
// inner one to 1. A zero axis and offset 1 make a point light. kSpotLinearAngle needs SPOT_ANGLES.
float spot_attenuation(vec3 to_light, vec3 axis, float offset, float profile) {
    float t = -dot(to_light, axis);
#ifdef SPOT_ANGLES
    float scale = max(length(axis), 1e-20);
    t = profile == kSpotLinearAngle ? -acos(clamp(t / scale, -1.0, 1.0)) * scale : t;
#endif
    float s = clamp(t + offset, 0.0, 1.0);
    return profile == kSpotSmoothstep ? s * s * (3.0 - 2.0 * s) : s;
}
