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
