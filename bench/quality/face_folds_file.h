#pragma once

#include "bench/quality/quality.h"
#include "ecs/components/surface.h"

#include <string_view>

namespace limn {

/// Reports where the skin of a face folds in each of its expressions: a row and a bound for each
/// rule of anatomy for which the face has the shapes, and a table of all expressions and regions.
/// A bound on the dimples of a raised chin is for faces that model them; of others it is reported.
/// Fails if it has no regions with directions or no morph targets.
Status measure_face(
    std::string_view name, const MeshData& face, QualityReport& report, bool has_dimples = false);

/// The same for the mesh with the most named action units in a glTF file.
Status measure_face_file(const std::string& path, QualityReport& report);

}  // namespace limn
