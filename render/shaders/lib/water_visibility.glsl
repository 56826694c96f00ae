// Visibility buffer of water: the surface point in a pixel, as two texels; written by water_surface.frag, shaded by
// water.frag.

struct VisibleWater {
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

uvec4[2] pack_visible_water(VisibleWater visible) {
    uint number = uint(visible.body + 1) << 1 | (visible.above ? 1u : 0u);  // 0: no water
    return uvec4[2](
        uvec4(floatBitsToUint(vec3(visible.rest, visible.depth)), number),
        uvec4(
            packHalf2x16(visible.by_x.xy), packHalf2x16(visible.by_z.xy),
            packHalf2x16(vec2(visible.by_x.z, visible.by_z.z)),
            packHalf2x16(vec2(min(visible.footprint, kMaxHalf), visible.variance))));
}

VisibleWater unpack_visible_water(uvec4 position, uvec4 bend) {
    vec2 by_z = unpackHalf2x16(bend.y);
    vec2 last = unpackHalf2x16(bend.z);
    vec2 mean = unpackHalf2x16(bend.w);
    return VisibleWater(
        int(position.w >> 1) - 1, (position.w & 1u) != 0u, uintBitsToFloat(position.xy), uintBitsToFloat(position.z),
        mean.x, vec3(unpackHalf2x16(bend.x), last.x), vec3(by_z, last.y), mean.y);
}
