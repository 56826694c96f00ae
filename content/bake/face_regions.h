#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"

#include <span>
#include <string_view>
#include <vector>

namespace limn {

// Where the skin of a face folds, as named regions with soft borders and, at each vertex, the
// direction across the folds. Rules and directions were measured on the neutral face and the
// expressions of ICT FaceKit (Li et al. 2020): the direction is that of maximum shortening in the
// expressions that fold the region; around the outer corners of the eyes and the mouth, folds
// radiate; the nasolabial fold and the pouch below the corner of the mouth (marionette) follow
// anatomy. The chin has no direction: it dimples where it is compressed on average.
//
//     forehead      raised brows          lower_lid      smile          mouth_corner  smile
//     glabella      frown                 inner_canthus  squint         marionette    mouth frown
//     nose_root     sneer                 crows_feet     smile, squint  mentolabial   pucker
//     nose_side     sneer                 cheek          smile          chin          chin raise
//     nasolabial    smile                 upper_lip      pucker         upper_lid     sneer
//
// A face of other proportions is first warped to the reference (point_warp.h); a face with
// expressions has directions measured from those (region_directions.h).

/// Names of the regions, in the order of make_face_regions.
[[nodiscard]] std::span<const std::string_view> face_region_names();

/// One region for each name, symmetric about the reference's plane x = 0. `reference`: the vertices
/// in the space of the reference face [cm], with +x to its left, +y up and +z forward; NaN for a
/// vertex that is not skin of the face. `normals`: unit, of the mesh at rest, with the same axes.
[[nodiscard]] std::vector<VertexRegion>
make_face_regions(std::span<const Vec3> reference, std::span<const Vec3> normals);

}  // namespace limn
