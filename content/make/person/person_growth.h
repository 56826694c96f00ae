#pragma once

#include "content/make/person/person_skeleton.h"
#include "ecs/components/surface.h"

namespace limn {

// Children: a person is modelled with the proportions of an adult, then each bone is scaled, with
// the skin that it moves. A head is a fifth of the height of a child of four and a seventh and a
// half of an adult's; legs, neck, hands and feet are shorter, shoulders and hips narrower (A.
// Tilley, "The Measure of Man and Woman", 2002).

/// The joints of the person itself, at the reference height: those of `frame` for an adult.
[[nodiscard]] PersonFrame grown_frame(const PersonFrame& frame);

/// From a mesh of `frame` at the reference height, with skin weights, to one of `own`, its
/// grown_frame, at the person's height.
void grow_mesh(MeshData& mesh, const PersonFrame& frame, const PersonFrame& own);

}  // namespace limn
