// Sizes and colors of particles, discs that face the camera among them, for particle.vert and particle_splat.comp.
// Include after lib/particle.glsl and lib/view.glsl.

// Extent of a pixel at this position [m].
float pixel_extent(vec3 position_ws) {
    float ahead = dot(position_ws - view.camera_ws.xyz, view.ray_forward.xyz);
    return max(ahead, 1e-4) * 2.0 * length(view.ray_up.xyz) * view.size.w;
}

// Color and opacity at the distance `away` [m], with the fades near the camera and far from it.
vec4 color_from(Particle p, float away) {
    vec4 more = look_texel(p.look, kLookMore);
    vec4 color = color_of(p);
    color.a *= more.y > 0.0 ? smoothstep(0.0, more.y, away) : 1.0;
    color.a *= more.z > 0.0 ? smoothstep(more.z, 0.6 * more.z, away) : 1.0;
    return color;
}

// Diameter [m] at the distance `away`, for sizes in pixels too; `shape`: texel 0 of the look.
float size_from(Particle p, vec4 shape, int facing, float away) {
    float size = size_of(p, shape);
    if (facing == kFacingPixels) {
        vec4 point = look_texel(p.look, kLookMore + 1u);
        size *= inversesqrt(max(point.x + away * (point.y + away * point.z), 1e-12)) * pixel_extent(p.position);
    }
    return size;
}

// Diameter [px]. A disc that faces the camera projects to an ellipse off the image's center: that of a circle of equal
// area.
float point_diameter(vec3 position_ws, float size, int facing, float away) {
    float diameter = size / pixel_extent(position_ws);
    if (facing == kFacingCamera) {
        diameter *= sqrt(away / max(dot(position_ws - view.camera_ws.xyz, view.ray_forward.xyz), 1e-4));
    }
    return diameter;
}

// Smaller discs are drawn fainter instead of smaller. At two pixels the light of one varies by an eighth with its
// position among the pixels; at one it would come and go, so that small points would twinkle.
const float kMinPoint = 2.0;  // diameter [px]

float point_opacity(float diameter) {
    return min(diameter * diameter / (kMinPoint * kMinPoint), 1.0);
}
