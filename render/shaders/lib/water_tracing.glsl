// Screen-space tracing of rays from a water surface, in the image of the scene without water. Include after
// lib/view.glsl.

layout(binding = 5) uniform sampler2D behind_radiance;   // water_behind.frag
layout(binding = 26) uniform sampler2D behind_distance;

const int kMirrorSteps = 10;
const int kBendSteps = 8;
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
bool on_screen(vec3 at) {
    return at.z > view.camera_ws.w && all(lessThan(abs(at.xy - 0.5 * view.size.xy), 0.5 * view.size.xy));
}

// Distance along the view axis of the surface in a pixel [m]; 0: none, or off screen.
float distance_at(vec2 pixel) {
    bool shown = all(lessThan(abs(pixel - 0.5 * view.size.xy), 0.5 * view.size.xy));
    return shown ? texelFetch(behind_distance, ivec2(pixel), 0).r : 0.0;
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

// Whether the image has a surface at `at` that is nearer than it and on the same side of the water at rest as the ray.
bool is_hidden(vec3 at, Side side) {
    float seen = distance_at(at.xy);
    return seen > 0.0 && seen < at.z && side.up * (height_of(at.xy, seen) - side.level) > 0.0;
}

// Radiance along a reflected ray: from the image where the ray hits something on screen, else `around`, at infinite
// distance.
RayHit trace_reflection(vec3 position, vec3 direction, vec3 around, Side side) {
    ScreenRay ray = screen_ray(position, direction);
    float low = 0.0;
    float high = 0.02 * distance(position, view.camera_ws.xyz) + 0.05;
    int steps = 0;
    vec3 at;
    bool inside;
    bool hidden;
    do {
        at = ray_point(ray, high);
        inside = on_screen(at);
        hidden = inside && is_hidden(at, side);
        low = hidden ? low : high;
        high = hidden ? high : 1.7 * high;
    } while (inside && !hidden && ++steps < kMirrorSteps);
    // It went behind something between the last two steps: bisect.
    bool met = hidden;
    float followed = low;
    steps = 0;
    do {
        float middle = 0.5 * (low + high);
        hidden = is_hidden(ray_point(ray, middle), side);
        low = hidden ? low : middle;
        high = hidden ? middle : high;
    } while (met && ++steps < kHalvings);
    vec3 hit = ray_point(ray, high);
    vec2 pixel = clamp_to_screen(met ? hit.xy : at.xy);
    vec3 color = radiance_at(pixel);
    // If it is far behind the occluder, its hit is not visible on screen. Under water, where no sky can take its place,
    // the occluder is the better guess.
    float gap = hit.z - distance_at(pixel);
    vec2 edge = min(hit.xy, view.size.xy - hit.xy) * view.size.zw;
    float trust = clamp(min(edge.x, edge.y) * 12.0, 0.0, 1.0) * clamp(2.0 - gap / (2.0 * (high - low) + 0.05), 0.0, 1.0);
    trust = !met ? 0.0 : side.up > 0.0 ? trust : 1.0;
#ifdef FROM_BELOW
    // Under water no sky can take its place: continue the pixel where the ray leaves the screen.
    if (side.up < 0.0 && !met && !inside && at.z > view.camera_ws.w) {
        vec3 start = ray_point(ray, 0.0);
        vec2 out_of = at.xy - start.xy;
        vec2 room = mix(view.size.xy - 1.0 - start.xy, 1.0 - start.xy, lessThan(out_of, vec2(0.0)));
        vec2 shares = room / mix(out_of, vec2(1e-3), lessThan(abs(out_of), vec2(1e-3)));
        vec2 leaves = clamp_to_screen(start.xy + clamp(min(shares.x, shares.y), 0.0, 1.0) * out_of);
        // If something above the water is there, follow it down into the water.
        float seen = distance_at(leaves);
        float over = max(height_of(leaves, seen) - side.level + 0.2, 0.0);
        leaves.y -= seen > 0.0 ? over / (seen * 2.0 * view.size.w * max(view.ray_up.y, 1e-3)) : 0.0;
        leaves = clamp_to_screen(leaves);
        seen = distance_at(leaves);
        if (seen > 0.0 && height_of(leaves, seen) < side.level) {
            return RayHit(radiance_at(leaves), followed);
        }
    }
#endif
    return RayHit(mix(around, color, trust), trust > 0.5 ? high : kInfiniteDistance);
}

// Hit of a refracted ray on screen: steps until it is behind something, then bisection. Surfaces in front of the water
// are ignored. `max_distance`: distance after which a hit is certain [m].
RayHit trace_refraction(vec3 position, vec3 direction, float max_distance) {
    vec2 pixel = gl_FragCoord.xy;
    ScreenRay ray = screen_ray(position, direction);
    float here = ray.from.z;
    float straight = distance_at(pixel);
    float path = straight > 0.0 ? (straight - here) * length(view_ray(pixel)) : kInfiniteDistance;
    // Rays that approach the screen edge are bent less, from half way on, so that the edge is not smeared.
    vec2 shift = ray_point(ray, min(path, max_distance)).xy - pixel;
    vec2 room = mix(view.size.xy - pixel, pixel, lessThan(shift, vec2(0.0)));
    vec2 shares = room / max(2.0 * abs(shift), vec2(1e-6));
    direction = normalize(mix(normalize(position - view.camera_ws.xyz), direction, min(min(shares.x, shares.y), 1.0)));
    ray = screen_ray(position, direction);
    float reach = min(max_distance, min(3.0 * path + 0.5, kInfiniteDistance));
    float low = 0.0;
    float high = reach;
    vec2 shown = pixel;  // the last pixel on the ray that nothing in front of the water covers
    bool met;
    int steps = 0;
    do {
        float share = float(steps + 1) / float(kBendSteps);
        high = reach * share * share;
        vec3 at = ray_point(ray, high);
        pixel = clamp_to_screen(at.xy);
        float seen = distance_at(pixel);
        shown = seen > here ? pixel : shown;
        met = seen > here && seen < at.z;
        low = met ? low : high;
    } while (!met && ++steps < kBendSteps);
    steps = 0;
    do {
        float middle = 0.5 * (low + high);
        vec3 at = ray_point(ray, middle);
        float seen = distance_at(clamp_to_screen(at.xy));
        bool hidden = seen > here && seen < at.z;
        low = hidden ? low : middle;
        high = hidden ? middle : high;
    } while (met && ++steps < kHalvings);
    pixel = clamp_to_screen(ray_point(ray, high).xy);
    shown = distance_at(pixel) > here ? pixel : shown;
    bool unbounded = straight <= 0.0 && high >= reach;
    return RayHit(radiance_at(shown), unbounded ? kInfiniteDistance : high);
}
