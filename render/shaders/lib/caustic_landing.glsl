// Where light lands that water has bent, as ecs/base/caustic_optics.h explains it.

// The place where light that flat water bends would have entered, had it come to the point at `depth`. Light that
// enters at `entry` of the plane at rest goes `astray` [m] on a meter down, beside the light of flat water.
vec2 flat_place(vec2 entry, vec2 astray, float depth) {
    return entry + astray * depth;
}

const float kFarPlane = 10000.0;

// Way along `ray` to the plane dot(normal, x) = offset; kFarPlane where that lies behind or the ray runs along it.
float way_to_plane(vec3 from, vec3 ray, vec3 normal, float offset) {
    float along = dot(normal, ray);
    float way = (offset - dot(normal, from)) / (abs(along) > 1e-9 ? along : 1e-9);
    return abs(along) > 1e-9 && way >= 0.0 ? way : kFarPlane;
}

// The nearest of a pool's bottom and four walls; the pool is a box of half extents `half_size` about the origin.
vec3 land_in_pool(vec3 from, vec3 ray, vec2 half_size, float depth) {
    float way = way_to_plane(from, ray, vec3(0.0, 1.0, 0.0), -depth);
    way = min(way, way_to_plane(from, ray, vec3(1.0, 0.0, 0.0), half_size.x));
    way = min(way, way_to_plane(from, ray, vec3(-1.0, 0.0, 0.0), half_size.x));
    way = min(way, way_to_plane(from, ray, vec3(0.0, 0.0, 1.0), half_size.y));
    way = min(way, way_to_plane(from, ray, vec3(0.0, 0.0, -1.0), half_size.y));
    return from + way * ray;
}

// As bright as the water is high: 0 at the least height, 1 at the greatest.
float pool_light(float height, float least, float per_height) {
    float c = (height - least) * per_height;
    return c * c * c;
}

// Where a vertex of a mirror sends light from `light` (a place and 1, or the direction toward it and 0): place on the
// plane dot(normal, x) = plane.w, and w: light there. `look`: powers of the cosines at the plane and at the mirror,
// the farthest way, the greatest height above the plane. One that faces away stays where it is, with w = -1.
vec4 mirror_vertex(vec3 vertex, vec3 normal, vec4 light, vec4 plane, vec4 look) {
    vec3 incoming = light.w > 0.0 ? normalize(vertex - light.xyz) : -light.xyz;
    float facing = -dot(incoming, normal);
    if (facing < 0.0) {
        return vec4(vertex, -1.0);
    }
    vec3 outgoing = incoming + 2.0 * facing * normal;
    float toward = -dot(plane.xyz, outgoing);
    float height = dot(plane.xyz, vertex) - plane.w;
    float way = toward > 1e-9 ? height / toward : height > 0.0 ? 0.0 : look.z;
    vec3 place = vertex + clamp(way, 0.0, look.z) * outgoing;
    float above = dot(plane.xyz, place) - plane.w;
    bool black = above > look.w;
    place -= way > look.z || black ? above * plane.xyz : vec3(0.0);
    float lit = pow(max(toward, 1e-9), look.x) * pow(max(facing, 1e-9), look.y);
    return vec4(place, black || toward <= 0.0 ? -1.0 : lit);
}
