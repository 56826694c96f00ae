// Attributes of opaque surfaces. Definitions of lib/material.glsl, and
//   ALPHA_MASK  holes where the opacity is below the cutoff
//   VELOCITY    motion since the previous frame, as a difference of texture coordinates (current - previous)
//   MATERIAL_RECORDS  also the index of the material
//   LAYER_TARGETS  with MATERIAL_RECORDS: also the layers of materials that have some
//   KEY_SHADOWS  also the visibility of the key lights (lib/key_lights.glsl)
//   HATCHED     strokes of hatching
// Techniques: deferred.gbuffer
#version 450
#include "lib/view.glsl"
#include "lib/material.glsl"

#ifdef VELOCITY
#include "lib/velocity.glsl"
layout(location = 5) in vec3 previous_clip;
layout(location = 1) out vec2 velocity;
#endif
layout(location = 0) out uvec4 surface;
#ifdef MATERIAL_RECORDS
#ifdef VELOCITY
const int kMaterialLocation = 2;
#else
const int kMaterialLocation = 1;
#endif
#ifdef LAYER_TARGETS
layout(location = kMaterialLocation) out uvec2 material;
#else
layout(location = kMaterialLocation) out uint material;
#endif
#if defined(LAYER_TARGETS) && defined(LAYERED)
layout(location = kMaterialLocation + 1) out uvec4 layers;
#endif
#endif
#ifdef KEY_SHADOWS
#if defined(MATERIAL_RECORDS) && defined(LAYER_TARGETS)
layout(location = kMaterialLocation + 2) out vec2 key_light;
#elif defined(MATERIAL_RECORDS)
layout(location = kMaterialLocation + 1) out vec2 key_light;
#elif defined(VELOCITY)
layout(location = 2) out vec2 key_light;
#else
layout(location = 1) out vec2 key_light;
#endif
#endif

void main() {
    vec4 color = surface_color();
    SurfaceSample s = surface_sample(color.rgb);
    surface = pack_surface(s);
#if defined(MATERIAL_RECORDS) && defined(LAYER_TARGETS)
    material = uvec2(material_and_flags.x, 0u);
#ifdef LAYERED
    PackedLayers stored = pack_layers(s.layers, surface.x);
    layers = stored.bits;
    material.y = stored.more;
#endif
#elif defined(MATERIAL_RECORDS)
    material = material_and_flags.x;
#endif
#ifdef KEY_SHADOWS
    key_light = s.key_visibility;
#endif
#ifdef VELOCITY
    vec2 now_ndc = gl_FragCoord.xy * view.size.zw * 2.0 - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
    vec3 previous = previous_clip;
#ifdef OFF_MESH
    previous += (view.previous_clip_from_world * vec4(surface_offset, 0.0)).xyw;
#endif
    velocity = velocity_from(now_ndc, previous, view.size.xy);
#endif
    cut_surface(color.a);
}
