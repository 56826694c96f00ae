// Light of particles with images of the light from six sides: part of lib/particle_shading.glsl.

bool is_six_way(Look look) {
    return look_texel(look.index, kLookMotion).w >= 0.0;
}

#ifdef LIT
// Radiance of white surfaces that face the sides.
struct SixWayLight {
    vec3 positive[3];
    vec3 negative[3];
};

// Adds a light to the three sides that face it, weighted by the squared cosines, whose sum is 1.
void add_light(inout SixWayLight sum, Incoming light, mat3 axes) {
    vec3 cosines = light.to_light * axes;
    for (int i = 0; i < 3; ++i) {
        vec3 arriving = light.irradiance * (cosines[i] * cosines[i] / kPi);
        sum.positive[i] += cosines[i] > 0.0 ? arriving : vec3(0.0);
        sum.negative[i] += cosines[i] > 0.0 ? vec3(0.0) : arriving;
    }
}

// `axes`: to the right, up and away from the camera; `radius`: of the particle [m].
SixWayLight six_way_light(vec3 position_ws, vec3 normal, mat3 axes, float radius, vec2 pixel, float distance) {
    SixWayLight sum;
    const float kSquared = 2.0 / 3.0;  // of the cosine in an even environment, against the cosine itself
    for (int i = 0; i < 3; ++i) {
        sum.positive[i] = kSquared * environment_light(position_ws, axes[i], axes[i], 1.0).irradiance;
        sum.negative[i] = kSquared * environment_light(position_ws, -axes[i], -axes[i], 1.0).irradiance;
    }
#ifdef DIRECTIONAL_LIGHTS
    for (int i = 0; i < int(view.grid_depth.z); ++i) {
        add_light(sum, incoming_directional(i, position_ws, normal, pixel), axes);
    }
#endif
#ifdef LOCAL_LIGHTS
    WaterMedium medium = water_medium(position_ws);
    uvec2 list = cell_list(clamp(pixel, vec2(0.0), view.size.xy - 1.0), distance);
    for (uint i = list.x; i < list.x + list.y; ++i) {
        int index = int(texelFetch(light_indices, int(i)).x);
        add_light(sum, incoming_shadowed(index, position_ws, normal, radius, pixel, medium), axes);
    }
#endif
    return sum;
}
#endif

// `at`: pixel and distance of the particle.
void write_six_way(Particle p, Look look, ParticleCorner c, vec3 at) {
    glow_color = c.color.rgb * look.glow.x * c.color.a;
    for (int i = 0; i < 3; ++i) {
        positive_side[i] = vec4(0.0, 0.0, 0.0, look_texel(look.index, kLookMotion).w);
        negative_side[i] = vec3(0.0);
    }
#ifdef LIT
    if (is_six_way(look) && look.glow.y > 0.0) {
        vec3 away_axis = -to_viewer(p.position);
        mat3 axes = mat3(normalize(c.quad.right), normalize(c.quad.up), away_axis);
        SixWayLight sides = six_way_light(lit_position(p, c.offset), -away_axis, axes, 0.5 * c.size, at.xy, at.z);
        vec3 white = c.color.rgb * look.glow.y * c.color.a;
        for (int i = 0; i < 3; ++i) {
            positive_side[i].rgb = white * sides.positive[i];
            negative_side[i] = white * sides.negative[i];
        }
    }
#endif
}

void add_fog_to_six_way(float kept, vec3 veil) {
    glow_color = glow_color * kept + veil;
    for (int i = 0; i < 3; ++i) {
        positive_side[i].rgb *= kept;
        negative_side[i] *= kept;
    }
}
