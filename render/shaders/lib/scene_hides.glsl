// Whether surfaces of the scene occlude marks that are drawn over the finished image.

#include "furrow_gpu.h"

layout(binding = kFurrowSceneUnit) uniform sampler2D scene_depth;  // reversed: near / distance
uniform int has_scene;                              // 0: nothing hides it

const float kSceneSlack = 1.01;  // of the distance: the scene has the surface itself, which is drawn with jitter

bool scene_hides(vec3 fragment) {
    return has_scene != 0 && texelFetch(scene_depth, ivec2(fragment.xy), 0).r > kSceneSlack * fragment.z;
}
