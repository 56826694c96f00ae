#pragma once

#include "ecs/components/crowd_script.h"
#include "ecs/components/skeleton.h"

namespace limn {

// Cyclic scripts of background characters, made for any skeleton of a person: arms and legs are
// turned to directions, so that any rest pose does.
// Techniques: char.crowd-script

/// A loop of seconds, on the spot, in place of a recording. Sitting, hips are lowered to the height
/// of the knees and feet stay on the ground. Without legs, a clip of the rest pose.
[[nodiscard]] ClipData make_activity_clip(const SkeletonData& skeleton, CrowdActivity activity);

}  // namespace limn
