// Light of a ghost that passes all rims of the lens (lens_flare_pass.h).
// Techniques: engine.lens-flare
#version 450

layout(location = 0) in vec2 point;
layout(location = 1) flat in vec4 radiance_softness;
layout(location = 2) flat in vec4 rims[4];  // scale, offset; FlareShape or -1

uniform float blades;
uniform float blade_rotation;

layout(location = 0) out vec4 radiance;

const float kPi = 3.14159265;
const float kPolygon = 1.0;  // FlareShape; 0 is a disc
const float kRing = 2.0;
const float kGlow = 3.0;

// Distance from the center, relative to the radius of the rim; for a polygon, relative to its boundary.
float rim_distance(vec2 at, float shape) {
    if (shape != kPolygon || blades < 3.0) {
        return length(at);
    }
    float sector = 2.0 * kPi / blades;
    float angle = at == vec2(0.0) ? 0.0 : atan(at.y, at.x) - blade_rotation;
    float from_edge = mod(angle, sector) - 0.5 * sector;
    return length(at) * cos(from_edge) / cos(0.5 * sector);
}

void main() {
    float passed = 1.0;
    for (int i = 0; i < 4; ++i) {
        if (rims[i].w >= 0.0) {
            float from_center = rim_distance(rims[i].x * point + rims[i].yz, rims[i].w);
            float soft = max(radiance_softness.w * abs(rims[i].x), 1e-4);
            float inside = 1.0 - smoothstep(1.0 - soft, 1.0 + soft, from_center);
            inside *= rims[i].w == kRing ? smoothstep(0.6, 1.0, from_center) : 1.0;
            float halo = max(1.0 - from_center, 0.0);
            inside = rims[i].w == kGlow ? halo * halo * halo : inside;
            passed = min(passed, inside);
        }
    }
    radiance = vec4(passed * radiance_softness.rgb, 0.0);
}
