#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

// Shape controls of a mesh: few parameters that move thousands of vertices. They act on the rest
// shape after morph targets and before joints. All positions are in mesh space.

/// A muscle between bone and skin that pulls the vertices in its cone toward the bone
/// (face.waters-muscle): K. Waters, "A Muscle Model for Animating Three-Dimensional Facial
/// Expression", 1987. His cosines are squared where the pull ends, at the border of the cone and at
/// its `reach`: their slopes there would crease the skin.
struct LinearMuscle {
    Vec3 attachment{0, 0, 0};
    Vec3 insertion{0, 0.05f, 0};
    float angle = 0.6f;        ///< between axis and border of the cone [rad]
    float full = 0.04f;        ///< distance of the strongest pull from the attachment [m]
    float reach = 0.06f;       ///< distance at which the pull ends [m], > full
    float contraction = 0.0f;  ///< fraction of the muscle's length by which it pulls
};

LIMN_FIELDS(LinearMuscle) {
    LIMN_FIELD(attachment, "end on the bone", "m");
    LIMN_FIELD(insertion, "end in the skin", "m");
    LIMN_FIELD(
        angle, "angle between axis and border of the cone that it moves", "rad", 0.01f, 1.57f);
    LIMN_FIELD(full, "distance of the strongest pull from the attachment", "m", 1e-4f, 1e4f);
    LIMN_FIELD(reach, "distance at which the pull ends; more than full", "m", 1e-4f, 1e4f);
    LIMN_FIELD(
        contraction, "fraction of its length by which it pulls; negative: pushes", "", -1, 1);
}

/// A ring of muscle that contracts the vertices in its ellipse, as around the mouth
/// (face.waters-muscle).
struct SphincterMuscle {
    Vec3 center{0, 0, 0};
    Vec3 right{0.03f, 0, 0};   ///< semi-axis [m]
    Vec3 up{0, 0.02f, 0};      ///< semi-axis; its part along `right` is ignored [m]
    float depth = 0.03f;       ///< extent perpendicular to the ellipse [m]
    float contraction = 0.0f;  ///< fraction of the distance to the center
};

LIMN_FIELDS(SphincterMuscle) {
    LIMN_FIELD(center, "center of the ellipse", "m");
    LIMN_FIELD(right, "semi-axis of the ellipse", "m");
    LIMN_FIELD(up, "other semi-axis", "m");
    LIMN_FIELD(depth, "extent perpendicular to the ellipse", "m", 1e-4f, 1e4f);
    LIMN_FIELD(contraction, "fraction of the distance to the center; negative: apart", "", -1, 1);
}

/// A box of 4 x 4 x 4 control points (face.ffd): T. Sederberg and S. Parry, "Free-Form Deformation
/// of Solid Geometric Models", 1986. A vertex inside follows the points by the weights of cubic
/// Bezier volumes; others do not move. Where two layers of points at a side do not move, the
/// surface is smooth there.
struct Lattice {
    Vec3 origin{-0.5f, -0.5f, -0.5f};  ///< corner
    Vec3 u{1, 0, 0};                   ///< edges [m]
    Vec3 v{0, 1, 0};
    Vec3 w{0, 0, 1};
    std::vector<Vec3> offsets;  ///< of the point (i, j, k) at i + 4 j + 16 k [m]; missing: 0
};

LIMN_FIELDS(Lattice) {
    LIMN_FIELD(origin, "corner of the box", "m");
    LIMN_FIELD(u, "edge of the box", "m");
    LIMN_FIELD(v, "edge of the box", "m");
    LIMN_FIELD(w, "edge of the box", "m");
    LIMN_FIELD(
        offsets, "offset of the control point (i, j, k), 0 .. 3 each, at i + 4 j + 16 k", "m");
}

inline constexpr std::size_t kLatticePoints = 64;

/// A pull at one point of the skin, as by two fingers: vertices closer to `at` than `radius` move
/// by (1 - (distance / radius)^2)^3 of `offset`. At the border the surface stays smooth up to its
/// curvature; it folds over itself where |offset| exceeds 0.58 radius.
struct Tug {
    Vec3 at{0, 0, 0};
    Vec3 offset{0, 0, 0};
    float radius = 0.04f;
};

LIMN_FIELDS(Tug) {
    LIMN_FIELD(at, "the point that moves by the whole offset", "m");
    LIMN_FIELD(offset, "displacement at that point; 0: none", "m");
    LIMN_FIELD(radius, "distance at which the pull ends", "m", 1e-4f, 1e4f);
}

/// With a MeshInstance. Pulls of all muscles add up, but move no vertex farther than the most
/// distant attachment or center that pulls; then the lattices act in turn, and then the tugs.
struct Deformers {
    std::vector<LinearMuscle> muscles{};
    std::vector<SphincterMuscle> sphincters{};
    std::vector<Lattice> lattices{};
    std::vector<Tug> tugs{};
};

LIMN_FIELDS(Deformers) {
    LIMN_FIELD(muscles, "muscles that pull toward bone");
    LIMN_FIELD(sphincters, "rings of muscle");
    LIMN_FIELD(lattices, "free-form deformation, one after the other");
    LIMN_FIELD(tugs, "pulls at single points of the skin, one after the other");
}

/// The Deformers packed for CPU and GPU; written by update_deformers.
struct DeformerState {
    std::vector<Vec4> now;       ///< pack_deformers
    std::vector<Vec4> previous;  ///< of the previous step; as long as `now` after the first
};

LIMN_FIELDS(DeformerState) {
    LIMN_FIELD(now, "packed controls after the last step");
    LIMN_FIELD(previous, "packed controls of the previous step");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<DeformerState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

// A packed list begins with (number of records, step for normals [m], 0, 0). Records:
//   muscle     (kMuscle, contraction * length, angle, 0) (attachment, full) (unit axis, reach)
//   sphincter  (kSphincter, contraction, 0, 0) (center, 0) and three rows that map the vector from
//              the center to the unit ball: (row of right, 0) (row of up, 0) (row of depth, depth)
//   lattice    (kLattice, 0, 0, 0) (origin, 0), three rows that map the vector from the origin to
//              the unit cube, (row, 0) each, and the offsets of 64 points, (offset, 0) each
//   tug        (kTug, offset) (at, 1 / radius^2)
// Muscles and sphincters come first.
// shaders/lib/deformers.glsl reads the same.

inline constexpr float kMuscle = 1.0f;
inline constexpr float kSphincter = 2.0f;
inline constexpr float kLattice = 3.0f;
inline constexpr float kTug = 4.0f;
inline constexpr std::size_t kMuscleTexels = 3;
inline constexpr std::size_t kSphincterTexels = 5;
inline constexpr std::size_t kLatticeTexels = 5 + kLatticePoints;
inline constexpr std::size_t kTugTexels = 2;

/// Skips controls without extent (a muscle of no length or with full >= reach, an ellipse or a box
/// of no area or volume), tugs without offset or radius and controls that are not finite. Empty if
/// none remain. `more` act after the tugs of `deformers`.
[[nodiscard]] std::vector<Vec4>
pack_deformers(const Deformers& deformers, std::span<const Tug> more = {});

/// Bound on the displacement of any vertex [m].
[[nodiscard]] float max_displacement(std::span<const Vec4> packed);

}  // namespace limn
