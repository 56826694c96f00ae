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

// What a glTF file holds, checked to the last index and independent of any world. Loading stops
// here when anything is wrong, so that gltf_spawn.h, which puts it into a world, cannot fail
// halfway.

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
    std::int32_t skin = -1;         ///< of `parts`, an index into GltfScene::skins
    std::int32_t first_morph = -1;  ///< of `parts`, the place of target 0 in morph_weights
    /// From extras.limn. Entities in them are nodes, as gltf_node_entity() writes them; assets are
    /// indices into this scene.
    std::vector<AnyComponent> components;
};

struct GltfScene {
    std::string name;                 ///< of the file, without folder and extension
    std::vector<GltfNode> nodes;      ///< parents before their children
    std::vector<MeshData> meshes;     ///< one for each primitive that is drawn
    std::vector<Material> materials;  ///< their ImageIds are indices into `images`
    std::vector<ImageData> images;
    SkeletonData skeleton;             ///< no joints where nothing moves; joint 0 is the scene
    std::vector<std::int32_t> joints;  ///< of each node, -1: stays where its parent is
    std::vector<SkinData> skins;
    std::vector<ClipData> clips;
    std::vector<float> morph_weights;   ///< of all nodes with morph targets, as the file has them
    std::vector<std::string> warnings;  ///< what the file asks for and was left out, a line each
};

/// Stands for node `node` in a component until there are entities.
[[nodiscard]] constexpr Entity gltf_node_entity(std::uint32_t node) {
    return {node, 0xffffffffu};
}

/// World matrix of every node, when roots stand at the origin.
[[nodiscard]] std::vector<Affine> find_node_matrices(const GltfScene& scene);

/// skeleton_from_joint of every joint at rest.
[[nodiscard]] std::vector<Affine> find_rest_joints(const SkeletonData& skeleton);

/// Box around the vertices of `mesh` where `joints` put them; in the space of those matrices.
[[nodiscard]] Bounds
posed_bounds(const MeshData& mesh, const SkinData& skin, std::span<const Affine> joints);

/// Box around everything that is drawn, skinned meshes at rest, in world space [m]; empty when
/// nothing is.
[[nodiscard]] Bounds find_bounds(const GltfScene& scene);

/// The box around `box` after `matrix`.
[[nodiscard]] Bounds transform_bounds(const Affine& matrix, const Bounds& box);

/// Where a camera with the vertical angle `fov_y` [rad] stands to see all of `bounds` in a picture
/// of `aspect` = width / height: somewhat from above and from the side. An empty box is taken for a
/// unit cube.
[[nodiscard]] Transform frame_bounds(const Bounds& bounds, float fov_y, float aspect);

}  // namespace limn
