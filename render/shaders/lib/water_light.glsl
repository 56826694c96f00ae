// Light in the body of water: what scatters toward a viewer. After lib/lighting.glsl, lib/optics.glsl and
// lib/water_surface.glsl.

const float kUpwelling = 0.33;  // share of backscatter over absorption that comes up again (Gordon et al. 1975)
const float kDimming = 1.2;     // how much longer than straight the way down of light in the water is

vec3 water_extinction(WaterRecord water) {
    return water.absorption.rgb + water.scattering.rgb;
}

// Irradiance over pi that falls through the surface: of the lights, and of all around. Of light number `sun` there is
// `share` as much as falls through flat water.
vec3 light_falling_in(WaterRecord water, int sun, float share) {
    vec3 sum = irradiance_toward(surroundings[0], vec3(0.0, 1.0, 0.0));
#ifdef DIRECTIONAL_LIGHTS
    int directional = int(view.grid_depth.z);
    int n = 0;
    do {
        vec3 to_light = texelFetch(lights, n * int(kLightTexels)).xyz;
        vec3 irradiance = texelFetch(lights, n * int(kLightTexels) + 1).rgb;
        float down = max(to_light.y, 0.0);
        sum += irradiance * (n == sun ? share : 1.0) * (down * (1.0 - fresnel(down, water.shape.w)) / kPi);
    } while (++n < directional);
#endif
    return sum;
}
vec3 light_falling_in(WaterRecord water) {
    return light_falling_in(water, -1, 1.0);
}

// Radiance of endless water at `depth` [m] that comes from `direction`, where so much light falls in: from above there
// is three times as much as from below (by eye, after Mobley 1994).
vec3 scattered_light(WaterRecord water, vec3 falling_in, float depth, vec3 direction) {
    vec3 extinction = max(water_extinction(water), vec3(1e-6));
    vec3 here = falling_in * exp(-extinction * (kDimming * depth));
    return here * (kUpwelling * water.scattering.rgb / extinction) * (2.0 + direction.y);
}
vec3 scattered_light(WaterRecord water, float depth, vec3 direction) {
    return scattered_light(water, light_falling_in(water), depth, direction);
}

// Of water that is not deep: radiance of a bottom that the picture does not show, of mean albedo, and the way there
// from the surface [m].
const float kGroundAlbedo = 0.35;

vec3 ground_light(WaterRecord water) {
    return light_falling_in(water) * kGroundAlbedo * exp(-water_extinction(water) * (kDimming * water.absorption.w));
}
float way_to_ground(WaterRecord water, vec3 direction) {
    return water.absorption.w / max(-direction.y, 0.02);
}
