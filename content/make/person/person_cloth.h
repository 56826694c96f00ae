#pragma once

#include "content/make/person/person_body.h"
#include "content/make/person/person_mesh.h"

namespace limn {

// What the garments of a person share: surfaces that what is sewn onto them lies on. Left side, at
// the reference height.

inline constexpr int kHalfColumns = 20;       ///< of the trunk, from front to back
inline constexpr float kClothColumn = 0.02f;  ///< width of a column in texture space [m]
inline constexpr float kWaist = 1.008f;       ///< height of the upper edge of trousers [m]
inline constexpr float kShirtTop = 1.477f;    ///< height of a shirt's last row below the collar [m]

/// Around the trunk, 0 in front, pi behind.
[[nodiscard]] float cloth_angle(int column);

/// A point of a cubic curve from `a` to `b` with tangents `da` and `db`.
[[nodiscard]] Vec3
curve_point(const Vec3& a, const Vec3& da, const Vec3& b, const Vec3& db, float t);

[[nodiscard]] BodySection grown(const BodySection& section, float ease);
/// The larger of both in each direction.
[[nodiscard]] BodySection larger(const BodySection& a, const BodySection& b);
[[nodiscard]] BodySection mixed(const BodySection& a, const BodySection& b, float t);

/// Lower edge of what is worn on the trunk [m].
[[nodiscard]] float shirt_hem(const PersonFrame& frame);
/// Heights of a shirt's rows, from the hem to kShirtTop.
[[nodiscard]] std::vector<float> shirt_rows(const PersonFrame& frame);
/// On the shirt at `angle`, `grow` outside of it. Near the neck, its opening is lower in front.
[[nodiscard]] Vec3 shirt_point(const PersonFrame& frame, float height, float angle, float grow);
/// How far below `height` a shirt of a person is at `angle` [m].
[[nodiscard]] float neckline_drop(const PersonFrame& frame, float height, float angle);

/// On trousers or a skirt, above the legs.
[[nodiscard]] Vec3 waist_point(const PersonFrame& frame, float height, float angle, float grow);

/// Collar leaves, placket, buttons and pockets of a shirt or a coat.
void add_shirt_trims(BodyMesh& mesh, const PersonFrame& frame);
/// Fly, pockets, belt loops and buckle, as far as a shirt does not cover them.
void add_trouser_trims(BodyMesh& mesh, const PersonFrame& frame);

}  // namespace limn
