// Light scattered toward the viewer in a body of water. Include after lib/lighting.glsl, lib/optics.glsl and
// lib/water_surface.glsl.

const float kUpwelling = 0.33;       // upwelling irradiance, per backscatter over absorption (Gordon et al. 1975)
const float kDownwellingPath = 1.2;  // mean path of downwelling light relative to depth

vec3 water_extinction(WaterRecord water) {
    return water.absorption.rgb + water.scattering.rgb;
}

// Downwelling irradiance over pi just below the surface, from lights and environment. Light number `sun` is multiplied
// by `scale`, its intensity relative to flat water.
vec3 downwelling_light(WaterRecord water, int sun, float scale) {
    vec3 sum = irradiance_toward(surroundings[0], vec3(0.0, 1.0, 0.0));
#ifdef DIRECTIONAL_LIGHTS
    int directional = int(view.grid_depth.z);
    int n = 0;
    do {
        vec3 to_light = texelFetch(lights, n * int(kLightTexels)).xyz;
        vec3 irradiance = texelFetch(lights, n * int(kLightTexels) + 1).rgb;
        float down = max(to_light.y, 0.0);
        sum += irradiance * (n == sun ? scale : 1.0) * (down * (1.0 - fresnel(down, water.shape.w)) / kPi);
    } while (++n < directional);
#endif
    return sum;
}
vec3 downwelling_light(WaterRecord water) {
    return downwelling_light(water, -1, 1.0);
}

// Radiance of unbounded water at `depth` [m] along `direction`, for the downwelling light `downwelling`: three times as
// much from above as from below (by eye, after Mobley 1994).
vec3 scattered_light(WaterRecord water, vec3 downwelling, float depth, vec3 direction) {
    vec3 extinction = max(water_extinction(water), vec3(1e-6));
    vec3 here = downwelling * exp(-extinction * (kDownwellingPath * depth));
    return here * (kUpwelling * water.scattering.rgb / extinction) * (2.0 + direction.y);
}
vec3 scattered_light(WaterRecord water, float depth, vec3 direction) {
    return scattered_light(water, downwelling_light(water), depth, direction);
}

// For shallow water: radiance of a bottom that is off screen, with a typical albedo, and the distance to it from the
// surface [m].
const float kBottomAlbedo = 0.35;

vec3 bottom_light(WaterRecord water) {
    return downwelling_light(water) * kBottomAlbedo
           * exp(-water_extinction(water) * (kDownwellingPath * water.absorption.w));
}
float distance_to_bottom(WaterRecord water, vec3 direction) {
    return water.absorption.w / max(-direction.y, 0.02);
}
