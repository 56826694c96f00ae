// Fog that thins with height, integrated from the camera (render/environment/fog_block.h).
// Techniques: light.height-fog

#include "lib/view.glsl"
#include "fog_gpu.h"

UNIFORM_BLOCK(kFogBinding, HeightFog, FogBlock, height_fog, height_fogs);

const float kMaxOpticalDepth = 80.0;

float fog_optical_depth(float rise, float path) {
    float x = height_fog.density.y * rise * path;
    float mean = abs(x) < 1e-2 ? 1.0 - x * (0.5 - x / 6.0) : (1.0 - exp(min(-x, kMaxOpticalDepth))) / x;
    return min(height_fog.density.x * path * mean, kMaxOpticalDepth);
}

// Phase function of Henyey and Greenstein.
float fog_phase(float cosine) {
    float g = height_fog.density.z;
    float d = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * 3.14159265 * d * sqrt(d));
}

// In-scattered radiance over `path` [m] from the camera, and the opacity; `direction`: unit.
vec4 fog_along(vec3 direction, float path) {
    float opacity = 1.0 - exp(-fog_optical_depth(direction.y, path));
    vec3 scattered = height_fog.ambient.rgb + height_fog.sun.rgb * fog_phase(dot(direction, height_fog.to_sun.xyz));
    return vec4(scattered * opacity, opacity);
}

vec4 fog_before(vec3 position_ws) {
    if (height_fog.density.x <= 0.0) {
        return vec4(0.0);
    }
    vec3 ray = position_ws - view.camera_ws.xyz;
    float path = max(length(ray), 1e-6);
    return fog_along(ray / path, max(path - view.orthographic.x, 0.0));
}
