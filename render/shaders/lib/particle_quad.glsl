// Where the quad of a particle is: after lib/particle.glsl and lib/view.glsl.

const int kFacingCamera = 0;
const int kFacingVelocity = 1;
const int kFacingGround = 2;
const int kFacingPixels = 3;

// Half the extents of the quad in world space: along x and y of `corner`.
struct Quad {
    vec3 right;
    vec3 up;
};
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
        float seen = length(across);  // its length in the image, of what it would be from the side
        across = seen > 1e-3 ? across / seen : right;
        return Quad(half_size * across, (half_size + 0.5 * streak.y * speed) * along);
    }
    if (tumble > 0.0) {
        float lean = tumble * (0.6 + 0.4 * random_share(p.random, 3u)) * p.age + 3.14159 * random_share(p.random, 4u);
        right = cos(lean) * right + sin(lean) * cross(right, up);
    }
    return Quad(half_size * right, half_size * up);
}
