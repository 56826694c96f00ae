// Sunlight reflected by waters onto surfaces above them (caustics_pass.h). Include after lib/caustic_tile.glsl, the
// lights and lib/shadow.glsl of lib/lighting.glsl.
// Techniques: caustic.projected-vertices

const float kNormalOffset = 1.5;  // offset along the normal for lookups, against self-occlusion [texels of the map]

// Light reflected by water number n, focused by its waves.
vec3 mirrored_by(int n, vec3 position_ws, vec3 normal) {
    int at = int(kHeaderTexels) + int(texelFetch(water_lights, 0).x) * int(kUnderwaterTexels) + n * int(kMirrorTexels);
    vec4 origin = texelFetch(water_lights, at);
    vec4 shape = texelFetch(water_lights, at + 1);
    vec4 bent = texelFetch(water_lights, at + 2);
    CausticTile tile = caustic_tile(int(shape.y));
    int light = int(shape.z) * int(kLightTexels);
    vec3 to_sun = texelFetch(lights, light).xyz;
    float facing = max(dot(normal, vec3(to_sun.x, -to_sun.y, to_sun.z)), 0.0);

    vec2 texel = 1.0 / (tile.window.zw * tile.rect.z);
    vec3 from = position_ws - origin.xyz + normal * (kNormalOffset * max(texel.x, texel.y));
    vec2 local = vec2(origin.w * from.x + shape.x * from.z, origin.w * from.z - shape.x * from.x);
    vec2 uv = (local - bent.xy * from.y - tile.window.xy) * tile.window.zw;
    bool inside = from.y > 0.0 && from.y < shape.w && all(greaterThan(uv, vec2(0.0))) && all(lessThan(uv, vec2(1.0)));
    float light_scale = bent.z * facing * caustic_texel(tile, uv) * path_visibility(tile, uv, from.y);
    return inside ? texelFetch(lights, light + 1).rgb * light_scale : vec3(0.0);
}

// Irradiance from all waters.
vec3 mirrored_irradiance(vec3 position_ws, vec3 normal) {
    int count = int(texelFetch(water_lights, 0).y);
    vec3 sum = vec3(0.0);
    int n = 0;
    do {
        sum += n < count ? mirrored_by(n, position_ws, normal) : vec3(0.0);
    } while (++n < count);
    return sum;
}
