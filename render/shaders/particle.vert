// A particle as a quad of what its image shows, lit at its corners. Definitions: those of lib/lighting.glsl, and
//   LIT      some particle scatters light that is evaluated at its corners
//   LIT_MIDDLE  some scatters light that particle_light.comp has evaluated
//   SIX_WAY  some have images of the light from six sides
//   POINTS   all are discs that face the camera: one vertex each, a point
//   RIBBONS  some are segments of ribbons
//   BILLBOARDS  some are quads of billboards
//   VELOCITY  without light, but with where they were in the previous frame
//   WEIGHTED  into the sums of a weighted mean (render/particles/particle_weighted.h)
//   IN_WATER  seen from above, before the water is drawn over it
//   FOCUS  without light, for its depth where it covers enough
// Techniques: engine.particle-cpu, engine.particle-params, particle.gpu-draw
#version 450
#define UNMASKED  // shadow masks are of the surfaces behind
#define VARYING out
#include "lib/particle.glsl"
#include "lib/particle_varyings.glsl"
#include "lib/view.glsl"

#include "lib/height_fog.glsl"
#include "lib/particle_point.glsl"
#include "lib/particle_quad.glsl"
#if defined(LIT) || defined(IN_WATER)
#include "lib/lighting.glsl"
#endif
#ifdef LIT
#include "lib/particle_scattering.glsl"
#endif
#ifdef LIT_MIDDLE
layout(binding = 28) uniform samplerBuffer middle_light;  // of each particle to draw
#endif
#ifdef RIBBONS
#include "lib/ribbon.glsl"
layout(binding = 8) uniform samplerBuffer ribbon_points;
#endif

#ifdef BILLBOARDS
#include "lib/billboard.glsl"
layout(binding = 26) uniform samplerBuffer billboard_quads;
#endif

#ifdef VELOCITY
#include "lib/particle_motion.glsl"
layout(location = 6) out vec3 previous_clip;  // clip x, y, w
#endif

uniform int first;         // of the particles to draw
uniform float resolution;  // of the image, as a share of the view's
uniform float framed;      // extent of the image, as a share of the viewport's

#ifdef WEIGHTED
uniform vec2 weight_range;  // nearest distance ahead [m], 1 / (farthest - nearest)

const float kWeightFall = 8.0;  // optical depth of the cloud that the weights suit

float weight_at(float ahead) {
    return exp(-kWeightFall * clamp((ahead - weight_range.x) * weight_range.y, 0.0, 1.0));
}
#endif

#ifdef LIT
#ifdef SIX_WAY
// Radiance of white surfaces that face the sides.
struct SixWayLight {
    vec3 positive[3];
    vec3 negative[3];
};

// A light counts at the sides that it faces by the squares of its cosines, whose sum is 1.
void add_light(inout SixWayLight sum, Incoming light, mat3 axes) {
    vec3 cosines = light.to_light * axes;
    for (int i = 0; i < 3; ++i) {
        vec3 arriving = light.irradiance * (cosines[i] * cosines[i] / kPi);
        sum.positive[i] += cosines[i] > 0.0 ? arriving : vec3(0.0);
        sum.negative[i] += cosines[i] > 0.0 ? vec3(0.0) : arriving;
    }
}

// `axes`: to the right, up and away from the camera; `radius`: of the particle [m].
SixWayLight six_way_light(vec3 position_ws, vec3 normal, mat3 axes, float radius, vec2 pixel, float distance) {
    SixWayLight sum;
    const float kSquared = 2.0 / 3.0;  // of the cosine in an even environment, against the cosine itself
    for (int i = 0; i < 3; ++i) {
        sum.positive[i] = kSquared * environment_light(position_ws, axes[i], axes[i], 1.0).irradiance;
        sum.negative[i] = kSquared * environment_light(position_ws, -axes[i], -axes[i], 1.0).irradiance;
    }
#ifdef DIRECTIONAL_LIGHTS
    for (int i = 0; i < int(view.grid_depth.z); ++i) {
        add_light(sum, incoming_directional(i, position_ws, normal, pixel), axes);
    }
#endif
#ifdef LOCAL_LIGHTS
    WaterMedium medium = water_medium(position_ws);
    uvec2 list = cell_list(clamp(pixel, vec2(0.0), view.size.xy - 1.0), distance);
    for (uint i = list.x; i < list.x + list.y; ++i) {
        int index = int(texelFetch(light_indices, int(i)).x);
        add_light(sum, incoming_shadowed(index, position_ws, normal, radius, pixel, medium), axes);
    }
#endif
    return sum;
}
#endif

#endif

const float kSmallDisc = 3.0;  // half its width, up to which it is drawn as one triangle [px]

// Of a triangle around the unit disc; the other one of the quad has no area. Along the diagonal of a quad, a software
// OpenGL shades the blocks of both triangles.
vec2 triangle_corner(int vertex) {
    const float kApex = 1.5;
    const float kBase = 2.2360680;  // (apex + 1) / sqrt(apex^2 - 1)
    return vertex < 2 ? vec2(float(2 * vertex - 1) * kBase, -1.0) : vec2(0.0, kApex);
}

#ifdef BILLBOARDS
const int kAlignedView = 1;
const int kAlignedAxis = 2;

Quad billboard_quad(int index, vec3 position) {
    vec4 first = texelFetch(billboard_quads, index * int(kBillboardTexels));
    vec3 right = first.xyz;
    vec3 up = texelFetch(billboard_quads, index * int(kBillboardTexels) + 1).xyz;
    vec3 camera_right = normalize(view.ray_right.xyz);
    if (int(first.w) == kAlignedView) {
        return Quad(length(right) * camera_right, length(up) * normalize(view.ray_up.xyz));
    }
    if (int(first.w) == kAlignedAxis) {
        right = length(right) * billboard_right(normalize(up), to_viewer(position), camera_right);
    }
    return Quad(right, up);
}
#endif

#ifdef RIBBONS
// A segment from `begin` to `end`, between its neighbors; a join where these are one place.
struct RibbonSegment {
    vec3 before;
    vec3 begin;
    vec3 end;
    vec3 after;
    vec4 place;  // of the end at which the corner is: position, texture coordinate along the ribbon
    vec4 rest;   // span, share of the curves
};

vec4 ribbon_texel(int point, int texel) {
    return texelFetch(ribbon_points, point * int(kRibbonTexels) + texel);
}

RibbonSegment ribbon_segment(int before, int end) {
    vec4 points[4];
    for (int i = 0; i < 4; ++i) {
        points[i] = ribbon_texel(before + i, 0);
    }
    return RibbonSegment(points[0].xyz, points[1].xyz, points[2].xyz, points[3].xyz, points[1 + end],
                         ribbon_texel(before + 1 + end, 1));
}

// From the middle of the ribbon to the corner; -1 .. 1 across it in w.
vec4 ribbon_corner(RibbonSegment s, int vertex, float half_width, bool has_image) {
    vec3 to_camera = normalize(view.camera_ws.xyz - s.place.xyz);
    vec3 right = normalize(view.ray_right.xyz);
    float side = float(vertex >> 1) * 2.0 - 1.0;
    bool is_cap = s.before == s.after;
    if (s.begin == s.end) {
        return is_cap && has_image ? vec4(0.0)
                                   : half_width * ribbon_join(s.before, s.begin, s.after, vertex, to_camera, right);
    }
    bool at_begin = (vertex & 1) == 0;
    vec3 before = at_begin ? s.before : s.begin;
    vec3 after = at_begin ? s.end : s.after;
    return vec4(side * ribbon_edge(before, s.place.xyz, after, to_camera, right, half_width), side * half_width);
}
#endif

void main() {
#ifdef POINTS
    int index = gl_VertexID;
    int vertex = 0;
#else
    int index = gl_VertexID >> 2;
    int vertex = gl_VertexID & 3;
#endif
    Particle p = read_particle(first + index);
    int look = p.look;
    vec4 shape = look_texel(look, 0u);
    vec4 streak = look_texel(look, 1u);
    vec4 glow = look_texel(look, 2u);
    vec4 book = look_texel(look, 3u);
    vec4 more = look_texel(look, kLookMore);
#ifdef POINTS
    corner = vec3(0.0, 0.0, 1.0);
#else
    corner = vec3(corner_of(vertex), 1.0);
#endif
#ifdef RIBBONS
    bool is_ribbon = uint(glow.w) == kFacingRibbon;
    RibbonSegment segment;
    if (is_ribbon) {
        segment = ribbon_segment(p.record, vertex & 1);
        p.position = segment.place.xyz;
        p.share = segment.rest.w;
    }
#endif
    int facing = int(glow.w);
    float away = distance(p.position, view.camera_ws.xyz);
    float size = size_from(p, shape, facing, away);
    vec4 color = color_from(p, away);

#ifdef BILLBOARDS
    bool is_billboard = uint(glow.w) == kFacingBillboard;
    if (is_billboard) {
        color.a *= p.opacity;
    }
#endif
#ifdef POINTS
    float diameter = resolution * point_diameter(p.position, size, facing, away);
    gl_PointSize = max(diameter, 1.0);
    color.a *= point_opacity(diameter);
    Quad quad = Quad(vec3(0.0), vec3(0.0));
#else
    Quad quad = quad_of(p, shape, streak, more.w, facing, size);
#endif
#ifdef BILLBOARDS
    if (is_billboard) {
        quad = billboard_quad(p.record, p.position);
    }
#endif

    float shown = frame_shown(p, book, int(more.x));
#ifdef BILLBOARDS
    shown = is_billboard ? texelFetch(billboard_quads, p.record * int(kBillboardTexels) + 1).w : shown;
#endif
    Flipbook flipbook = flipbook_at(shown, book, int(more.x));
#ifdef IMAGES
    corner.xy = trimmed_corner(corner.xy, look, flipbook, quad, pixel_extent(p.position) / resolution);
#endif
    bool is_small_disc = book.w < 0.0 && min(length(quad.right), length(quad.up)) * resolution < kSmallDisc * pixel_extent(p.position);
#ifdef LIT
    is_small_disc = is_small_disc && (glow.y <= 0.0 || look_texel(look, kLookFocus).y > 0.0);  // not lit at its corners
#endif
#ifdef RIBBONS
    is_small_disc = is_small_disc && !is_ribbon;
#endif
    corner.xy = is_small_disc ? triangle_corner(vertex) : corner.xy;
    vec3 offset = corner.x * quad.right + corner.y * quad.up;
#ifdef RIBBONS
    if (is_ribbon) {
        vec3 span = segment.rest.xyz;
        offset = corner.y * 0.5 * size_factor(look, p.share * float(kLookSamples - 1u)) * span;
        float side = corner.y;
        float half_width = 1.0;
        p.position += 0.5 * span;
        if (span == vec3(0.0)) {
            float thinnest = pixel_extent(p.position);  // fainter instead of narrower: thin ones would break up into dots
            color.a *= min(0.5 * size / thinnest, 1.0);
            half_width = max(0.5 * size, thinnest);
            vec4 across = ribbon_corner(segment, vertex, half_width, book.w >= 0.0);
            offset = across.xyz;
            side = across.w;
        }
        // A disc's profile is the same all along.
        corner = vec3(book.w < 0.0 ? 0.0 : 2.0 * segment.place.w - 1.0, side, half_width);
    }
#endif
    vec3 corner_ws = p.position + offset;
    gl_Position = view.clip_from_world * vec4(corner_ws, 1.0);
    gl_Position.xy *= framed;
    distance_ahead = gl_Position.w;
#ifdef WEIGHTED
    weight = weight_at(distance_ahead);
#endif
#ifdef VELOCITY
    vec3 velocity = p.velocity;
    float age = p.age;
    vec4 pull = look_texel(look, kLookMotion + 1u);
#ifdef BILLBOARDS
    if (is_billboard) {
        velocity = texelFetch(billboard_quads, p.record * int(kBillboardTexels) + 2).xyz;
        age = since_previous.x;
        pull = vec4(0.0);
    }
#endif
    previous_clip = (view.previous_clip_from_world * vec4(previous_place(corner_ws, velocity, age, pull), 1.0)).xyw;
#endif
#ifdef CLIPPED
    gl_ClipDistance[0] = dot(view.clip_plane, vec4(corner_ws, 1.0));
#endif

    vec3 radiance = vec3(glow.x);
    bool is_lit = glow.y > 0.0;
#ifdef LIT_MIDDLE
    bool at_middle = look_texel(look, kLookFocus).y > 0.0;
    radiance += at_middle ? texelFetch(middle_light, first + index).rgb : vec3(0.0);
    is_lit = is_lit && !at_middle;
#endif
#ifdef SIX_WAY
    float negative_layer = look_texel(look, kLookMotion).w;
    bool is_six_way = negative_layer >= 0.0;
    glow_color = color.rgb * glow.x * color.a;
    for (int i = 0; i < 3; ++i) {
        positive_side[i] = vec4(0.0, 0.0, 0.0, negative_layer);
        negative_side[i] = vec3(0.0);
    }
#ifdef LIT
    if (is_six_way && glow.y > 0.0) {
        vec3 away_axis = -to_viewer(p.position);
        mat3 axes = mat3(normalize(quad.right), normalize(quad.up), away_axis);
        vec4 middle = view.clip_from_world * vec4(p.position, 1.0);
        vec2 pixel = (middle.xy / max(middle.w, 1e-6) * 0.5 + 0.5) * view.size.xy;
        float ahead = max(middle.w, view.camera_ws.w);
        SixWayLight sides = six_way_light(lit_place(p, offset), -away_axis, axes, 0.5 * size, pixel, ahead);
        vec3 white = color.rgb * glow.y * color.a;
        for (int i = 0; i < 3; ++i) {
            positive_side[i].rgb = white * sides.positive[i];
            negative_side[i] = white * sides.negative[i];
        }
    }
#endif
#endif
#ifdef LIT
#ifdef SIX_WAY
    if (is_lit && !is_six_way) {
#else
    if (is_lit) {
#endif
#ifdef POINTS
        vec3 normal = to_viewer(p.position);
#else
        vec3 normal = rounded_normal(p.position, offset);
#endif
        vec4 middle = view.clip_from_world * vec4(p.position, 1.0);
        vec2 pixel = (middle.xy / max(middle.w, 1e-6) * 0.5 + 0.5) * view.size.xy;
        float ahead = max(middle.w, view.camera_ws.w);
        radiance += glow.y * scattered_light(lit_place(p, offset), normal, streak.w, 0.5 * size, pixel, ahead);
    }
#endif
    light = vec4(color.rgb * radiance * color.a, color.a);
#ifndef IN_WATER  // which is drawn over it and gets the fog
    vec4 fog = fog_before(p.position);
    vec3 veil = fog.rgb * (color.a * glow.z);
    light.rgb = light.rgb * (1.0 - fog.a) + veil;
#ifdef SIX_WAY
    glow_color = glow_color * (1.0 - fog.a) + veil;
    for (int i = 0; i < 3; ++i) {
        positive_side[i].rgb *= 1.0 - fog.a;
        negative_side[i] *= 1.0 - fog.a;
    }
#endif
#endif
#ifdef IN_WATER
    WaterMedium water = water_medium(p.position);
    medium = vec4(water.extinction, water.index);
#endif

    frames = flipbook.frames;
    next_frame = vec4(flipbook.next, look_texel(look, kLookMotion).xy);
    blend = vec4(glow.z, streak.z, flipbook.progress, book.w);
    // Too small to draw, transparent or dead.
    bool is_gone = size <= 0.0 || color.a <= 0.0 || p.is_dead;
#ifdef IN_WATER
    is_gone = is_gone || water.depth < 0.0;
#endif
#ifdef VELOCITY
    is_gone = is_gone || color.a * glow.z <= look_texel(look, kLookMotion).z;
    blend.x = glow.z / max(look_texel(look, kLookMotion).z, 1e-6);
#endif
#ifdef FOCUS
    float least = max(look_texel(look, kLookFocus).x, 1e-6);
    is_gone = is_gone || color.a <= least;
    blend.x = 1.0 / least;
#endif
#ifdef RIBBONS
#ifdef VELOCITY
    is_gone = is_gone || is_ribbon;
#else
    is_gone = is_gone && !is_ribbon;
#endif
#endif
#if defined(BILLBOARDS) && !defined(VELOCITY)
    is_gone = is_billboard ? color.a <= 0.0 : is_gone;
#endif
    if (is_gone) {
#ifdef POINTS
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
#else
        gl_Position = vec4(0.0, 0.0, 0.5, 1.0);  // without area: outside the image, it would have to be clipped
#endif
    }
}
