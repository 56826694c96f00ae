// Whether surfaces of the scene occlude marks that are drawn over the finished image.

#include "furrow_gpu.h"

layout(binding = kFurrowSceneUnit) uniform sampler2D scene_depth;  // reversed: near / distance
uniform int has_scene;                                             // 0: no depth test

const float kSceneSlack = 1.01;  // relative to the distance: the scene contains the surface itself, drawn with jitter

bool scene_hides(vec3 fragment) {
    return has_scene != 0 && texelFetch(scene_depth, ivec2(fragment.xy), 0).r > kSceneSlack * fragment.z;
}
