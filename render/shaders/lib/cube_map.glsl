// Directions of a cube map's texels; render/environment/cube_map.h has the table in C++.
// Techniques: env.cube-addressing

// Direction of (s, t) of a face, on the cube of half side 1.
vec3 cube_direction(int face, vec2 st) {
    vec2 p = 2.0 * st - 1.0;
    if (face < 2) {
        float side = face == 0 ? 1.0 : -1.0;
        return vec3(side, -p.y, -side * p.x);
    }
    if (face < 4) {
        float side = face == 2 ? 1.0 : -1.0;
        return vec3(p.x, side, side * p.y);
    }
    float side = face == 4 ? 1.0 : -1.0;
    return vec3(side * p.x, -p.y, side);
}
