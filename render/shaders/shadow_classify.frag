// Classifies each pixel by the shadow map of a light: 0 shadow, 1 lit, and 0.5 where nearby texels disagree and shadow
// volumes must decide (shadow.hybrid-edge). The filter spans more texels than the map's bias can move an edge. Volumes
// also decide at grazing incidence: there the bias hides that a facet of a round object faces away, though its smooth
// normal does not.
// Techniques: shadow.hybrid-edge
#version 450
#include "lib/gbuffer.glsl"
#include "lib/view.glsl"
#include "light_gpu.h"
#include "lib/shadow.glsl"
#include "shadow_volume_gpu.h"
#include "gbuffer_gpu.h"

layout(binding = kShadowVolumeBinding, std140) uniform Volume {
    VolumeBlock volume;
};
layout(binding = kGbufferUnit) uniform usampler2D gbuffer;
layout(binding = kDepthUnit) uniform sampler2D scene_depth;

uniform vec4 map;  // LightRecord::shadow

layout(location = 0) out float mask;

const float kAgree = 1e-3;   // rounding error of the filter's weights
const float kGrazing = 0.2;  // cosine; the facets of 32 around a column are turned by 0.1

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 position_ws = world_position(gl_FragCoord.xy, texelFetch(scene_depth, pixel, 0).r);
    vec3 normal = unpack_surface(texelFetch(gbuffer, pixel, 0)).normal_ws;
    vec3 away = away_from_light(position_ws, volume.light);
    vec3 to_light = normalize(-away);
    if (dot(normal, to_light) <= 0.0 || dot(away, away) * volume.light.w > volume.extrusion.w * volume.extrusion.w) {
        mask = 0.0;  // unlit
        return;
    }
    float lit = light_visibility(map, position_ws, normal, to_light, gl_FragCoord.xy);
    bool grazes = dot(normal, to_light) < kGrazing;
    mask = lit < kAgree ? 0.0 : lit > 1.0 - kAgree && !grazes ? 1.0 : 0.5;
}
