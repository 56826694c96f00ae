#include "content/make/make_mesh.h"

#include "content/make/head/head.h"
#include "content/make/models/bar.h"
#include "content/make/models/boat.h"
#include "content/make/models/body_part.h"
#include "content/make/models/boulder.h"
#include "content/make/models/fragments.h"
#include "content/make/models/fur_strands.h"
#include "content/make/models/hovercraft.h"
#include "content/make/models/joined.h"
#include "content/make/models/mannequin.h"
#include "content/make/models/masonry.h"
#include "content/make/models/patch_mesh.h"
#include "content/make/models/plants.h"
#include "content/make/models/projected.h"
#include "content/make/models/refine_mesh.h"
#include "content/make/models/retargeted.h"
#include "content/make/models/robot_arm.h"
#include "content/make/models/shapes.h"
#include "content/make/models/simplify_mesh.h"
#include "content/make/models/sweep.h"
#include "content/make/models/teapot.h"
#include "content/make/models/terrain.h"
#include "content/make/person/person.h"

#include <type_traits>
#include <vector>

namespace limn {

namespace {

template <typename Shape, auto make>
MeshKind mesh_kind(const char* name, const char* doc) {
    const auto call = [](const void* parameters, const Assets& assets) {
        const auto& shape = *static_cast<const Shape*>(parameters);
        if constexpr (std::is_invocable_v<decltype(make), const Shape&, const Assets&>) {
            return make(shape, assets);
        } else {
            return make(shape);
        }
    };
    return {name, doc, &component_info<Shape>(), call, nullptr};
}

/// A kind of meshes with a skeleton.
template <typename Shape, auto make, auto make_rig>
MeshKind rigged_kind(const char* name, const char* doc) {
    MeshKind kind = mesh_kind<Shape, make>(name, doc);
    kind.make_rig = [](const void* parameters) {
        return make_rig(*static_cast<const Shape*>(parameters));
    };
    return kind;
}

}  // namespace

std::span<const MeshKind> mesh_kinds() {
    static const std::vector<MeshKind> kinds = {
        mesh_kind<ArchShape, make_arch>("arch", "a pointed rib or frame on two legs, facing z"),
        rigged_kind<BarShape, make_bar, make_bar_rig>(
            "bar", "a flexible bar around +y, with two joints and clips that twist and bend it"),
        mesh_kind<BoatShape, make_boat>("boat", "a part of a wooden boat with a sail, facing z"),
        mesh_kind<BodyPartShape, make_body_part>(
            "body_part", "a hand or a foot, upright, with its back to z, its nails, or a forearm"),
        mesh_kind<BoulderShape, make_boulder>(
            "boulder", "a ball cut by planes, with worn edges and rough faces"),
        mesh_kind<BoxShape, make_box>("box", "a box, optionally with rounded edges"),
        mesh_kind<ConeShape, make_cone>("cone", "a cone or a frustum around +y"),
        rigged_kind<CreatureShape, make_creature, make_creature_rig>(
            "creature", "an animal on four legs that faces z, with skeleton, skin and clips"),
        mesh_kind<CylinderShape, make_cylinder>("cylinder", "a closed tube around +y"),
        mesh_kind<DiscShape, make_disc>("disc", "a disc or ring that faces +y"),
        mesh_kind<DodecahedronShape, make_dodecahedron>(
            "dodecahedron", "twelve pentagons, or some of them"),
        mesh_kind<FinsShape, make_fins>(
            "fins", "cards on the edges of another mesh, for its fur where it is seen edge-on"),
        mesh_kind<FragmentsShape, make_fragments>(
            "fragments", "another mesh of the level, broken into pieces that can fly apart"),
        rigged_kind<HeadShape, make_head, make_head_rig>(
            "head", "a part of a human head that faces z, with expressions, skeleton and clips"),
        mesh_kind<HovercraftShape, make_hovercraft>(
            "hovercraft", "a racing craft that hovers, facing z"),
        mesh_kind<JoinedShape, make_joined>(
            "joined", "several meshes of the level as one, at rest"),
        mesh_kind<LatheShape, make_lathe>("lathe", "a profile revolved around +y"),
        rigged_kind<MannequinShape, make_mannequin, make_mannequin_rig>(
            "mannequin", "an artist's wooden figure that faces z, with skeleton, skin and a clip"),
        mesh_kind<PatchMeshShape, make_patch_grid>(
            "patch_mesh", "a curved sheet of biquadratic patches, by a grid of control points"),
        rigged_kind<PersonShape, make_person, make_person_rig>(
            "person", "a dressed person that faces z, each seed another, with skeleton and clips"),
        mesh_kind<PlaneShape, make_plane>("plane", "a rectangle that faces +y"),
        mesh_kind<PlantShape, make_plants>(
            "plants", "grass, bushes or trees of blades that branch, standing on y = 0"),
        mesh_kind<ProjectedShape, make_projected>(
            "projected", "another mesh of the level with texture coordinates by projection"),
        mesh_kind<RefinedShape, make_refined>(
            "refined", "another mesh of the level with more triangles where its skin folds"),
        mesh_kind<RetargetedShape, make_retargeted>(
            "retargeted", "the surface of one face fitted onto another, with its motion"),
        rigged_kind<RobotArmShape, make_robot_arm, make_robot_arm_rig>(
            "robot_arm", "a part of a robot arm with seven axes, standing on y = 0"),
        mesh_kind<SimplifiedShape, make_simplified>(
            "simplified", "another mesh of the level with fewer triangles, its skin and shapes"),
        mesh_kind<SphereShape, make_sphere>("sphere", "a sphere with longitude and latitude as uv"),
        mesh_kind<StrandsShape, make_strands>(
            "strands", "strands of hair that grow on another mesh of the level and move with it"),
        mesh_kind<SweepShape, make_sweep>("sweep", "a profile swept along a path of the level"),
        mesh_kind<TeapotShape, make_teapot>(
            "teapot", "Newell's teapot, standing on y = 0, its spout along +x"),
        mesh_kind<TerrainShape, make_terrain>("terrain", "hills and ridges as a height field"),
        mesh_kind<TorusShape, make_torus>("torus", "a ring around +y"),
        mesh_kind<TriangleShape, make_triangle>("triangle", "an equilateral triangle that faces z"),
        mesh_kind<VaultShape, make_vault>("vault", "a pointed cross vault over a rectangle"),
        mesh_kind<MasonryWall, make_wall>(
            "wall", "a wall with a pointed or round opening, facing z"),
    };
    return kinds;
}

}  // namespace limn
