// Light shafts of the sun in water, focused by its waves and shadowed by objects in and above it. Include after
// lib/noise.glsl and lib/lighting.glsl. Light refracted by flat water keeps its texel in the map of caustics_pass.h, so
// a view ray crosses the map on a straight line; light counts as focused all along its path as much as where it lands.
// Techniques: caustic.projected-vertices

const float kForward = 0.5;  // mean cosine of scattering; by eye, that of the sea is 0.9

// Phase function relative to isotropic scattering (Henyey and Greenstein 1941).
float scattered_forward(float cosine) {
    float g = kForward;
    return (1.0 - g * g) * pow(1.0 + g * g - 2.0 * g * cosine, -1.5);
}

// Mean sunlight along the view ray of unit `direction`, relative to that in flat unoccluded water, weighted by
// transmittance to the camera: importance-sampled steps of equal weight, jittered per pixel, over the distance `path`.
// The contrast rises toward the sun, `to_sun` in the water, by the phase function.
float shafts_along(Underwater water, vec3 to_sun, vec3 direction, float path, vec3 extinction, vec2 pixel) {
    CausticTile tile = caustic_tile(int(water.maps.x));
    vec2 aside = vec2(
        water.axis.x * direction.x + water.axis.y * direction.z, water.axis.x * direction.z - water.axis.y * direction.x);
    vec2 uv = (water.xz - water.bent.xy * water.depth - tile.window.xy) * tile.window.zw;
    vec2 uv_by_path = (aside + water.bent.xy * direction.y) * tile.window.zw;
    float loss = max(dot(extinction, vec3(1.0 / 3.0)), 1e-4);
    float absorbed = 1.0 - exp(-loss * path);
    float steps = max(water.bent.w, 1.0);
    float offset = pixel_noise(pixel);
    float sum = 0.0;
    float n = 0.0;
    do {
        float along = -log(max(1.0 - absorbed * (n + offset) / steps, 1e-6)) / loss;
        vec2 at = uv + uv_by_path * along;
        float depth = water.depth - direction.y * along;
        vec2 inside = min(at, 1.0 - at);
        float coverage = clamp(min(inside.x, inside.y) / max(tile.view.y, 1e-6), 0.0, 1.0);
        float light = mix(1.0, caustic_texel(tile, at), water.bent.z) * path_visibility(tile, at, depth);
        sum += mix(1.0, max(light, 0.0), coverage);
        n += 1.0;
    } while (n < steps);
    float mean = 1.0 + scattered_forward(dot(to_sun, direction)) * (sum / steps - 1.0);
    // Averages the pixels of a quad.
    mean -= dFdx(mean) * (mod(floor(pixel.x), 2.0) - 0.5);
    mean -= dFdy(mean) * (mod(floor(pixel.y), 2.0) - 0.5);
    return water.depth >= 0.0 && water.maps.y > 0.0 && tile.rect.w > 0.0 && water.bent.w > 0.0 ? max(mean, 0.0) : 1.0;
}
