#pragma once

#include "content/make/person/person_skeleton.h"
#include "ecs/components/skeleton.h"

#include <vector>

namespace limn {

/// "idle": the arms hang, chest and head move as the person breathes and shifts weight. And poses
/// to look at a body in: "arms_up", "sit", "squat", "fist" and "palms_up", each held for a second.
[[nodiscard]] std::vector<ClipData> make_person_clips(const PersonFrame& frame);

}  // namespace limn
