#pragma once

#include "ecs/components/surface.h"

namespace limn {

// Directions across the folds of a face (face_regions.h), rotated to those in which its own
// expressions shorten its skin. For each region, the mean direction of maximum shortening
// (face.strain) in the expression that folds it is measured on the left side and, mirrored, on the
// right, and the whole region turns by that angle. Folds keep their positions, which follow
// anatomy: another face may push its brows straight down to frown where the reference also pulls
// them together.

/// Regions whose folds radiate or that fold in no expression of the mesh, by the action units of
/// its morph targets, are unchanged; none turns by more than 35 degrees, or at all on the midline
/// x = 0.
void fit_region_directions(MeshData& mesh);

}  // namespace limn
