#pragma once

#include "content/app/commands/import_command.h"
#include "content/load/faces/marker_retarget.h"
#include "content/load/gltf/gltf_clip.h"
#include "ecs/base/result.h"

#include <span>
#include <string>
#include <vector>

namespace limn {

/// `limn import markers`: a .glb of the markers, or of a face that performs their recording; and
/// the recording, with its sound, in a library of speech.
[[nodiscard]] Status import_marker_take(const ImportOptions& options);

/// Places of markers on the face in the file `face`, by the file `map` or, if that is "", by name.
[[nodiscard]] Result<FaceMarkers> place_on_face(
    const std::string& face, std::span<const std::string> markers, const std::string& map);

/// Adds the weights `row` of `shapes` to those of a node's shapes of the same names.
void add_weights_by_name(
    const GltfFaceNode& node, std::span<const std::string> shapes, std::span<const float> row,
    std::span<float> weights);

}  // namespace limn
