// Maps a direction of any length to (u, v) in [0, 1]^2 of a panorama, v upward. The same as render/environment/panorama.h, which
// explains the three mappings. An arc cosine would lose the last degrees near the poles to rounding; the arc tangents
// here do not.
// Techniques: env.angular-map

const float kTwoPi = 6.28318530718;

// Numbered as PanoramaMapping.
const int kEquirectangular = 0;
const int kCylindrical = 1;
const int kAngular = 2;

vec2 panorama_uv(int mapping, vec3 d, float half_angle) {
    float across = length(d.xz);
    // At a pole any longitude is valid; atan(0, 0) is undefined.
    float longitude = (across > 0.0 ? atan(d.x, -d.z) : 0.0) / kTwoPi + 0.5;
    if (mapping == kEquirectangular) {
        return vec2(longitude, 2.0 * atan(d.y, across) / kTwoPi + 0.5);
    }
    if (mapping == kCylindrical) {
        float height = d.y / max(across, 1e-20);
        return vec2(longitude, clamp(0.5 + height / (2.0 * tan(half_angle)), 0.0, 1.0));
    }
    return 0.5 + d.xz * (atan(across, d.y) / (kTwoPi * max(across, 1e-20)));
}
