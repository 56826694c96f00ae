// Reflection of incoming light by a surface. Lights are reduced to direction and irradiance, whatever their type
// (light.interface). A shading model is a file shade_<model>.glsl and a row of the table in render/material/shading_models.h.
// The file has
//
//     void prepare_<model>(inout Reflector r, SurfaceSample s)  terms that are the same for all lights
//     Response lobe_<lobe>(Reflector r, Cosines c)              reflection of one light; models may share it
//
// prepare_pbr() has run before the prepare function of any other model. SHADE_<MODEL> is defined if some surface may
// use the model; that only saves a software OpenGL needless work. SHADING_LOBE, a lobe_number(), is defined if all
// surfaces have this lobe. SMOOTH_NORMALS is defined if some skin is lit by its
// normal without wrinkles, too; BLENDED_SKIN, if light of both is blended; FOLD_LIGHT, if it bounces within folds.
// Techniques: bump.self-shadow, bump.self-shadow-smooth, light.interface, light.phong-pixel, wrinkle.compression.lighting, wrinkle.fold-light

#include "lib/brdf.glsl"
#include "lib/fold_light.glsl"
#include "lib/gbuffer.glsl"
#include "lib/hair.glsl"

struct Incoming {
    vec3 to_light;    // unit
    vec3 irradiance;  // on a plane that faces the light
    vec3 unshadowed;  // the same without occluders
};

// The terms of a surface that are the same for all lights.
struct Reflector {
    vec3 normal;
    vec3 to_camera;
    float n_v;
    uint model;        // kModel*
    float alpha2;      // roughness^4
    vec3 diffuse;      // albedo of the diffuse part, less the reflectance of the specular part
    vec3 specular_0;   // reflectance at normal incidence, with multiple scattering; factor of Response::specular
    vec3 specular_90;  // the same at grazing angles; factor of Response::fresnel
    vec3 mirror;       // specular reflectance for a uniform environment
    vec4 own;          // parameters of the lobe, defined by its file
#ifdef SHADE_SUBSURFACE
    vec3 diffusion;    // d of the profile of Subsurface [m]
#endif
#ifdef SHADE_HAIR
    HairLobes hair;
#endif
#ifdef LAYER_ANISOTROPY
    vec3 along;        // unit, in the surface
    vec2 alphas;       // along it and across
    float stretch;     // anisotropy
#endif
#ifdef LAYER_SHEEN
    vec3 sheen;
    float sheen_roughness;
    float sheen_albedo;  // of white sheen, toward the camera; may exceed 1
#endif
#ifdef LAYER_COAT
    vec3 coat_normal;
    float coat_n_v;
    float coat_roughness;
    float coat_alpha2;
    float coat;        // reflectance of the clear coat, 0 without one
#endif
#ifdef SMOOTH_NORMALS
    vec4 fading;       // normal without wrinkles or bumps; w: how light that grazes it fades, see smooth_fade()
#endif
#ifdef KEY_SHADOWS
    vec2 key_visibility;
#endif
#ifdef FOLD_LIGHT
    float open;        // of the fold that light bounces in, > 0 (lib/fold_light.glsl); 1: none
#endif
};

// Between normal, light, viewer and the half vector h; and where the light is.
struct Cosines {
    float n_l;  // >= 0
    float n_h;
    float v_h;
    float l_v;
    vec3 to_light;  // unit
};

// Reflection of an irradiance of 1, before the factors of the Reflector.
struct Response {
    vec3 diffuse;    // n.l
    float specular;  // lobe
    float fresnel;   // lobe (1 - v.h)^5, the part of it with grazing reflectance
};

#include "generated/model_functions.glsl"

const float kMinOpen = 0.05;

Reflector make_reflector(SurfaceSample s, vec3 to_camera) {
    Reflector r;
    r.normal = s.normal_ws;
    r.to_camera = to_camera;
    // Normal maps and interpolation turn some normals away from the viewer: treated as grazing.
    r.n_v = max(dot(s.normal_ws, to_camera), 1e-3);
    r.model = s.model;
    r.own = vec4(0.0);
#ifdef SHADE_SUBSURFACE
    r.diffusion = vec3(0.0);
#endif
#ifdef SHADE_HAIR
    r.hair.density = 0.0;
#endif
#ifdef SMOOTH_NORMALS
    r.fading = vec4(s.smooth_normal_ws, s.bump_shadow > 0u ? 1.0 + float(s.bump_shadow) : s.fades ? 1.0 : 0.0);
#endif
#ifdef FOLD_LIGHT
    r.open = s.bounces ? clamp(dot(s.normal_ws, s.smooth_normal_ws), kMinOpen, 1.0) : 1.0;
#endif
#ifdef KEY_SHADOWS
    r.key_visibility = s.key_visibility;
#endif
#ifdef LAYER_ANISOTROPY
    r.along = vec3(0.0);
    r.alphas = vec2(1.0);
    r.stretch = 0.0;
#endif
#ifdef LAYER_SHEEN
    r.sheen = vec3(0.0);
    r.sheen_roughness = 1.0;
    r.sheen_albedo = 0.0;
#endif
#ifdef LAYER_COAT
    r.coat_normal = s.normal_ws;
    r.coat_n_v = 1.0;
    r.coat_roughness = 1.0;
    r.coat_alpha2 = 1.0;
    r.coat = 0.0;
#endif
    prepare_model(r, s);
    return r;
}

// Normal of the skin as in its shadow maps, without the folds that light bounces in.
vec3 body_normal(Reflector r) {
#ifdef FOLD_LIGHT
    return r.open < 1.0 ? r.fading.xyz : r.normal;
#else
    return r.normal;
#endif
}

// Sums over lights, before the material's factors (light.multi).
struct LightSum {
    vec3 diffuse;
    vec3 specular;
    vec3 fresnel;
#ifdef LAYER_SHEEN
    vec3 sheen;
#endif
#ifdef LAYER_COAT
    vec3 coat;
#endif
};

LightSum no_light() {
    LightSum sum;
    sum.diffuse = vec3(0.0);
    sum.specular = vec3(0.0);
    sum.fresnel = vec3(0.0);
#ifdef LAYER_SHEEN
    sum.sheen = vec3(0.0);
#endif
#ifdef LAYER_COAT
    sum.coat = vec3(0.0);
#endif
    return sum;
}

#ifdef SMOOTH_NORMALS
// Fade of light on wrinkled skin by the cosine at the skin without wrinkles: its back is unlit, and highlights of
// single slopes do not pop up where it turns to the light (wrinkle.compression.lighting).
float grazing_fade(float cosine) {
    return clamp(8.0 * cosine, 0.0, 1.0);
}

// Fade of light by the cosine at the normal without wrinkles or bumps; how: 0 none, 1 grazing_fade(), 1 + kBumpGated,
// 1 + kBumpSmoothed.
float smooth_fade(float how, float cosine) {
    float fade = mix(1.0, grazing_fade(cosine), min(how, 1.0));
    fade = how > 1.5 ? (cosine > 0.0 ? 1.0 : 0.0) : fade;
    return how > 2.5 ? max(cosine, 0.0) : fade;
}
#endif

#ifdef SHADE_TOON
// Of the light, how much is not shadowed.
float visible_fraction(Incoming light) {
    float all = dot(light.unshadowed, vec3(1.0));
    return min(dot(light.irradiance, vec3(1.0)) / max(all, 1e-20), 1.0);
}
#endif

void add_light(inout LightSum sum, Reflector r, Incoming light) {
    float n_l = max(dot(r.normal, light.to_light), 0.0);
    float l_v = dot(light.to_light, r.to_camera);
    vec2 h = half_cosines(n_l, r.n_v, l_v);
#ifdef SMOOTH_NORMALS
    light.irradiance *= smooth_fade(r.fading.w, dot(r.fading.xyz, light.to_light));
#endif
#ifdef SHADE_TOON
    // Shadows move light down the ramp instead of darkening its color.
    if (r.model == kModelToon) {
        n_l *= visible_fraction(light);
        light.irradiance = light.unshadowed;
    }
#endif
    Response response = model_response(r, Cosines(n_l, h.x, h.y, l_v, light.to_light));
#ifdef FOLD_LIGHT
    if (r.open < 1.0) {
        vec2 walls = wall_cosines(r.open, n_l, dot(r.fading.xyz, light.to_light));
        float lit = walls.x / max(n_l, 1e-4);
        response.diffuse = wall_light(r.open, r.diffuse, lit * response.diffuse, walls.y);
        response.specular *= lit;
        response.fresnel *= lit;
    }
#endif
    sum.diffuse += light.irradiance * response.diffuse;
    sum.specular += light.irradiance * response.specular;
    sum.fresnel += light.irradiance * response.fresnel;
#ifdef LAYER_SHEEN
    float fibers = sheen_lobe(n_l, r.n_v, h.x, r.sheen_roughness * r.sheen_roughness);
    fibers *= sheen_dimming(r.sheen_albedo, sheen_reflectance(n_l, r.sheen_roughness));
    sum.sheen += light.irradiance * fibers;
#endif
#ifdef LAYER_COAT
    float coat_n_l = max(dot(r.coat_normal, light.to_light), 0.0);
    vec2 coat_h = half_cosines(coat_n_l, r.coat_n_v, l_v);
    sum.coat += light.irradiance * ggx_lobe(coat_n_l, r.coat_n_v, coat_h.x, r.coat_alpha2);
#endif
}

struct Reflected {
    vec3 diffuse;
    vec3 specular;
};
