#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <span>

namespace limn {

struct Loft;

// Bodies as tables of blended primitives (content/models), to be triangulated by mesh_surface
// (implicit_mesh.h).

enum class PartShape : std::uint8_t {
    Cone,       ///< from `a` to `b`, with rounded ends
    Squashed,   ///< the same, scaled about `a` by `squash`
    Ellipsoid,  ///< `a`: center, `b`: radii
    Box,        ///< `a`: center, `b`: half size; edges rounded by `radius_a`
    Above,      ///< the half space above `a`
    Before,     ///< the half space before `a`, toward +z
    Loft,       ///< `loft`
    Custom,     ///< `distance`
};

enum class PartUse : std::uint8_t {
    Join,
    Cut,   ///< removes its inside
    Clip,  ///< removes its outside
};

/// Lengths are in the units of the model.
struct ModelPart {
    PartShape shape = PartShape::Cone;
    PartUse use = PartUse::Join;
    float blend = 0;  ///< width of the blend with previous parts; 0 = a sharp edge
    Vec3 a = {0, 0, 0};
    Vec3 b = {0, 0, 0};
    float radius_a = 0;
    float radius_b = 0;
    Vec3 squash = {1, 1, 1};
    const Loft* loft = nullptr;
    float (*distance)(const Vec3& p) = nullptr;
    std::uint16_t joint = 0;  ///< joint of a skeleton that the part follows
};

/// Parts that are combined with each other first, then with previous groups.
struct ModelGroup {
    float blend;  ///< width of the blend with previous groups
    std::span<const ModelPart> parts;
};

/// Signed distance to one part; < 0 inside.
[[nodiscard]] float part_distance(const ModelPart& part, const Vec3& p);

/// Signed distance to the group; the parts of both sides if `mirrored`, where those with a.x > 0
/// are listed once, for the left side.
[[nodiscard]] float group_distance(std::span<const ModelPart> parts, const Vec3& p, bool mirrored);

/// Signed distance to all groups, as they are listed.
[[nodiscard]] float model_distance(std::span<const ModelGroup> groups, const Vec3& p);

/// `p` on the other side of the plane of symmetry x = 0.
[[nodiscard]] inline Vec3 mirrored(const Vec3& p) {
    return {-p.x, p.y, p.z};
}

}  // namespace limn
