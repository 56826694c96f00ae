// Whether a light sees a point.

// Share of the light that reaches `position_ws`, 0 .. 1.
//   shadow  LightRecord::shadow
//   normal  of the surface, unit
//   pixel   that shows it, gl_FragCoord.xy
float light_visibility(vec4 shadow, vec3 position_ws, vec3 normal, vec3 to_light, vec2 pixel) {
    return 1.0;
}
