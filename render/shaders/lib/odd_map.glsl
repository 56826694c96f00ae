// Omni-directional displacement maps (content/bake/odd_map.h): what view rays see of a tile that repeats, by position and
// direction. The map holds a block of positions for each of 16 x 16 directions. Its mip levels stay within the blocks.
// Source: "Omni-directional displacement maps", with a blend of the nearest directions, and of depths instead of
// distances along the ray, which makes it exact for level surfaces
// Techniques: odd.light-distance, odd.shade

const int kOddDirections = 16;
const float kOddDistance = 8.0;  // relief depths at which the distance in the map is 1
const float kOddPi = 3.14159265;

// Fractions of pi that index a unit direction to the viewer, in tangent space.
vec2 odd_angles(vec3 to_viewer) {
    float across = length(to_viewer.xz);
    return vec2(across > 1e-6 ? atan(max(to_viewer.z, 0.0), to_viewer.x) : 0.5 * kOddPi, atan(across, to_viewer.y)) / kOddPi;
}

// Bilinear within the block of a direction, whose borders meet: the tile repeats.
vec4 odd_texel(vec2 position, ivec2 direction, int level) {
    float side = max(float(textureSize(material_maps[RELIEF_MAP], level).x / kOddDirections), 1.0);
    vec2 at = fract(position) * side - 0.5;
    vec2 weight = fract(at);
    vec2 low = mod(floor(at), side);
    vec2 high = mod(low + 1.0, side);
    // Centers of texels: without texelFetch(), since a software OpenGL reads one level for four pixels.
    vec4 corners = (vec4(low, high) + vec4(vec2(direction), vec2(direction)) * side + 0.5) / (side * float(kOddDirections));
    float layer = map_layer(map_layers, kReliefSlot);
    float lod = float(level);
    vec4 a = textureLod(material_maps[RELIEF_MAP], vec3(corners.xy, layer), lod);
    vec4 b = textureLod(material_maps[RELIEF_MAP], vec3(corners.zy, layer), lod);
    vec4 c = textureLod(material_maps[RELIEF_MAP], vec3(corners.xw, layer), lod);
    vec4 d = textureLod(material_maps[RELIEF_MAP], vec3(corners.zw, layer), lod);
    return mix(mix(a, b, weight.x), mix(c, d, weight.x), weight.y);
}

// The point that is visible from `to_viewer` at `position` of the mesh, in texture coordinates. xyz: unit normal in
// tangent space; w: depth, 0 on the mesh and 1 deepest. `lod`: of a map with a texel per position.
vec4 odd_lookup(vec2 position, vec3 to_viewer, float lod) {
    int levels = textureQueryLevels(material_maps[RELIEF_MAP]);
    int level = clamp(int(lod + 0.5), 0, max(min(levels - 1, 5), 0));
    vec2 at = odd_angles(to_viewer) * float(kOddDirections) - 0.5;
    vec2 weight = fract(at);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        ivec2 direction = clamp(ivec2(floor(at)) + corner, 0, kOddDirections - 1);
        vec2 angles = (vec2(direction) + 0.5) * (kOddPi / float(kOddDirections));
        vec4 texel = odd_texel(position, direction, level);
        vec2 share = mix(1.0 - weight, weight, vec2(corner));
        float depth = min(texel.w * kOddDistance * sin(angles.x) * sin(angles.y), 1.0);
        sum += share.x * share.y * vec4(texel.xyz * 2.0 - 1.0, depth);
    }
    return vec4(sum.xyz * inversesqrt(max(dot(sum.xyz, sum.xyz), 1e-12)), sum.w);
}
