// Inputs of shaders that place the vertices of meshes, whose names are those of lib/mesh_attributes.glsl. Definition:
//   TESSELLATED  the shader is an evaluation stage: inputs are interpolated within a triangle

#ifdef TESSELLATED
layout(triangles, fractional_odd_spacing, ccw) in;
// Triangles that share an edge get the same bits on it: the term of the third corner is 0 there.
#define VERTEX_INPUT(at, type, name)              \
    layout(location = at) in type name##_of[]; \
    precise type name = gl_TessCoord.x * name##_of[0] + gl_TessCoord.y * name##_of[1] + gl_TessCoord.z * name##_of[2]
#define INSTANCE_INPUT(at, type, name)            \
    layout(location = at) in type name##_of[]; \
    type name = name##_of[0]
#else
#define VERTEX_INPUT(at, type, name) layout(location = at) in type name
#define INSTANCE_INPUT(at, type, name) layout(location = at) in type name
#endif
