// A geometry shader that lights FACET_SAMPLES points of each triangle, 6 or 10, by all lights that reach its object (fakephong.quadratic,
// fakephong.cubic).
// Techniques: fakephong.cubic, fakephong.gouraud-subdivided, fakephong.quadratic
#include "lib/facet_point.glsl"

layout(location = 9) flat out vec3 sampled[2 * FACET_SAMPLES];  // diffuse, specular of each point

// Positions of the points in (s, t): corners and midpoints; or corners, thirds of edges, centroid.
#if FACET_SAMPLES == 6
const vec2 kPoints[6] = kSixPoints;
#else
const float kThird = 1.0 / 3.0;
const vec2 kPoints[10] = vec2[](
    vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(0.0, 1.0),
    vec2(kThird, 0.0), vec2(2.0 * kThird, 0.0),
    vec2(2.0 * kThird, kThird), vec2(kThird, 2.0 * kThird),
    vec2(0.0, 2.0 * kThird), vec2(0.0, kThird),
    vec2(kThird, kThird));
#endif

void main() {
    vec3 light[2 * FACET_SAMPLES];
    for (int i = 0; i < FACET_SAMPLES; ++i) {
        Reflected r = light_at(mesh_point(kPoints[i]));
        light[2 * i] = r.diffuse;
        light[2 * i + 1] = r.specular;
    }
    for (int i = 0; i < 3; ++i) {
        put_corner(i);
        sampled = light;
        EmitVertex();
    }
    EndPrimitive();
}
