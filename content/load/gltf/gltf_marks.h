#pragma once

#include "content/load/gltf/gltf_document.h"
#include "ecs/components/skeleton.h"

#include <cstddef>

namespace limn {

/// Adds the contacts and events of an animation, in extras.limn:
///     "contacts": [{"joint": "LeftFoot", "begin": 0.2, "end": 0.7}],
///     "events": [{"name": "step", "time": 0.2}]
/// sorted by time and clamped to the clip. One with an unknown joint or without a number is left
/// out with a warning.
void read_clip_marks(
    GltfDocument& document, std::size_t animation, const SkeletonData& skeleton, ClipData& clip);

}  // namespace limn
