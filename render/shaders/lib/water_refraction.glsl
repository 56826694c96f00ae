// What is seen through the surface of water, one way or another (ecs/components/water_look.h). After
// lib/water_tracing.glsl and lib/water_light.glsl. Definitions:
//   LOOKS      some body of water is not drawn as usual
//   FLOOR_MAP  one has a map of its floor
//   UNBENT     from above none shows the picture where bent rays go

const int kTracedRefraction = 0;
const int kShiftedRefraction = 1;
const int kFloorRefraction = 2;
const float kShift = 0.02;  // of the picture, where a normal lies flat

#ifdef FLOOR_MAP
layout(binding = 27) uniform sampler2D floor_map;  // repeats
uniform float floor_tile;                          // side of a copy [m]

// The map of the floor where a bent ray meets it, lit by what falls in.
Seen floor_through(WaterRecord water, vec3 position, vec3 bent) {
    float way = (water.absorption.w + position.y - water.origin.y) / max(-bent.y, 0.02);
    vec3 hit = world_to_water(water, position + way * bent - water.origin.xyz);
    // The level of flat water: waves that gather rays are no reason for another.
    float texels = float(textureSize(floor_map, 0).x) / floor_tile;
    float pixel = distance(position, view.camera_ws.xyz) * 2.0 * length(view.ray_up.xyz) * view.size.w;
    vec3 color = textureLod(floor_map, hit.xz / floor_tile, log2(max(pixel * texels, 1.0))).rgb;
    vec3 light = light_falling_in(water) * exp(-water_extinction(water) * (kDimming * water.absorption.w));
    return Seen(color * light, way);
}
#endif

#ifdef LOOKS
// The picture, shifted as the normal leans; never what stands before the water or above it (Vlachos et al. 2004).
Seen shifted_through(WaterRecord water, vec3 normal) {
    vec2 lean = vec2(dot(normal.xz, view.ray_right.xz) / length(view.ray_right.xyz), dot(normal.xz, view.ray_forward.xz));
    vec2 to = into_picture(gl_FragCoord.xy + kShift * water.ocean.w * lean * view.size.xy);
    float here = view_distance(gl_FragCoord.z);
    float there = distance_at(to);
    bool outside = there > 0.0 && (there <= here || height_of(to, there) > water.origin.y);
    to = outside ? gl_FragCoord.xy : to;
    there = distance_at(to);
    float way = there > 0.0 ? (there - here) * length(view_ray(gl_FragCoord.xy)) : kEndless;
    return Seen(radiance_at(to), max(way, 0.0));
}
#endif

Seen look_through(WaterRecord water, vec3 position, vec3 normal, vec3 bent, float most, bool above) {
#ifdef LOOKS
    int how = above ? int(water.scattering.w) >> 4 & 3 : kTracedRefraction;
    Seen through = shifted_through(water, normal);
#if defined(FROM_BELOW) || !defined(UNBENT)
    Seen traced = seen_through(position, bent, most);
    if (how == kTracedRefraction) {
        through = traced;
    }
#endif
#ifdef FLOOR_MAP
    if (how == kFloorRefraction) {
        through = floor_through(water, position, bent);
    }
#endif
    return through;
#else
    return seen_through(position, bent, most);
#endif
}
