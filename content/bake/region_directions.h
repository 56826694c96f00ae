#pragma once

#include "ecs/components/surface.h"

namespace limn {

// Directions across the folds of a face (face_regions.h), turned to those in which its own
// expressions shorten its skin. Of a region, the mean direction of most shortening (face.strain) in
// the expression that folds it is found on the left side and, mirrored, on the right, and the whole
// region turns by as much. Folds keep their places, which are anatomy's: another face may push its
// brows straight down to frown where the reference pulls them together as well.

/// Regions whose folds radiate or that fold in no expression of the mesh, by the action units of
/// its morph targets, stay as they are; none turns by more than 35 degrees, or in the middle of the
/// face, the plane x = 0.
void fit_region_directions(MeshData& mesh);

}  // namespace limn
