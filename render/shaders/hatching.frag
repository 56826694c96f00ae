// Replaces the shade of surfaces with the shading model Toon by strokes (hatching_pass.h).
// Techniques: tex.hatching
#version 450
#include "fullscreen_gpu.h"
#include "lib/stored_surface.glsl"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;

uniform vec4 ink;     // color; w: opacity
uniform float white;  // luminance of white without strokes
uniform float wash;   // how much of the shading stays

layout(location = 0) out vec4 radiance;

const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);
const float kStrokeRim = 0.2;  // range of tones over which a stroke appears

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 scene = texelFetch(scene_radiance, pixel, 0);
    bool has_surface = texelFetch(scene_depth, pixel, 0).r > 0.0;
    SurfaceSample s = unpack_surface(texelFetch(gbuffer, pixel, 0));
    vec3 flat_color = max(s.albedo, vec3(0.02)) * white + s.emission;
    // Perceived, so that half of the strokes are in the middle of what looks half dark.
    float tone = sqrt(clamp(dot(scene.rgb, kLuminance) / max(dot(flat_color, kLuminance), 1e-6), 0.0, 1.0));
    float stroke = clamp((s.metalness - tone) / kStrokeRim, 0.0, 1.0);
    vec3 drawn = mix(mix(flat_color, scene.rgb, wash), ink.rgb, ink.a * stroke);
    radiance = vec4(has_surface && s.model == kModelToon ? drawn : scene.rgb, scene.a);
}
