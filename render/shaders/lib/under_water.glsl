// Underwater light: refracted by the surface at rest, absorbed along its path, focused by waves where there is a
// caustic map (caustics_pass.h). Include after lib/optics.glsl.
// Techniques: caustic.projected-vertices

#include "lib/caustic_tile.glsl"

const float kDiffusePath = 1.2;            // mean path of diffuse light relative to depth
const float kDiffuseTransmittance = 0.93;  // transmittance of the surface for diffuse light

struct Underwater {
    float depth;      // below the water at rest [m]; < 0: not in water
    vec2 xz;          // in water space [m]
    vec2 axis;        // x axis of the water, in the world
    vec3 extinction;  // [1/m]
    float index;      // of refraction
    vec4 maps;        // UnderwaterRecord
    vec4 bent;
};

// The water that contains a point.
Underwater underwater_at(vec3 position_ws) {
    Underwater found = Underwater(-1.0, vec2(0.0), vec2(1.0, 0.0), vec3(0.0), 1.333, vec4(0.0), vec4(0.0));
    vec4 grid = texelFetch(water_lights, 1);
    vec2 cells = texelFetch(water_lights, 2).xy;
    vec2 cell = clamp(floor((position_ws.xz - grid.xy) * grid.zw), vec2(0.0), cells - 1.0);
    vec2 list = texelFetch(water_lights, int(texelFetch(water_lights, 0).w + cell.y * cells.x + cell.x)).xy;
    int i = int(list.x);
    int end = int(list.y);
    do {
        int at = int(kHeaderTexels) + int(texelFetch(water_lights, i).x) * int(kUnderwaterTexels);
        vec4 origin = texelFetch(water_lights, at);
        vec4 shape = texelFetch(water_lights, at + 1);
        vec4 extinction = texelFetch(water_lights, at + 2);
        vec2 axis = vec2(origin.w, shape.x);
        vec3 from = position_ws - origin.xyz;
        vec2 xz = vec2(axis.x * from.x + axis.y * from.z, axis.x * from.z - axis.y * from.x);
        vec2 bounds = mix(vec2(1e9), shape.yz, greaterThan(shape.yz, vec2(0.0)));
        float bottom = extinction.w > 0.0 ? 1.001 * extinction.w + 0.01 : 1e9;
        bool inside = i < end && from.y < 0.0 && -from.y <= bottom && all(lessThanEqual(abs(xz), bounds + 1e-3));
        if (inside) {
            found = Underwater(
                -from.y,
                xz,
                axis,
                extinction.rgb,
                shape.w,
                texelFetch(water_lights, at + 3),
                texelFetch(water_lights, at + 4));
        }
    } while (++i < end);
    return found;
}

// Direction toward the light in the water, refracted by a flat surface; `to_light` above the water.
vec3 bent_to_light(Underwater water, vec3 to_light) {
    return -refract_ray(vec3(0.0, 1.0, 0.0), to_light, 1.0 / water.index);
}

// Irradiance at the point relative to that above the water, both perpendicular to the light; `to_light` above the
// water.
vec3 underwater_transmittance(Underwater water, vec3 to_light, vec3 bent) {
    float through = 1.0 - fresnel(to_light.y, water.index);
    float down = max(bent.y, 0.1);
    vec3 transmittance = exp(-water.extinction * (water.depth / down));
    return transmittance * (through * max(to_light.y, 0.0) / down);
}

// Light focused by waves, relative to that under flat water, and the shadow view for its occluders.
struct FocusedLight {
    float light;
    float view;  // -1: no map covers the point
};

// From the finest map that covers the point; blends into the next one toward its edge, finally into flat water.
FocusedLight focused_light_at(Underwater water, int light) {
    vec2 entry = water.xz - water.bent.xy * water.depth;
    int map = int(water.maps.x);
    int end = map + (float(light) == water.maps.z && water.depth < water.maps.w ? int(water.maps.y) : 0);
    FocusedLight found = FocusedLight(1.0, -1.0);
    float open = 1.0;  // weight not yet taken by a map
    float sum = 0.0;
    do {
        CausticTile tile = caustic_tile(map);
        vec2 uv = (entry - tile.window.xy) * tile.window.zw;
        vec2 inside = min(uv, 1.0 - uv);
        float edge = min(inside.x, inside.y);
        bool covers = map < end && edge > 0.0;
        float weight = covers ? open * clamp(edge / max(tile.view.y, 1e-6) - 1.0, 0.0, 1.0) : 0.0;
        weight = covers && map + 1 == end ? open : weight;
        sum += covers ? weight * (tile.rect.w > 0.0 ? caustic_texel(tile, uv) : 1.0) : 0.0;
        open -= weight;
        found.view = covers && found.view < 0.0 ? tile.view.x : found.view;
        ++map;
    } while (map < end && open > 0.0);
    found.light = max(mix(1.0, sum + open, water.bent.z), 0.0);
    return found;
}

// Transmittance of the water for environment light.
vec3 underwater_environment(vec3 position_ws) {
    Underwater water = underwater_at(position_ws);
    vec3 transmittance = kDiffuseTransmittance * exp(-water.extinction * (kDiffusePath * water.depth));
    return water.depth >= 0.0 ? transmittance : vec3(1.0);
}
