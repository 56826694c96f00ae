#pragma once

#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Texture coordinates for meshes that have none that suit an image, in two parts: the image is
// wrapped onto a simple surface around the mesh, which is then projected onto it (Bier and Sloan,
// "Two-Part Texture Mappings", 1986). The image is upright and unmirrored from outside.
// Techniques: tex.two-part-mapping

/// The surface around a mesh.
enum class Wrapping : std::uint8_t { Plane, Box, Cylinder, Sphere };

/// Where the point of that surface is that a point of the mesh shows.
enum class WrapDirection : std::uint8_t {
    Position,  ///< away from the center or, of a cylinder, the axis
    Normal,    ///< along the normal
};

/// Texture coordinates of a point: u in [0, 1) around cylinders and spheres, 0.5 at their poles,
/// its seam at -z; v from 0 at the top to 1. Of a box, those of the side that `facing` is toward.
[[nodiscard]] Vec2 wrapped_uv(
    Wrapping wrapping, WrapDirection direction, const Bounds& box, const Vec3& position,
    const Vec3& normal, const Vec3& facing);

struct ProjectedShape {
    MeshId mesh;
    Wrapping wrapping = Wrapping::Cylinder;
    WrapDirection direction = WrapDirection::Position;
};

LIMN_FIELDS(ProjectedShape) {
    LIMN_FIELD(mesh, "the mesh to map, by name; must come earlier in the file");
    LIMN_FIELD(
        wrapping, .doc = "surface that the image is wrapped onto: along y a plane, or around y",
        .values = "plane box cylinder sphere");
    LIMN_FIELD(
        direction, .doc = "of its projection onto the mesh: from the center or along normals",
        .values = "position normal");
}

/// A copy of another mesh with texture coordinates by projection, split where u wraps around. Omits
/// skins and morph targets. Empty without a mesh.
[[nodiscard]] MeshData make_projected(const ProjectedShape& shape, const Assets& assets);

}  // namespace limn
