// Skinning by linear blending of matrices (char.skin-bone-offset), or of dual quaternions (L. Kavan et al., "Geometric
// Skinning with Approximate Dual Quaternion Blending", 2008).
// Techniques: char.skin-bone-offset

// The three upper rows of an affine matrix.
struct Rows {
    vec4 x;
    vec4 y;
    vec4 z;
};

Rows add_rows(Rows a, float weight, Rows b) {
    return Rows(a.x + weight * b.x, a.y + weight * b.y, a.z + weight * b.z);
}

Rows choose_rows(bool b, Rows yes, Rows no) {
    return Rows(b ? yes.x : no.x, b ? yes.y : no.y, b ? yes.z : no.z);
}

vec3 rows_point(Rows m, vec3 p) {
    vec4 p1 = vec4(p, 1.0);
    return vec3(dot(m.x, p1), dot(m.y, p1), dot(m.z, p1));
}

vec3 rows_vector(Rows m, vec3 v) {
    return vec3(dot(m.x.xyz, v), dot(m.y.xyz, v), dot(m.z.xyz, v));
}

vec3 unit_or(vec3 v, vec3 fallback) {
    float length2 = dot(v, v);
    return length2 > 1e-30 ? v * inversesqrt(length2) : fallback;
}

// Unit. Transforms by the inverse transpose of `m` up to scale: the cofactor matrix, whose rows are the cross products
// of the rows, times the sign of the determinant. If `m` collapses to a line, as when joints twist by half a turn,
// `strongest` is used instead: the matrix of the joint with the largest weight.
vec3 rows_normal(Rows m, Rows strongest, vec3 n) {
    vec3 yz = cross(m.y.xyz, m.z.xyz);
    vec3 turned = vec3(dot(yz, n), dot(cross(m.z.xyz, m.x.xyz), n), dot(cross(m.x.xyz, m.y.xyz), n));
    float size = dot(m.x.xyz, m.x.xyz) + dot(m.y.xyz, m.y.xyz) + dot(m.z.xyz, m.z.xyz);
    if (dot(turned, turned) <= 1e-12 * size * size) {
        return unit_or(rows_vector(strongest, n), n);
    }
    return (dot(m.x.xyz, yz) < 0.0 ? -1.0 : 1.0) * unit_or(turned, n);
}

// A rigid motion as a dual quaternion, x, y, z, w: rotation, and half the translation times the rotation.
struct Dual {
    vec4 real;
    vec4 dual;
};

// Adds `b` in the hemisphere of `first`: q and -q are the same motion, but cancel in a sum.
Dual add_dual(Dual a, float weight, Dual b, vec4 first) {
    float w = dot(b.real, first) < 0.0 ? -weight : weight;
    return Dual(a.real + w * b.real, a.dual + w * b.dual);
}

// Normalized; `first` where opposite motions cancel.
Dual unit_dual(Dual d, Dual first) {
    float size = length(d.real);
    return size > 1e-6 ? Dual(d.real / size, d.dual / size) : first;
}

vec3 dual_vector(Dual d, vec3 v) {
    return v + 2.0 * cross(d.real.xyz, cross(d.real.xyz, v) + d.real.w * v);
}

vec3 dual_point(Dual d, vec3 p) {
    vec3 translation = d.real.w * d.dual.xyz - d.dual.w * d.real.xyz + cross(d.real.xyz, d.dual.xyz);
    return dual_vector(d, p) + 2.0 * translation;
}
