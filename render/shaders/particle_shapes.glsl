// Height fields and meshes as colliders of particles: systems/particles/collider.cpp and mesh_bvh.cpp in single
// precision. Their texels are laid out as in systems/particles/gpu_shapes.h. Included by particle_collide.glsl.
// Techniques: particle.constraints, particle.heightfield-collision

layout(binding = kParticleShapesUnit) uniform samplerBuffer shapes;

const float kNever = 1e30;
const float kShapeRounding = 1e-6;  // of fractions and coordinates

// ---- height fields

// The bilinear surface of a cell, as a function of the grid coordinates within it, 0 .. 1.
struct Patch {
    float height;
    vec2 along;   // rise along x and z
    float twist;
    float raise;  // of the surface for a particle with a radius
    vec2 cell;    // size [m]
};

float patch_at(Patch p, vec2 at) {
    return p.height + dot(p.along, at) + p.twist * at.x * at.y + p.raise;
}
vec3 patch_normal(Patch p, vec2 at) {
    vec2 slope = (p.along + p.twist * at.yx) / p.cell;
    return normalize(vec3(-slope.x, 1.0, -slope.y));
}
Patch read_patch(GpuCollider field, ivec2 cell, float radius) {
    vec4 h = texelFetch(shapes, field.shape + cell.y * (int(field.half_size.x) - 1) + cell.x);
    Patch p = Patch(
        field.a.y + h.x, vec2(h.y - h.x, h.z - h.x), h.w - h.y - h.z + h.x, 0.0, vec2(field.a.w, field.b.x));
    p.raise = radius / patch_normal(p, vec2(0.5)).y;
    return p;
}

// The smallest s >= 0 at which a s^2 + b s + c, c >= 0, becomes negative.
float falls_below_zero(float a, float b, float c) {
    float inside = b * b - 4.0 * a * c;
    if (inside < 0.0) {
        return kNever;
    }
    float root = sqrt(inside);
    return b < 0.0 ? 2.0 * c / (root - b) : a < 0.0 ? -(b + root) / (2.0 * a) : kNever;
}

// Walks the cells below the path; in each, the height above the surface is quadratic in the fraction of the path.
Touch touch_heights(GpuCollider field, vec3 start, vec3 delta, float radius) {
    vec2 size = vec2(field.a.w, field.b.x);
    vec2 cells = field.half_size.xy - 1.0;
    vec2 from = (start.xz - field.a.xz) / size;
    vec2 path = delta.xz / size;
    float fraction = 0.0;
    float end = 1.0;
    for (int k = 0; k < 2; ++k) {
        if (path[k] != 0.0) {
            float a = -from[k] / path[k];
            float b = (cells[k] - from[k]) / path[k];
            fraction = max(fraction, min(a, b));
            end = min(end, max(a, b));
        } else if (!(from[k] >= 0.0 && from[k] <= cells[k])) {
            end = -1.0;
        }
    }
    ivec2 cell = ivec2(clamp(from + fraction * path, vec2(0.0), cells - 1.0));
    ivec2 toward = ivec2(greaterThan(path, vec2(0.0)));
    bool is_first = true;
    Touch found = kNoTouch;
    bool goes_on = fraction <= end;
    while (goes_on) {
        float next = end;
        int crossed = -1;
        for (int k = 0; k < 2; ++k) {
            float border = path[k] != 0.0 ? (float(cell[k] + toward[k]) - from[k]) / path[k] : kNever;
            if (border < next) {
                next = max(border, fraction);
                crossed = k;
            }
        }
        Patch p = read_patch(field, cell, radius);
        vec2 at = from + fraction * path - vec2(cell);
        float above = start.y + fraction * delta.y - patch_at(p, at);
        // As on the CPU, it may be below where a cell begins, though not where the previous one ended.
        float fall = above < 0.0 ? 0.0
                                 : falls_below_zero(
                                     -p.twist * path.x * path.y,
                                     delta.y - dot(p.along + p.twist * at.yx, path), above);
        if (is_first && above < 0.0) {
            goes_on = false;  // starts below
        } else if (fraction + fall <= next) {
            found = Touch(fraction + fall, patch_normal(p, at + fall * path), 0.0);
            goes_on = false;
        } else if (crossed < 0) {
            goes_on = false;
        } else {
            fraction = next;
            cell[crossed] += path[crossed] > 0.0 ? 1 : -1;
            goes_on = cell[crossed] >= 0 && cell[crossed] < int(cells[crossed]);
        }
        is_first = false;
    }
    return found;
}

vec4 find_heights_exit(GpuCollider field, vec3 position, float radius) {
    vec2 cells = field.half_size.xy - 1.0;
    vec2 at = (position.xz - field.a.xz) / vec2(field.a.w, field.b.x);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, cells))) {
        return vec4(0.0);
    }
    ivec2 cell = ivec2(min(at, cells - 1.0));
    Patch p = read_patch(field, cell, radius);
    at -= vec2(cell);
    return vec4(patch_normal(p, at), patch_at(p, at) - position.y);
}

// ---- meshes

// The path in a space whose last axis is the longest of its direction (Woop, Benthin and Wald 2013).
struct ShapeRay {
    vec3 from;
    ivec3 axis;
    vec2 shear;
    float scale;
};

ShapeRay make_shape_ray(vec3 from, vec3 delta) {
    vec3 size = abs(delta);
    int longest = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    ivec3 axis = ivec3((longest + 1) % 3, (longest + 2) % 3, longest);
    float along = delta[longest];
    return ShapeRay(from, axis, vec2(delta[axis.x], delta[axis.y]) / along, 1.0 / along);
}

vec3 sheared(ShapeRay ray, vec3 corner) {
    vec3 relative = corner - ray.from;
    precise float z = relative[ray.axis.z];
    precise float x = relative[ray.axis.x] - ray.shear.x * z;
    precise float y = relative[ray.axis.y] - ray.shear.y * z;
    return vec3(x, y, z * ray.scale);
}

// The same but for the sign for both triangles of an edge, so that nothing slips through between them.
float edge_of(vec3 a, vec3 b) {
    precise float side = a.x * b.y - a.y * b.x;
    return side;
}

// The first triangle along the path, extended by 4 radii: its number and fraction are kept in `best` and `nearest`.
void touch_triangle(ShapeRay ray, int texel, inout float nearest, inout uint best, inout vec3 normal) {
    vec4 first = texelFetch(shapes, texel);
    vec3 corners[3] = vec3[3](first.xyz, texelFetch(shapes, texel + 1).xyz, texelFetch(shapes, texel + 2).xyz);
    vec3 a = sheared(ray, corners[0]);
    vec3 b = sheared(ray, corners[1]);
    vec3 c = sheared(ray, corners[2]);
    float u = edge_of(c, b);
    float v = edge_of(a, c);
    float w = edge_of(b, a);
    float sum = u + v + w;
    bool is_inside = min(min(u, v), w) >= 0.0 || max(max(u, v), w) <= 0.0;
    float fraction = (u * a.z + v * b.z + w * c.z) / (sum != 0.0 ? sum : 1.0);
    float slack = kShapeRounding * max(max(abs(a.z), abs(b.z)), abs(c.z));
    if (!is_inside || sum == 0.0 || fraction < -slack || fraction > 1.0 + slack) {
        return;
    }
    fraction = clamp(fraction, 0.0, 1.0);
    uint number = floatBitsToUint(first.w);
    if (fraction < nearest || (fraction == nearest && number < best)) {
        nearest = fraction;
        best = number;
        normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    }
}

Touch touch_mesh(GpuCollider mesh, vec3 start, vec3 path, float radius) {
    float path_length = length(path);
    if (!(path_length > 0.0)) {
        return kNoTouch;
    }
    float beyond = 1.0 + 4.0 * radius / path_length;
    vec3 from = to_box(mesh, start, 1.0);
    vec3 delta = to_box(mesh, beyond * path, 0.0);
    vec3 size = abs(from);
    float pad = kShapeRounding * (max(max(size.x, size.y), size.z) + mesh.half_size.y);
    vec3 low = min(from, from + delta) - pad;
    vec3 high = max(from, from + delta) + pad;
    vec3 inverse = mix(sign(delta), vec3(1.0), equal(delta, vec3(0.0))) / max(abs(delta), 1e-30);
    ShapeRay ray = make_shape_ray(from, delta);
    int nodes = int(mesh.half_size.x);
    int triangles = mesh.shape + 2 * nodes;
    float nearest = 1.0;
    uint best = 0xffffffffu;
    vec3 normal = vec3(0.0);
    int node = 0;
    while (node < nodes) {
        vec4 box_min = texelFetch(shapes, mesh.shape + 2 * node);
        vec4 box_max = texelFetch(shapes, mesh.shape + 2 * node + 1);
        vec3 a = (box_min.xyz - pad - from) * inverse;
        vec3 b = (box_max.xyz + pad - from) * inverse;
        vec3 enter = min(a, b);
        vec3 leave_at = max(a, b);
        float near = max(max(enter.x, enter.y), enter.z);
        float far = min(min(leave_at.x, leave_at.y), leave_at.z);
        bool meets = all(lessThanEqual(box_min.xyz, high)) && all(greaterThanEqual(box_max.xyz, low))
                     && near <= far * (1.0 + 4.0 * kShapeRounding) && near <= nearest * (1.0 + 4.0 * kShapeRounding);
        uint held = meets ? floatBitsToUint(box_max.w) : 0u;
        int triangle = triangles + 3 * int(held / 8u);
        for (uint i = 0u; i < (held & 7u); ++i) {
            touch_triangle(ray, triangle + 3 * int(i), nearest, best, normal);
        }
        node = meets ? node + 1 : floatBitsToInt(box_min.w);
    }
    if (best == 0xffffffffu) {
        return kNoTouch;
    }
    normal = normalize(from_box(mesh, normal));  // by the inverse of the transpose
    float speed = dot(normal, path);
    normal = speed > 0.0 ? -normal : normal;
    speed = abs(speed);
    float before = nearest * beyond * speed;  // distance from the plane
    if (before < radius) {
        return Touch(0.0, normal, radius - before);
    }
    float fraction = radius > 0.0 ? (before - radius) / speed : nearest;
    return fraction <= 1.0 ? Touch(fraction, normal, 0.0) : kNoTouch;
}
