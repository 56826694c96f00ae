// Light of lamps that the fog in front of surfaces and the sky scatters (render/environment/airlight_pass.h).
// Techniques: light.airlight
#version 450
#include "lib/view.glsl"
#include "lib/height_fog.glsl"
#include "lib/light.glsl"
#include "airlight_gpu.h"

layout(binding = kAirlightDepthUnit) uniform sampler2D scene_depth;
layout(binding = kAirlightUnit) uniform samplerBuffer lights;

layout(location = 0) out vec4 radiance;

const float kFarthest = 1e4;     // of scattered light, where a light is unbounded [m]
const float kLampRadius = 0.02;  // closer to a light, it does not grow brighter [m]

// Gauss-Legendre quadrature on -1 .. 1.
const int kNodes = 7;
const float kNode[kNodes] = float[](-0.9491079, -0.7415312, -0.4058452, 0.0, 0.4058452, 0.7415312, 0.9491079);
const float kWeight[kNodes] = float[](0.1294850, 0.2797054, 0.3818301, 0.4179592, 0.3818301, 0.2797054, 0.1294850);

// Cuts `span` to the part of the ray inside a sphere; `offset`: from the ray's origin to its center.
vec2 cut_to_sphere(vec2 span, vec3 offset, vec3 direction, float radius) {
    float middle = dot(offset, direction);
    float squared = radius * radius - dot(offset, offset) + middle * middle;
    float half_chord = sqrt(max(squared, 0.0));
    return squared > 0.0 ? vec2(max(span.x, middle - half_chord), min(span.y, middle + half_chord)) : vec2(0.0);
}

// Cuts `span` to a cone of less than 180 degrees with its apex at `offset`.
vec2 cut_to_cone(vec2 span, vec3 offset, vec3 direction, vec3 axis, float cosine) {
    float along = dot(direction, axis);
    float start = -dot(offset, axis);
    float cosine2 = cosine * cosine;
    float a = along * along - cosine2;
    float b = along * start + cosine2 * dot(direction, offset);
    float c = start * start - cosine2 * dot(offset, offset);
    float squared = b * b - a * c;
    if (squared <= 0.0) {
        return a > 0.0 ? span : vec2(0.0);
    }
    float root = sqrt(squared);
    if (a < 0.0) {  // enters and leaves, in front of the apex or behind it
        vec2 cut = vec2(max(span.x, (-b + root) / a), min(span.y, (-b - root) / a));
        return start + along * 0.5 * (cut.x + cut.y) > 0.0 ? cut : vec2(0.0);
    }
    a = max(a, 1e-6);
    return along > 0.0 ? vec2(max(span.x, (-b + root) / a), span.y) : vec2(span.x, min(span.y, (-b - root) / a));
}

// Optical depth from a point where the extinction is `extinction` along `ray` [m].
float optical_depth(float extinction, vec3 ray) {
    float x = height_fog.density.y * ray.y;
    float mean = abs(x) < 1e-2 ? 1.0 - x * (0.5 - x / 6.0) : (1.0 - exp(min(-x, kMaxOpticalDepth))) / x;
    return extinction * length(ray) * mean;
}

vec3 scattered_light(int first, vec3 direction, float path) {
    vec4 position = texelFetch(lights, first);
    vec4 color = texelFetch(lights, first + 1);
    vec4 polynomial = texelFetch(lights, first + 2);
    vec4 axis = texelFetch(lights, first + 3);
    vec4 cone = texelFetch(lights, first + 4);
    vec3 offset = position.xyz - view.camera_ws.xyz;
    vec2 span = vec2(0.0, min(path, kFarthest));
    if (position.w > 0.0) {
        span = cut_to_sphere(span, offset, direction, inversesqrt(position.w));
    }
    if (cone.w > 0.0) {
        span = cut_to_cone(span, offset, direction, cone.xyz, cone.w);
    }
    if (span.y <= span.x) {
        return vec3(0.0);
    }
    float middle = dot(offset, direction);
    float beside = sqrt(max(dot(offset, offset) - middle * middle, kLampRadius * kLampRadius));
    // The angle is measured from the start of the span: seen from an eye inside a beam, both ends lie almost at a
    // right angle, where a tangent has no precision.
    vec2 ends = (span - middle) / beside;
    float half_angle = 0.5 * atan(ends.y - ends.x, 1.0 + ends.x * ends.y);
    float sum = 0.0;
    for (int i = 0; i < kNodes; ++i) {
        float angle = half_angle * (1.0 + kNode[i]);
        float behind = beside * (ends.x * cos(angle) + sin(angle)) / max(cos(angle) - ends.x * sin(angle), 1e-6);
        float t = middle + behind;
        float d2 = beside * beside + behind * behind;
        vec3 to_light = offset - t * direction;
        vec3 unit = to_light * inversesqrt(max(dot(to_light, to_light), 1e-12));
        float thicker = min(-height_fog.density.y * direction.y * t, kMaxOpticalDepth);
        float extinction = height_fog.density.x * exp(thicker);
        float depth = fog_optical_depth(direction.y, t) + optical_depth(extinction, to_light);
        float light = distance_attenuation(d2, position.w, polynomial.xyz, color.w)
                      * spot_attenuation(unit, axis.xyz, axis.w, polynomial.w);
        float scattering = height_fog.density.x * exp(thicker - depth);  // one exponential: neither overflows alone
        sum += kWeight[i] * light * d2 * (scattering * fog_phase(dot(direction, unit)));
    }
    return color.rgb * (sum * half_angle / beside);
}

void main() {
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec3 ray = view_ray(gl_FragCoord.xy);
    float path = depth > 0.0 ? view_distance(depth) * length(ray) - view.orthographic.x : kFarthest;
    vec3 direction = normalize(ray);
    vec3 sum = vec3(0.0);
    int count = int(texelFetch(lights, 0).x);
    for (int i = 0; i < count; ++i) {
        sum += scattered_light(1 + i * int(kAirlightTexels), direction, path);
    }
    radiance = vec4(sum, 0.0);
}
