#pragma once

#include "content/make/head/head_action_units.h"
#include "content/make/person/person_skeleton.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// The face of a person moves by a few morph targets, each named after the action unit of FACS that
// leads it, so that whatever drives faces drives this one (`limn speak`, morph_player): "AU26" the
// jaw opens, "AU20" lips wide, "AU18" round, "AU24" pressed, "AU12" a smile, "AU45" a blink, "AU1"
// brows up, "AU4" brows down.

inline constexpr std::uint16_t kPersonFaceShapes = 8;

/// Levels of detail with fewer triangles have closed lips and no such shapes.
inline constexpr int kMinFaceTriangles = 5000;

/// Whether the mesh has shapes of the face, if it has one.
[[nodiscard]] bool has_face_shapes(const PersonShape& shape);

/// One target per shape, with normals, at the reference height. `points`: one per vertex, in the
/// space of head_surface.h.
void add_face_shapes(MeshData& mesh, std::span<const HeadPoint> points, const PersonFrame& frame);

/// "talk" says some sentences and falls silent between them, "blink" and "smile", to be played
/// beside other clips by a morph_player. `first`: index of the first shape of a face in its mesh.
[[nodiscard]] std::vector<ClipData> make_person_face_clips(std::uint16_t first);

}  // namespace limn
