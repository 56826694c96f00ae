// Shading of a surface by every light of the pixel's cell and by the environment. Definitions, which only save a
// software OpenGL needless work:
//   DIRECTIONAL_LIGHTS  there are directional lights
//   DIRECTIONAL_COUNT   their number, a constant, so that their loop is unrolled (shade.control-flow)
//   SPOT_LIGHTS         some light is a spot
//   SPOT_ANGLES         some spot has the profile kSpotLinearAngle
//   LINEAR_FADE         some polynomial has a linear term
//   SHADOWS             some light has a shadow
//   PROJECTORS          some light projects a cookie
//   LOCAL_LIGHTS        there are point or spot lights
//   WATERS              there is water; ON_WATER: and its surface is being shaded
//   MIRRORS             some water reflects the sun's light upward
//   KEY_SHADOWS         surfaces know the visibility of the key lights
//   PARTICLE_SHADOWS    particles cast shadows: 1: in the first directional light, 2: in a spot with a shadow
// Techniques: env.reflect, shade.control-flow, shade.lighting-space, skin.transmission, wrinkle.compression.bump-blend,
//     wrinkle.fold-light

#include "lib/diffusion.glsl"
#include "lib/key_lights.glsl"
#include "lib/light.glsl"
#include "lib/numbers.glsl"  // must not be included first within the #ifdef below
#include "lib/optics.glsl"
#include "lib/radiance.glsl"
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
#ifdef PARTICLE_SHADOWS
#include "lib/particle_shadow.glsl"
#endif
#if defined(SHADOWS) || defined(PROJECTORS)
#define LIGHT_TRANSMITTANCE
#endif
#if defined(WATERS) && !defined(ON_WATER)
#define UNDER_WATER
#include "lib/under_water.glsl"
#endif

layout(binding = kLightIndicesUnit) uniform usamplerBuffer light_indices;  // the lists of the cells, one after the other
layout(binding = kLightCellsUnit) uniform usamplerBuffer light_cells;    // begin and length of each cell's list
#if defined(UNDER_WATER) && defined(MIRRORS)
#define OVER_WATER
#include "lib/over_water.glsl"
#endif

// Transmittance of shadow casters and cookies between `position_ws` and a light with this LightRecord::shadow.
vec3 shadow_transmittance(vec4 shadow, vec3 position_ws, vec3 normal, vec3 to_light, vec2 pixel) {
    vec3 transmittance = vec3(1.0);
#ifdef SHADOWS
    transmittance *= light_visibility(shadow, position_ws, normal, to_light, pixel);
#endif
#ifdef PROJECTORS
    transmittance *= projected_color(shadow.w, position_ws);
#endif
    return transmittance;
}

vec3 light_transmittance(int index, vec3 position_ws, vec3 normal, vec3 to_light, vec2 pixel) {
#ifdef LIGHT_TRANSMITTANCE
    vec4 shadow = texelFetch(lights, index * int(kLightTexels) + 4);
    vec3 transmittance = shadow_transmittance(shadow, position_ws, normal, to_light, pixel);
#if defined(PARTICLE_SHADOWS) && PARTICLE_SHADOWS == 2
    transmittance *= particle_transmittance(index, position_ws);
#endif
    return transmittance;
#else
    return vec3(1.0);
#endif
}

Incoming incoming_directional(int index, vec3 position_ws, vec3 normal, vec2 pixel) {
    vec3 to_light = texelFetch(lights, index * int(kLightTexels)).xyz;
    vec3 irradiance = texelFetch(lights, index * int(kLightTexels) + 1).rgb;
    vec3 unshadowed = irradiance;
#ifdef UNDER_WATER
    vec4 shadow = texelFetch(lights, index * int(kLightTexels) + 4);
    Underwater water = underwater_at(position_ws);
    bool under_water = water.depth >= 0.0;
    vec3 bent = bent_to_light(water, to_light);
    irradiance *= under_water ? underwater_transmittance(water, to_light, bent) : vec3(1.0);
    FocusedLight focused = focused_light_at(water, index);
    if (focused.view >= 0.0 && under_water) {
        irradiance *= focused.light;
        shadow.xyz = vec3(focused.view, kShadowView, 1.0);
    }
    to_light = under_water ? bent : to_light;
    unshadowed = irradiance;
#ifdef LIGHT_TRANSMITTANCE
    irradiance *= shadow_transmittance(shadow, position_ws, normal, to_light, pixel);
#endif
#else
    irradiance *= light_transmittance(index, position_ws, normal, to_light, pixel);
#endif
#if defined(PARTICLE_SHADOWS) && PARTICLE_SHADOWS == 1
    irradiance *= particle_transmittance(index, position_ws);
#endif
    return Incoming(to_light, irradiance, unshadowed);
}

// The water that a point is in.
struct WaterMedium {
    vec3 extinction;  // [1/m]
    float depth;      // [m]; < 0: not in water
    float index;      // of refraction
};
WaterMedium water_medium(vec3 position_ws) {
#ifdef UNDER_WATER
    Underwater water = underwater_at(position_ws);
    return WaterMedium(water.extinction, water.depth, water.index);
#else
    return WaterMedium(vec3(0.0), -1.0, 1.333);
#endif
}

// Transmittance of water for a local light `offset` away from a point in it, along a straight line through a flat
// surface.
vec3 lamp_through_water(WaterMedium medium, vec3 offset) {
    float path = length(offset);
    bool above = offset.y > medium.depth;
    float inside = above ? medium.depth / offset.y : 1.0;
    float let_in = above ? 1.0 - fresnel(offset.y / max(path, 1e-6), medium.index) : 1.0;
    return medium.depth >= 0.0 ? let_in * exp(-medium.extinction * (path * inside)) : vec3(1.0);
}

Incoming incoming_local(int index, vec3 position_ws, vec3 normal, WaterMedium medium) {
    vec4 position = texelFetch(lights, index * int(kLightTexels));
    vec4 color = texelFetch(lights, index * int(kLightTexels) + 1);
    vec4 polynomial = texelFetch(lights, index * int(kLightTexels) + 2);
    vec3 offset = position.xyz - position_ws;
    float d2 = dot(offset, offset);
    float fade = distance_attenuation(d2, position.w, polynomial.xyz, color.w);
    vec3 to_light = d2 > 1e-12 ? offset * inversesqrt(d2) : normal;
#ifdef SPOT_LIGHTS
    vec4 axis = texelFetch(lights, index * int(kLightTexels) + 3);
    fade *= spot_attenuation(to_light, axis.xyz, axis.w, polynomial.w);
#endif
    vec3 irradiance = color.rgb * (fade * lamp_through_water(medium, offset));
    return Incoming(to_light, irradiance, irradiance);
}

// The light that a surface's own relief lets through.
Incoming past_relief(Incoming light, Reflector r, int index) {
#ifdef KEY_SHADOWS
    ivec2 keys = key_lights();
    light.irradiance *= index == keys.x ? r.key_visibility.x : index == keys.y ? r.key_visibility.y : 1.0;
#endif
    return light;
}

#if (defined(SHADE_SUBSURFACE) || defined(SHADE_HAIR)) && defined(SHADOWS) && defined(SHADOW_MAPS)
// Adds the light of a lamp with a shadow, and light transmitted through a body:
//   skin  the diffuse light that has entered at the back: by the profile, over the distance from the surface in the
//         light's shadow map, whose normal is assumed to be the opposite one (Jimenez et al., "Real-Time Realistic Skin
//         Translucency", 2010)
//   hair  light that passes strands of the same body
void add_shadowed(inout LightSum sum, Reflector r, int index, Incoming light, vec3 position_ws) {
    light = past_relief(light, r, index);
    vec4 shadow = texelFetch(lights, index * int(kLightTexels) + 4);
    float thickness = shadow_thickness(shadow, position_ws, light.to_light);
#ifdef SHADE_HAIR
    light.irradiance = max(light.irradiance, light.unshadowed * past_strands(r.hair, thickness));
#endif
    add_light(sum, r, light);
#ifdef SHADE_SUBSURFACE
    vec3 transmitted = transmitted_fraction(thickness, r.diffusion);
    sum.diffuse += light.unshadowed * transmitted * max(-dot(body_normal(r), light.to_light), 0.0);
#endif
}
#else
void add_shadowed(inout LightSum sum, Reflector r, int index, Incoming light, vec3 position_ws) {
    add_light(sum, r, past_relief(light, r, index));
}
#endif

// Cell of the light clusters of a pixel at a distance along the view axis.
int light_cell(vec2 pixel, float distance) {
    vec2 tile = floor(pixel / view.grid_cells.w);
    float slice = clamp(floor(log2(distance) * view.grid_depth.x + view.grid_depth.y), 0.0, view.grid_cells.z - 1.0);
    return int((slice * view.grid_cells.y + tile.y) * view.grid_cells.x + tile.x);
}

// Specular occlusion from ambient occlusion (Lagarde and de Rousiers 2014).
float specular_occlusion(float n_v, float occlusion, float roughness) {
    return clamp(pow(n_v + occlusion, exp2(-16.0 * roughness - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
}

const int kNoLight = 0x7fffffff;

// Clamps to existing records: fetches past the end of a buffer texture are undefined.
int existing_light(int index) {
    return min(index, light_count() - 1);
}

// Adds the directional lights.
void add_directional(inout LightSum sum, Reflector r, vec3 position_ws, vec2 pixel) {
    // Loops test after their body: if tested before, a software OpenGL runs one more masked iteration.
#ifdef DIRECTIONAL_LIGHTS
#ifdef DIRECTIONAL_COUNT
    const int directional = DIRECTIONAL_COUNT;
#else
    int directional = int(view.grid_depth.z);
#endif
    int n = 0;
    do {
        Incoming light = incoming_directional(n, position_ws, body_normal(r), pixel);
        add_shadowed(sum, r, n, light, position_ws);
    } while (++n < directional);
#endif
}

// Adds the point and spot lights of a list: begin and length in light_indices. The record read for an empty list, or
// past the end, adds nothing. Lights with shadows or cookies come last, in a separate loop.
void add_listed(inout LightSum sum, Reflector r, uvec2 list, vec3 position_ws, vec2 pixel) {
#ifdef LOCAL_LIGHTS
    WaterMedium medium = water_medium(position_ws);
    int i = int(list.x);
    int end = int(list.x + list.y);
    int index = int(texelFetch(light_indices, i).x);
#ifdef LIGHT_TRANSMITTANCE
    int first_shadowed = int(view.grid_depth.w);
#else
    int first_shadowed = kNoLight;
#endif
    index = list.y > 0u ? index : kNoLight;
    do {
        Incoming light = incoming_local(existing_light(index), position_ws, r.normal, medium);
        light.irradiance *= index < first_shadowed ? 1.0 : 0.0;
        light.unshadowed *= index < first_shadowed ? 1.0 : 0.0;
        add_light(sum, r, light);
        i += index < first_shadowed ? 1 : 0;
        index = i < end ? int(texelFetch(light_indices, i).x) : kNoLight;
    } while (index < first_shadowed);
#ifdef LIGHT_TRANSMITTANCE
    do {
        int existing = existing_light(index);
        Incoming light = incoming_local(existing, position_ws, r.normal, medium);
        vec3 transmittance = light_transmittance(existing, position_ws, body_normal(r), light.to_light, pixel);
        light.irradiance *= i < end ? transmittance : vec3(0.0);
        light.unshadowed *= i < end ? 1.0 : 0.0;
        add_shadowed(sum, r, existing, light, position_ws);
        ++i;
        index = i < end ? int(texelFetch(light_indices, i).x) : kNoLight;
    } while (i < end);
#endif
#endif
}

// Reflected light of all lights, and of the environment. Neither includes emission.
Reflected reflect_lights(Reflector r, LightSum sum) {
    Reflected result;
    result.diffuse = r.diffuse * (sum.diffuse / kPi);
    result.specular = r.specular_0 * (sum.specular - sum.fresnel) + r.specular_90 * sum.fresnel;
#ifdef LAYER_SHEEN
    result.specular += r.sheen * sum.sheen;
#endif
#ifdef LAYER_COAT
    result.diffuse *= 1.0 - r.coat;
    result.specular = mix(result.specular, sum.coat, r.coat);
#endif
    return result;
}

// Emission that passes the clear coat.
vec3 visible_emission(SurfaceSample s, vec3 position_ws) {
#ifdef LAYER_COAT
    return s.emission * (1.0 - make_reflector(s, to_viewer(position_ws)).coat);
#else
    return s.emission;
#endif
}

// The fraction of uniform light that does not enter the surface.
float reflected_fraction(Reflector r) {
    float fraction = dot(r.mirror, vec3(1.0 / 3.0));
#ifdef LAYER_SHEEN
    fraction = mix(fraction, 1.0, largest(r.sheen) * min(r.sheen_albedo, 1.0));
#endif
#ifdef LAYER_COAT
    fraction = mix(fraction, 1.0, r.coat);
#endif
    return fraction;
}

// The normal by which the environment is mirrored. Anisotropic highlights stretch: bent toward the plane of the viewer
// and the direction across, as in the sample renderer of glTF.
vec3 mirror_normal(Reflector r, float roughness) {
#ifdef LAYER_ANISOTROPY
    vec3 across = cross(r.normal, r.along);
    vec3 bent = cross(cross(across, r.to_camera), across);
    float bend = 1.0 - r.stretch * (1.0 - roughness);
    vec3 n = mix(bent * inversesqrt(max(dot(bent, bent), 1e-12)), r.normal, bend * bend * bend * bend);
    return r.stretch > 0.0 ? n * inversesqrt(max(dot(n, n), 1e-12)) : r.normal;
#else
    return r.normal;
#endif
}

#if defined(LAYER_SHEEN) || defined(LAYER_COAT)
// Adds the layers over a base that is lit by the environment, whose light is multiplied by `passed`.
void add_layers_around(inout Reflected base, Reflector r, SurfaceSample s, vec3 position_ws, vec3 passed) {
#ifdef LAYER_SHEEN
    vec3 direction = reflect(-r.to_camera, r.normal);
    vec3 fibers = environment_light(position_ws, r.normal, direction, r.sheen_roughness).mirrored * passed;
    float albedo = min(r.sheen_albedo, 1.0);
    float below = 1.0 - largest(r.sheen) * albedo;
    base.diffuse *= below;
    base.specular = base.specular * below
                    + r.sheen * (albedo * specular_occlusion(r.n_v, s.occlusion, r.sheen_roughness)) * fibers;
#endif
#ifdef LAYER_COAT
    vec3 mirrored = reflect(-r.to_camera, r.coat_normal);
    vec3 coat = environment_light(position_ws, r.coat_normal, mirrored, r.coat_roughness).mirrored * passed;
    coat *= specular_occlusion(r.coat_n_v, s.occlusion, r.coat_roughness);
    base.diffuse *= 1.0 - r.coat;
    base.specular = mix(base.specular, coat, r.coat);
#endif
}
#endif

Reflected reflect_surroundings(Reflector r, SurfaceSample s, vec3 position_ws) {
    vec3 mirrored = reflect(-r.to_camera, mirror_normal(r, s.roughness));
    EnvironmentLight around = environment_light(position_ws, r.normal, mirrored, s.roughness);
#ifdef UNDER_WATER
    vec3 left = underwater_environment(position_ws);
    around.irradiance *= left;
    around.mirrored *= left;
#endif
    float open = specular_occlusion(r.n_v, s.occlusion, s.roughness);
    Reflected result;
#ifdef FOLD_LIGHT
    around.irradiance *= wall_light_around(r.open, r.diffuse);
    open *= r.open;
#endif
    result.diffuse = r.diffuse * (around.irradiance * s.occlusion);
    result.specular = r.mirror * around.mirrored * open;
#if defined(LAYER_SHEEN) || defined(LAYER_COAT)
#ifndef UNDER_WATER
    const vec3 left = vec3(1.0);
#endif
    add_layers_around(result, r, s, position_ws, left);
#endif
#ifdef OVER_WATER
    result.diffuse += r.diffuse * (mirrored_irradiance(position_ws, r.normal) / kPi);
#endif
    return result;
}

Reflected add_reflected(Reflected a, Reflected b) {
    return Reflected(a.diffuse + b.diffuse, a.specular + b.specular);
}

#ifdef BLENDED_SKIN
// Skin without its wrinkles.
SurfaceSample smooth_skin(SurfaceSample s) {
    s.normal_ws = s.smooth_normal_ws;
    return s;
}

// Blends the light of wrinkled and smooth skin, by SurfaceSample::raised (wrinkle.compression.bump-blend).
Reflected blend_skin(SurfaceSample s, Reflected wrinkled, Reflected smooth_light) {
    return Reflected(
        mix(smooth_light.diffuse, wrinkled.diffuse, s.raised), mix(smooth_light.specular, wrinkled.specular, s.raised));
}
#endif

// Darkens lit skin by its wrinkles (wrinkle.compression.alpha-shading).
Reflected shade_skin(SurfaceSample s, Reflected light) {
#ifdef SHADED_SKIN
    return Reflected(s.shade * light.diffuse, s.shade * light.specular);
#else
    return light;
#endif
}

// Light of lights and the environment, by the normal of `s` only.
Reflected reflect_by_normal(SurfaceSample s, vec3 position_ws, vec2 pixel, uvec2 list) {
    Reflector r = make_reflector(s, to_viewer(position_ws));
    LightSum sum = no_light();
    add_directional(sum, r, position_ws, pixel);
    add_listed(sum, r, list, position_ws, pixel);
    return add_reflected(reflect_lights(r, sum), reflect_surroundings(r, s, position_ws));
}

// Radiance toward the camera of a surface at `position_ws` in `pixel`, without its emission; `list` as in add_listed.
Reflected reflect_all(SurfaceSample s, vec3 position_ws, vec2 pixel, uvec2 list) {
    Reflected light = reflect_by_normal(s, position_ws, pixel, list);
#ifdef BLENDED_SKIN
    if (s.raised < 1.0) {
        light = blend_skin(s, light, reflect_by_normal(smooth_skin(s), position_ws, pixel, list));
    }
#endif
    return shade_skin(s, light);
}

// The environment's part of reflect_all().
Reflected reflect_around(SurfaceSample s, vec3 position_ws) {
    Reflected light = reflect_surroundings(make_reflector(s, to_viewer(position_ws)), s, position_ws);
#ifdef BLENDED_SKIN
    SurfaceSample skin = smooth_skin(s);
    light = blend_skin(s, light, reflect_surroundings(make_reflector(skin, to_viewer(position_ws)), skin, position_ws));
#endif
    return shade_skin(s, light);
}

// The light list of the cell of a pixel at a distance along the view axis.
uvec2 cell_list(vec2 pixel, float distance) {
#ifdef LOCAL_LIGHTS
    return texelFetch(light_cells, light_cell(pixel, distance)).xy;
#else
    return uvec2(0u);
#endif
}
