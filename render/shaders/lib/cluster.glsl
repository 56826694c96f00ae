// Cells of the light clusters, and blocks of cells: indexing and culling.

#include "lib/view.glsl"

const uvec3 kBlockSize = uvec3(kBlockColumns, kBlockRows, kBlockSlices);
const float kMaxDistance = 1e12;  // [m]; end of the last slice, which is unbounded
const float kSlack = 1e-3;        // relative enlargement of cells, as log2 and exp2 differ in the last bits

uvec3 cell_counts() {
    return uvec3(view.grid_cells.xyz);
}

uvec3 block_counts() {
    return (cell_counts() + kBlockSize - 1u) / kBlockSize;
}

uvec3 block_position(uint block) {
    uvec3 n = block_counts();
    return uvec3(block % n.x, block / n.x % n.y, block / (n.x * n.y));
}

// Number of light records. Not a uniform: if a uniform is the only bound of a loop in a compute shader, zink (Mesa 22.3
// on lavapipe) compiles its value into the code and keeps that code after the value changes.
uint light_count_of(samplerBuffer cluster_lights) {
    return uint(textureSize(cluster_lights)) / kClusterLightTexels;
}

// Words of the light mask of each block.
uint word_count(uint lights) {
    return (lights + 31u) / 32u;
}

// Whether a light's box of cells (ClusterLights::boxes) intersects the cells first .. last.
bool boxes_intersect(uvec2 box, uvec3 first, uvec3 last) {
    uvec3 low = uvec3(box.x & 255u, box.x >> 16 & 255u, box.y & 255u);
    uvec3 high = uvec3(box.x >> 8 & 255u, box.x >> 24, box.y >> 8 & 255u);
    return low.x <= last.x && high.x >= first.x && low.y <= last.y && high.y >= first.y && low.z <= last.z
           && high.z >= first.z;
}

// A cell's box in view space, x right, y up, z along the view axis.
struct CellBox {
    vec3 low;
    vec3 high;
};

// x / z (or y / z) of the left and right edges of a tile; `tangent` of half the field of view.
vec2 tile_slopes(uint tile, float pixels, float jitter, float tangent) {
    vec2 edge = (vec2(tile) + vec2(0.0, 1.0)) * view.grid_cells.w;
    return (2.0 * edge / pixels - 1.0 - jitter) * tangent;
}

CellBox cell_box(uvec3 cell) {
    vec2 slices = (vec2(cell.z) + vec2(0.0, 1.0) - view.grid_depth.y) / view.grid_depth.x;
    float z0 = cell.z == 0u ? 0.0 : exp2(slices.x) * (1.0 - kSlack);
    float z1 = cell.z + 1u == cell_counts().z ? kMaxDistance : exp2(slices.y) * (1.0 + kSlack);
    vec2 x = tile_slopes(cell.x, view.size.x, view.ray_right.w, length(view.ray_right.xyz));
    vec2 y = tile_slopes(cell.y, view.size.y, view.ray_up.w, length(view.ray_up.xyz));
    vec2 low = vec2(x.x, y.x);
    vec2 high = vec2(x.y, y.y);
    return CellBox(
        vec3(min(low * z0, low * z1), z0), vec3(max(high * z0, high * z1), z1));
}

// Whether the sphere about `center` certainly misses the box; radius2 < 0: unbounded.
bool sphere_outside(vec3 center, float radius2, CellBox box) {
    vec3 offset = center - clamp(center, box.low, box.high);
    return radius2 >= 0.0 && dot(offset, offset) > radius2;
}

// Whether the cone from `apex` along the unit `axis` certainly misses the sphere (Wronski 2017).
bool cone_outside(vec3 apex, vec3 axis, float cosine, vec3 center, float radius) {
    vec3 v = center - apex;
    float along = dot(v, axis);
    float across = sqrt(max(dot(v, v) - along * along, 0.0));
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float enlarged = radius * (1.0 + kSlack);
    return cosine > -1.0 && (cosine * across - along * sine > enlarged || (cosine > 0.0 && along < -enlarged));
}
