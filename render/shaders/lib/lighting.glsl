// All light that reaches a surface and what the surface sends on: every light of the pixel's cell and the
// surroundings. Definitions, which only spare a software OpenGL work that nobody needs:
//   DIRECTIONAL_LIGHTS  there are directional lights
//   SPOT_LIGHTS         some light is a spot
//   SPOT_ANGLES         some spot has the profile kSpotLinearAngle
//   LINEAR_FADE         some polynomial has a linear term
//   SHADOWS             some light has a shadow
//   PROJECTORS          some light throws an image
//   LOCAL_LIGHTS        some point or spot light is in view
//   WATERS              there is water; ON_WATER: but what is lit is its surface
//   MIRRORS             some water throws the sun's light up

#include "lib/light.glsl"
#include "lib/optics.glsl"
#include "lib/reflector.glsl"
#include "lib/surroundings.glsl"
#include "lib/view.glsl"
#include "light_gpu.h"
#ifdef SHADOWS
#include "lib/shadow.glsl"
#endif
#ifdef PROJECTORS
#include "lib/projector.glsl"
#endif
#if defined(SHADOWS) || defined(PROJECTORS)
#define LIGHT_PASSING
#endif
#if defined(WATERS) && !defined(ON_WATER)
#define UNDER_WATER
#include "lib/under_water.glsl"
#endif

layout(binding = 9) uniform samplerBuffer lights;           // LightRecord
layout(binding = 10) uniform usamplerBuffer light_indices;  // the lists of the cells, one after the other
layout(binding = 11) uniform usamplerBuffer light_cells;    // begin and length of each cell's list
#if defined(UNDER_WATER) && defined(MIRRORS)
#define OVER_WATER
#include "lib/over_water.glsl"
#endif

// What casters and images let pass of a light with this LightRecord::shadow, on its way to `position_ws`.
vec3 shadow_passing(vec4 shadow, vec3 position_ws, vec3 normal, vec3 to_light, vec2 pixel) {
    vec3 passing = vec3(1.0);
#ifdef SHADOWS
    passing *= light_visibility(shadow, position_ws, normal, to_light, pixel);
#endif
#ifdef PROJECTORS
    passing *= projected_color(shadow.w, position_ws);
#endif
    return passing;
}

vec3 light_passing(int index, vec3 position_ws, vec3 normal, vec3 to_light, vec2 pixel) {
#ifdef LIGHT_PASSING
    vec4 shadow = texelFetch(lights, index * int(kLightTexels) + 4);
    return shadow_passing(shadow, position_ws, normal, to_light, pixel);
#else
    return vec3(1.0);
#endif
}

Incoming incoming_directional(int index, vec3 position_ws, vec3 normal, vec2 pixel) {
    vec3 to_light = texelFetch(lights, index * int(kLightTexels)).xyz;
    vec3 irradiance = texelFetch(lights, index * int(kLightTexels) + 1).rgb;
#ifdef UNDER_WATER
    vec4 shadow = texelFetch(lights, index * int(kLightTexels) + 4);
    Sunken water = sunken_at(position_ws);
    bool sunken = water.depth >= 0.0;
    vec3 bent = bent_to_light(water, to_light);
    irradiance *= sunken ? sunken_share(water, to_light, bent) : vec3(1.0);
    Gathered gathered = gathered_at(water, index);
    if (gathered.view >= 0.0 && sunken) {
        irradiance *= gathered.light;
        shadow.xyz = vec3(gathered.view, kShadowView, 1.0);
    }
    to_light = sunken ? bent : to_light;
#ifdef LIGHT_PASSING
    irradiance *= shadow_passing(shadow, position_ws, normal, to_light, pixel);
#endif
#else
    irradiance *= light_passing(index, position_ws, normal, to_light, pixel);
#endif
    return Incoming(to_light, irradiance);
}

// The water around a point.
struct WaterAbout {
    vec3 extinction;  // [1/m]
    float depth;      // [m]; < 0: in no water
    float index;      // of refraction
};
WaterAbout water_about(vec3 position_ws) {
#ifdef UNDER_WATER
    Sunken water = sunken_at(position_ws);
    return WaterAbout(water.extinction, water.depth, water.index);
#else
    return WaterAbout(vec3(0.0), -1.0, 1.333);
#endif
}

// What water leaves of a lamp's light that goes straight to a point in it, `offset` away, and goes in by flat water.
vec3 lamp_through_water(WaterAbout about, vec3 offset) {
    float way = length(offset);
    bool above = offset.y > about.depth;
    float inside = above ? about.depth / offset.y : 1.0;
    float let_in = above ? 1.0 - fresnel(offset.y / max(way, 1e-6), about.index) : 1.0;
    return about.depth >= 0.0 ? let_in * exp(-about.extinction * (way * inside)) : vec3(1.0);
}

Incoming incoming_local(int index, vec3 position_ws, vec3 normal, WaterAbout about) {
    vec4 place = texelFetch(lights, index * int(kLightTexels));
    vec4 color = texelFetch(lights, index * int(kLightTexels) + 1);
    vec4 polynomial = texelFetch(lights, index * int(kLightTexels) + 2);
    vec3 offset = place.xyz - position_ws;
    float d2 = dot(offset, offset);
    float fade = distance_attenuation(d2, place.w, polynomial.xyz, color.w);
    vec3 to_light = d2 > 1e-12 ? offset * inversesqrt(d2) : normal;
#ifdef SPOT_LIGHTS
    vec4 axis = texelFetch(lights, index * int(kLightTexels) + 3);
    fade *= spot_attenuation(to_light, axis.xyz, axis.w, polynomial.w);
#endif
    return Incoming(to_light, color.rgb * (fade * lamp_through_water(about, offset)));
}

// Cell of the light clusters that a pixel at a distance along the view axis belongs to.
int light_cell(vec2 pixel, float distance) {
    vec2 tile = floor(pixel / view.grid_cells.w);
    float slice = clamp(floor(log2(distance) * view.grid_depth.x + view.grid_depth.y), 0.0, view.grid_cells.z - 1.0);
    return int((slice * view.grid_cells.y + tile.y) * view.grid_cells.x + tile.x);
}

// Share of the mirrored surroundings that a hole of this openness lets through (Lagarde and de Rousiers 2014).
float specular_occlusion(float n_v, float occlusion, float roughness) {
    return clamp(pow(n_v + occlusion, exp2(-16.0 * roughness - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
}

const int kNoLight = 0x7fffffff / int(kLightTexels) - 1;  // reads zeros

// Adds the directional lights.
void add_directional(inout LightSum sum, Reflector r, vec3 position_ws, vec2 pixel) {
    // The loops ask after their body: a software OpenGL runs a body that is asked before once too often, masked.
#ifdef DIRECTIONAL_LIGHTS
    int directional = int(view.grid_depth.z);
    int n = 0;
    do {
        add_light(sum, r, incoming_directional(n, position_ws, r.normal, pixel));
    } while (++n < directional);
#endif
}

// Adds the point and spot lights of a list: begin and length in light_indices. An empty list reads zeros, and counts
// them not at all. Lights with shadows or images come last, in a loop of their own.
void add_listed(inout LightSum sum, Reflector r, uvec2 list, vec3 position_ws, vec2 pixel) {
#ifdef LOCAL_LIGHTS
    WaterAbout about = water_about(position_ws);
    int i = int(list.x);
    int end = int(list.x + list.y);
    int index = int(texelFetch(light_indices, i).x);
#ifdef LIGHT_PASSING
    int first_shadowed = int(view.grid_depth.w);
#else
    int first_shadowed = kNoLight;
#endif
    index = list.y > 0u ? index : kNoLight;
    do {
        Incoming light = incoming_local(index, position_ws, r.normal, about);
        light.irradiance *= index < first_shadowed ? 1.0 : 0.0;
        add_light(sum, r, light);
        i += index < first_shadowed ? 1 : 0;
        index = i < end ? int(texelFetch(light_indices, i).x) : kNoLight;
    } while (index < first_shadowed);
#ifdef LIGHT_PASSING
    do {
        Incoming light = incoming_local(index, position_ws, r.normal, about);
        vec3 passing = light_passing(index, position_ws, r.normal, light.to_light, pixel);
        light.irradiance *= i < end ? passing : vec3(0.0);
        add_light(sum, r, light);
        ++i;
        index = i < end ? int(texelFetch(light_indices, i).x) : kNoLight;
    } while (i < end);
#endif
#endif
}

// What a surface sends on of the light of all lights, and of the surroundings'. Neither has its emission.
Reflected reflect_lights(Reflector r, LightSum sum) {
    Reflected result;
    result.diffuse = r.diffuse * (sum.diffuse / kPi);
    result.specular = r.specular_0 * (sum.specular - sum.fresnel) + r.specular_90 * sum.fresnel;
    return result;
}

Reflected reflect_surroundings(Reflector r, SurfaceSample s, vec3 position_ws) {
    Around around = light_from_around(position_ws, r.normal, reflect(-r.to_camera, r.normal), s.roughness);
#ifdef UNDER_WATER
    vec3 left = sunken_surroundings(position_ws);
    around.irradiance *= left;
    around.mirrored *= left;
#endif
    float open = specular_occlusion(r.n_v, s.occlusion, s.roughness);
    Reflected result;
    result.diffuse = r.diffuse * (around.irradiance * s.occlusion);
    result.specular = r.mirror * around.mirrored * open;
#ifdef OVER_WATER
    result.diffuse += r.diffuse * (mirrored_irradiance(position_ws, r.normal) / kPi);
#endif
    return result;
}

// Radiance toward the camera of a surface at `position_ws`, seen through `pixel`, without its emission; `list` as in
// add_listed.
Reflected reflect_all(SurfaceSample s, vec3 position_ws, vec2 pixel, uvec2 list) {
    Reflector r = make_reflector(s, to_viewer(position_ws));
    LightSum sum = LightSum(vec3(0.0), vec3(0.0), vec3(0.0));
    add_directional(sum, r, position_ws, pixel);
    add_listed(sum, r, list, position_ws, pixel);
    Reflected lights = reflect_lights(r, sum);
    Reflected around = reflect_surroundings(r, s, position_ws);
    return Reflected(lights.diffuse + around.diffuse, lights.specular + around.specular);
}

// The list of the cell that a pixel at a distance along the view axis belongs to.
uvec2 cell_list(vec2 pixel, float distance) {
#ifdef LOCAL_LIGHTS
    return texelFetch(light_cells, light_cell(pixel, distance)).xy;
#else
    return uvec2(0u);
#endif
}
