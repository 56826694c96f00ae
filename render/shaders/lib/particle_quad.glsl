// The quad of a particle: after lib/particle.glsl and lib/view.glsl.

const float kFilterPixels = 1.0;  // by which filtering spreads a frame's content, at texels as large as pixels

const float kRoundness = 0.8;  // how far the normals at the corners lean outward, by eye

// Normal at a corner, or between it and the center.
vec3 rounded_normal(vec3 position_ws, vec3 offset) {
    return normalize(to_viewer(position_ws) + kRoundness * normalize(offset + vec3(0.0, 1e-6, 0.0)));
}

Quad quad_of(Particle p, vec4 shape, vec4 streak, float tumble, int facing, float size) {
    float angle = angle_of(p, shape, streak);
    vec3 to_camera = normalize(view.camera_ws.xyz - p.position);
    vec3 right = normalize(view.ray_right.xyz);
    vec3 up = normalize(cross(to_camera, right));
    right = cross(up, to_camera);
    if (facing == kFacingPixels) {  // in the plane of the image, where its extent is the same everywhere
        right = normalize(view.ray_right.xyz);
        up = normalize(view.ray_up.xyz);
    }
    if (facing == kFacingGround) {
        right = vec3(1.0, 0.0, 0.0);
        up = vec3(0.0, 0.0, -1.0);
    }
    vec3 turned = cos(angle) * right + sin(angle) * up;
    up = cos(angle) * up - sin(angle) * right;
    right = turned;
    float half_size = 0.5 * size;
    if (facing == kFacingVelocity) {
        float speed = length(p.velocity);
        vec3 along = speed > 1e-6 ? p.velocity / speed : up;
        vec3 across = cross(along, to_camera);
        float projected = length(across);  // sine of the angle between the velocity and the view ray
        across = projected > 1e-3 ? across / projected : right;
        return Quad(half_size * across, (half_size + 0.5 * streak.y * speed) * along);
    }
    if (tumble > 0.0) {
        float lean = tumble * (0.6 + 0.4 * random_signed(p.random, 3u)) * p.age + 3.14159 * random_signed(p.random, 4u);
        right = cos(lean) * right + sin(lean) * cross(right, up);
    }
    return Quad(half_size * right, half_size * up);
}

// Left, bottom, right and top of a frame's content, in the quad's coordinates (render/particles/frame_insets.h).
vec4 frame_box(int look, float number) {
    const float kBase = float(kInsetSteps / 2u);
    const vec4 kDigits = vec4(1.0, kBase, kBase * kBase, kBase * kBase * kBase);
    int n = int(number);
    float code = n < int(kMaxInsetFrames) ? look_texel(look, kLookInsets + uint(n >> 2))[n & 3] : 0.0;
    vec4 insets = mod(floor(code / kDigits), kBase) * (2.0 / float(kInsetSteps));
    return vec4(-1.0 + insets.xy, 1.0 - insets.zw);
}

// The corner of a quad trimmed to the content of the current frames; `pixel`: extent of a pixel [m], by which filtering
// may spread it.
vec2 trimmed_corner(vec2 corner, int look, Flipbook book, Quad quad, float pixel) {
    vec4 a = frame_box(look, book.numbers.x);
    vec4 b = frame_box(look, book.numbers.y);
    vec2 blur = kFilterPixels * pixel / max(vec2(length(quad.right), length(quad.up)), vec2(1e-6));
    vec2 low = max(min(a.xy, b.xy) - blur, -1.0);
    vec2 high = min(max(a.zw, b.zw) + blur, 1.0);
    return mix(low, high, 0.5 + 0.5 * corner);
}
