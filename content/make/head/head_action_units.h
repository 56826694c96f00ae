#pragma once

#include "content/make/head/head_layout.h"
#include "ecs/base/math.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace limn {

struct HeadShape;

// Expressions of a head as action units of FACS (P. Ekman and W. Friesen, "Facial Action Coding
// System", 1978): tables of what each muscle pulls where, and how far in a strong adult movement.
// Pulls fall off to zero within an ellipsoid; sliding skin keeps its depth on the bone; lids turn
// about the eyeball, lips about their own axis, the jaw about the joint in front of the ears. All
// in centimeters, in the space of head_surface.h, symmetric; one half of a unit is the whole times
// a weight that changes smoothly over 2 cm across the midline of the face.

/// Which lip a pull moves.
enum class Lips : std::uint8_t { Both, Upper, Lower };

/// Skin around `center` that moves with a muscle: by `motion` there, by nothing beyond `radii`.
struct MusclePull {
    Vec3 center = {};  ///< on the left side or the midline; the other side has its mirror image
    Vec3 motion = {};  ///< [mm]
    Vec3 radii = {};   ///< semi-axes of an ellipsoid; 0: no pull
    Lips lips = Lips::Both;
    bool slides = false;  ///< along the surface
};

struct ActionUnit {
    std::string_view name;  ///< "AU12"
    bool sided = false;     ///< its halves are separate shapes: "AU12_L", "AU12_R"
    std::array<MusclePull, 5> pulls = {};
    float jaw = 0;         ///< opens by this angle [degrees]
    Vec3 jaw_shift = {};   ///< moves the jaw without turning [mm]
    float upper_lid = 0;   ///< lowers it by this fraction of the eye's opening
    float lower_lid = 0;   ///< raises it likewise; together 1: closed
    float upper_roll = 0;  ///< turns the lip inwards [degrees]
    float lower_roll = 0;
    float tongue = 0;  ///< out of the mouth [mm]
};

[[nodiscard]] std::span<const ActionUnit> action_units();

/// The unit called `name`, which must exist.
[[nodiscard]] const ActionUnit& action_unit(std::string_view name);

/// A point of a head at rest that expressions move.
struct HeadPoint {
    Vec3 rest = {};
    HeadLoops loops = HeadLoops::None;  ///< of the skin that it is part of
    int loop = 0;
    float angle = 0;      ///< see HeadVertex
    float jaw = 0;        ///< how much it turns with the jaw, 0 .. 1
    float upper_lip = 0;  ///< 1 above the mouth, 0 below
    float tongue = 0;     ///< along the tongue, 1 at its tip; 0: no tongue
    int eye = 0;          ///< 1: of the left ball, -1: of the right one
    bool skin = true;     ///< moved by muscles
};

/// A point of the skin.
[[nodiscard]] HeadPoint skin_point(const HeadVertex& vertex, const Vec3& rest);

/// A point that is fixed to the skull (0) or the jaw (1).
[[nodiscard]] HeadPoint bone_point(const Vec3& rest, float jaw);

/// How far `unit` moves `point` at weight 1, on both sides.
[[nodiscard]] Vec3
action_offset(const ActionUnit& unit, const HeadPoint& point, const HeadShape& shape);

/// Weight of the left half of the face at `x`.
[[nodiscard]] float left_weight(float x);

}  // namespace limn
