#pragma once

#include "ecs/any_component.h"
#include "ecs/components/camera.h"
#include "ecs/components/light.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace limn {

// The content of a glTF file, fully validated and independent of any world. All errors are found
// while loading, so that spawning it (gltf_spawn.h) cannot fail halfway.

/// A mesh and its material: indices into GltfScene.
struct GltfPart {
    std::uint32_t mesh = 0;
    std::uint32_t material = 0;
};

using GltfLight = std::variant<std::monostate, PointLight, SpotLight, DirectionalLight>;

struct GltfNode {
    std::string name;          ///< "" when the file gives none
    std::int32_t parent = -1;  ///< an earlier node, or -1
    Transform transform;       ///< relative to the parent
    std::vector<GltfPart> parts;
    bool has_camera = false;
    Camera camera;
    GltfLight light;
    std::int32_t skin = -1;         ///< of `parts`: index into GltfScene::skins, or -1
    std::int32_t first_morph = -1;  ///< of `parts`: first index into morph_weights, or -1
    /// From extras.limn. Entities are nodes encoded by gltf_node_entity(), assets are indices into
    /// this scene.
    std::vector<AnyComponent> components;
    bool is_named = false;  ///< a level changes it: becomes an entity even if it is a joint
};

struct GltfScene {
    std::string name;                 ///< of the file, without folder and extension
    std::vector<GltfNode> nodes;      ///< parents before their children
    std::vector<MeshData> meshes;     ///< one for each primitive that is drawn
    std::vector<Material> materials;  ///< their ImageIds are indices into `images`
    std::vector<ImageData> images;
    SkeletonData skeleton;             ///< empty if nothing is animated; joint 0 is the scene
    std::vector<std::int32_t> joints;  ///< joint of each node; -1: fixed to its parent
    std::vector<SkinData> skins;
    std::vector<ClipData> clips;
    std::vector<float> morph_weights;   ///< initial weights of all nodes with morph targets
    std::vector<std::string> variants;  ///< names of the choices of materials
    std::vector<std::string> warnings;  ///< one line per ignored feature of the file
};

/// The assets of a scene, as lists of the names that Assets has (asset_lists.h).
struct GltfAssetLists {
    const std::vector<MeshData>& meshes;
    const std::vector<Material>& materials;
    const std::vector<ImageData>& images;
    std::span<const SkeletonData> skeletons;
    const std::vector<SkinData>& skins;
    const std::vector<ClipData>& clips;
    std::span<const PathData> paths;
};
[[nodiscard]] GltfAssetLists list_assets(const GltfScene& scene);

/// Placeholder for node `node` in components until entities exist.
[[nodiscard]] constexpr Entity gltf_node_entity(std::uint32_t node) {
    return {node, 0xffffffffu};
}

/// Matrix of every node relative to the scene.
[[nodiscard]] std::vector<Affine> find_node_matrices(const GltfScene& scene);

/// skeleton_from_joint of every joint in the rest pose.
[[nodiscard]] std::vector<Affine> find_rest_joints(const SkeletonData& skeleton);

/// Bounds of the vertices of `mesh` skinned by `joints`, in the space of those matrices.
[[nodiscard]] Bounds
posed_bounds(const MeshData& mesh, const SkinData& skin, std::span<const Affine> joints);

/// World-space bounds of everything drawn, skinned meshes in the rest pose [m]; may be empty.
[[nodiscard]] Bounds find_bounds(const GltfScene& scene);

/// Bounds of the transformed `box`.
[[nodiscard]] Bounds transform_bounds(const Affine& matrix, const Bounds& box);

/// How a camera frames a box.
struct Framing {
    Transform camera;
    float aspect = 0;  ///< width / height of the narrowest image that shows all of the box
};

/// Frames all of `bounds` with the vertical field of view `fov_y` [rad] and `aspect` = width /
/// height, from slightly above and to the side. An empty box counts as a unit cube. `turns`: also
/// when it turns about its vertical axis.
[[nodiscard]] Framing
frame_bounds(const Bounds& bounds, float fov_y, float aspect, bool turns = false);

}  // namespace limn
