#pragma once

#include "content/load/faces/face_import.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <string>
#include <string_view>

namespace limn {

// Reads the faces of ICT FaceKit (USC Institute for Creative Technologies 2020; Li et al.,
// "Learning Formation of Physically-Based Face Attributes", CVPR 2020): the neutral mesh and
// all expressions that exist, named like the files, with their action units. If an expression has
// only one half, the other is its mirror image. Parts: skin, mucosa, teeth, sclera, iris, cornea
// with the tear line, lashes. Not read: the strips that blend and darken the borders of the eyes,
// and identities.

/// A scene in meters of the files in `folder`, or in FaceXModel under it. Fails if the neutral mesh
/// is missing, a file has another number of vertices, or there is no expression.
[[nodiscard]] Result<GltfScene>
import_ict_facekit(const std::string& folder, const ImportProgress& progress);

/// The action unit of an expression of ICT FaceKit, "AU12_L" for "mouthSmile_L"; empty if no unit
/// corresponds.
[[nodiscard]] std::string ict_action_unit(std::string_view shape);

}  // namespace limn
