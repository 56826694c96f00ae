// The quad of a billboard that turns about an axis (engine.billboard, engine.billboard-composite).
// Techniques: engine.billboard, engine.billboard-composite

// The quad's right: perpendicular to the unit vector `axis` and to `to_camera`, so that the quad faces the camera as
// far as the axis allows. If the camera is on the axis, the direction is undefined: then `otherwise`, the camera's
// right, which is the last angle of a camera that came there upright.
vec3 billboard_right(vec3 axis, vec3 to_camera, vec3 otherwise) {
    vec3 right = cross(axis, to_camera);
    if (dot(right, right) < 1e-8 * dot(to_camera, to_camera)) {
        right = otherwise - dot(otherwise, axis) * axis;
    }
    float size = length(right);
    return size > 0.0 ? right / size : otherwise;
}
