// Ways to draw water that are not the usual ones (ecs/components/water_look.h). After lib/view.glsl, lib/optics.glsl
// and lib/water_surface.glsl. Definitions:
//   LOOKS     some body of water is not drawn as usual
//   PLANAR    one has a planar reflection
//   UNTRACED  none mirrors what the picture shows

const int kSchlick = 1;
const int kByAngle = 2;
const int kPictureReflection = 0;
const int kPlanarReflection = 2;

// Of a water's surface, seen from above or below: share of light that it mirrors.
float water_share(WaterRecord water, bool above, float cosine) {
    float share = fresnel(cosine, above ? water.shape.w : 1.0 / water.shape.w);
#ifdef LOOKS
    int how = int(water.scattering.w) & 3;
    share = above && how == kSchlick ? fresnel_schlick(cosine, water.shape.w) : share;
    share = above && how == kByAngle ? fresnel_tso_barsky(cosine) : share;
#endif
    return share;
}

int reflection_of(WaterRecord water) {
#ifdef LOOKS
    return int(water.scattering.w) >> 2 & 3;
#else
    return kPictureReflection;
#endif
}

#ifdef PLANAR
// What a camera sees that is mirrored in the surface at rest, upside down; w: distance along its axis [m], 0 where
// nothing is. Its levels are blurred.
layout(binding = 22) uniform sampler2D reflection_map;

const int kPlanarSteps = 3;
const float kFarAway = 1e4;  // [m]

// What is mirrored at `position` toward `away`. Behind flat water the mirrored scene lies where the camera sees it; a
// wave shifts it, the more the further away it is: as far as the picture shows there, and there again. `alpha`: of the
// distribution of normals too fine to be seen.
vec3 planar_reflection(WaterRecord water, vec3 position, vec3 away, float alpha) {
    // The ray goes on behind the surface.
    vec3 start = vec3(position.x, 2.0 * water.origin.y - position.y, position.z);
    vec3 onward = vec3(away.x, -max(away.y, 0.0), away.z);
    vec3 from = (view.clip_from_world * vec4(start, 1.0)).xyw;
    vec3 along = (view.clip_from_world * vec4(onward, 0.0)).xyw;
    vec2 straight = gl_FragCoord.xy * view.size.zw;
    vec2 uv = straight;
    float way = kFarAway;
    for (int i = 0; i < kPlanarSteps; ++i) {
        float seen = textureLod(reflection_map, vec2(uv.x, 1.0 - uv.y), 0.0).w;
        way = seen > 0.0 ? clamp((seen - from.z) / max(along.z, 1e-3), 0.0, kFarAway) : kFarAway;
        vec3 clip = from + way * along;
        uv = 0.5 + 0.5 * clip.xy / max(clip.z, 1e-6);
    }
    uv = mix(straight, uv, water.ocean.w);
    float pixel = 2.0 * length(view.ray_up.xyz) / float(textureSize(reflection_map, 0).y);
    float blur = 2.0 * alpha * way / (way + distance(position, view.camera_ws.xyz));
    return textureLod(reflection_map, vec2(uv.x, 1.0 - uv.y), log2(max(blur / pixel, 1.0))).rgb;
}
#endif
