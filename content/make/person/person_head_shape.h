#pragma once

#include "content/make/head/head.h"
#include "content/make/person/person_skeleton.h"

namespace limn {

/// The head that a person wears, in the space of head_surface.h.
[[nodiscard]] HeadShape person_head_shape(const PersonFrame& frame);

}  // namespace limn
