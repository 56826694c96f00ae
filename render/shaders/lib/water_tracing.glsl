// Screen-space tracing of rays from a water surface, in the image of the scene without water. Include after
// lib/view.glsl.

#include "water_gpu.h"

layout(binding = kBehindWaterUnit) uniform sampler2D behind_radiance;  // without the water
layout(binding = kBehindWaterDepthUnit) uniform sampler2D behind_depth;
layout(binding = kHighestWaterUnit) uniform sampler2D highest_surfaces;  // water_columns.frag

// Of reflected rays.
const float kMirrorStep = 10.0;       // [px] on average; narrower objects may be missed
const float kMinMirrorSteps = 10.0;
const float kMaxMirrorSteps = 48.0;
const float kMirrorDistance = 2000.0; // maximum length of a ray [m]
const int kMaxClearTiles = 64;
const float kMirrorThickness = 0.2;   // of the surfaces they hit, relative to the path, by eye
const float kNothing = 1e9;
const float kFarther = 0.8;           // ratio of the reciprocal distances of a surface and one before it
const float kSameSurface = 0.25;      // relative difference of the reciprocal distances of its points
const float kApproach = 0.25;         // share of the difference before bisection that may be left on a single surface
const float kPastEdge = 2.0;          // of the surface that hid a ray [px]
const int kPasses = 3;                // rejected hits after which a ray ends
const int kBendSteps = 8;
const float kOpenDistance = 150.0;    // of refracted rays in pixels without ground: farther hits are ignored [m]
// After a hit, loops repeat their last step: in llvmpipe (Mesa 22.3) a pixel iterates as long as the loop of a neighbor
// runs.
#ifdef FROM_BELOW
const int kHalvings = 7;  // total internal reflection would show steps
#else
const int kHalvings = 4;
#endif
const float kInfiniteDistance = 1e4;  // distance through water [m]

// A ray in screen space: from + t along is (pixel x w, pixel y w, w), with w its distance along the view axis [m].
struct ScreenRay {
    vec3 from;
    vec3 along;
};
ScreenRay screen_ray(vec3 from, vec3 along) {
    vec3 a = (view.clip_from_world * vec4(from, 1.0)).xyw;
    vec3 b = (view.clip_from_world * vec4(along, 0.0)).xyw;
    return ScreenRay(
        vec3(0.5 * view.size.xy * (a.xy + a.z), a.z), vec3(0.5 * view.size.xy * (b.xy + b.z), b.z));
}

// Pixel and distance of the point at `path`.
vec3 ray_point(ScreenRay ray, float path) {
    vec3 p = ray.from + path * ray.along;
    return vec3(p.xy / max(p.z, 1e-6), p.z);
}

// Screen-space derivative [px] of the ray's point at `path`, which is in `pixel` at `distance`; `by` is the difference
// of the ray to that of the neighboring pixel.
vec2 ray_step(ScreenRay by, float path, vec2 pixel, float distance) {
    vec3 step = by.from + path * by.along;
    return (step.xy - step.z * pixel) / max(distance, 1e-6);
}

// Widens a step to that of a filter of two pixels: 0 for steps up to a pixel, and at most kWidestStep.
vec2 wider_step(vec2 step) {
    const float kWidestStep = 32.0;  // beyond, pixels see different bodies
    float size = max(length(step), 1e-3);
    return step * max(2.0 - 2.0 / size, 0.0) * min(1.0, kWidestStep / (2.0 * size));
}

// Distance along the view axis of the surface in a pixel [m]; 0: none, or off screen.
float distance_at(vec2 pixel) {
    bool shown = all(lessThan(abs(pixel - 0.5 * view.size.xy), 0.5 * view.size.xy));
    float depth = texelFetch(behind_depth, ivec2(pixel), 0).r;
    return shown && depth > 0.0 ? view_distance(depth) : 0.0;
}
vec2 clamp_to_screen(vec2 pixel) {
    return clamp(pixel, vec2(0.5), view.size.xy - 0.5);
}
vec3 radiance_at(vec2 pixel) {
    return texelFetch(behind_radiance, ivec2(pixel), 0).rgb;
}
float height_of(vec2 pixel, float distance) {
    return view.camera_ws.y + view_ray(pixel).y * distance;
}

// Radiance along a ray, and the distance to its hit [m].
struct RayHit {
    vec3 color;
    float path;
};

// The side of the water at rest on which a ray leaves the surface.
struct Side {
    float level;  // height of the water at rest, moved slightly toward the other side because of waves
    float up;     // 1: above, -1: below
};

// Reciprocal distance of the surface in a pixel [1/m], if it is on the same side of the water at rest as the ray; else
// that of kInfiniteDistance.
float blocking_nearness(vec2 pixel, Side side) {
    float near = texelFetch(behind_depth, ivec2(pixel), 0).r / view.camera_ws.w;
    float up = view_ray(pixel).y + (view.camera_ws.y - side.level) * near;  // of the surface, divided by its distance
    return near > 0.0 && side.up * up > 0.0 ? near : 1.0 / kInfiniteDistance;
}

// Mean of what a pixel of the water reflects, the ray of whose center hits `pixel` at reciprocal distance `nearness`; a:
// share of the pixel that reflects surfaces at about that distance. `across` and `down`: changes of where rays hit from
// pixel to pixel [px].
vec4 mean_radiance_at(vec2 pixel, vec2 across, vec2 down, float nearness, Side side) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {  // a rotated grid
        vec2 at = 0.25 * vec2(i, (2 * i + 1) % 5) - 0.375;
        vec2 tap = clamp_to_screen(pixel + at.x * across + at.y * down);
        float there = blocking_nearness(tap, side);
        float hits = step(abs(there - nearness), kSameSurface * nearness);
        sum += hits * vec4(radiance_at(tap), 1.0);
    }
    return vec4(sum.rgb / max(sum.a, 1.0), 0.25 * sum.a);
}

// Reciprocal distance of the water at rest in a pixel [1/m].
float nearness_of_water(vec2 pixel, Side side) {
    float over = view.camera_ws.y - side.level;
    return -view_ray(pixel).y / (abs(over) < 1e-3 ? 1e-3 : over);
}

// Empty-space skipping: distance, in units of `along` and up to `end`, that a ray from `from` [px] crosses the image
// through tiles with nothing above water level, for a side above the water. An ascending ray skips a column of such
// tiles at once.
float clear_distance(vec2 from, vec2 along, float end, Side side) {
    vec2 slope = mix(along, vec2(1e-6), lessThan(abs(along), vec2(1e-6)));
    vec2 inverse = 1.0 / slope;
    vec2 beyond = step(0.0, slope) + 1e-3 * sign(slope);  // the next tile [tiles]
    ivec2 last = textureSize(highest_surfaces, 0) - 1;
    float path = 0.0;
    bool is_clear;
    int tiles = 0;
    do {
        ivec2 tile = clamp(ivec2(from + path * along) / kHighestTile, ivec2(0), last);
        vec2 highest = texelFetch(highest_surfaces, tile, 0).rg;  // in the tile, and in it and those above it
        is_clear = side.up > 0.0 && highest.x <= side.level;
        vec2 leaving = ((vec2(tile) + beyond) * float(kHighestTile) - from) * inverse;
        float next = along.y > 0.0 && highest.y <= side.level ? leaving.x : min(leaving.x, leaving.y);
        path = is_clear ? max(path, next) : path;
    } while (is_clear && path < end && ++tiles < kMaxClearTiles);
    return min(path, end);
}

// Radiance along a reflected ray: from the image where the ray hits something on screen, else `around`, at infinite
// distance. The ray is marched in the image, where pixels and the reciprocal of the distance are linear, until it
// leaves the screen; steps grow from the first tile with anything above the water. `is_inside`: the neighbors of the
// pixel are of the same water.
RayHit trace_reflection(vec3 position, vec3 direction, vec3 around, Side side, bool is_inside) {
    ScreenRay ray = screen_ray(position, direction);
    vec2 from = gl_FragCoord.xy;
    vec2 along = ray.along.xy - ray.along.z * from;  // pixel = from + u * along, with u = path / distance
    ScreenRay by_x = ScreenRay(dFdx(ray.from), dFdx(ray.along));
    ScreenRay by_y = ScreenRay(dFdy(ray.from), dFdy(ray.along));
    vec2 room = mix(view.size.xy - 1.0 - from, 1.0 - from, lessThan(along, vec2(0.0)));
    vec2 leaving = room / mix(along, vec2(1e-6), lessThan(abs(along), vec2(1e-6)));
    float max_path = ray.along.z < 0.0 ? min(kMirrorDistance, -0.95 * ray.from.z / ray.along.z) : kMirrorDistance;
    float u_max = max_path / (ray.from.z + max_path * ray.along.z);
    float u_end = max(min(u_max, min(leaving.x, leaving.y)), 0.0);
    float u_begin = clear_distance(from, along, u_end, side);
    float rest = u_end - u_begin;
    float count = rest > 0.0 ? ceil(clamp(rest * length(along) / kMirrorStep, kMinMirrorSteps, kMaxMirrorSteps)) : 1.0;
    float low = u_begin;
    float high = u_begin;
    float inverse_from = 1.0 / ray.from.z;
    float ahead = 0.0;  // difference of the reciprocal distances of ray and surface: at low
    float behind;       // and at high
    float hiding = kNothing;  // reciprocal distance of the surface that hides the ray at low
    bool met = false;
    float step = 0.0;
    float u;
    float path;
    float trust;
    bool is_one;
    int passes = 0;
    do {
        float surface;
        do {
            float fraction = min(++step / count, 1.0);
            high = met ? high : u_begin + rest * fraction * (0.3 + 0.7 * fraction);
            surface = blocking_nearness(from + high * along, side);
            // As long as a surface hides it, it cannot hit that surface; under water, where there is no sky to fall back
            // to, it does.
            float nearness = (1.0 - high * ray.along.z) * inverse_from;
            behind = surface - nearness;
            met = met || (behind > 0.0 && (surface < kFarther * hiding || side.up < 0.0));
            ahead = met ? ahead : -behind;
            low = met ? low : high;
            hiding = met ? hiding : behind > 0.0 ? surface : kNothing;
        } while (!met && step < count);
        // It passed behind a surface in the last step, or from behind one surface to behind another: bisect, and assume
        // a plane between the last two points unless they are on different surfaces.
        float other = hiding < kNothing ? 0.5 * (hiding + surface) : kNothing;
        float last = high;
        float behind_last = behind;
        float apart_at_first = ahead + behind;
        vec2 ends = vec2(hiding, surface);
        int steps = 0;
        do {
            float midpoint = 0.5 * (low + high);
            float there = blocking_nearness(from + midpoint * along, side);
            float nearness = (1.0 - midpoint * ray.along.z) * inverse_from;
            float apart = there - nearness;
            bool hidden = apart > 0.0 && there < other;
            // A surface that stands in the water goes on below.
            float above = nearness - nearness_of_water(from + midpoint * along, side);
            ahead = hidden ? ahead : min(-apart, max(above, 0.0));
            behind = hidden ? apart : behind;
            ends = hidden ? vec2(ends.x, there) : vec2(there, ends.y);
            low = hidden ? low : midpoint;
            high = hidden ? midpoint : high;
        } while (met && ++steps < kHalvings);
        // On one surface, which bisection approaches, it lies between them; else, if it passes far behind the edge, it
        // goes on.
        float z = ray.from.z / (1.0 - high * ray.along.z);
        float thickness = kMirrorThickness * high * z + 0.05;
        is_one = ahead >= 0.0 && (ahead + behind) < max(thickness / (z * z), kApproach * apart_at_first);
        u = !met ? u_end : is_one ? mix(low, high, ahead / (ahead + behind)) : high;
        u += other < kNothing ? kPastEdge / length(along) : 0.0;
        path = u * ray.from.z / (1.0 - u * ray.along.z);
        bool recedes = other < kNothing && ends.x - ends.y < kApproach * (hiding - surface);
        trust = recedes ? 0.0 : is_one ? 1.0 : clamp(3.5 - 2.0 * behind * z * z / thickness, 0.0, 1.0);
        met = met && (trust > 0.0 || side.up < 0.0 || ++passes >= kPasses);
        low = last;
        ahead = -behind_last;
        hiding = surface;
    } while (!met && step < count);
    vec2 hit = from + u * along;
    vec2 edge = min(hit, view.size.xy - hit) * view.size.zw;
    trust *= clamp(min(edge.x, edge.y) * 12.0, 0.0, 1.0);
    // Weighted by the share of the pixel's footprint that hits the same surface. Past an edge, near the horizon, the
    // point may lie beyond infinity: then it has no footprint.
    float distance = ray.from.z + path * ray.along.z;
    bool is_wide = is_inside && path > 0.0 && distance > 0.0 && distance < kInfiniteDistance;
    vec2 across = is_wide ? wider_step(ray_step(by_x, path, hit, distance)) : vec2(0.0);
    vec2 down = is_wide ? wider_step(ray_step(by_y, path, hit, distance)) : vec2(0.0);
    vec4 mean = mean_radiance_at(hit, across, down, blocking_nearness(clamp_to_screen(hit), side), side);
    vec3 color = mean.a > 0.0 ? mean.rgb : radiance_at(clamp_to_screen(hit));
    trust *= mean.a;
    trust = !met ? 0.0 : side.up > 0.0 ? trust : 1.0;
#ifdef FROM_BELOW
    // Under water there is no sky to fall back to: extend the pixel where the ray leaves the screen.
    if (side.up < 0.0 && !met && u_end < u_max) {
        // If something above the water is there, follow it down into the water.
        float surface = distance_at(hit);
        float over = max(height_of(hit, surface) - side.level + 0.2, 0.0);
        hit.y -= surface > 0.0 ? over / (surface * 2.0 * view.size.w * max(view.ray_up.y, 1e-3)) : 0.0;
        hit = clamp_to_screen(hit);
        surface = distance_at(hit);
        if (surface > 0.0 && height_of(hit, surface) < side.level) {
            return RayHit(radiance_at(hit), path);
        }
    }
#endif
    return RayHit(mix(around, color, trust), trust > 0.5 ? path : kInfiniteDistance);
}

// Hit of a refracted ray on screen: steps until it is behind a surface, then bisection; a single step if it goes
// `downward` from a pixel without ground, where it can only hit objects in the water. Surfaces in front of the water
// are ignored. `max_distance`: distance after which a hit is certain [m].
RayHit trace_refraction(vec3 position, vec3 direction, float max_distance, bool downward) {
    vec2 pixel = gl_FragCoord.xy;
    ScreenRay ray = screen_ray(position, direction);
    float here = ray.from.z;
    float straight = distance_at(pixel);
    float path = straight > 0.0 ? (straight - here) * length(view_ray(pixel)) : kInfiniteDistance;
    // Rays that approach the screen edge are bent less, from halfway on, so that the edge is not smeared.
    vec2 shift = ray_point(ray, min(path, max_distance)).xy - pixel;
    vec2 room = mix(view.size.xy - pixel, pixel, lessThan(shift, vec2(0.0)));
    vec2 scale = room / max(2.0 * abs(shift), vec2(1e-6));
    direction = normalize(mix(normalize(position - view.camera_ws.xyz), direction, min(min(scale.x, scale.y), 1.0)));
    ray = screen_ray(position, direction);
    bool open = downward && straight <= 0.0;
    float max_path = min(max_distance, open ? kOpenDistance : min(3.0 * path + 0.5, kInfiniteDistance));
    int count = open ? 1 : kBendSteps;
    float low = 0.0;
    float high = max_path;
    vec2 shown = pixel;  // the last pixel on the ray that nothing in front of the water covers
    bool met = false;
    int steps = 0;
    do {
        float fraction = float(steps + 1) / float(count);
        high = met ? high : max_path * fraction * fraction;
        vec3 at = ray_point(ray, high);
        pixel = clamp_to_screen(at.xy);
        float surface = distance_at(pixel);
        shown = surface > here ? pixel : shown;
        met = surface > here && surface < at.z;
        low = met ? low : high;
    } while (!met && ++steps < count);
    steps = 0;
    do {
        float midpoint = 0.5 * (low + high);
        vec3 at = ray_point(ray, midpoint);
        float surface = distance_at(clamp_to_screen(at.xy));
        bool hidden = met && surface > here && surface < at.z;
        low = hidden ? low : midpoint;
        high = hidden ? midpoint : high;
    } while (met && ++steps < kHalvings);
    pixel = clamp_to_screen(ray_point(ray, high).xy);
    shown = distance_at(pixel) > here ? pixel : shown;
    bool unbounded = straight <= 0.0 && high >= max_path;
    return RayHit(radiance_at(shown), unbounded ? kInfiniteDistance : high);
}
