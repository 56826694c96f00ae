// Shells of a coat of fur: a hook of lib/mesh_vertex.glsl. Shell i of k is the mesh, inflated by length i / k. It moves
// along the surface, too, with the square of its height: strands rise from the skin and bend over. Definitions:
//   FUR_SHELL  it is one
//   FUR_FIN    or fins, which rise from edges by the second texture coordinates
// Techniques: shade.fur

#ifdef FUR_SHELL
#include "lib/fur_record.glsl"

// Of the strand through this vertex, 0 at its root .. 1.
float fur_height() {
#ifdef FUR_FIN
    return second_uv.y;
#else
    return uintBitsToFloat(instance.w) / max(fur_texel(instance.y, 1).x, 1e-20);
#endif
}

// How far tips lie from their roots along the surface, in lengths.
vec3 fur_lean() {
    vec4 lean = fur_texel(instance.y, 0);
    vec3 n = normal_ms * inversesqrt(max(dot(normal_ms, normal_ms), 1e-30));
    vec3 up = world_row1.xyz * inversesqrt(max(dot(world_row1.xyz, world_row1.xyz), 1e-30));
    vec3 all = lean.xyz - lean.w * up;
    return all - n * dot(n, all);
}
#endif

void fur_position(inout vec3 position) {
#ifdef FUR_SHELL
    float height = fur_height();
    float offset = color.a * height * fur_texel(instance.y, 1).x;
    position = inflate(position, normal_ms, offset - uintBitsToFloat(instance.w));
    position += offset * height * fur_lean();
#endif
}
