// What a pixel shows of a water surface, as two texels: written by water_surface.frag, lit by water.frag.

struct SeenWater {
    int body;
    bool above;      // the camera sees the surface from above
    vec2 rest;       // the point at rest, in water space [m]
    float depth;     // as in the depth buffer
    float footprint; // side of the pixel on the surface at rest [m]
    vec3 by_x;       // derivatives of the offset by analytic waves
    vec3 by_z;
    float variance;  // of slopes that vertices do not resolve
};

const float kMaxHalf = 65504.0;

uvec4[2] pack_seen_water(SeenWater seen) {
    uint number = uint(seen.body + 1) << 1 | (seen.above ? 1u : 0u);  // 0: no water
    return uvec4[2](
        uvec4(floatBitsToUint(vec3(seen.rest, seen.depth)), number),
        uvec4(
            packHalf2x16(seen.by_x.xy), packHalf2x16(seen.by_z.xy), packHalf2x16(vec2(seen.by_x.z, seen.by_z.z)),
            packHalf2x16(vec2(min(seen.footprint, kMaxHalf), seen.variance))));
}

SeenWater unpack_seen_water(uvec4 place, uvec4 bend) {
    vec2 by_z = unpackHalf2x16(bend.y);
    vec2 last = unpackHalf2x16(bend.z);
    vec2 mean = unpackHalf2x16(bend.w);
    return SeenWater(
        int(place.w >> 1) - 1, (place.w & 1u) != 0u, uintBitsToFloat(place.xy), uintBitsToFloat(place.z), mean.x,
        vec3(unpackHalf2x16(bend.x), last.x), vec3(by_z, last.y), mean.y);
}
