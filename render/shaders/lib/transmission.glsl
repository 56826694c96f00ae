// Transmission through a clear medium: the image behind it, displaced as by a slab of its thickness, blurred by its
// roughness, and tinted by absorption (M. McGuire and M. Mara, "Phenomenological Transparency", 2017; thickness as in
// KHR_materials_volume). Surfaces within the medium, such as an iris beneath its cornea, appear where the refracted ray
// hits them. Off screen the environment is used. Definition REFRACTION: the medium has a thickness. Include after
// lib/lighting.glsl and lib/material.glsl. DISPERSION: its refractive index differs for red, green and blue
// (KHR_materials_dispersion).
// Techniques: shade.dispersion
// Source of shade.dispersion: KHR_materials_dispersion

#include "lib/optics.glsl"
#include "material_clear_gpu.h"

layout(binding = kBehindClearUnit) uniform sampler2D behind_radiance;  // with mip levels
layout(binding = kBehindClearDepthUnit) uniform sampler2D behind_depth;

layout(location = 9) flat in float scale;

const float kBorder = 0.04;  // fraction of the image over which it fades into the environment

struct ClearMedium {
    float transmission;
    float index;      // of refraction
    float thickness;  // [m]
    vec3 absorption;  // [1/m]
    float dispersion; // 20 / Abbe number
};
ClearMedium clear_medium(uint material) {
    vec4 medium = block_texel(material, kClearBlock, 0);
    vec3 absorption = block_texel(material, kClearBlock, 1).rgb;
    float transmission = medium.x;
    float thickness = medium.z * scale;
#ifdef TRANSMISSION_MAP
    transmission *= MAP_TEXEL(TRANSMISSION_MAP, kTransmissionSlot).r;
#endif
#ifdef THICKNESS_MAP
    thickness *= MAP_TEXEL(THICKNESS_MAP, kThicknessSlot).g;
#endif
    return ClearMedium(transmission, medium.y, thickness, absorption, medium.w);
}

// The image behind at `uv`, averaged over `diameter` pixels: four bilinear samples hide the texels of a mip level.
vec3 blurred_behind(vec2 uv, float diameter) {
    float level = log2(max(diameter, 1.0));
    if (level <= 0.0) {
        return textureLod(behind_radiance, uv, 0.0).rgb;
    }
    vec2 half_texel = 0.5 * min(exp2(level), diameter) * view.size.zw;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 corner = vec2(i & 1, i >> 1) * 2.0 - 1.0;
        sum += textureLod(behind_radiance, uv + corner * half_texel, max(level - 0.5, 0.0)).rgb;
    }
    return 0.25 * sum;
}

#ifdef REFRACTION
vec3 clip_of(vec3 position) {
    return (view.clip_from_world * vec4(position, 1.0)).xyw;
}

// Distance that a ray from `position`, at view distance `here`, travels inside: to the surface that it hits, at most
// `thickness`. Fixed-point iteration on the image behind, starting straight ahead. Fails if nearer surfaces hide the
// hit.
float distance_inside(vec3 position, vec3 inside, float here, float thickness) {
    const int kSteps = 5;
    float deeper = clip_of(position + inside).z - here;  // along the view axis, by a unit of the ray
    vec2 uv = gl_FragCoord.xy * view.size.zw;
    float path = thickness;
    for (int i = 0; i < kSteps; ++i) {
        float depth = textureLod(behind_depth, uv, 0.0).r;
        float behind = depth > 0.0 ? view_distance(depth) - here : 0.0;
        path = behind > 0.0 && deeper > 0.0 ? min(behind / deeper, thickness) : thickness;
        vec3 clip = clip_of(position + path * inside);
        uv = clip.xy / max(clip.z, 1e-6) * 0.5 + 0.5;
    }
    return path;
}
#endif

// Radiance through a medium of this refractive index, before absorption.
vec3 refracted_radiance(
    float index, float thickness, vec3 position, vec3 normal, vec3 to_camera, float roughness) {
    vec2 here_uv = gl_FragCoord.xy * view.size.zw;
    float here = view_distance(gl_FragCoord.z);
#ifdef REFRACTION
    vec3 inside = refract_ray(normal, to_camera, 1.0 / index);
    float path = distance_inside(position, inside, here, thickness);
    vec3 clip = clip_of(position + path * inside);
    vec2 uv = clip.xy / max(clip.z, 1e-6) * 0.5 + 0.5;
    float depth = textureLod(behind_depth, uv, 0.0).r;
    bool in_front = depth > 0.0 && view_distance(depth) < here;  // surfaces in front of the medium are not behind it
    uv = in_front ? here_uv : uv;
    float turn = index - 1.0;  // deflection of a refracted ray per unit of slope
#else
    vec2 uv = here_uv;
    const float turn = 0.5;  // like glass
#endif
    float depth_behind = textureLod(behind_depth, uv, 0.0).r;
    // Distance to the surface behind, relative to its depth.
    float gap = depth_behind > 0.0 ? max(1.0 - here * depth_behind / view.camera_ws.w, 0.0) : 1.0;
    float pixel = 2.0 * length(view.ray_up.xyz) * view.size.w;  // at 1 m
    vec3 transmitted = blurred_behind(uv, 2.0 * roughness * roughness * turn * gap / pixel);
#ifdef REFRACTION
    vec2 inward = min(uv, 1.0 - uv) / kBorder;
    float shown = in_front ? 1.0 : clip.z > 0.0 ? clamp(min(inward.x, inward.y), 0.0, 1.0) : 0.0;
    if (shown < 1.0) {
        transmitted = mix(environment_light(position, normal, inside, roughness).mirrored, transmitted, shown);
    }
#endif
    return transmitted;
}

// Radiance through the medium, before the Fresnel reflection at its front. `normal` faces the viewer.
vec3 transmitted_radiance(ClearMedium medium, vec3 position, vec3 normal, vec3 to_camera, float roughness) {
#ifdef DISPERSION
    float spread = (medium.index - 1.0) * 0.025 * medium.dispersion;
    vec3 transmitted;
    for (int c = 0; c < 3; ++c) {
        float index = max(medium.index + spread * (float(c) - 1.0), 1.0);
        transmitted[c] = refracted_radiance(index, medium.thickness, position, normal, to_camera, roughness)[c];
    }
#else
    vec3 transmitted =
        refracted_radiance(medium.index, medium.thickness, position, normal, to_camera, roughness);
#endif
    return transmitted * exp(-medium.absorption * medium.thickness);
}
