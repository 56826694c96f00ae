#pragma once

namespace limn {

// Converts between distance along the view axis and depth buffer values
// (post.linear-to-window-depth). Ours are reversed with an infinite far plane: near / e; the finite
// ones take `far`. Points at or behind the eye map to the nearest depth.
// Techniques: post.linear-to-window-depth

/// Conventional depth: 0 at the near plane, 1 at the far one.
[[nodiscard]] inline double window_depth(double eye_distance, double near, double far) {
    return eye_distance > 0 ? (far - far * near / eye_distance) / (far - near) : 0;
}
[[nodiscard]] inline double eye_distance_of(double window_depth, double near, double far) {
    return far * near / (far - window_depth * (far - near));
}

/// Reversed depth: 1 at the near plane, 0 at the far one.
[[nodiscard]] inline double reversed_depth(double eye_distance, double near, double far) {
    return eye_distance > 0 ? near * (far - eye_distance) / (eye_distance * (far - near)) : 1;
}

/// Reversed depth without a far plane, as we use it; 0 at infinity.
[[nodiscard]] inline double reversed_depth(double eye_distance, double near) {
    return eye_distance > 0 ? near / eye_distance : 1;
}

}  // namespace limn
