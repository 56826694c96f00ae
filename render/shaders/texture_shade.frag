// Skin lit in texture space: Blinn's highlight, a directional light and a directional view that are fixed to the camera
// (Bando 2001, 4.2).
// Techniques: wrinkle.furrow.texture-space-shading
#version 450
#include "lib/tone.glsl"
#include "texture_shade_gpu.h"

layout(binding = kShadedNormalsUnit) uniform sampler2D normals;  // s to the right, t up, outwards
layout(binding = kShadedColorUnit) uniform sampler2D surface;  // its color

uniform vec2 size;              // of the target [px]
uniform mat3 camera_from_mesh;  // may scale
uniform vec3 to_light;          // in camera space, unit
uniform vec3 strengths;         // ambient, light, specular
uniform float shininess;
uniform bool unrolled;  // normals are those of a cylinder
uniform bool encoded;   // the target is sRGB

layout(location = 0) out vec4 color;

const float kTurn = 6.28318530717959;
const vec3 kToCamera = vec3(0.0, 0.0, 1.0);

// A normal at the angle `s` around a cylinder, rolled up.
vec3 roll_up(vec3 n, float s) {
    return vec3(n.x * cos(s) + n.z * sin(s), n.y, n.z * cos(s) - n.x * sin(s));
}

void main() {
    vec2 uv = gl_FragCoord.xy / size;
    vec3 n = 2.0 * textureLod(normals, uv, 0.0).xyz - 1.0;
    n = normalize(camera_from_mesh * (unrolled ? roll_up(n, kTurn * uv.x) : n));
    vec3 reflectance = textureLod(surface, uv, 0.0).rgb;

    float facing = dot(n, to_light);
    vec3 halfway = normalize(to_light + kToCamera + vec3(0.0, 0.0, 1e-6));
    float highlight = facing > 0.0 ? pow(max(dot(n, halfway), 0.0), shininess) : 0.0;
    vec3 lit = reflectance * (strengths.x + strengths.y * max(facing, 0.0)) + strengths.y * strengths.z * highlight;
    color = vec4(encoded ? srgb_encode(clamp(lit, 0.0, 1.0)) : lit, 1.0);
}
