// Heat haze in a box or ball: the path of a ray through it, and the eddies at the midpoint of that path.
// Techniques: post.glare-heat-haze
#version 450
#include "lib/noise.glsl"
#include "lib/view.glsl"
#include "gbuffer_gpu.h"

layout(binding = kDepthUnit) uniform sampler2D scene_depth;

uniform mat4 local_from_world;  // half-extent 1
uniform bool is_ball;
uniform float max_shift;  // largest shift [px]
uniform float scale;      // of an eddy [m]
uniform float raised;     // distance by which the air has risen [eddies]
uniform uint seed;

layout(location = 0) out vec4 shift;  // [px]; alpha: maximum depth to read

// Parameters t at which `from + t along` enters and leaves; it misses the box if the second is smaller.
vec2 box_span(vec3 from, vec3 along) {
    vec3 a = (-1.0 - from) / along;
    vec3 b = (1.0 - from) / along;
    vec3 low = min(a, b);
    vec3 high = max(a, b);
    return vec2(max(low.x, max(low.y, low.z)), min(high.x, min(high.y, high.z)));
}

vec2 ball_span(vec3 from, vec3 along) {
    float a = dot(along, along);
    float b = dot(from, along);
    float root = b * b - a * (dot(from, from) - 1.0);
    return root > 0.0 ? (vec2(-1.0, 1.0) * sqrt(root) - b) / a : vec2(1.0, 0.0);
}

void main() {
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec3 ray = view_ray(gl_FragCoord.xy);
    vec3 from = (local_from_world * vec4(view.camera_ws.xyz, 1.0)).xyz;
    vec3 along = mat3(local_from_world) * ray;
    along = mix(along, vec3(1e-9), lessThan(abs(along), vec3(1e-9)));

    // t is the distance along the view axis [m].
    vec2 span = is_ball ? ball_span(from, along) : box_span(from, along);
    float enter = max(span.x, view.camera_ws.w);
    float hidden = min(span.y, view.camera_ws.w / max(depth, 1e-20));
    float whole = span.y - enter;
    float fraction = whole > 0.0 ? max(hidden - enter, 0.0) / whole : 0.0;

    float t = enter + 0.5 * max(hidden - enter, 0.0);
    vec3 local = from + t * along;
    vec3 inside = max(1.0 - local * local, 0.0);
    float fade = is_ball ? max(1.0 - dot(local, local), 0.0) : inside.x * inside.y * inside.z;

    vec3 point = (view.camera_ws.xyz + t * ray) / scale - vec3(0.0, raised, 0.0);
    vec2 eddy = vec2(gradient_noise(point, seed), gradient_noise(point, seed + 0x9e37u));
    vec2 moved = 0.70710678 * max_shift * fraction * fade * eddy;
    if (moved == vec2(0.0)) {
        discard;  // leaves the depth of other effects
    }
    shift = vec4(moved, 0.0, view.camera_ws.w / enter);
}
