#pragma once

#include "content/load/obj/obj_file.h"

#include <string>

namespace limn {

struct GltfScene;

/// Appends a material for each of `obj.materials` to the scene, from the libraries under the folder
/// of `path`, with their images; what is missing or bad leaves a warning in the scene. Of several
/// materials of a name, the first counts. `mtllib` and names are read as programs write them: a
/// statement names one file with spaces, or several, and ` #` begins a comment where no file or
/// material has that name with it.
void build_obj_materials(
    const ObjFile& obj, const std::string& path, const ObjLimits& limits, GltfScene& scene);

}  // namespace limn
