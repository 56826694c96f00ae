// Relief in a box (ecs/components/relief_box.h): the ray through a side of the box ends where it leaves the box, and
// where it finds nothing there is a hole. Texture coordinates uv.xy are those of the map, uv.z is the depth in the box.
//   RELIEF_CLOSED  the relief has a back surface; otherwise it is solid to the end of the box
//   RELIEF_SLICES  fragments are on planes within the box: covered where front < depth < back, and no search is needed
// Included by lib/relief_surface.glsl. Depths are read at the finest level: coarser ones mix what is empty into edges.
// Techniques: relief.box, relief.multi-face, relief.slices, relief.slices-view

layout(location = 22) flat in mat3 box_from_world;  // steps, to u, v and depth of the map

const float kBoxEnd = 0.996;  // depths from here on are empty (Policarpo and Oliveira 2005)

float box_depth = 0.0;         // of the visible point
vec3 box_normal_ts = vec3(0.0);  // in place of that of the map, or 0

// Front and back depth.
vec2 box_interval(vec4 texel) {
#ifdef RELIEF_CLOSED
    return texel.wz;
#else
    return vec2(texel.w, texel.w + relief_start < kBoxEnd ? 2.0 : texel.w);
#endif
}

// From map axes (u, v, depth) to the tangent space of the map, not unit: slopes are metric.
vec3 box_normal(vec3 gradient) {
    vec3 n = gradient * box_from_world;  // a covector
    vec3 bitangent = cross(normal_ws, tangent_ws.xyz) * tangent_ws.w;
    return vec3(dot(n, tangent_ws.xyz), dot(n, bitangent), dot(n, normal_ws));
}

// Where the back is nearer than the front, the normal of the back.
void find_box_normal(vec2 at) {
#ifdef RELIEF_CLOSED
    vec4 texel = RELIEF_TEXEL(at);
    vec2 texel_size = 1.0 / vec2(textureSize(material_maps[RELIEF_MAP], 0).xy);
    vec2 slope = vec2(
        RELIEF_TEXEL(at + vec2(texel_size.x, 0.0)).z - RELIEF_TEXEL(at - vec2(texel_size.x, 0.0)).z,
        RELIEF_TEXEL(at + vec2(0.0, texel_size.y)).z - RELIEF_TEXEL(at - vec2(0.0, texel_size.y)).z) / (2.0 * texel_size);
    if (box_depth - texel.w > texel.z - box_depth) {
        box_normal_ts = box_normal(vec3(-slope, 1.0));
    }
#endif
}

// Distances along the ray, from the fragment, to the planes of the sides: where it enters the box and leaves it.
struct BoxRay {
    vec3 along;   // a step of the ray in map axes
    vec3 begin;   // of each axis
    float entry;  // the last of those
    float exit;
};

BoxRay box_ray(vec3 at, vec3 ray_ws) {
    vec3 along = box_from_world * ray_ws;
    vec3 per_side = 1.0 / mix(along, vec3(1e-12), lessThan(abs(along), vec3(1e-12)));
    vec3 low = -at * per_side;
    vec3 high = (1.0 - at) * per_side;
    vec3 begin = min(low, high);
    vec3 end = max(low, high);
    return BoxRay(along, begin, max(begin.x, max(begin.y, begin.z)), min(end.x, min(end.y, end.z)));
}

#ifdef RELIEF_SLICES
// Where each side has a map, that of the side through which the ray enters the box counts: uv.w is 1.
void find_in_box(inout vec4 uv, vec3 ray_ws) {
    BoxRay box = box_ray(uv.xyz, ray_ws);
    bool is_other = uv.w > 0.5 && (box.begin.z < box.entry || box.along.z <= 0.0);
    vec2 at = map_coordinates(kReliefSlot, uv);
    vec2 interval = box_interval(RELIEF_TEXEL(at));
    surface_hole = is_other || !(interval.x < uv.z && uv.z < interval.y);
    box_depth = uv.z;
    find_box_normal(at);
}
#else
// search: of the material's block; x is how far shadow casters are moved away from their light [m].
void find_in_box(inout vec4 uv, vec3 ray_ws, vec4 clip, vec4 search) {
    int steps = int(search.y + 0.5);
    int refinements = int(search.z);
    BoxRay box = box_ray(uv.xyz, ray_ws);
    vec3 along = box.along;
    float range = box.exit;
    ReliefRay ray = ReliefRay(
        map_coordinates(kReliefSlot, uv), map_gradient(kReliefSlot, vec4(along.xy * range, 0.0, 0.0)), along.z * range, 0.0);
    relief_start = uv.z;
    vec2 interval = box_interval(RELIEF_TEXEL(ray.uv));
    bool cut = interval.x < 0.0 && interval.y > 0.0 && uv.z > 1e-4;  // solid where the side cuts it
#ifdef RELIEF_CLOSED
    float x = relief_search(ray, steps, refinements, true);
#else
    float x = relief_search(ray, steps, refinements, false);
#endif
    x = cut ? 0.0 : x;
    box_depth = uv.z + min(x, 1.0) * ray.slope;
    bool leaves = box.entry + range <= 0.0;  // a far side, which the ray leaves through
    surface_hole = leaves || x > 1.0;
#ifndef RELIEF_CLOSED
    surface_hole = surface_hole || box_depth >= kBoxEnd && !cut;
#endif
    x = surface_hole ? 0.0 : x;
    uv.xy += along.xy * (range * x);
    relief_start = 0.0;
    find_box_normal(map_coordinates(kReliefSlot, uv));
    vec3 entry_side = -sign(along) * vec3(equal(box.begin, vec3(box.entry)));
    box_normal_ts = cut ? box_normal(entry_side) : box_normal_ts;
    surface_offset = ray_ws * (range * x);
#ifdef SHADOW_CASTER
    surface_offset += ray_ws * search.x;
#endif
    vec4 moved = clip + view.clip_from_world * vec4(surface_offset, 0.0);
    surface_depth = min(gl_FragCoord.z, moved.z / moved.w);
}
#endif
