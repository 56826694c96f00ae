// Motion blur of a single frame by its velocities. See motion_blur_pass.h.
// Techniques: post.motion-blur-reconstruct
#version 450
#include "lib/motion.glsl"
#include "lib/noise.glsl"
#include "fullscreen_gpu.h"
#include "motion_blur_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D radiance;
layout(binding = kMotionUnit) uniform sampler2D motion_map;          // motion_pack.frag
layout(binding = kMotionNeighborsUnit) uniform sampler2D neighbors;  // motion_neighbor.frag

uniform int side;     // of a tile [px]
uniform int samples;  // along the motion

layout(location = 0) out vec4 blurred;

const float kStill = 0.5;       // less than this to either side counts as no motion [px]
const float kSameDepth = 0.02;  // relative; within it, the faster one counts as in front

struct Pixel {
    vec2 motion;
    float depth;
    float speed;
};

// Sums along a line, in pixels of its length unless noted.
struct Found {
    vec3 front;         // radiance of surfaces passing in front of this pixel, times fraction of the exposure
    float front_weight; // fraction of the exposure
    vec3 own;           // the pixel's own layer: surfaces that move with it
    float own_length;
    float gap;          // of the same length, where the layer behind is visible
    vec3 behind;
    float behind_weight;
};

vec4 fetch_motion(ivec2 at) {
    return texelFetch(motion_map, at, 0);
}

// Samples one line through the pixel, `range` [px] to either side, where it crosses columns or rows of pixels: at most
// about `max_samples` of them, at a regular stride. as_front: gathers surfaces that pass in front; as_own: gathers the
// pixel's own layer and the one behind it.
void gather(
    inout Found found, Pixel here, vec2 direction, float range, int max_samples, float jitter, bool as_front,
    bool as_own) {
    ivec2 last = textureSize(radiance, 0) - 1;
    float major = max(abs(direction.x), abs(direction.y));
    vec2 pace = direction / major;
    int far = int(range * major + 0.5);
    int stride = (2 * far + max_samples) / max_samples;
    float spacing = float(stride) / major;
    float own_range = abs(dot(here.motion, direction));
    for (int k = int(jitter * float(stride)) - far; k <= far; k += stride) {
        ivec2 position = clamp(ivec2(gl_FragCoord.xy + float(k) * pace), ivec2(0), last);
        vec4 texel = fetch_motion(position);
        vec3 color = texelFetch(radiance, position, 0).rgb;
        float distance_px = abs(float(k)) / major;

        // Pixels with the same motion form one layer at any depth: their mutual occlusion does not change.
        float apart = distance(texel.xy, here.motion);
        float alike = clamp(1.5 - apart / (0.5 + 0.2 * max(texel.w, here.speed)), 0.0, 1.0);
        float nearer = (texel.z - here.depth) / (kSameDepth * max(max(texel.z, here.depth), 1e-9));
        float faster = clamp((texel.w - here.speed) / (0.5 + 0.1 * here.speed), -1.0, 1.0);
        float before = clamp(0.5 + nearer + 0.5 * faster, 0.0, 1.0);

        if (as_front) {
            float along = abs(dot(texel.xy, direction));
            float straight = clamp(2.0 * along / max(texel.w, 1e-3) - 1.0, 0.0, 1.0);
            float exposed = spacing / max(2.0 * along, 1.0) * covers(along, distance_px) * straight;
            exposed *= (1.0 - alike) * before;
            found.front += exposed * color;
            found.front_weight += exposed;
        }
        if (as_own) {
            float inside = spacing * covers(own_range, distance_px);
            found.own += inside * alike * color;
            found.own_length += inside * alike;
            float back = inside * (1.0 - alike) * (1.0 - before);
            found.gap += back;
            float weight = back * (1.05 - distance_px / max(own_range, distance_px));
            found.behind += weight * color;
            found.behind_weight += weight;
        }
    }
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 color = texelFetch(radiance, pixel, 0);
    vec4 neighbor = texelFetch(neighbors, pixel / side, 0);
    float longest = length(neighbor.xy);
    blurred = color;
    if (longest <= kStill) {
        return;
    }
    float jitter = pixel_noise(gl_FragCoord.xy);
    vec4 texel = fetch_motion(pixel);
    Pixel here = Pixel(texel.xy, texel.z, texel.w);

    if (neighbor.xy == neighbor.zw) {
        // Uniform motion in the neighborhood.
        blurred.rgb = mean_along(radiance, gl_FragCoord.xy, here.motion, 2 * samples + 1, jitter);
        return;
    }

    Found found = Found(vec3(0.0), 0.0, 1e-3 * color.rgb, 1e-3, 0.0, vec3(0.0), 0.0);
    bool moves = here.speed > kStill;
    vec2 main_direction = neighbor.xy / longest;
    // For a pixel that moves like the fastest one, a single line is enough.
    bool one_line = moves && distance(here.motion, neighbor.xy) < 0.2 * longest + 0.5;
    float other = length(neighbor.zw);
    bool crossing = other > kStill;
    int lines = (moves && !one_line ? 2 : 1) + (crossing ? 1 : 0);
    int max_samples = lines == 1 ? 2 * samples : samples;
    gather(found, here, main_direction, longest, max_samples, jitter, true, one_line);
    if (moves && !one_line) {
        gather(found, here, here.motion / here.speed, here.speed, max_samples, jitter, false, true);
    }
    if (crossing) {
        gather(found, here, neighbor.zw / other, other, max_samples, jitter, true, false);
    }

    vec3 own = found.own / found.own_length;
    if (found.behind_weight > 0.0) {
        own = mix(found.behind / found.behind_weight, own, found.own_length / (found.own_length + found.gap));
    }
    if (found.front_weight > 1.0) {
        found.front /= found.front_weight;
        found.front_weight = 1.0;
    }
    blurred.rgb = found.front + (1.0 - found.front_weight) * own;
}
