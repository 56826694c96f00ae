// post.scene-ripple: offset of the lookup at `uv`. Distances along x are scaled by `aspect`.
vec2 screen_ripple(vec2 uv, vec2 center, float radius, float amplitude, float aspect) {
    vec2 away = (uv - center) * vec2(aspect, 1.0);
    float far = length(away);
    vec2 direction = far > 0.0 ? away / far : vec2(0.0);
    float near = max(0.0, 1.0 - far / radius);
    float wave = near * amplitude * cos(near * 7.853981634);  // 2.5 pi
    return direction * wave / vec2(aspect, 1.0);
}
