// Prefiltered environment maps: octahedral, one per layer (environment_gpu.h); mip level l is blurred for roughness
// (l / (levels - 1))^2, with finer steps where the image is sharper. Every level has a border of one texel that
// continues across the fold, so that bilinear filtering leaves no seam.

#include "lib/octahedral.glsl"

// Texture coordinates of a point of the octahedral square [-1, 1]^2, in a level of side `size` [px].
vec2 bordered_uv(vec2 p, float size) {
    return (p * (0.5 * size - 1.0) + 0.5 * size) / size;
}

// The direction of texel `pixel` (gl_FragCoord.xy) of a level of side `size`, border included.
vec3 bordered_direction(vec2 pixel, float size) {
    vec2 p = (pixel - 0.5 * size) / (0.5 * size - 1.0);
    // Beyond an edge the square continues mirrored along that edge.
    if (abs(p.x) > 1.0) {
        p = vec2(sign_not_zero(p).x * (2.0 - abs(p.x)), -p.y);
    }
    if (abs(p.y) > 1.0) {
        p = vec2(-p.x, sign_not_zero(p).y * (2.0 - abs(p.y)));
    }
    return octahedral_decode(p);
}

vec3 reflected_radiance(sampler2DArray maps, float layer, vec2 levels_size, vec3 direction, float roughness) {
    float level = sqrt(clamp(roughness, 0.0, 1.0)) * (levels_size.x - 1.0);
    float low = min(floor(level), levels_size.x - 2.0);
    vec2 p = octahedral_encode(direction);
    float size = levels_size.y * exp2(-low);
    vec3 sharp = textureLod(maps, vec3(bordered_uv(p, size), layer), low).rgb;
    vec3 rough = textureLod(maps, vec3(bordered_uv(p, 0.5 * size), layer), low + 1.0).rgb;
    return mix(sharp, rough, level - low);
}
