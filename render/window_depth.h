#pragma once

namespace limn {

// Between distances along the view axis and what depth buffers hold (post.linear-to-window-depth).
// Ours are reversed and have no far plane: near / e; with finite ones, `far` is where they end.
// What is at the eye or behind it counts as nearest.

/// Of a usual depth buffer: 0 at the near plane, 1 at the far one.
[[nodiscard]] inline double window_depth(double eye_distance, double near, double far) {
    return eye_distance > 0 ? (far - far * near / eye_distance) / (far - near) : 0;
}
[[nodiscard]] inline double eye_distance_of(double window_depth, double near, double far) {
    return far * near / (far - window_depth * (far - near));
}

/// Of a reversed one: 1 at the near plane, 0 at the far one.
[[nodiscard]] inline double reversed_depth(double eye_distance, double near, double far) {
    return eye_distance > 0 ? near * (far - eye_distance) / (eye_distance * (far - near)) : 1;
}

/// Of ours; infinity has 0.
[[nodiscard]] inline double reversed_depth(double eye_distance, double near) {
    return eye_distance > 0 ? near / eye_distance : 1;
}

}  // namespace limn
