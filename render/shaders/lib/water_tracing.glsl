// What rays that leave the surface of water meet, found in the picture of the scene without it. After lib/view.glsl.

layout(binding = 5) uniform sampler2D behind_radiance;   // water_behind.frag
layout(binding = 26) uniform sampler2D behind_distance;

const int kMirrorSteps = 10;
const int kBendSteps = 8;
#ifdef FROM_BELOW
const int kHalvings = 7;  // all of what is seen is mirrored there: steps would show
#else
const int kHalvings = 4;
#endif
const float kEndless = 1e4;  // way through water [m]

// A ray in the picture: at way t, from + t along is (pixel x w, pixel y w, w), w its distance along the view axis [m].
struct PictureRay {
    vec3 from;
    vec3 along;
};
PictureRay picture_ray(vec3 from, vec3 along) {
    vec3 a = (view.clip_from_world * vec4(from, 1.0)).xyw;
    vec3 b = (view.clip_from_world * vec4(along, 0.0)).xyw;
    return PictureRay(
        vec3(0.5 * view.size.xy * (a.xy + a.z), a.z), vec3(0.5 * view.size.xy * (b.xy + b.z), b.z));
}

// Where its point at `way` is: pixel and distance.
vec3 picture_of(PictureRay ray, float way) {
    vec3 p = ray.from + way * ray.along;
    return vec3(p.xy / max(p.z, 1e-6), p.z);
}
bool in_picture(vec3 at) {
    return at.z > view.camera_ws.w && all(lessThan(abs(at.xy - 0.5 * view.size.xy), 0.5 * view.size.xy));
}

// Distance along the view axis of what the picture shows [m]; 0: nothing, or beyond the picture's edge.
float distance_at(vec2 pixel) {
    bool shown = all(lessThan(abs(pixel - 0.5 * view.size.xy), 0.5 * view.size.xy));
    return shown ? texelFetch(behind_distance, ivec2(pixel), 0).r : 0.0;
}
vec2 into_picture(vec2 pixel) {
    return clamp(pixel, vec2(0.5), view.size.xy - 0.5);
}
vec3 radiance_at(vec2 pixel) {
    return texelFetch(behind_radiance, ivec2(pixel), 0).rgb;
}
float height_of(vec2 pixel, float distance) {
    return view.camera_ws.y + view_ray(pixel).y * distance;
}

// Radiance along a ray, and the way to where it comes from [m].
struct Seen {
    vec3 color;
    float way;
};

// The side of the water at rest on which a ray is that leaves its surface.
struct Side {
    float level;  // height of the water at rest, a little toward the other side: waves
    float up;     // 1: above, -1: below
};

// Whether the picture shows something at `at` that is nearer than it, and on the same side of the water at rest as
// the ray.
bool is_hidden(vec3 at, Side side) {
    float seen = distance_at(at.xy);
    return seen > 0.0 && seen < at.z && side.up * (height_of(at.xy, seen) - side.level) > 0.0;
}

// What is seen along a ray that leaves the surface: the picture itself where it shows it, else `around`, after an
// endless way.
Seen mirrored(vec3 position, vec3 direction, vec3 around, Side side) {
    PictureRay ray = picture_ray(position, direction);
    float low = 0.0;
    float high = 0.02 * distance(position, view.camera_ws.xyz) + 0.05;
    int steps = 0;
    vec3 at;
    bool inside;
    bool hidden;
    do {
        at = picture_of(ray, high);
        inside = in_picture(at);
        hidden = inside && is_hidden(at, side);
        low = hidden ? low : high;
        high = hidden ? high : 1.7 * high;
    } while (inside && !hidden && ++steps < kMirrorSteps);
    // Between the last step and this one it went behind something: where?
    bool met = hidden;
    float followed = low;
    steps = 0;
    do {
        float middle = 0.5 * (low + high);
        hidden = is_hidden(picture_of(ray, middle), side);
        low = hidden ? low : middle;
        high = hidden ? middle : high;
    } while (met && ++steps < kHalvings);
    vec3 hit = picture_of(ray, high);
    vec2 pixel = into_picture(met ? hit.xy : at.xy);
    vec3 color = radiance_at(pixel);
    // Far behind what hides it, it meets something that the picture does not show. Under water, where there is no sky
    // to see instead, what hides it is a better guess.
    float gap = hit.z - distance_at(pixel);
    vec2 edge = min(hit.xy, view.size.xy - hit.xy) * view.size.zw;
    float trust = clamp(min(edge.x, edge.y) * 12.0, 0.0, 1.0) * clamp(2.0 - gap / (2.0 * (high - low) + 0.05), 0.0, 1.0);
    trust = !met ? 0.0 : side.up > 0.0 ? trust : 1.0;
#ifdef FROM_BELOW
    // Under water there is no sky to see instead: what is where it leaves the picture goes on.
    if (side.up < 0.0 && !met && !inside && at.z > view.camera_ws.w) {
        vec3 start = picture_of(ray, 0.0);
        vec2 out_of = at.xy - start.xy;
        vec2 room = mix(view.size.xy - 1.0 - start.xy, 1.0 - start.xy, lessThan(out_of, vec2(0.0)));
        vec2 shares = room / mix(out_of, vec2(1e-3), lessThan(abs(out_of), vec2(1e-3)));
        vec2 leaves = into_picture(start.xy + clamp(min(shares.x, shares.y), 0.0, 1.0) * out_of);
        // What stands out of the water there is followed down into it.
        float seen = distance_at(leaves);
        float over = max(height_of(leaves, seen) - side.level + 0.2, 0.0);
        leaves.y -= seen > 0.0 ? over / (seen * 2.0 * view.size.w * max(view.ray_up.y, 1e-3)) : 0.0;
        leaves = into_picture(leaves);
        seen = distance_at(leaves);
        if (seen > 0.0 && height_of(leaves, seen) < side.level) {
            return Seen(radiance_at(leaves), followed);
        }
    }
#endif
    return Seen(mix(around, color, trust), trust > 0.5 ? high : kEndless);
}

// What a bent ray meets, as far as the picture shows it: steps to where it has gone behind something, then between
// the last two. What stands before the water is not in it. `most`: way after which there is something for certain [m].
Seen seen_through(vec3 position, vec3 direction, float most) {
    vec2 pixel = gl_FragCoord.xy;
    PictureRay ray = picture_ray(position, direction);
    float here = ray.from.z;
    float straight = distance_at(pixel);
    float way = straight > 0.0 ? (straight - here) * length(view_ray(pixel)) : kEndless;
    // Rays that leave the picture are bent less, so that its edge is not drawn out: from half way to it on.
    vec2 shift = picture_of(ray, min(way, most)).xy - pixel;
    vec2 room = mix(view.size.xy - pixel, pixel, lessThan(shift, vec2(0.0)));
    vec2 shares = room / max(2.0 * abs(shift), vec2(1e-6));
    direction = normalize(mix(normalize(position - view.camera_ws.xyz), direction, min(min(shares.x, shares.y), 1.0)));
    ray = picture_ray(position, direction);
    float reach = min(most, min(3.0 * way + 0.5, kEndless));
    float low = 0.0;
    float high = reach;
    vec2 shown = pixel;  // of the way so far, where what stands before the water does not cover it
    bool met;
    int steps = 0;
    do {
        float share = float(steps + 1) / float(kBendSteps);
        high = reach * share * share;
        vec3 at = picture_of(ray, high);
        pixel = into_picture(at.xy);
        float seen = distance_at(pixel);
        shown = seen > here ? pixel : shown;
        met = seen > here && seen < at.z;
        low = met ? low : high;
    } while (!met && ++steps < kBendSteps);
    steps = 0;
    do {
        float middle = 0.5 * (low + high);
        vec3 at = picture_of(ray, middle);
        float seen = distance_at(into_picture(at.xy));
        bool hidden = seen > here && seen < at.z;
        low = hidden ? low : middle;
        high = hidden ? middle : high;
    } while (met && ++steps < kHalvings);
    pixel = into_picture(picture_of(ray, high).xy);
    shown = distance_at(pixel) > here ? pixel : shown;
    bool endless = straight <= 0.0 && high >= reach;
    return Seen(radiance_at(shown), endless ? kEndless : high);
}
