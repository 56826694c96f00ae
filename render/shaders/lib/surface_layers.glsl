// What the maps of a layered material (render/material/material_layers.h) say of a point: values from 0 to 1, 1 without
// a map, to be multiplied by the factors of the material's record when the surface is lit. As stored:
//
//     x     normal of the clear coat, octahedral                     16 + 16
//     y     clear coat, its roughness, roughness of the sheen, anisotropy    8 each
//     z     sheen r, g, b (square roots), weight of the specular reflection  8 each
//     w     its tint r, g, b (square roots), iridescence                     8 each
//     more  angle of the anisotropy, modulo half a turn, 16; thickness of the film 16

struct SurfaceLayers {
    vec3 coat_normal_ws;  // unit
    vec3 along_ws;        // unit: highlights stretch along it; T and -T are the same
    float coat;
    float coat_roughness;
    vec3 sheen;
    float sheen_roughness;
    vec3 tint;
    float weight;
    float anisotropy;
    float iridescence;
    float film;
};

struct PackedLayers {
    uvec4 bits;
    uint more;
};

// A unit vector in the plane of a unit normal. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017.
vec3 any_tangent(vec3 normal) {
    float side = normal.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + normal.z);
    return vec3(1.0 + side * normal.x * normal.x * a, side * normal.x * normal.y * a, -side * normal.x);
}

// Layers without maps on a surface with this normal.
SurfaceLayers plain_layers(vec3 normal) {
    return SurfaceLayers(normal, any_tangent(normal), 1.0, 1.0, vec3(1.0), 1.0, vec3(1.0), 1.0, 1.0, 1.0, 1.0);
}

// `normal_bits`: pack_direction() of the surface's normal, which the angle is stored relative to.
PackedLayers pack_layers(SurfaceLayers layers, uint normal_bits) {
    vec3 normal = unpack_direction(normal_bits);
    vec3 x = any_tangent(normal);
    vec2 along = vec2(dot(layers.along_ws, x), dot(layers.along_ws, cross(normal, x)));
    float half_turns = atan(along.y, along.x) / 3.14159265358979;
    uint angle = uint((half_turns - floor(half_turns)) * 65536.0 + 0.5) & 65535u;
    uint film = uint(clamp(layers.film, 0.0, 1.0) * 65535.0 + 0.5);
    return PackedLayers(
        uvec4(
            pack_direction(layers.coat_normal_ws),
            packUnorm4x8(vec4(layers.coat, layers.coat_roughness, layers.sheen_roughness, layers.anisotropy)),
            packUnorm4x8(vec4(sqrt(layers.sheen), layers.weight)),
            packUnorm4x8(vec4(sqrt(layers.tint), layers.iridescence))),
        angle | film << 16);
}

SurfaceLayers unpack_layers(PackedLayers stored, vec3 normal) {
    vec4 y = unpackUnorm4x8(stored.bits.y);
    vec4 z = unpackUnorm4x8(stored.bits.z);
    vec4 w = unpackUnorm4x8(stored.bits.w);
    float angle = float(stored.more & 65535u) * (3.14159265358979 / 65536.0);
    vec3 x = any_tangent(normal);
    SurfaceLayers layers;
    layers.coat_normal_ws = unpack_direction(stored.bits.x);
    layers.along_ws = cos(angle) * x + sin(angle) * cross(normal, x);
    layers.coat = y.x;
    layers.coat_roughness = y.y;
    layers.sheen = z.rgb * z.rgb;
    layers.sheen_roughness = y.z;
    layers.tint = w.rgb * w.rgb;
    layers.weight = z.a;
    layers.anisotropy = y.w;
    layers.iridescence = w.a;
    layers.film = float(stored.more >> 16) / 65535.0;
    return layers;
}
