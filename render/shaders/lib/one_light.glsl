// One light, for passes that accumulate light by light. Include after lib/lighting.glsl. Definition:
//   DIRECTIONAL_LIGHT  it is directional

uniform int light_index;

// By the normal of `s` only.
Reflected reflect_one_by_normal(SurfaceSample s, vec3 position_ws, vec2 pixel) {
    Reflector r = make_reflector(s, to_viewer(position_ws));
#ifdef DIRECTIONAL_LIGHT
    Incoming light = incoming_directional(light_index, position_ws, body_normal(r), pixel);
#else
    Incoming light = incoming_local(light_index, position_ws, r.normal, water_medium(position_ws));
    light.irradiance *= light_transmittance(light_index, position_ws, body_normal(r), light.to_light, pixel);
#endif
    LightSum sum = no_light();
    add_shadowed(sum, r, light_index, light, position_ws);
    return reflect_lights(r, sum);
}

// Radiance toward the camera due to the light.
vec3 reflect_one(SurfaceSample s, vec3 position_ws, vec2 pixel) {
    Reflected reflected = reflect_one_by_normal(s, position_ws, pixel);
#ifdef BLENDED_SKIN
    reflected = blend_skin(s, reflected, reflect_one_by_normal(smooth_skin(s), position_ws, pixel));
#endif
    reflected = shade_skin(s, reflected);
    return reflected.diffuse + reflected.specular;
}
