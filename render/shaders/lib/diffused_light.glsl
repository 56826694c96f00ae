// Diffuse light that exits a surface around the point where it entered (render/light/subsurface_pass.h).
// Techniques: skin.diffusion

#include "lib/diffusion.glsl"
#include "lib/material_record.glsl"
#include "lib/stored_surface.glsl"
#include "lib/view.glsl"
#include "material_subsurface_gpu.h"

layout(binding = kScatteredUnit) uniform sampler2D scattered;  // without albedo; alpha 1 where light scatters; has mips

layout(binding = kDistancesUnit) uniform sampler2D distances;  // along the view axis, and their squares; with mip levels

const vec2 kGoldenTurn = vec2(-0.73736888, 0.67549029);  // cosine and sine of the golden angle
const float kFewWithin = 24.0;   // radius of the last ring [px] below which few rings differ by less than 1 % of an edge
const float kFewestWithin = 12.0;  // the same for the fewest
const float kMinFacing = 0.15;   // cosine between plane and viewer; planes that are more edge-on are tilted
const float kBlob = 0.9;         // side of a sample relative to the square root of its area; tuned for least error
const vec2 kSlack = vec2(1.0, 0.6);  // pixels, and fractions of a sample, within which the plane's own slope is ignored
const float kRounding = 4e-4;        // relative rounding error of distances, from their squares in single precision

// Light that exits at a pixel (gl_FragCoord.xy), whose texel of `scattered` is `here`.
vec3 diffused_light(vec2 frag_coord, vec4 here) {
    ivec2 pixel = ivec2(frag_coord);
    SurfaceSample s = stored_surface(pixel);
    float distance_here = view_distance(texelFetch(scene_depth, pixel, 0).r);
    vec3 point = view.camera_ws.xyz + view_ray(frag_coord) * distance_here;
    vec3 to_camera = to_viewer(point);

    // The plane, and its projection: clip coordinates x, y, w.
    float facing = dot(s.normal_ws, to_camera);
    vec3 normal = normalize(s.normal_ws + max(kMinFacing - facing, 0.0) * to_camera);
    facing = max(dot(normal, to_camera), kMinFacing);
    vec3 right = normalize(cross(abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), normal));
    vec3 up = cross(normal, right);
    vec3 clip_point = (view.clip_from_world * vec4(point, 1.0)).xyw;
    vec3 clip_right = (view.clip_from_world * vec4(right, 0.0)).xyw;
    vec3 clip_up = (view.clip_from_world * vec4(up, 0.0)).xyw;
    float pixels_per_meter = 0.5 * view.size.y / (length(view.ray_up.xyz) * distance_here);

    int first = block_begin(s.material, kSubsurfaceBlock);
    vec3 falloff = 1.442695 / (3.0 * max(texelFetch(materials, first + kDiffusionTexel).rgb, vec3(kMinDiffusion)));
    float widest = texelFetch(materials, first + kFewSamplesTexel - 1).x * pixels_per_meter;
    bool few = widest < kFewWithin;
    bool fewest = widest < kFewestWithin;
    int begin = first + (fewest ? kFewestSamplesTexel : few ? kFewSamplesTexel : kSamplesTexel);
    uint rings = fewest ? kFewestDiffusionSamples : few ? kFewDiffusionSamples : kDiffusionSamples;
    int count = widest < 0.5 ? 0 : int(rings);
    float slope = sqrt(max(1.0 - facing * facing, 0.0)) / (facing * pixels_per_meter);  // of distance [m] per pixel
    float area_to_pixels = kBlob * kBlob * 3.14159265 * facing * pixels_per_meter * pixels_per_meter;

    vec3 sum = vec3(0.0);
    vec3 total = vec3(0.0);
    vec2 turn = vec2(1.0, 0.0);
    vec4 ring = texelFetch(materials, begin);
    float inner = 0.0;
    for (int i = 0; i < count; ++i) {
        vec4 next = texelFetch(materials, begin + min(i + 1, count - 1));
        float outer = i + 1 < count ? 0.5 * (ring.x + next.x) : 2.0 * ring.x - inner;
        vec2 offset = turn * ring.x;
        vec3 clip = clip_point + offset.x * clip_right + offset.y * clip_up;
        vec2 uv = clip.xy / max(clip.z, 1e-6) * 0.5 + 0.5;
        bool inside = all(greaterThan(uv, vec2(0.0))) && all(lessThan(uv, vec2(1.0)));

        // A square of this side [px]; if it is smaller than a pixel, bilinear filtering is narrowed accordingly.
        vec2 at = uv * view.size.xy;
        float side = sqrt((outer * outer - inner * inner) * area_to_pixels);
        vec2 corner = floor(at - 0.5);
        vec2 within = clamp((at - corner - 1.0) / clamp(side, 1e-3, 1.0) + 0.5, 0.0, 1.0);
        vec2 where = (corner + 0.5 + within) * view.size.zw;
        float level = log2(max(side, 1.0));
        level = few ? floor(level + 0.5) : level;  // between two levels a software OpenGL samples both
        vec4 light = textureLod(scattered, where, level);

        // Samples off the plane count as farther away, by the root mean square distance from it.
        vec2 moments = textureLod(distances, where, level).xy;
        float apart = sqrt(max(moments.y - clip.z * (2.0 * moments.x - clip.z), 0.0));
        apart = max(apart - slope * dot(kSlack, vec2(1.0, max(side, 1.0))) - kRounding * distance_here, 0.0);
        float excess = length(vec2(ring.x, apart)) - ring.x;
        vec3 weight = ring.yzw * exp2(-excess * falloff) * (inside ? 1.0 : 0.0);
        sum += weight * light.rgb;
        total += weight * light.a;

        inner = outer;
        ring = next;
        turn = vec2(turn.x * kGoldenTurn.x - turn.y * kGoldenTurn.y, turn.x * kGoldenTurn.y + turn.y * kGoldenTurn.x);
    }
    vec3 left = mix(here.rgb, sum / max(total, vec3(1e-6)), greaterThan(total, vec3(1e-3)));
    return s.albedo * left;
}
