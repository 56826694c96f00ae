// Light under water: bent by the surface at rest, absorbed on its way down, gathered by the waves where there is a map
// of that (caustics_pass.h). After lib/optics.glsl.

#include "caustics_gpu.h"

layout(binding = 20) uniform samplerBuffer sunken_waters;  // SunkenRecord; the first texel's x is their number
layout(binding = 21) uniform sampler2DArray caustic_maps;  // light that arrives over the light that flat water lets in

const float kDiffuseWay = 1.2;     // how much longer than straight down the way of light from all around is
const float kDiffuseThrough = 0.93;  // of light from all around, that the surface lets in

struct Sunken {
    float depth;      // below the water at rest [m]; < 0: in no water
    vec2 place;       // along x and z, in the water's own space [m]
    vec2 axis;        // of the water, in the world
    vec3 extinction;  // [1/m]
    float index;      // of refraction
    vec4 window;      // SunkenRecord
    vec4 map;
    vec3 bent;
};

// In which water a point is.
Sunken sunken_at(vec3 position_ws) {
    Sunken found = Sunken(-1.0, vec2(0.0), vec2(1.0, 0.0), vec3(0.0), 1.333, vec4(0.0), vec4(-1.0), vec3(0.0));
    int count = int(texelFetch(sunken_waters, 0).x);
    int i = 0;
    do {
        int at = 1 + i * int(kSunkenTexels);
        vec4 origin = texelFetch(sunken_waters, at);
        vec4 shape = texelFetch(sunken_waters, at + 1);
        vec4 extinction = texelFetch(sunken_waters, at + 2);
        vec2 axis = vec2(origin.w, shape.x);
        vec3 from = position_ws - origin.xyz;
        vec2 place = vec2(axis.x * from.x + axis.y * from.z, axis.x * from.z - axis.y * from.x);
        vec2 bounds = mix(vec2(1e9), shape.yz, greaterThan(shape.yz, vec2(0.0)));
        float bottom = extinction.w > 0.0 ? 1.001 * extinction.w + 0.01 : 1e9;
        bool inside = from.y < 0.0 && -from.y <= bottom && all(lessThanEqual(abs(place), bounds + 1e-3));
        if (inside) {
            found = Sunken(
                -from.y,
                place,
                axis,
                extinction.rgb,
                shape.w,
                texelFetch(sunken_waters, at + 3),
                texelFetch(sunken_waters, at + 4),
                texelFetch(sunken_waters, at + 5).xyz);
        }
    } while (++i < count);
    return found;
}

// The way down of light that comes from `to_light`: bent by flat water.
vec3 bent_to_light(Sunken water, vec3 to_light) {
    return -refract_ray(vec3(0.0, 1.0, 0.0), to_light, 1.0 / water.index);
}

// Irradiance there over the light's own, across the light; `to_light` above the water.
vec3 sunken_share(Sunken water, vec3 to_light, vec3 bent) {
    float through = 1.0 - fresnel(to_light.y, water.index);
    float down = max(bent.y, 0.1);
    vec3 left = exp(-water.extinction * (water.depth / down));
    return left * (through * max(to_light.y, 0.0) / down);
}

// Whether the map knows the place.
bool in_caustic_map(Sunken water, int light, out vec3 uv) {
    uv = vec3((water.place - water.bent.xy * water.depth - water.window.xy) * water.window.zw, water.map.x);
    bool inside = all(greaterThan(uv.xy, vec2(0.0))) && all(lessThan(uv.xy, vec2(1.0)));
    return inside && water.map.y >= 0.0 && float(light) == water.map.z && water.depth < water.map.w;
}

// What waves make of the light at a place of the map, over that under flat water.
float caustic_at(Sunken water, vec3 uv) {
    float gathered = textureLod(caustic_maps, uv, 0.0).r;
    return water.map.x >= 0.0 ? max(mix(1.0, gathered, water.bent.z), 0.0) : 1.0;
}

// Light from all around that is left.
vec3 sunken_surroundings(vec3 position_ws) {
    Sunken water = sunken_at(position_ws);
    vec3 left = kDiffuseThrough * exp(-water.extinction * (kDiffuseWay * water.depth));
    return water.depth >= 0.0 ? left : vec3(1.0);
}
