// Highlights of all lights in maps of the camera's axes (fakephong.envmap-bake; ENVIRONMENT_LAYOUT): the sum of E (W.L)^(n / 4), W
// the direction of a texel and n the exponent of Blinn's highlight. All lights count as directional, with the direction
// from the center of a layer's objects. Texels at the edge of a sphere map are 0, like those beyond its disc.
// Techniques: fakephong.envmap-bake
#version 450
#define LINEAR_FADE
#define SPOT_ANGLES
#include "lib/light.glsl"
#include "lib/view.glsl"
#include "lib/highlight_layout.glsl"
#include "light_gpu.h"
#include "highlight_gpu.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kHighlightRecordsUnit) uniform samplerBuffer layers;  // center of its objects [m]; w: exponent n
layout(binding = kLightsUnit) uniform samplerBuffer lights;  // LightRecord
layout(binding = kHighlightMapsImage, rgba16f) writeonly uniform image2DArray maps;

uniform int light_count;

const float kLobe = 0.25;  // exponent of W.L over that of N.H: lobes of equal width

struct Lobe {
    vec3 to_light;
    vec3 irradiance;
};

Lobe lobe_of(int light, vec3 center) {
    vec4 texels[4];
    for (int i = 0; i < 4; ++i) {
        texels[i] = texelFetch(lights, light * int(kLightTexels) + i);
    }
    if (light < int(view.grid_depth.z)) {
        return Lobe(texels[0].xyz, texels[1].rgb);
    }
    vec3 offset = texels[0].xyz - center;
    float d2 = max(dot(offset, offset), 1e-12);
    vec3 to_light = offset * inversesqrt(d2);
    float fade = distance_attenuation(d2, texels[0].w, texels[2].xyz, texels[1].w)
                 * spot_attenuation(to_light, texels[3].xyz, texels[3].w, texels[2].w);
    return Lobe(to_light, fade * texels[1].rgb);
}

void main() {
    ivec2 size = imageSize(maps).xy;
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    vec2 at = 2.0 * (vec2(texel) + 0.5) / vec2(size) - 1.0;
    vec3 w = map_direction(at);
    vec3 sum = vec3(0.0);
    if (w != vec3(0.0)) {
        vec3 w_ws = w.x * normalize(view.ray_right.xyz) + w.y * normalize(view.ray_up.xyz) - w.z * view.ray_forward.xyz;
        vec4 layer = texelFetch(layers, int(gl_WorkGroupID.z));
        for (int i = 0; i < light_count; ++i) {
            Lobe lobe = lobe_of(i, layer.xyz);
            float cosine = dot(w_ws, lobe.to_light);
            sum += cosine > 0.0 ? pow(cosine, kLobe * layer.w) * lobe.irradiance : vec3(0.0);
        }
    }
    imageStore(maps, ivec3(gl_GlobalInvocationID), vec4(min(sum, 65504.0), 1.0));
}
