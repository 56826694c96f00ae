#pragma once

#include "content/load/faces/face_import.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <string>
#include <string_view>

namespace limn {

// Reads the human of MakeHuman (CC0 assets of MakeHuman 1.3): base.obj with the mean of the
// macrodetails whose names end in "young", the macrodetails and the expression units as morph
// targets, named like the files, with their action units, the default rig of bones, and the
// high-poly eyes. Rig, eyes and macrodetails are optional. Parts: skin, mucosa, teeth, sclera,
// iris, cornea. Not read: clothes, hair and lashes of the helper geometry.

/// A scene in meters, standing on y = 0, of the files in `folder`: base.obj, targets, rigs and
/// proxies. Fails if base.obj or all expressions are missing, and on a mesh other than hm08.
[[nodiscard]] Result<GltfScene>
import_makehuman(const std::string& folder, const ImportProgress& progress);

/// The action unit of an expression unit of MakeHuman, "AU9_L" for "nose-left-elevation"; empty if
/// no unit corresponds.
[[nodiscard]] std::string makehuman_action_unit(std::string_view target);

}  // namespace limn
