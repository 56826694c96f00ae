// A particle as a quad, lit at its corners. Definitions: those of lib/lighting.glsl, and
//   LIT      some particle scatters light
//   RIBBONS  some are segments of ribbons
//   BILLBOARDS  some are quads of billboards
#version 450
#define UNMASKED  // shadow masks are of the surfaces behind
#include "lib/periodic.glsl"
#include "lib/view.glsl"
#include "particle_gpu.h"
#ifdef LIT
#include "lib/lighting.glsl"
#endif
#ifdef RIBBONS
#include "lib/ribbon.glsl"
layout(binding = 8) uniform samplerBuffer ribbon_points;
#endif

#ifdef BILLBOARDS
#include "lib/billboard.glsl"
layout(binding = 26) uniform samplerBuffer billboard_quads;
#endif

layout(binding = 2) uniform usamplerBuffer particles;
layout(binding = 3) uniform samplerBuffer looks;
uniform int first;  // of the particles to draw

layout(location = 0) out vec3 corner;                  // -1 .. 1; y is multiplied by z, so that it stays straight
layout(location = 1) out vec4 light;                   // radiance of the middle, premultiplied by a: its opacity
layout(location = 2) flat out vec4 frames;             // texture coordinates: scale xy, offset of the frame zw
layout(location = 3) flat out vec4 blend;              // cover, softness [m], share of the next frame, layer
layout(location = 4) flat out vec2 next_frame;         // its offset
layout(location = 5) out float distance_ahead;         // along the view axis [m]

const int kFacingVelocity = 1;
const int kFacingGround = 2;
const int kFacingPixels = 3;
const int kFramesShuffle = 1;
const int kFramesPick = 2;
const float kRoundness = 0.8;  // how far the normals at the corners lean outward, by eye

float random_share(uint bits, uint index) {  // -1 .. 1
    uint h = (bits + index * 0x9e3779b9u) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return float(h >> 8) * (2.0 / 16777216.0) - 1.0;
}

vec4 look_texel(int look, uint texel) {
    return texelFetch(looks, look * int(kLookTexels) + int(texel));
}

float size_factor(int look, float at) {
    int i = min(int(at), int(kLookSamples) - 2);
    float a = look_texel(look, kLookSizes + uint(i >> 2))[i & 3];
    float b = look_texel(look, kLookSizes + uint((i + 1) >> 2))[(i + 1) & 3];
    return mix(a, b, at - float(i));
}

vec4 color_at(int look, float at) {
    int i = min(int(at), int(kLookSamples) - 2);
    return mix(look_texel(look, kLookColors + uint(i)), look_texel(look, kLookColors + uint(i) + 1u), at - float(i));
}

#ifdef LIT
// Radiance that a white puff scatters toward `to_camera`: around its round surface, and forward through it (Henyey and
// Greenstein 1941).
vec3 scattered(Incoming light, vec3 normal, vec3 to_camera, float forward) {
    float wrapped = 0.5 + 0.5 * dot(normal, light.to_light);
    float g2 = forward * forward;
    float base = 1.0 + g2 + 2.0 * forward * dot(light.to_light, to_camera);
    float lobe = (1.0 - g2) / (4.0 * max(base * sqrt(base), 1e-4));
    return light.irradiance * (mix(wrapped * wrapped, lobe, abs(forward)) / kPi);
}

vec3 scattered_light(vec3 position_ws, vec3 normal, float forward, vec2 pixel, float distance) {
    vec3 to_camera = to_viewer(position_ws);
    vec3 sum = environment_light(position_ws, normal, normal, 1.0).irradiance;
#ifdef DIRECTIONAL_LIGHTS
    for (int i = 0; i < int(view.grid_depth.z); ++i) {
        sum += scattered(incoming_directional(i, position_ws, normal, pixel), normal, to_camera, forward);
    }
#endif
#ifdef LOCAL_LIGHTS
    WaterMedium medium = water_medium(position_ws);
    uvec2 list = cell_list(clamp(pixel, vec2(0.0), view.size.xy - 1.0), distance);
    for (uint i = list.x; i < list.x + list.y; ++i) {
        int index = int(texelFetch(light_indices, int(i)).x);
        Incoming light = incoming_local(index, position_ws, normal, medium);
        light.irradiance *= index < int(view.grid_depth.w)
                                ? vec3(1.0)
                                : light_transmittance(index, position_ws, normal, light.to_light, pixel);
        sum += scattered(light, normal, to_camera, forward);
    }
#endif
    return sum;
}
#endif

// Extent of a pixel at this place [m].
float pixel_extent(vec3 position_ws) {
    float ahead = dot(position_ws - view.camera_ws.xyz, view.ray_forward.xyz);
    return max(ahead, 1e-4) * 2.0 * length(view.ray_up.xyz) * view.size.w;
}

// Half the extents of the quad in world space: along x and y of `corner`.
struct Quad {
    vec3 right;
    vec3 up;
};
Quad quad_of(vec4 shape, vec4 streak, float tumble, vec3 position, vec3 velocity, int facing, uint random, float size,
             float age) {
    float angle = shape.z * random_share(random, 1u) + (shape.w + streak.x * random_share(random, 2u)) * age;
    vec3 to_camera = normalize(view.camera_ws.xyz - position);
    vec3 right = normalize(view.ray_right.xyz);
    vec3 up = normalize(cross(to_camera, right));
    right = cross(up, to_camera);
    if (facing == kFacingGround) {
        right = vec3(1.0, 0.0, 0.0);
        up = vec3(0.0, 0.0, -1.0);
    }
    vec3 turned = cos(angle) * right + sin(angle) * up;
    up = cos(angle) * up - sin(angle) * right;
    right = turned;
    float half_size = 0.5 * size;
    if (facing == kFacingVelocity) {
        float speed = length(velocity);
        vec3 along = speed > 1e-6 ? velocity / speed : up;
        vec3 across = cross(along, to_camera);
        float seen = length(across);  // its length in the image, of what it would be from the side
        across = seen > 1e-3 ? across / seen : right;
        return Quad(half_size * across, (half_size + 0.5 * streak.y * speed) * along);
    }
    if (tumble > 0.0) {
        float lean = tumble * (0.6 + 0.4 * random_share(random, 3u)) * age + 3.14159 * random_share(random, 4u);
        right = cos(lean) * right + sin(lean) * cross(right, up);
    }
    return Quad(half_size * right, half_size * up);
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
    int particle = first + gl_InstanceID;
    uvec4 place = texelFetch(particles, particle * int(kParticleTexels));
    uvec4 rest = texelFetch(particles, particle * int(kParticleTexels) + 1);
    vec3 position = uintBitsToFloat(place.xyz);
    int look = int(place.w >> 16);
    float share = float(place.w & 0xffffu) / 65535.0;
    vec2 velocity_xy = unpackHalf2x16(rest.x);
    vec2 velocity_z_age = unpackHalf2x16(rest.y);
    vec3 velocity = vec3(velocity_xy, velocity_z_age.x);
    float age = velocity_z_age.y;

    vec4 shape = look_texel(look, 0u);
    vec4 streak = look_texel(look, 1u);
    vec4 glow = look_texel(look, 2u);
    vec4 book = look_texel(look, 3u);
    vec4 more = look_texel(look, kLookMore);
    corner = vec3(gl_VertexID & 1, gl_VertexID >> 1, 1.0) * vec3(2.0, 2.0, 1.0) - vec3(1.0, 1.0, 0.0);
#ifdef RIBBONS
    bool is_ribbon = uint(glow.w) == kFacingRibbon;
    RibbonSegment segment;
    if (is_ribbon) {
        segment = ribbon_segment(int(rest.x), gl_VertexID & 1);
        position = segment.place.xyz;
        share = segment.rest.w;
    }
#endif
    float at = share * float(kLookSamples - 1u);
    float size = max(shape.x + shape.y * random_share(rest.z, 0u), 0.0) * size_factor(look, at);
    vec4 wave = look_texel(look, kLookMore + 2u);
    vec4 varied = look_texel(look, kLookMore + 3u);
    float color_share = at;
    if (age >= 0.0 && (wave.y != 0.0 || wave.z != 0.0) && int(glow.w) < int(kFacingRibbon)) {
        float place_in_colors = wave.y + wave.z * periodic_wave(int(wave.x), varied.x * age, wave.w);
        color_share = clamp(place_in_colors, 0.0, 1.0) * float(kLookSamples - 1u);
    }
    vec4 color = color_at(look, color_share);
    if (varied.yzw != vec3(0.0)) {
        vec3 chance = vec3(random_share(rest.z, 6u), random_share(rest.z, 7u), random_share(rest.z, 8u));
        color.rgb = max(color.rgb + varied.yzw * chance, vec3(0.0));
    }
    float away = distance(position, view.camera_ws.xyz);
    color.a *= more.y > 0.0 ? smoothstep(0.0, more.y, away) : 1.0;
    color.a *= more.z > 0.0 ? smoothstep(more.z, 0.6 * more.z, away) : 1.0;
    vec4 point = look_texel(look, kLookMore + 1u);
    if (point.w > 0.0 && share > 0.0) {
        color.a *= clamp(age * (1.0 - share) / (share * point.w), 0.0, 1.0);
    }
    if (int(glow.w) == kFacingPixels) {
        size *= inversesqrt(max(point.x + away * (point.y + away * point.z), 1e-12)) * pixel_extent(position);
    }

#ifdef BILLBOARDS
    bool is_billboard = uint(glow.w) == kFacingBillboard;
    if (is_billboard) {
        color.a *= uintBitsToFloat(rest.y);
    }
#endif
    Quad quad = quad_of(shape, streak, more.w, position, velocity, int(glow.w), rest.z, size, age);
#ifdef BILLBOARDS
    if (is_billboard) {
        quad = billboard_quad(int(rest.x), position);
    }
#endif
    vec3 offset = corner.x * quad.right + corner.y * quad.up;
#ifdef RIBBONS
    if (is_ribbon) {
        vec3 span = segment.rest.xyz;
        offset = corner.y * 0.5 * size_factor(look, at) * span;
        float side = corner.y;
        float half_width = 1.0;
        position += 0.5 * span;
        if (span == vec3(0.0)) {
            float thinnest = pixel_extent(position);  // fainter instead of narrower: thin ones would break up into dots
            color.a *= min(0.5 * size / thinnest, 1.0);
            half_width = max(0.5 * size, thinnest);
            vec4 across = ribbon_corner(segment, gl_VertexID, half_width, book.w >= 0.0);
            offset = across.xyz;
            side = across.w;
        }
        // A disc's profile is the same all along.
        corner = vec3(book.w < 0.0 ? 0.0 : 2.0 * segment.place.w - 1.0, side, half_width);
    }
#endif
    vec3 corner_ws = position + offset;
    gl_Position = view.clip_from_world * vec4(corner_ws, 1.0);
    distance_ahead = gl_Position.w;
#ifdef CLIPPED
    gl_ClipDistance[0] = dot(view.clip_plane, vec4(corner_ws, 1.0));
#endif

    vec3 radiance = vec3(glow.x);
#ifdef LIT
    if (glow.y > 0.0) {
        vec3 normal = normalize(to_viewer(position) + kRoundness * normalize(offset + vec3(0.0, 1e-6, 0.0)));
        vec4 middle = view.clip_from_world * vec4(position, 1.0);
        vec2 pixel = (middle.xy / max(middle.w, 1e-6) * 0.5 + 0.5) * view.size.xy;
        radiance += glow.y * scattered_light(position, normal, streak.w, pixel, max(middle.w, view.camera_ws.w));
    }
#endif
    light = vec4(color.rgb * radiance * color.a, color.a);

    float count = book.x * book.y;
    float shown = book.z > 0.0 ? age * book.z : share * (count - 1.0);
    int frames_shown = int(more.x);
    float chance = floor((0.5 + 0.5 * random_share(rest.z, 5u)) * count);
    shown = frames_shown == kFramesPick ? chance : frames_shown == kFramesShuffle ? shown + chance : shown;
#ifdef BILLBOARDS
    shown = is_billboard ? texelFetch(billboard_quads, int(rest.x) * int(kBillboardTexels) + 1).w : shown;
#endif
    bool loops = book.z > 0.0 || frames_shown == kFramesShuffle;
    float frame = mod(floor(shown), count);
    float next = loops ? mod(frame + 1.0, count) : min(frame + 1.0, count - 1.0);
    frames = vec4(1.0 / book.xy, vec2(mod(frame, book.x), floor(frame / book.x)) / book.xy);
    next_frame = vec2(mod(next, book.x), floor(next / book.x)) / book.xy;
    blend = vec4(glow.z, streak.z, count > 1.0 ? fract(shown) : 0.0, book.w);
    // Too small to draw, transparent or dead.
    bool is_gone = size <= 0.0 || color.a <= 0.0 || rest.w != 0u;
#ifdef RIBBONS
    is_gone = is_gone && !is_ribbon;
#endif
#ifdef BILLBOARDS
    is_gone = is_billboard ? color.a <= 0.0 : is_gone;
#endif
    if (is_gone) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
}
