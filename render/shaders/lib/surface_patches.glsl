// Smooth patches through the vertices of a surface that moves a mesh: ecs/components/surface_anchors.h has their layout,
// systems/animation/surface_patches.cpp the same on the CPU. Needs `samplerBuffer controls`.
// Techniques: face.bids-rebuild, face.bids-surface

const uint kNoPatch = 0xffffffffu;
const int kPatchTexels = 22;
const int kPatchPoints = 10;          // control points; the offsets follow
const float kMinPatchNormal = 1e-20;  // squared length below which a sum of normals counts as zero
const float kMinCorner = 1e-12;       // 1 - weight of a corner, at that corner

struct PatchPoint {
    vec3 position;
    vec3 by_u;
    vec3 by_v;
    vec3 normal;  // unit
    vec3 normal_by_u;
    vec3 normal_by_v;
};

// One step of de Casteljau's algorithm.
vec3 mix_three(int patch_texel, ivec3 points, vec3 barycentric) {
    return barycentric.x * texelFetch(controls, patch_texel + points.x).xyz
           + barycentric.y * texelFetch(controls, patch_texel + points.y).xyz
           + barycentric.z * texelFetch(controls, patch_texel + points.z).xyz;
}

// Adds the offset of one end of an edge, 12 c^2 a^2 b / (a + b) of it. `at_c` and so on: derivatives of c, a and b by
// u and v.
void add_bend(int texel, float c, float a, float b, vec2 at_c, vec2 at_a, vec2 at_b, inout PatchPoint at) {
    vec3 offset = texelFetch(controls, texel).xyz;
    float share = a + b > kMinCorner ? clamp(a / (a + b), 0.0, 1.0) : 0.5;
    vec2 by = 24.0 * c * a * b * share * at_c + 12.0 * c * c * b * share * (2.0 - share) * at_a
              + 12.0 * c * c * a * share * share * at_b;
    at.position += 12.0 * c * c * a * b * share * offset;
    at.by_u += by.x * offset;
    at.by_v += by.y * offset;
}

PatchPoint evaluate_patch(int texel, float u, float v) {
    float w = 1.0 - u - v;
    vec3 barycentric = vec3(u, v, w);
    vec3 q200 = mix_three(texel, ivec3(0, 3, 8), barycentric);
    vec3 q020 = mix_three(texel, ivec3(4, 1, 5), barycentric);
    vec3 q002 = mix_three(texel, ivec3(7, 6, 2), barycentric);
    vec3 q110 = mix_three(texel, ivec3(3, 4, 9), barycentric);
    vec3 q011 = mix_three(texel, ivec3(9, 5, 6), barycentric);
    vec3 q101 = mix_three(texel, ivec3(8, 9, 7), barycentric);
    vec3 r100 = mat3(q200, q110, q101) * barycentric;
    vec3 r010 = mat3(q110, q020, q011) * barycentric;
    vec3 r001 = mat3(q101, q011, q002) * barycentric;

    PatchPoint at;
    at.position = mat3(r100, r010, r001) * barycentric;
    at.by_u = 3.0 * (r100 - r001);
    at.by_v = 3.0 * (r010 - r001);
    const vec2 du = vec2(1.0, 0.0);
    const vec2 dv = vec2(0.0, 1.0);
    const vec2 dw = vec2(-1.0, -1.0);
    int bends = texel + kPatchPoints;
    add_bend(bends, u, v, w, du, dv, dw, at);
    add_bend(bends + 1, v, u, w, dv, du, dw, at);
    add_bend(bends + 2, v, w, u, dv, dw, du, at);
    add_bend(bends + 3, w, v, u, dw, dv, du, at);
    add_bend(bends + 4, w, u, v, dw, du, dv, at);
    add_bend(bends + 5, u, w, v, du, dw, dv, at);

    vec3 m100 = mix_three(texel, ivec3(16, 19, 21), barycentric);
    vec3 m010 = mix_three(texel, ivec3(19, 17, 20), barycentric);
    vec3 m001 = mix_three(texel, ivec3(21, 20, 18), barycentric);
    vec3 sum = mat3(m100, m010, m001) * barycentric;
    float length2 = dot(sum, sum);
    if (!(length2 > kMinPatchNormal)) {
        at.normal = unit_or(cross(at.by_u, at.by_v), vec3(0.0, 0.0, 1.0));
        at.normal_by_u = vec3(0.0);
        at.normal_by_v = vec3(0.0);
        return at;
    }
    at.normal = sum * inversesqrt(length2);
    vec3 by_u = 2.0 * (m100 - m001);
    vec3 by_v = 2.0 * (m010 - m001);
    at.normal_by_u = (by_u - dot(by_u, at.normal) * at.normal) * inversesqrt(length2);
    at.normal_by_v = (by_v - dot(by_v, at.normal) * at.normal) * inversesqrt(length2);
    return at;
}

// Derivatives of the position by (u, v, distance), at a distance along the normal.
mat3 patch_axes(PatchPoint at, float distance) {
    return mat3(at.by_u + distance * at.normal_by_u, at.by_v + distance * at.normal_by_v, at.normal);
}

// A covector of (u, v, distance), not normalized.
vec3 patch_normal(mat3 axes, vec3 covector) {
    mat3 cofactors = mat3(cross(axes[1], axes[2]), cross(axes[2], axes[0]), cross(axes[0], axes[1]));
    return (dot(axes[0], cofactors[0]) < 0.0 ? -1.0 : 1.0) * (cofactors * covector);
}

// `offset`: along tangent, bitangent and normal.
vec3 point_on_patch(PatchPoint at, vec3 offset) {
    vec3 tangent = unit_or(at.by_u - dot(at.by_u, at.normal) * at.normal, vec3(1.0, 0.0, 0.0));
    return at.position + mat3(tangent, cross(at.normal, tangent), at.normal) * offset;
}
