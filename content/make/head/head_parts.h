#pragma once

#include "content/make/head/head_action_units.h"
#include "ecs/components/surface.h"

#include <vector>

namespace limn {

// Parts of a head besides its skin, in centimeters of the space of head_surface.h.

struct HeadPart {
    MeshData mesh;                  ///< positions, uvs, colors and indices [cm]
    std::vector<HeadPoint> points;  ///< one per vertex
    std::vector<bool> covered;      ///< per triangle: removed in the end; or empty
};

/// Factor of the material's color on the skin at rest position `point` [cm]: hair, flush, lips.
[[nodiscard]] Vec3
head_skin_color(const HeadVertex& vertex, const Vec3& point, const HeadShape& shape);

/// Alpha of colors in [0, kSkinCavity] is no relief: divided by kSkinCavity, it is the share of the
/// surroundings that light a cavity of skin, or a tooth (lib/material.glsl).
inline constexpr float kSkinCavity = 0.1f;

/// How deep pores are there, 1 on the nose, where they are deepest: the alpha of the skin's colors,
/// which scales the material's detail_texture. In nostrils and mouth: how open they are.
[[nodiscard]] float head_skin_relief(const HeadVertex& vertex, const Vec3& point);

/// Both eyeballs, of radius kBallRadius, with an iris as deep behind the cornea as in a real eye,
/// and a pupil of 3 mm; and the caruncles in the inner corners of the eyes.
[[nodiscard]] HeadPart make_eye_balls();

/// The clear shells in front of them, and the tear lines along the lower lids.
[[nodiscard]] HeadPart make_corneas();

/// 14 teeth in each jaw.
[[nodiscard]] HeadPart make_teeth();

/// Gums and the tongue.
[[nodiscard]] HeadPart make_mouth();

/// Brows and lashes: ribbons, visible from both sides.
[[nodiscard]] HeadPart make_face_hair(const HeadShape& shape);

/// The hair of the scalp in a short cut: cards in layers, v from roots to tips, normals those of
/// the scalp so that all cards are lit as one body.
[[nodiscard]] HeadPart make_scalp_hair(const HeadShape& shape);

/// A shirt on the shoulders of `shape`, which hangs a little below the end of their skin. Its
/// points move like skin.
[[nodiscard]] HeadPart make_shirt(const HeadShape& shape);

/// For each vertex of head_layout(true), at `skin` [cm] at rest: whether it is so far below the
/// neckline of the shirt that it stays hidden however the head turns.
[[nodiscard]] std::vector<bool> find_covered_skin(const std::vector<Vec3>& skin);

/// Density of hair at `p` on a head, 0 .. 1.
[[nodiscard]] float scalp_hair_cover(const Vec3& p);

/// Radius of an eye without its cornea [cm]: the lids lie on a ball that is a little larger.
inline constexpr float kBallRadius = 1.27f;

/// Adds the triangles of a grid of `rows` x `columns` vertices, which have been appended row by
/// row; `closed`: the last column joins the first. They face the side from which rows run down and
/// columns to the left, or with `flip` the other side.
void append_grid(
    MeshData& mesh, std::uint32_t rows, std::uint32_t columns, bool closed, bool flip = false);

}  // namespace limn
