// What differs between the passes that draw particles: after lib/particle.glsl and lib/view.glsl. Definitions, one at
// most:
//   VELOCITY  where they were in the previous frame, without light
//   FOCUS     their depth where they cover enough, without light
//   WEIGHTED  into the sums of a weighted mean (render/particles/particle_weighted.h)
//   IN_WATER  visible from above, before the water is drawn over them; after lib/lighting.glsl
#ifdef VELOCITY
#include "lib/particle_motion.glsl"
layout(location = 6) out vec3 previous_clip;  // clip x, y, w
const bool kHidesRibbons = true;
#else
const bool kHidesRibbons = false;
#endif

#ifdef WEIGHTED
uniform vec2 weight_range;  // nearest distance ahead [m], 1 / (farthest - nearest)

const float kWeightFall = 8.0;  // optical depth of the cloud that the weights assume
#endif

// Factor on the opacity; for VELOCITY and FOCUS scaled by the threshold, so that a product above 1 passes.
float cover_in_pass(Look look) {
#if defined(VELOCITY)
    return look.glow.z / max(look_texel(look.index, kLookMotion).z, 1e-6);
#elif defined(FOCUS)
    return 1.0 / max(look_texel(look.index, kLookFocus).x, 1e-6);
#else
    return look.glow.z;
#endif
}

bool is_too_faint(Look look, float opacity) {
#if defined(VELOCITY)
    return opacity * look.glow.z <= look_texel(look.index, kLookMotion).z;
#elif defined(FOCUS)
    return opacity <= max(look_texel(look.index, kLookFocus).x, 1e-6);
#else
    return opacity <= 0.0;
#endif
}

bool is_out_of_water(vec3 position_ws) {
#ifdef IN_WATER
    return water_medium(position_ws).depth < 0.0;
#else
    return false;
#endif
}

void write_pass(Particle p, Look look, vec3 corner_ws, float ahead) {
#if defined(VELOCITY)
    vec4 pull = look_texel(look.index, kLookMotion + 1u);
    vec3 previous_ws = previous_position(corner_ws, p.velocity, p.age, pull);
    previous_clip = (view.previous_clip_from_world * vec4(previous_ws, 1.0)).xyw;
#elif defined(WEIGHTED)
    weight = exp(-kWeightFall * clamp((ahead - weight_range.x) * weight_range.y, 0.0, 1.0));
#elif defined(IN_WATER)
    WaterMedium water = water_medium(p.position);
    medium = vec4(water.extinction, water.index);
#endif
}
