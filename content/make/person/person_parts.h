#pragma once

#include "content/make/person/person_body.h"
#include "content/make/person/person_mesh.h"

namespace limn {

// Shells of the parts of a person, at the reference height: the left half, to be mirrored, unless
// said otherwise.

/// Vertices around an arm and a sleeve; a hand ends in as many.
inline constexpr int kArmColumns = 20;

/// The arm from `start` along it to the finger tips, closed where it begins.
void add_arm(BodyMesh& mesh, const PersonFrame& frame, float start);

/// The leg from `top` [m] down into the shoe, closed at both ends.
void add_leg(BodyMesh& mesh, const PersonFrame& frame, float top);

/// Where what is worn ends: skin begins a little within.
struct PersonHems {
    float sleeve = 0;  ///< along the arm [m]
    float leg = 0;     ///< height [m]
};
[[nodiscard]] PersonHems person_hems(const PersonFrame& frame);

void add_shirt(BodyMesh& mesh, const PersonFrame& frame);
void add_trousers(BodyMesh& mesh, const PersonFrame& frame);  ///< or shorts, or a skirt
void add_shoe(BodyMesh& mesh, const PersonFrame& frame);

/// Folds of cloth, on both sides: after mirroring.
void fold_cloth(BodyMesh& mesh, const PersonFrame& frame);

/// Both eyeballs.
void add_eyes(BodyMesh& mesh, const PersonFrame& frame);

/// Hair of the scalp; none if bald. Not to be mirrored.
void add_hair(BodyMesh& mesh, const PersonFrame& frame);

/// Face, brows and neck with lips closed, about PersonShape::head_triangles triangles, with the
/// normals of the fine head.
[[nodiscard]] MeshData make_person_head(const PersonFrame& frame);

}  // namespace limn
