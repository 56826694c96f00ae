// The surface of a material at a point: factors times textures. Which textures there are is fixed when the
// program is compiled, since a software OpenGL pays for both sides of every branch:
//   BASE_COLOR_MAP METAL_ROUGH_MAP NORMAL_MAP OCCLUSION_MAP EMISSION_MAP
//   VERTEX_COLOR   the mesh has colors
//   UV_MAPS        a texture has its own uv set or transform; otherwise all use the first set as it is
//   DOUBLE_SIDED   seen from behind, the normal turns to the viewer

#include "lib/gbuffer.glsl"
#include "material_gpu.h"

layout(binding = 0) uniform sampler2D base_color_map;
layout(binding = 1) uniform sampler2D metal_rough_map;  // g, b
layout(binding = 2) uniform sampler2D normal_map;       // tangent space, green up
layout(binding = 3) uniform sampler2D occlusion_map;    // r
layout(binding = 4) uniform sampler2D emission_map;
layout(binding = 12) uniform samplerBuffer materials;   // MaterialRecord

layout(location = 0) in vec3 normal_ws;
layout(location = 1) in vec4 tangent_ws;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 vertex_color;
layout(location = 4) flat in uvec2 material_and_flags;

vec4 material_texel(int i) {
    return texelFetch(materials, int(material_and_flags.x * kMaterialTexels) + i);
}

// Texture coordinates of texture `slot` (base color 0 .. emission 4).
vec2 slot_uv(int slot) {
#ifdef UV_MAPS
    vec4 rows = material_texel(5 + 2 * slot);
    vec4 offset = material_texel(6 + 2 * slot);
    vec2 set = offset.z > 0.5 ? uv.zw : uv.xy;
    return vec2(dot(rows.xy, set), dot(rows.zw, set)) + offset.xy;
#else
    return uv.xy;
#endif
}

vec4 surface_color() {
    vec4 color = material_texel(0);
#ifdef BASE_COLOR_MAP
    color *= texture(base_color_map, slot_uv(0));
#endif
#ifdef VERTEX_COLOR
    color *= vertex_color;
#endif
    return color;
}

vec3 surface_normal(float strength) {
    vec3 n = normal_ws;
#ifdef NORMAL_MAP
    vec3 n_ts = texture(normal_map, slot_uv(2)).xyz * 2.0 - 1.0;
    vec3 bitangent = cross(normal_ws, tangent_ws.xyz) * tangent_ws.w;
    n = n_ts.x * strength * tangent_ws.xyz + n_ts.y * strength * bitangent + n_ts.z * normal_ws;
#endif
    n *= inversesqrt(max(dot(n, n), 1e-20));
#ifdef DOUBLE_SIDED
    // The rasterizer knows the winding on the screen; a mirrored instance has turned it.
    if (gl_FrontFacing == ((material_and_flags.y & 1u) != 0u)) {
        n = -n;
    }
#endif
    return n;
}

// Where a normal map changes within a pixel, the lobe is widened by as much: no sparkle. Curved meshes are left
// sharp, since the same roughness blurs what they mirror.
// Tokuyoshi and Kaplanyan, "Improved Geometric Specular Antialiasing", 2019.
float widen_roughness(float roughness, vec3 normal) {
#ifdef NORMAL_MAP
    vec3 dx = dFdx(normal);
    vec3 dy = dFdy(normal);
    float variance = 0.159 * (dot(dx, dx) + dot(dy, dy));
    float alpha = roughness * roughness;
    roughness = sqrt(sqrt(clamp(alpha * alpha + min(2.0 * variance, 0.18), 0.0, 1.0)));
#endif
    return roughness;
}

SurfaceSample surface_sample(vec3 albedo) {
    vec4 emission = material_texel(1);
    vec4 factors = material_texel(2);
    SurfaceSample s;
    s.normal_ws = surface_normal(emission.w);
    s.albedo = albedo;
    s.emission = emission.rgb;
    s.metalness = factors.x;
    s.roughness = factors.y;
    s.occlusion = 1.0;
    s.material = material_and_flags.x;
    s.model = uint(material_texel(4).x);
#ifdef METAL_ROUGH_MAP
    vec2 rough_metal = texture(metal_rough_map, slot_uv(1)).gb;
    s.roughness *= rough_metal.x;
    s.metalness *= rough_metal.y;
#endif
#ifdef OCCLUSION_MAP
    s.occlusion = 1.0 + factors.z * (texture(occlusion_map, slot_uv(3)).r - 1.0);
#endif
#ifdef EMISSION_MAP
    s.emission *= texture(emission_map, slot_uv(4)).rgb;
#endif
    s.roughness = widen_roughness(s.roughness, s.normal_ws);
    if (s.model == kModelUnlit) {
        s.emission += s.albedo;
        s.albedo = vec3(0.0);
    }
    return s;
}
