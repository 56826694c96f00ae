// Normals along great circles (fakephong.normal-interp-variants, after Kuijk and Blake, "Faster Phong Shading via Angular
// Interpolation", 1989): along the edge from corner 1 to corner 2, then from corner 0 to there.
// Techniques: fakephong.normal-interp-variants
#version 450
#include "lib/facet_normal.glsl"

// From unit a to unit b along the great circle; the face normal if they are opposite.
vec3 slerp(vec3 a, vec3 b, float t) {
    float cosine = dot(a, b);
    if (cosine < -0.999999) {
        return facet_normals[6];
    }
    if (cosine > 0.9999) {  // the chord is accurate enough, and sin(angle) is near 0
        return normalize(mix(a, b, t));
    }
    float angle = acos(cosine);
    return (sin((1.0 - t) * angle) * a + sin(t * angle) * b) / sin(angle);
}

void main() {
    float away = clamp(st.x + st.y, 0.0, 1.0);
    vec3 edge = slerp(facet_normals[2], facet_normals[4], away > 0.0 ? clamp(st.y / away, 0.0, 1.0) : 0.0);
    radiance = radiance_by(slerp(facet_normals[0], edge, away));
}
