#pragma once

#include "content/make/head/head.h"
#include "ecs/components/skeleton.h"

#include <vector>

namespace limn {

// Facial expressions as action units: after P. Ekman and W. Friesen, "Emotional Facial Action
// Coding System" (1983), and some of single muscles.

/// Clips of make_head_rig: "smile", "surprise", "frown", "sadness", "disgust", "fear", "pucker",
/// "puff", "wink", "doubt" and "gape", each from rest to rest; "expressions", all of them with a
/// wandering gaze; "talk", which says the English text `says` by the rules of content/speech, with
/// blinks, gaze and nods; "relax", the same with brows that rise and relax; "blink"; and, for a
/// head that grows old, "old", a morph animation whose weight is its age. With wrinkle channels,
/// expressions set weights of wrinkle maps as well.
[[nodiscard]] std::vector<ClipData> make_head_clips(const HeadShape& shape);

}  // namespace limn
