// Visibility of lights: lookups in the shadow atlas (render/shadow/shadow_list.h).
//
// The bias needs no tuning. Lookups are offset along the normal by up to a texel of the map in world units, more at
// grazing incidence; and every texel of a filter is compared with the depth of the surface's plane there (receiver
// plane bias), not with that of the point. Planes have no acne at any angle, the offset helps curved surfaces, and a
// shadow is detached from its caster by two texels at most.
// After Isidoro, "Shadow Mapping: GPU-based Tips and Techniques", 2006; King, "Shadow Mapping Algorithms", 2004.
//
// Definitions, which only save a software OpenGL needless work:
//   SHADOW_CUBES     some light has six faces
//   SHADOW_CASCADES  some light has cascades
//   SHADOW_SOFT      some filter is wider than 2x2
//   SHADOW_CONTACT   some filter is contact-hardening; with SHADOW_SOFT
//   SHADOW_MAPS      some light has a map
//   SHADOW_MASKS     some light has a layer of the shadow mask: shadow volumes
// Techniques: shadow.map, shadow.map-omni, shadow.pcf, shadow.penumbra, shadow.soft-pcf,
//     shadow.stencil-frame, skin.transmission
// Source of skin.transmission: Jimenez et al. 2010

#include "lib/noise.glsl"
#include "shadow_gpu.h"

layout(binding = kShadowAtlasUnit) uniform sampler2D shadow_atlas;      // reversed depth, 0 where empty
layout(binding = kShadowViewsUnit) uniform samplerBuffer shadow_views;  // ShadowViewRecord

const float kCascadeBlend = 0.1;  // fraction of a cascade over which it blends into the next one

// ShadowFilter.
const float kFilterHard = 0.0;
const float kFilterBilinear = 1.0;
const float kFilterSoft = 2.0;
const float kFilterContactHardening = 3.0;

const float kOffsetFacing = 0.1;  // along the normal at normal incidence, against rounding [texels]
const float kOffsetGrazing = 1.0;  // added at grazing incidence [texels]
const float kMinCosine = 0.05;  // between light and plane; below it, the plane's slope is unreliable

const float kSoftHalf = 2.0;      // half side of the soft filter [texels]
const int kSearchTaps = 16;       // of the blocker search
const int kPenumbraTaps = 32;
const vec2 kGoldenTurn = vec2(-0.73736888, 0.67549029);  // cosine and sine of the golden angle

// A point in a shadow view.
struct ShadowPoint {
    vec2 st;      // texels of the atlas
    float depth;
    vec2 slope;   // of the surface's plane: depth per texel
    vec4 rect;    // texels that may be read
};

// Depth of the surface's plane at texels; clamped to be no farther from the light than the point, so that the ground
// in front of a wall, nearer than the wall's plane below it, does not shadow the wall.
vec4 plane_depths(ShadowPoint p, vec4 s, vec4 t) {
    return p.depth + max(p.slope.x * (s - p.st.x) + p.slope.y * (t - p.st.y), 0.0);
}

// Area [texels] of a square of side 2 `half_side` about `st` that is covered by lit texels, of the 2x2 texels right of
// and above `corner`.
float lit_area(ShadowPoint p, vec2 st, vec2 corner, float half_side) {
    vec4 s = corner.xxxx + vec4(0.5, 1.5, 1.5, 0.5);
    vec4 t = corner.yyyy + vec4(1.5, 1.5, 0.5, 0.5);
    vec4 nearest = textureGather(shadow_atlas, (corner + 1.0) / vec2(textureSize(shadow_atlas, 0)));
    vec4 lit = vec4(lessThanEqual(nearest, plane_depths(p, s, t)));
    vec4 covered = clamp(half_side + 0.5 - abs(s - st.x), 0.0, 1.0) * clamp(half_side + 0.5 - abs(t - st.y), 0.0, 1.0);
    return dot(lit, covered);
}

// The lower left corner of the 2x2 texels nearest to a point.
vec2 corner_at(ShadowPoint p, vec2 st) {
    return floor(clamp(st, p.rect.xy + 1.0, p.rect.zw - 1.0) - 0.5);
}

// Bilinear 2x2 comparison (PCF); or the nearest texel only.
float lit_fraction(ShadowPoint p, bool hard) {
    vec2 corner = corner_at(p, p.st);
    vec2 st = hard ? corner + 0.5 + step(0.5, p.st - 0.5 - corner) : p.st;
    return lit_area(p, st, corner, 0.5);
}

#ifdef SHADOW_CONTACT
// Mean depth of blockers within `radius` [texels], or 0.
float blocker_depth(ShadowPoint p, float radius, vec2 turn) {
    float sum = 0.0;
    float count = 0.0;
    int n = 0;
    do {
        vec2 at = p.st + turn * (radius * sqrt(float(n) / float(kSearchTaps)));  // its own texel first
        at = clamp(at, p.rect.xy + 0.5, p.rect.zw - 0.5);
        float nearest = texelFetch(shadow_atlas, ivec2(at), 0).r;
        vec2 to = floor(at) + 0.5 - p.st;
        float blocks = nearest > p.depth + max(dot(p.slope, to), 0.0) ? 1.0 : 0.0;
        sum += blocks * nearest;
        count += blocks;
        turn = vec2(turn.x * kGoldenTurn.x - turn.y * kGoldenTurn.y, turn.x * kGoldenTurn.y + turn.y * kGoldenTurn.x);
    } while (++n < kSearchTaps);
    return sum / max(count, 1.0);
}

// All filters in one loop over 2x2 texels, since a software OpenGL would execute one loop per filter: one iteration
// for the narrow filters; nine for the soft one, 6x6 texels of which the square covers 5x5; and for the
// contact-hardening one, points of a disc as wide as the penumbra (Fernando 2005).
float filtered_visibility(ShadowPoint p, vec4 settings, vec2 pixel, bool needed) {
    float filter_kind = settings.x;
    bool contact = filter_kind == kFilterContactHardening;
    bool soft = filter_kind == kFilterSoft;

    // The disc is rotated per pixel (Jimenez 2014), which turns banding into fine grain.
    float angle = 6.2831853 * pixel_noise(pixel);
    vec2 turn = vec2(cos(angle), sin(angle));
    float search = min(0.5 * settings.z * (1.0 - p.depth), settings.w);
    float blocker = contact ? blocker_depth(p, search, turn) : 0.0;
    float radius = clamp(0.5 * settings.z * (blocker - p.depth), 0.0, settings.w);

    vec2 near = soft ? floor(p.st - kSoftHalf) : corner_at(p, p.st);
    vec2 center = filter_kind == kFilterHard ? near + 0.5 + step(0.5, p.st - 0.5 - near) : p.st;
    float half_side = soft ? kSoftHalf : 0.5;
    int taps = contact ? kPenumbraTaps : soft ? 9 : 1;
    float sum = 0.0;
    int n = 0;
    do {
        float row = floor((float(n) + 0.5) / 3.0);
        vec2 st = p.st + turn * (radius * sqrt((float(n) + 0.5) / float(kPenumbraTaps)));
        vec2 corner = contact ? corner_at(p, st) : near + (soft ? 2.0 * vec2(float(n) - 3.0 * row, row) : vec2(0.0));
        sum += lit_area(p, contact ? clamp(st, p.rect.xy + 1.0, p.rect.zw - 1.0) : center, corner, half_side);
        turn = vec2(turn.x * kGoldenTurn.x - turn.y * kGoldenTurn.y, turn.x * kGoldenTurn.y + turn.y * kGoldenTurn.x);
    } while (++n < taps);
    float lit = sum / (contact ? float(kPenumbraTaps) : soft ? 16.0 : 1.0);
    return contact && blocker == 0.0 ? 1.0 : lit;
}
#elif defined(SHADOW_SOFT)
// The same without the contact-hardening filter. Three lookups per row, so that narrow filters end after the first row.
// Not `needed`: any result will do, as soon as possible.
float filtered_visibility(ShadowPoint p, vec4 settings, vec2 pixel, bool needed) {
    bool soft = needed && settings.x == kFilterSoft;
    vec2 corner = soft ? floor(p.st - kSoftHalf) : corner_at(p, p.st);
    vec2 center = settings.x == kFilterHard ? corner + 0.5 + step(0.5, p.st - 0.5 - corner) : p.st;
    float half_side = soft ? kSoftHalf : 0.5;
    int rows = soft ? 3 : 1;
    float sum = 0.0;
    int row = 0;
    do {
        sum += lit_area(p, center, corner, half_side);
        sum += lit_area(p, center, corner + vec2(2.0, 0.0), half_side);
        sum += lit_area(p, center, corner + vec2(4.0, 0.0), half_side);
        corner.y += 2.0;
    } while (++row < rows);
    return soft ? sum / 16.0 : sum;
}
#endif

// Visibility in one view; 1 outside it.
float view_visibility(int view_index, vec3 position_ws, vec3 normal, vec3 to_light, vec2 pixel) {
    int at = view_index * int(kShadowViewTexels);
    vec4 row_s = texelFetch(shadow_views, at);
    vec4 row_t = texelFetch(shadow_views, at + 1);
    vec4 row_r = texelFetch(shadow_views, at + 2);
    vec4 row_q = texelFetch(shadow_views, at + 3);
    vec4 settings = texelFetch(shadow_views, at + 8);

    // Width of a texel at the surface: the inverse of the texel gradient.
    vec4 position = vec4(position_ws, 1.0);
    float q = dot(row_q, position);
    vec2 st = vec2(dot(row_s, position), dot(row_t, position)) / q;
    vec3 right = row_s.xyz - st.x * row_q.xyz;
    vec3 up = row_t.xyz - st.y * row_q.xyz;
    float texel = abs(q) * inversesqrt(min(dot(right, right), dot(up, up)));
    float n_l = clamp(dot(normal, to_light), 0.0, 1.0);
    position.xyz += normal * (settings.y * texel * (kOffsetFacing + kOffsetGrazing * sqrt(1.0 - n_l * n_l)));

    ShadowPoint p;
    q = dot(row_q, position);
    p.st = vec2(dot(row_s, position), dot(row_t, position)) / q;
    p.depth = dot(row_r, position) / q;
    p.rect = texelFetch(shadow_views, at + 7);
    vec3 slanted = normal + to_light * max(kMinCosine - n_l, 0.0);
    vec4 plane = vec4(slanted, -dot(slanted, position.xyz));
    vec3 plane_in_shadow = vec3(
        dot(texelFetch(shadow_views, at + 4), plane),
        dot(texelFetch(shadow_views, at + 5), plane),
        dot(texelFetch(shadow_views, at + 6), plane));
    p.slope = plane_in_shadow.xy * (-min(settings.y, 1.0) / plane_in_shadow.z);

    bool inside = q > 0.0 && all(greaterThan(p.st, p.rect.xy)) && all(lessThan(p.st, p.rect.zw));
#ifdef SHADOW_SOFT
    float lit = filtered_visibility(p, settings, pixel, inside);
#else
    float lit = lit_fraction(p, settings.x == kFilterHard);
#endif
    return inside ? lit : 1.0;
}

// The cube map face of a direction, in the order of make_cube_view.
int cube_face(vec3 direction) {
    vec3 size = abs(direction);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    float along = axis == 0 ? direction.x : axis == 1 ? direction.y : direction.z;
    return 2 * axis + (along < 0.0 ? 1 : 0);
}

#ifdef SHADOW_MASKS
#ifdef UNMASKED
// The mask covers opaque surfaces only.
float mask_visibility(float layer, vec2 pixel) {
    return 1.0;
}
#else
layout(binding = kShadowMasksUnit) uniform sampler2DArray shadow_masks;  // one layer per light with shadow volumes

float mask_visibility(float layer, vec2 pixel) {
    return texelFetch(shadow_masks, ivec3(pixel, layer), 0).r;
}
#endif
#endif

#ifdef SHADOW_MAPS
// The view of a light toward a point; of cascades, the nearest.
int first_view(vec4 shadow, vec3 to_light) {
    int index = max(int(shadow.x), 0);
#ifdef SHADOW_CUBES
    index += shadow.y == kShadowCube ? cube_face(-to_light) : 0;
#endif
    return index;
}

const float kOpaque = 1e6;  // more than any thickness that transmits light [m]

// Thickness [m] of matter that light has crossed at `position_ws`: distance from the nearest caster, the mean of 2x2
// texels; kOpaque for lights without a map and outside the map. Of cascades, the first that contains the point.
float shadow_thickness(vec4 shadow, vec3 position_ws, vec3 to_light) {
    int index = first_view(shadow, to_light);
#ifdef SHADOW_CASCADES
    float along = dot(position_ws - view.camera_ws.xyz, view.ray_forward.xyz) - view.orthographic.x;
    vec4 ends = texelFetch(shadow_views, index * int(kShadowViewTexels) + 9);
    float passed = min(dot(step(ends, vec4(along)), vec4(1.0)), shadow.z - 1.0);
    index += shadow.y == kShadowCascades ? int(passed) : 0;
#endif
    int at = index * int(kShadowViewTexels);
    vec4 row_r = texelFetch(shadow_views, at + 2);
    vec4 row_q = texelFetch(shadow_views, at + 3);
    vec4 position = vec4(position_ws, 1.0);
    float q = dot(row_q, position);
    float r = dot(row_r, position);
    vec2 st = vec2(dot(texelFetch(shadow_views, at), position), dot(texelFetch(shadow_views, at + 1), position)) / q;
    vec4 rect = texelFetch(shadow_views, at + 7);
    vec2 corner = floor(clamp(st, rect.xy + 1.0, rect.zw - 1.0) - 0.5);
    vec4 nearest = textureGather(shadow_atlas, (corner + 1.0) / vec2(textureSize(shadow_atlas, 0)));
    // Depth (r + t r') / (q + t q') at t toward the light, solved for t.
    vec4 travel = (nearest * q - r) / (dot(row_r.xyz, to_light) - nearest * dot(row_q.xyz, to_light));
    vec2 fraction = clamp(st - corner - 0.5, 0.0, 1.0);
    travel = max(travel, vec4(0.0));
    float mean = mix(mix(travel.w, travel.z, fraction.x), mix(travel.x, travel.y, fraction.x), fraction.y);
    bool inside = q > 0.0 && all(greaterThan(st, rect.xy)) && all(lessThan(st, rect.zw));
    bool has_map = shadow.y != kShadowNone && shadow.y != kShadowMask;
    return inside && has_map ? mean : kOpaque;
}
#endif

// Fraction of the light that arrives at `position_ws`, 0 .. 1.
//   shadow  LightRecord::shadow
//   normal  of the surface, unit
//   pixel   that shows it, gl_FragCoord.xy
float light_visibility(vec4 shadow, vec3 position_ws, vec3 normal, vec3 to_light, vec2 pixel) {
#ifdef SHADOW_MAPS
    int index = first_view(shadow, to_light);
#ifdef SHADOW_CASCADES
    // Toward its end a cascade blends into the next one, or into light; only there both are sampled.
    float along = dot(position_ws - view.camera_ws.xyz, view.ray_forward.xyz) - view.orthographic.x;
    vec4 ends = texelFetch(shadow_views, index * int(kShadowViewTexels) + 9);
    bool cascades = shadow.y == kShadowCascades;
    float passed = cascades ? dot(step(ends, vec4(along)), vec4(1.0)) : 0.0;
    float end = passed < 1.0 ? ends.x : passed < 2.0 ? ends.y : passed < 3.0 ? ends.z : ends.w;
    float next = cascades ? clamp((along / end - 1.0 + kCascadeBlend) / kCascadeBlend, 0.0, 1.0) : 0.0;
    float weight = 1.0 - next;
    float lit = 0.0;
    do {
        int cascade = int(passed);
        bool exists = passed < shadow.z;
        float visible = view_visibility(index + (exists ? cascade : 0), position_ws, normal, to_light, pixel);
        lit += weight * (exists ? visible : 1.0);
        passed += 1.0;
        weight = next;
        next = 0.0;
    } while (weight > 0.0);
#else
    float lit = view_visibility(index, position_ws, normal, to_light, pixel);
#endif
#else
    float lit = 1.0;
#endif
#ifdef SHADOW_MASKS
    lit = shadow.y == kShadowMask ? mask_visibility(max(shadow.x, 0.0), pixel) : lit;
#endif
    return shadow.y == kShadowNone ? 1.0 : lit;
}
