// Shared by geometry shaders that prepare data once per triangle for its pixels. They define outputs and main(), which
// calls put_corner() before each EmitVertex().
// Techniques: fakephong.barycentric
#include "lib/material_record.glsl"

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
invariant gl_Position;  // the depth must equal that of facet_depth.geom

void put_corner(int i) {
    gl_Position = gl_in[i].gl_Position;
    st = vec2(i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0);
    uv = corner_uv[i];
    vertex_color = corner_color[i];
    material_and_flags = corner_instance[i].xy;
#ifdef MAP_LAYERS
    map_layers = map_layers_of(corner_instance[i].x);
#endif
}
