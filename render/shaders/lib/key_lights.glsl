// The records of lights; and the two key lights, whose shadows surfaces may know on their own (KEY_SHADOWS: relief that
// traces rays toward them): the first directional light, and the first other light with a shadow map.
// Techniques: relief.self-shadow

#include "lib/view.glsl"
#include "light_gpu.h"

layout(binding = kLightsUnit) uniform samplerBuffer lights;  // LightRecord

int light_count() {
    return textureSize(lights) / int(kLightTexels);
}

// Index into the records, or -1.
ivec2 key_lights() {
    int local = int(view.grid_depth.w);
    return ivec2(view.grid_depth.z > 0.0 ? 0 : -1, local < light_count() ? local : -1);
}

// Unit, from a point to a light; 0 for index -1 and out of the light's range.
vec3 to_key_light(int index, vec3 position_ws) {
    vec4 position = texelFetch(lights, max(index, 0) * int(kLightTexels));
    bool directional = float(index) < view.grid_depth.z;
    vec3 to_light = directional ? position.xyz : position.xyz - position_ws;
    float d2 = dot(to_light, to_light);
    bool reaches = index >= 0 && (directional || d2 * position.w < 1.0);
    return reaches ? to_light * inversesqrt(max(d2, 1e-20)) : vec3(0.0);
}
