// Light that particles scatter: after lib/particle.glsl and lib/lighting.glsl. Definitions: those of that file, and
//   MEAN_OF_CORNERS  as the mean of a quad's corners, whose normals are columns of a matrix
// Techniques: particle.lit-in-middle

#ifdef MEAN_OF_CORNERS
#define NORMALS mat4x3
#else
#define NORMALS vec3
#endif

const float kShadedFraction = 0.5;  // of the distance to the corners, at which shadows of particles are sampled, by eye

#ifdef MEAN_OF_CORNERS
vec3 surrounding_light(vec3 position_ws, mat4x3 normals) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        sum += environment_light(position_ws, normals[i], normals[i], 1.0).irradiance;
    }
    return 0.25 * sum;
}
float squared_wrap(mat4x3 normals, vec3 to_light) {
    vec4 wrapped = 0.5 + 0.5 * (to_light * normals);
    return 0.25 * dot(wrapped, wrapped);
}
vec3 one_normal(mat4x3 normals, vec3 to_camera) {
    return to_camera;
}
#else
vec3 surrounding_light(vec3 position_ws, vec3 normal) {
    return environment_light(position_ws, normal, normal, 1.0).irradiance;
}
float squared_wrap(vec3 normal, vec3 to_light) {
    float wrapped = 0.5 + 0.5 * dot(normal, to_light);
    return wrapped * wrapped;
}
vec3 one_normal(vec3 normal, vec3 to_camera) {
    return normal;
}
#endif

// Radiance that a white puff scatters toward `to_camera`: around its round surface, and forward through it (Henyey and
// Greenstein 1941).
vec3 scattered(Incoming light, NORMALS normals, vec3 to_camera, float forward) {
    float g2 = forward * forward;
    float base = 1.0 + g2 + 2.0 * forward * dot(light.to_light, to_camera);
    float lobe = (1.0 - g2) / (4.0 * max(base * sqrt(base), 1e-4));
    return light.irradiance * (mix(squared_wrap(normals, light.to_light), lobe, abs(forward)) / kPi);
}

#ifdef LOCAL_LIGHTS
// Mean of 1 / d^2 over a ball, relative to 1 / d^2 at its center. The mean is 3 (2 + (1 / x - x) ln|(1 + x) / (1 - x)|)
// / 4 / radius^2 with x = d / radius, fitted to 5 %. Without it, a puff around a lamp would be as bright as a surface
// that touches the lamp.
float mean_over_ball(float d2, float radius) {
    float x2 = max(d2, 1e-4) / max(radius * radius, 1e-12);
    return x2 < 1.0 ? x2 * (3.0 - x2 * (0.7 + 0.8 * x2)) : 1.0 + 0.5 / (x2 * x2);
}

Incoming incoming_shadowed(int index, vec3 position_ws, vec3 normal, float radius, vec2 pixel, WaterMedium medium) {
    Incoming light = incoming_local(index, position_ws, normal, medium);
    vec3 offset = texelFetch(lights, index * int(kLightTexels)).xyz - position_ws;
    bool by_square = texelFetch(lights, index * int(kLightTexels) + 2).x == 0.0;
    light.irradiance *= by_square ? mean_over_ball(dot(offset, offset), radius) : 1.0;
    light.irradiance *= index < int(view.grid_depth.w)
                            ? vec3(1.0)
                            : light_transmittance(index, position_ws, normal, light.to_light, pixel);
    return light;
}
#endif

// `radius`: of the particle [m].
vec3 scattered_light(vec3 position_ws, NORMALS normals, float forward, float radius, vec2 pixel, float distance) {
    vec3 to_camera = to_viewer(position_ws);
    vec3 normal = one_normal(normals, to_camera);  // for shadows
    vec3 sum = surrounding_light(position_ws, normals);
#ifdef DIRECTIONAL_LIGHTS
    for (int i = 0; i < int(view.grid_depth.z); ++i) {
        sum += scattered(incoming_directional(i, position_ws, normal, pixel), normals, to_camera, forward);
    }
#endif
#ifdef LOCAL_LIGHTS
    WaterMedium medium = water_medium(position_ws);
    uvec2 list = cell_list(clamp(pixel, vec2(0.0), view.size.xy - 1.0), distance);
    for (uint i = list.x; i < list.x + list.y; ++i) {
        int index = int(texelFetch(light_indices, int(i)).x);
        Incoming light = incoming_shadowed(index, position_ws, normal, radius, pixel, medium);
        sum += scattered(light, normals, to_camera, forward);
    }
#endif
    return sum;
}

// The position at which a corner is lit: it varies over the quad only if there are shadows of particles.
vec3 lit_position(Particle p, vec3 offset) {
#ifdef PARTICLE_SHADOWS
    return p.position + kShadedFraction * offset;
#else
    return p.position;
#endif
}
