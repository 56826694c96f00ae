// One layer of very distant surroundings, blended over the sky. Defined: PANORAMA_FACES for a cube of six images.
// Techniques: engine.panorama
#version 450
#include "lib/panorama.glsl"
#include "lib/radiance.glsl"
#include "lib/view.glsl"
#include "panorama_layer_gpu.h"

#ifdef PANORAMA_FACES
layout(binding = kPanoramaLayerUnit) uniform samplerCube faces;  // mirrored: front is +z
#else
layout(binding = kPanoramaLayerUnit) uniform sampler2D image;  // its first row is the top one
#endif

uniform mat3 layer_from_world;  // a rotation
uniform int mapping;            // PanoramaMapping
uniform float half_angle;
uniform float repeat;
uniform vec4 color;             // a: opacity

layout(location = 0) out vec4 radiance;

void main() {
    vec3 d = layer_from_world * normalize(view_ray(gl_FragCoord.xy));
#ifdef PANORAMA_FACES
    vec4 texel = texture(faces, vec3(d.xy, -d.z));
#else
    vec2 uv = panorama_uv(mapping, d, half_angle);
    uv.y = 1.0 - uv.y;
    // The longitude jumps behind the viewer, which must not choose the smallest mip level.
    vec2 dx = dFdx(uv);
    vec2 dy = dFdy(uv);
    vec2 scale = vec2(1.0);
    if (mapping != kAngular) {
        dx.x -= round(dx.x);
        dy.x -= round(dy.x);
        scale.x = repeat;
    }
    vec4 texel = textureGrad(image, scale * uv, scale * dx, scale * dy);
    if (mapping == kCylindrical && d.y > length(d.xz) * tan(half_angle)) {
        texel.a = 0.0;  // nothing is above the strip
    }
#endif
    radiance = vec4(storable(color.rgb * texel.rgb), color.a * texel.a);
}
