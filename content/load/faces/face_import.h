#pragma once

#include "content/load/gltf/gltf_scene.h"
#include "content/load/obj/obj_file.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Shared by importers of faces: a polygon mesh with expressions becomes one node, whose parts have
// the same morph targets. Normals of the face at rest and of each expression are averaged over the
// polygons around a position, so that UV seams do not show.

/// Called with the number of files read so far, and of all.
using ImportProgress = std::function<void(int done, int total)>;

/// Faces with one material.
struct FacePart {
    Material material;
    std::vector<std::uint32_t> faces;  ///< indices into ObjFile::faces; empty: the part is skipped
    std::function<Vec4(std::uint32_t position)> color = {};  ///< factor of a vertex, or none
    bool is_skin = false;  ///< has regions, and a chart with its tangents (make_face_chart) as uvs1
};

struct FaceShape {
    std::string name;
    std::string action_unit;    ///< of FACS, or empty
    std::vector<Vec3> offsets;  ///< one per position of the file, in its unit
};

/// `reference`: for make_face_regions, one per position of the file. Weights of the targets are 0.
/// `scale`: meters per unit of the file. `skin`: influences of the positions, or empty.
[[nodiscard]] GltfScene make_face_scene(
    const std::string& name, const ObjFile& obj, float scale, std::span<const FacePart> parts,
    std::span<const FaceShape> shapes, std::span<const Vec3> reference,
    const SkinWeights& skin = {});

/// Unit normals at `positions`: means over the adjacent polygons, weighted by their angles there.
/// +y where there are none.
[[nodiscard]] std::vector<Vec3> smooth_normals(
    const ObjFile& obj, std::span<const Vec3> positions, std::span<const std::uint32_t> faces);

/// For each position the index of the one nearest to its mirror image in x = 0.
[[nodiscard]] std::vector<std::uint32_t> mirror_positions(std::span<const Vec3> positions);

/// `offsets` mirrored to the other side of the face.
[[nodiscard]] std::vector<Vec3>
mirror_offsets(std::span<const Vec3> offsets, std::span<const std::uint32_t> mirror);

/// An eyeball of two shells: an outer one with the cornea, and an inner one with the iris.
struct EyeBall {
    Vec3 center = Vec3(0);
    Vec3 axis = {0, 0, 1};  ///< unit, towards the apex of the cornea
    float limbus = 0;       ///< radius of the cornea's border around the axis
    float pupil = 0;        ///< radius
};

/// Fits an eyeball to the vertices of the outer shell of an eye that looks along +z. `limbus`:
/// radius of the border of the cornea relative to that of the ball.
[[nodiscard]] EyeBall find_eye_ball(std::span<const Vec3> outer, float limbus);

/// Whether a point of the outer shell is on the cornea.
[[nodiscard]] bool is_on_cornea(const EyeBall& eye, const Vec3& p);

/// Color of the inner shell: a brown iris with a pupil, in a white sclera whose back is black.
[[nodiscard]] Vec4 iris_color(const EyeBall& eye, const Vec3& p);

/// 1 on the red of the lips, 0 elsewhere, at a position in the space of the reference face of
/// make_face_regions [cm].
[[nodiscard]] float lip_amount(const Vec3& reference);

// Materials of heads; linear Rec. 709, from published colors of skin, enamel and sclera.
[[nodiscard]] Material skin_material();
[[nodiscard]] Material mucosa_material();
[[nodiscard]] Material teeth_material();
[[nodiscard]] Material sclera_material();
[[nodiscard]] Material iris_material();
[[nodiscard]] Material cornea_material();
[[nodiscard]] Material lash_material();

/// Factor of skin_material: redder lips, cheeks, nose and lining of the mouth. 1 for NaN.
[[nodiscard]] Vec4 skin_tint(const Vec3& reference);

}  // namespace limn
