// A step of a particle among colliders: swept from contact to contact as in
// systems/particles/particle_collision.cpp, in single precision. Included by particle_update.comp and particle_balls.comp. Definitions:
//   SHAPES           some colliders are height fields or meshes
//   DEPTH_COLLISION  particles also collide with the depth of the previous frame

const uint kColliderPlane = 0u, kColliderSphere = 1u, kColliderBox = 2u, kColliderHeights = 3u, kColliderMesh = 4u;
const uint kBounce = 1u, kStick = 2u, kKill = 3u;  // of the emitter; 0: does not collide
const float kMinSkin = 1e-4;                       // distance kept from surfaces [m]
const float kSkinShare = 1.0 / 1048576.0;          // the same, of coordinates: 8 units in the last place
const float kRestSpeed = 0.2;                      // impact speed below which there is no rebound [m/s]
const int kMaxBounces = 8;

struct GpuCollider {
    uint kind;
    vec4 a;        // plane: normal, offset; sphere: center, radius; box, mesh: first row of the matrix from the world;
                   // heights: origin, size of a cell along x
    vec4 b, c;     // sphere: b.x 1: hollow; box, mesh: further rows; heights: b.x size of a cell along z
    vec3 half_size;  // heights: points along x and z; mesh: nodes, largest coordinate
    int shape;       // first texel of heights and meshes
};

struct Touch {
    float fraction;  // of the path; > 1: none
    vec3 normal;
    float lift;      // along the normal: of a ball that is nearer than its radius at the beginning [m]
};
const Touch kNoTouch = Touch(2.0, vec3(0.0), 0.0);

GpuCollider read_collider(int texel) {
    vec4 last = texelFetch(steps, texel + 3);
    return GpuCollider(
        floatBitsToUint(last.w), texelFetch(steps, texel), texelFetch(steps, texel + 1), texelFetch(steps, texel + 2),
        last.xyz, floatBitsToInt(texelFetch(steps, texel + 4).x));
}

vec3 to_box(GpuCollider box, vec3 v, float w) {
    return vec3(dot(box.a, vec4(v, w)), dot(box.b, vec4(v, w)), dot(box.c, vec4(v, w)));
}
vec3 from_box(GpuCollider box, vec3 v) {
    return box.a.xyz * v.x + box.b.xyz * v.y + box.c.xyz * v.z;
}

Touch touch_plane(GpuCollider plane, vec3 from, vec3 delta, float radius) {
    float before = dot(plane.a.xyz, from) - plane.a.w - radius;
    float change = dot(plane.a.xyz, delta);
    bool meets = before >= 0.0 && before + change < 0.0;
    return Touch(meets ? before / -change : 2.0, plane.a.xyz, 0.0);
}

Touch touch_sphere(GpuCollider sphere, vec3 from, vec3 delta, float radius) {
    bool hollow = sphere.b.x != 0.0;
    float side = hollow ? -1.0 : 1.0;
    float grown = sphere.a.w + side * radius;
    vec3 start = from - sphere.a.xyz;
    float a = dot(delta, delta);
    float b = dot(start, delta);
    float c = dot(start, start) - grown * grown;
    float root = b * b - a * c;
    if (!(grown > 0.0 && c * side >= 0.0) || (!hollow && !(root > 0.0 && b < 0.0))) {
        return kNoTouch;
    }
    float fraction = hollow && b <= 0.0 ? (sqrt(root) - b) / a : side * c / (sqrt(root) - side * b);
    return Touch(fraction <= 1.0 ? fraction : 2.0, side * normalize(start + fraction * delta), 0.0);
}

Touch touch_box(GpuCollider box, vec3 from, vec3 delta, float radius) {
    vec3 start = to_box(box, from, 1.0);
    vec3 path = to_box(box, delta, 0.0);
    float enter = -1e30;
    float leave = 1e30;
    vec3 normal = vec3(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        float grown = box.half_size[axis] + radius;
        if (path[axis] == 0.0) {
            if (abs(start[axis]) >= grown) {
                return kNoTouch;
            }
            continue;
        }
        float toward = path[axis] > 0.0 ? grown : -grown;
        float in_at = (-toward - start[axis]) / path[axis];
        if (in_at > enter) {
            enter = in_at;
            normal = vec3(0.0);
            normal[axis] = -sign(toward);
        }
        leave = min(leave, (toward - start[axis]) / path[axis]);
    }
    bool meets = enter >= 0.0 && enter <= 1.0 && enter <= leave;
    return Touch(meets ? enter : 2.0, from_box(box, normal), 0.0);
}

#ifdef SHAPES
#include "particle_shapes.glsl"
#endif

Touch touch(GpuCollider collider, vec3 from, vec3 delta, float radius) {
    if (collider.kind == kColliderPlane) {
        return touch_plane(collider, from, delta, radius);
    }
#ifdef SHAPES
    if (collider.kind == kColliderHeights) {
        return touch_heights(collider, from, delta, radius);
    }
    if (collider.kind == kColliderMesh) {
        return touch_mesh(collider, from, delta, radius);
    }
#endif
    return collider.kind == kColliderSphere ? touch_sphere(collider, from, delta, radius)
                                            : touch_box(collider, from, delta, radius);
}

// Outward normal and penetration depth: > 0 inside.
vec4 find_exit(GpuCollider collider, vec3 position, float radius) {
    if (collider.kind == kColliderPlane) {
        return vec4(collider.a.xyz, collider.a.w + radius - dot(collider.a.xyz, position));
    }
    if (collider.kind == kColliderSphere) {
        vec3 delta = position - collider.a.xyz;
        float distance_ = length(delta);
        vec3 outward = distance_ > 0.0 ? delta / distance_ : vec3(0.0, 1.0, 0.0);
        return collider.b.x != 0.0 ? vec4(-outward, distance_ - max(collider.a.w - radius, 0.0))
                                   : vec4(outward, collider.a.w + radius - distance_);
    }
#ifdef SHAPES
    if (collider.kind == kColliderHeights) {
        return find_heights_exit(collider, position, radius);
    }
    if (collider.kind == kColliderMesh) {  // has no inside
        return vec4(0.0);
    }
#endif
    vec3 local = to_box(collider, position, 1.0);
    vec3 inside = collider.half_size + radius - abs(local);
    int nearest = inside.x < inside.y ? (inside.z < inside.x ? 2 : 0) : (inside.z < inside.y ? 2 : 1);
    vec3 normal = vec3(0.0);
    normal[nearest] = local[nearest] < 0.0 ? -1.0 : 1.0;
    return vec4(from_box(collider, normal), inside[nearest]);
}

#ifdef DEPTH_COLLISION
#include "particle_depth_collision.glsl"
#endif

Touch first_touch(int first_collider, int collider_count, vec3 from, vec3 delta, float radius) {
    Touch nearest = kNoTouch;
    for (int i = 0; i < collider_count; ++i) {
        Touch one = touch(read_collider(first_collider + i * int(kColliderTexels)), from, delta, radius);
        if (one.fraction < nearest.fraction) {
            nearest = one;
        }
    }
#ifdef DEPTH_COLLISION
    Touch by_depth = touch_depth(from, delta, radius);
    if (by_depth.fraction < nearest.fraction) {
        nearest = by_depth;
    }
#endif
    return nearest;
}

// Pushes a particle that moves from `position` to `to` out of a solid. Height fields push straight up. Returns whether
// it was inside by more than rounding.
bool leave(vec4 exit_plane, bool upward, float skin, inout vec3 position, inout vec3 to, inout vec3 velocity) {
    if (exit_plane.w <= 0.0) {
        return false;
    }
    vec3 path = to - position;
    position += exit_plane.w * (upward ? vec3(0.0, 1.0, 0.0) : exit_plane.xyz) + 0.5 * skin * exit_plane.xyz;
    bool is_inside = exit_plane.w > 0.5 * skin;
    if (is_inside) {
        velocity -= min(dot(velocity, exit_plane.xyz), 0.0) * exit_plane.xyz;
        path -= min(dot(path, exit_plane.xyz), 0.0) * exit_plane.xyz;
    }
    to = position + path;
    return is_inside;
}

float largest_of(vec3 v) {
    vec3 size = abs(v);
    return max(max(size.x, size.y), size.z);
}

// Resolves the collisions of a particle that a step of `dt` seconds has moved from `start`. `response`: bounce,
// friction, radius, action (word).
void collide(inout Particle p, vec3 start, float dt, int first_collider, int collider_count, vec4 response) {
    uint action = floatBitsToUint(response.w);
    bool stops = action != kBounce;
    vec3 position = start;
    vec3 to = p.position;
    bool stopped = false;
    float skin = max(kMinSkin, kSkinShare * (largest_of(start) + largest_of(to - start)));
    float grown = response.z + 0.5 * skin;
    for (int i = 0; i < collider_count && !stopped; ++i) {
        GpuCollider collider = read_collider(first_collider + i * int(kColliderTexels));
        vec4 exit_plane = find_exit(collider, position, grown);
        bool upward = collider.kind == kColliderHeights;
        stopped = leave(exit_plane, upward, skin, position, to, p.velocity) && stops;
    }
#ifdef DEPTH_COLLISION
    stopped = stopped || (leave(find_depth_exit(position, grown), false, skin, position, to, p.velocity) && stops);
#endif
    // After each contact it moves off the surface by the skin, unless something else is there.
    float time = dt;
    int contacts = 0;
    bool settles = false;
    bool is_last = false;
    while (!stopped) {
        Touch found = first_touch(first_collider, collider_count, position, to - position, response.z);
        if (settles) {
            position = found.fraction > 1.0 ? to : position;
            to = position + time * p.velocity;
            settles = false;
            stopped = is_last;
            continue;
        }
        if (found.fraction > 1.0) {
            position = to;
            break;
        }
        float toward = -dot(p.velocity, found.normal);
        vec3 across = -toward * found.normal;
        vec3 contact = position + found.fraction * (to - position) + found.lift * found.normal;
        is_last = stops || ++contacts >= kMaxBounces;
        p.velocity = response.y * (p.velocity - across) - (toward < kRestSpeed ? 0.0 : response.x) * across;
        time *= 1.0 - found.fraction;
        to = contact + skin * found.normal;
        settles = true;
    }
    p.position = position;
    if (stopped) {
        p.velocity = vec3(0.0);
        p.life = action == kKill ? min(p.life, p.age) : action == kStick ? -p.life : p.life;
    }
}
