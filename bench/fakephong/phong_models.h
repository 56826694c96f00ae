#pragma once

#include "bench/fakephong/phong_scene.h"
#include "ecs/components/surface.h"

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace limn::fakephong {

// The scenes of the thesis, rebuilt (fakephong.scenes). It gives the models and the kinds of light;
// positions, exponents and cameras are fitted. Scanlines cross the highest highlight, and on
// teapots that of the body below those of handle and spout.
// Techniques: fakephong.results

/// A mesh of content/make or of a file, with its triangles unchanged.
[[nodiscard]] PhongMesh phong_mesh(const MeshData& mesh);
/// A latitude and longitude sphere of 2 slices (stacks - 1) triangles, with radial normals: the
/// mesh "sphere" of levels, rotated so that a column of vertices faces the eye.
[[nodiscard]] PhongMesh make_coarse_sphere(int slices, int stacks);

/// One triangle, point light near it: the canonical scene of the spec entry.
[[nodiscard]] PhongScene triangle_scene();
/// A triangle, light and exponents that reproduce all six printed figures within 0.0053, found by
/// differential evolution over the shape, the light, both exponents and the eye.
[[nodiscard]] PhongScene printed_triangle_scene();
/// The teapot with lookup textures of 11 x 11: the printed row has both Blinn maps below even
/// subdivided Gouraud and 0.0002 apart, which only coarse textures of 11 to 16 texels give here.
[[nodiscard]] PhongScene printed_teapot_scene();
[[nodiscard]] PhongScene teapot_scene();  ///< 3,750 facets, directional light
/// 30 triangles, point light: without the two faces that the eye sees least.
[[nodiscard]] PhongScene dodecahedron_scene();
[[nodiscard]] PhongScene sphere_scene();       ///< 40 triangles, point light
[[nodiscard]] PhongScene fine_sphere_scene();  ///< 3,750 triangles, directional light

/// Table 6.1 of the thesis, in the order of shading_methods()[1 .. 6].
struct PrintedRow {
    std::string_view model;
    std::array<double, 6> correctness;
};
[[nodiscard]] std::span<const PrintedRow> printed_table();  ///< teapot, triangle

}  // namespace limn::fakephong
