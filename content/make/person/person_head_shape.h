#pragma once

#include "content/make/head/head.h"
#include "content/make/person/person_skeleton.h"

namespace limn {

/// The head that a person wears, in the space of head_surface.h.
[[nodiscard]] HeadShape person_head_shape(const PersonFrame& frame);

/// From that space [cm]. A child's face is short and narrow below the eyes.
[[nodiscard]] Vec3 head_in_body(const PersonFrame& frame, Vec3 p);

}  // namespace limn
