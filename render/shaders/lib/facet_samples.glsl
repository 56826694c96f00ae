// A geometry shader that lights FACET_SAMPLES points of each triangle, 6 or 10, by all lights that reach its object (fakephong.quadratic,
// fakephong.cubic). A point between vertices has the weighted position and color, and the normalized weighted normal.
#define UNMASKED  // shadow masks are in screen space
#include "lib/lighting.glsl"
#include "lib/material_maps.glsl"
#include "lib/light_at.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

layout(location = 0) in vec3 corner_ws[];
layout(location = 1) in vec3 corner_normal_ws[];
layout(location = 2) in vec4 corner_uv[];
layout(location = 3) in vec4 corner_color[];
layout(location = 4) in uvec3 corner_instance[];  // material, flags, object

layout(location = 0) out vec2 st;  // p(s, t) = p0 + s (p1 - p0) + t (p2 - p0)
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) flat out uvec2 material_and_flags;
#ifdef MAP_LAYERS
layout(location = 7) flat out vec4 map_layers;
#endif
layout(location = 9) flat out vec3 sampled[2 * FACET_SAMPLES];  // diffuse, specular of each point
invariant gl_Position;  // the depth must equal that of depth_first.frag

// Where the points are, in (s, t): corners and midpoints, around the triangle; or corners, thirds of edges, centroid.
#if FACET_SAMPLES == 6
const vec2 kPoints[6] = vec2[](
    vec2(0.0, 0.0), vec2(0.5, 0.0), vec2(1.0, 0.0), vec2(0.5, 0.5), vec2(0.0, 1.0), vec2(0.0, 0.5));
#else
const float kThird = 1.0 / 3.0;
const vec2 kPoints[10] = vec2[](
    vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(0.0, 1.0),
    vec2(kThird, 0.0), vec2(2.0 * kThird, 0.0),
    vec2(2.0 * kThird, kThird), vec2(kThird, 2.0 * kThird),
    vec2(0.0, 2.0 * kThird), vec2(0.0, kThird),
    vec2(kThird, kThird));
#endif

// Unit; stands in for normals that cancel.
vec3 face_normal_ws() {
    vec3 n = cross(corner_ws[1] - corner_ws[0], corner_ws[2] - corner_ws[0]);
    return n * ((corner_instance[0].y & 1u) != 0u ? -1.0 : 1.0) * inversesqrt(max(dot(n, n), 1e-30));
}

MeshPoint mesh_point(vec2 at) {
    vec3 w = vec3(1.0 - at.x - at.y, at);
    vec3 n = w.x * corner_normal_ws[0] + w.y * corner_normal_ws[1] + w.z * corner_normal_ws[2];
    float n2 = dot(n, n);
    return MeshPoint(
        w.x * corner_ws[0] + w.y * corner_ws[1] + w.z * corner_ws[2],
        n2 > 1e-12 ? n * inversesqrt(n2) : face_normal_ws(),
        w.x * corner_color[0].rgb + w.y * corner_color[1].rgb + w.z * corner_color[2].rgb,
        corner_instance[0].xy, corner_instance[0].z);
}

void main() {
    vec3 light[2 * FACET_SAMPLES];
    for (int i = 0; i < FACET_SAMPLES; ++i) {
        Reflected r = light_at(mesh_point(kPoints[i]));
        light[2 * i] = r.diffuse;
        light[2 * i + 1] = r.specular;
    }
    for (int i = 0; i < 3; ++i) {
        gl_Position = gl_in[i].gl_Position;
        st = vec2(i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0);
        uv = corner_uv[i];
        vertex_color = corner_color[i];
        material_and_flags = corner_instance[i].xy;
#ifdef MAP_LAYERS
        map_layers = map_layers_of(corner_instance[i].x);
#endif
        sampled = light;
        EmitVertex();
    }
    EndPrimitive();
}
