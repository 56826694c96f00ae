// Covers the pixels within the radius of a line (furrow_pass.h).
#version 450
#include "lib/scene_hides.glsl"

layout(location = 0) in vec4 color;
layout(location = 1) noperspective in vec2 line_px;
layout(location = 2) flat in vec2 length_radius_px;
layout(location = 3) flat in float opacity;
layout(location = 0) out vec4 display;  // premultiplied

void main() {
    if (scene_hides(gl_FragCoord.xyz)) {
        discard;
    }
    float beyond = max(max(-line_px.x, line_px.x - length_radius_px.x), 0.0);
    float cover = clamp(length_radius_px.y + 0.5 - length(vec2(beyond, line_px.y)), 0.0, 1.0);
    display = opacity * cover * vec4(color.rgb, 1.0);
}
