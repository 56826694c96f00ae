// Shafts of the sun's light in the water, as its waves gather it and what stands in it and above it lets it through.
// After lib/noise.glsl and lib/lighting.glsl. Light that flat water bends keeps its place in the map of caustics_pass.h, so a ray of sight
// crosses the map on a straight line; as in the map, light is as gathered on its way as where it lands.

const float kForward = 0.5;  // of light that water scatters: mean cosine; by eye, that of the sea is 0.9

// Light scattered by an angle over its mean over all angles (Henyey and Greenstein 1941).
float scattered_forward(float cosine) {
    float g = kForward;
    return (1.0 - g * g) * pow(1.0 + g * g - 2.0 * g * cosine, -1.5);
}

// Mean light of the sun along the ray from `lens` into unit `direction`, over that in flat open water, as much as each
// part of the `way` is seen: by importance, steps that all count the same. The offset differs from pixel to pixel. What
// waves make of it shows the more the nearer one looks to the sun, `to_sun` in the water.
float shafts_along(Sunken water, vec3 to_sun, vec3 direction, float way, vec3 extinction, vec2 pixel) {
    CausticPlace place = caustic_place(int(water.maps.x));
    vec2 aside = vec2(
        water.axis.x * direction.x + water.axis.y * direction.z, water.axis.x * direction.z - water.axis.y * direction.x);
    vec2 uv = (water.place - water.bent.xy * water.depth - place.window.xy) * place.window.zw;
    vec2 uv_by_way = (aside + water.bent.xy * direction.y) * place.window.zw;
    float loss = max(dot(extinction, vec3(1.0 / 3.0)), 1e-4);
    float seen = 1.0 - exp(-loss * way);
    float steps = max(water.bent.w, 1.0);
    float offset = pixel_noise(pixel);
    float sum = 0.0;
    float n = 0.0;
    do {
        float along = -log(max(1.0 - seen * (n + offset) / steps, 1e-6)) / loss;
        vec2 at = uv + uv_by_way * along;
        float depth = water.depth - direction.y * along;
        vec2 inside = min(at, 1.0 - at);
        float known = clamp(min(inside.x, inside.y) / max(place.view.y, 1e-6), 0.0, 1.0);
        float light = mix(1.0, caustic_texel(place, at), water.bent.z) * way_is_open(place, at, depth);
        sum += mix(1.0, max(light, 0.0), known);
        n += 1.0;
    } while (n < steps);
    float mean = 1.0 + scattered_forward(dot(to_sun, direction)) * (sum / steps - 1.0);
    // Pixels of a quad share their steps.
    mean -= dFdx(mean) * (mod(floor(pixel.x), 2.0) - 0.5);
    mean -= dFdy(mean) * (mod(floor(pixel.y), 2.0) - 0.5);
    return water.depth >= 0.0 && water.maps.y > 0.0 && place.rect.w > 0.0 && water.bent.w > 0.0 ? max(mean, 0.0) : 1.0;
}
