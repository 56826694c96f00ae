// All light that reaches a surface, and what a surface makes of it. Lights answer one question - from where and
// how much - and surfaces never ask for their type (light.interface). Definitions:
//   SPOT_LIGHTS     some light is a spot
//   CLASSIC_MODELS  some surface is Blinn or Phong
// Both only spare a software OpenGL work that nobody needs.

#include "lib/brdf.glsl"
#include "lib/gbuffer.glsl"
#include "lib/light.glsl"
#include "lib/reflection_map.glsl"
#include "lib/sky.glsl"
#include "lib/view.glsl"
#include "light_gpu.h"
#include "material_gpu.h"

layout(binding = 7) uniform sampler2D reflection_map;
layout(binding = 8) uniform sampler2D specular_albedo;       // (scale, bias) of f0 by n.v and roughness
layout(binding = 9) uniform samplerBuffer lights;            // LightRecord
layout(binding = 10) uniform usamplerBuffer light_indices;   // the lists of the grid's cells, one after the other
layout(binding = 11) uniform usamplerBuffer light_cells;     // begin and length of each cell's list
#ifdef CLASSIC_MODELS
layout(binding = 13) uniform samplerBuffer surface_materials;  // MaterialRecord
#endif

// ---- lights ----

struct Incoming {
    vec3 to_light;    // unit
    vec3 irradiance;  // on a plane that faces the light
};

Incoming incoming_directional(int index) {
    return Incoming(texelFetch(lights, index * int(kLightTexels)).xyz, texelFetch(lights, index * int(kLightTexels) + 1).rgb);
}

Incoming incoming_local(int index, vec3 position_ws, vec3 normal) {
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
    return Incoming(to_light, color.rgb * fade);
}

// Cell of the light grid that a pixel at a distance along the view axis belongs to.
int light_cell(vec2 pixel, float distance) {
    vec2 tile = floor(pixel / view.grid_cells.w);
    float slice = clamp(floor(log2(distance) * view.grid_depth.x + view.grid_depth.y), 0.0, view.grid_cells.z - 1.0);
    return int((slice * view.grid_cells.y + tile.y) * view.grid_cells.x + tile.x);
}

// ---- surfaces ----

// What of a surface stays the same for all lights.
struct Reflector {
    vec3 normal;
    vec3 to_camera;
    float n_v;
    float alpha2;      // roughness^4
    vec3 diffuse;      // albedo of the diffuse part, losses to the specular part taken off
    vec3 f0;           // reflectance head on; ks of the classic models
    vec3 given_back;   // factor that returns what single scattering lost
    vec3 mirror;       // share of uniform surroundings that the specular part returns
    float lit;         // 0: Unlit
    float classic;     // 0: Pbr, 1: Blinn, 2: Phong
    float shininess;
};

Reflector make_reflector(SurfaceSample s, vec3 to_camera) {
    Reflector r;
    r.normal = s.normal_ws;
    r.to_camera = to_camera;
    // Normal maps and interpolation turn some normals away from the viewer: taken as seen edge on.
    r.n_v = max(dot(s.normal_ws, to_camera), 1e-3);
    float roughness = max(s.roughness, kMinRoughness);
    r.alpha2 = roughness * roughness * roughness * roughness;
    r.f0 = mix(vec3(0.04), s.albedo, s.metalness);

    vec2 size = vec2(textureSize(specular_albedo, 0));
    vec2 fit = texture(specular_albedo, (vec2(min(r.n_v, 1.0), s.roughness) * (size - 1.0) + 0.5) / size).rg;
    // Turquin, "Practical Multiple Scattering Compensation for Microfacet Models", 2019.
    r.given_back = 1.0 + r.f0 * (1.0 / (fit.x + fit.y) - 1.0);
    r.mirror = (r.f0 * fit.x + fit.y) * r.given_back;
    r.diffuse = s.albedo * (1.0 - s.metalness) * (1.0 - r.mirror);
    r.lit = s.model == kModelUnlit ? 0.0 : 1.0;
    r.classic = 0.0;
    r.shininess = 1.0;
#ifdef CLASSIC_MODELS
    if (s.model == kModelBlinn || s.model == kModelPhong) {
        vec4 specular = texelFetch(surface_materials, int(s.material * kMaterialTexels) + 3);
        r.classic = s.model == kModelBlinn ? 1.0 : 2.0;
        r.f0 = specular.rgb;
        r.shininess = specular.a;
        r.given_back = vec3(1.0);
        r.mirror = vec3(0.0);
        r.diffuse = s.albedo;
    }
#endif
    return r;
}

// Sums over lights, before the material's factors (light.multi).
struct LightSum {
    vec3 diffuse;   // E n.l
    vec3 specular;  // E lobe, to be multiplied by f0
    vec3 fresnel;   // E lobe (1 - v.h)^5, to be multiplied by 1 - f0
};

void add_light(inout LightSum sum, Reflector r, Incoming light) {
    float n_l = max(dot(r.normal, light.to_light), 0.0);
    float l_v = dot(light.to_light, r.to_camera);
    vec2 h = half_cosines(n_l, r.n_v, l_v);  // n.h, v.h
    float lobe = ggx_lobe(n_l, r.n_v, h.x, r.alpha2);
    float p = schlick_weight(h.y);
#ifdef CLASSIC_MODELS
    float n_v = dot(r.normal, r.to_camera);
    vec2 true_h = half_cosines(n_l, n_v, l_v);
    float r_v = 2.0 * n_l * n_v - l_v;
    float classic = lit(n_l, r.classic > 1.5 ? r_v : true_h.x, r.shininess).z / kPi;
    lobe = r.classic > 0.5 ? classic : lobe;
    p = r.classic > 0.5 ? 0.0 : p;
#endif
    sum.diffuse += light.irradiance * n_l;
    sum.specular += light.irradiance * lobe;
    sum.fresnel += light.irradiance * (lobe * p);
}

struct Reflected {
    vec3 diffuse;
    vec3 specular;
};

// Share of the mirrored surroundings that a hole of this openness lets through (Lagarde and de Rousiers 2014).
float specular_occlusion(float n_v, float occlusion, float roughness) {
    return clamp(pow(n_v + occlusion, exp2(-16.0 * roughness - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
}

// Radiance toward the camera of a surface at `position_ws`, seen through `pixel`, without its emission.
Reflected reflect_all(SurfaceSample s, vec3 position_ws, vec2 pixel, float distance) {
    Reflector r = make_reflector(s, normalize(view.camera_ws.xyz - position_ws));
    LightSum sum = LightSum(vec3(0.0), vec3(0.0), vec3(0.0));

    int directional = int(view.grid_depth.z);
    for (int i = 0; i < directional; ++i) {
        add_light(sum, r, incoming_directional(i));
    }
    uvec2 list = texelFetch(light_cells, light_cell(pixel, distance)).xy;
    for (uint i = 0u; i < list.y; ++i) {
        int index = int(texelFetch(light_indices, int(list.x + i)).x);
        add_light(sum, r, incoming_local(index, position_ws, r.normal));
    }

    vec3 mirrored = reflected_radiance(
        reflection_map, environment.reflection.xy, reflect(-r.to_camera, r.normal), s.roughness);
    vec3 ambient = environment_irradiance(r.normal) * s.occlusion;
    float open = specular_occlusion(r.n_v, s.occlusion, s.roughness);

    Reflected result;
    result.diffuse = r.lit * r.diffuse * (sum.diffuse / kPi + ambient);
    result.specular = r.lit
                      * (r.given_back * (r.f0 * (sum.specular - sum.fresnel) + sum.fresnel)
                         + r.mirror * mirrored * open);
    return result;
}
