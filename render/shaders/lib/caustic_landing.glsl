// Where light refracted by water lands; derived in ecs/base/caustic_optics.h.
// Techniques: caustic.reflection-plane, caustic.refraction-pool

// Where light refracted by flat water would have entered to reach the same point at `depth`. Light that enters the
// rest plane at `entry` deviates by `deviation` [m] per meter down from that of flat water.
vec2 undisturbed_entry(vec2 entry, vec2 deviation, float depth) {
    return entry + deviation * depth;
}

const float kFarPlane = 10000.0;

// Distance along `ray` to the plane dot(normal, x) = offset; kFarPlane if it lies behind or is parallel to the ray.
float distance_to_plane(vec3 from, vec3 ray, vec3 normal, float offset) {
    float along = dot(normal, ray);
    float path = (offset - dot(normal, from)) / (abs(along) > 1e-9 ? along : 1e-9);
    return abs(along) > 1e-9 && path >= 0.0 ? path : kFarPlane;
}

// Hit point with the bottom and four walls of a pool, a box of half extents `half_size` about the origin.
vec3 land_in_pool(vec3 from, vec3 ray, vec2 half_size, float depth) {
    float path = distance_to_plane(from, ray, vec3(0.0, 1.0, 0.0), -depth);
    path = min(path, distance_to_plane(from, ray, vec3(1.0, 0.0, 0.0), half_size.x));
    path = min(path, distance_to_plane(from, ray, vec3(-1.0, 0.0, 0.0), half_size.x));
    path = min(path, distance_to_plane(from, ray, vec3(0.0, 0.0, 1.0), half_size.y));
    path = min(path, distance_to_plane(from, ray, vec3(0.0, 0.0, -1.0), half_size.y));
    return from + path * ray;
}

// Brightness by height of the water: 0 at the minimum height, 1 at the maximum.
float pool_light(float height, float min_height, float inverse_range) {
    float c = (height - min_height) * inverse_range;
    return c * c * c;
}

// Where a mirror's vertex reflects light from `light` (position and 1, or the direction toward it and 0): point on
// the plane dot(normal, x) = plane.w, and w: light there. `look`: exponents of the cosines at the plane and at the
// mirror, maximum distance, maximum height above the plane. A vertex that faces away stays where it is, with w = -1.
vec4 mirror_vertex(vec3 vertex, vec3 normal, vec4 light, vec4 plane, vec4 look) {
    vec3 incoming = light.w > 0.0 ? normalize(vertex - light.xyz) : -light.xyz;
    float facing = -dot(incoming, normal);
    if (facing < 0.0) {
        return vec4(vertex, -1.0);
    }
    vec3 outgoing = incoming + 2.0 * facing * normal;
    float toward = -dot(plane.xyz, outgoing);
    float height = dot(plane.xyz, vertex) - plane.w;
    float path = toward > 1e-9 ? height / toward : height > 0.0 ? 0.0 : look.z;
    vec3 landing = vertex + clamp(path, 0.0, look.z) * outgoing;
    float above = dot(plane.xyz, landing) - plane.w;
    bool black = above > look.w;
    landing -= path > look.z || black ? above * plane.xyz : vec3(0.0);
    float lit = pow(max(toward, 1e-9), look.x) * pow(max(facing, 1e-9), look.y);
    return vec4(landing, black || toward <= 0.0 ? -1.0 : lit);
}
