#include "content/load/scene_bounds.h"

#include "content/load/gltf/gltf_scene.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr float kFlat = 0.02f;        // thickness of a ground / width
constexpr float kGroundWidth = 2.5f;  // relative to what stands on it
constexpr float kDomeSize = 30.0f;    // relative to what is inside

Affine local_matrix(const World& world, Entity entity) {
    const Transform* const t = world.find<Transform>(entity);
    return t == nullptr ? Affine{} : affine_from(t->position, t->rotation, t->scale);
}

/// Matrices of joints in the rest pose, with the shear that a Transform attached to one lacks.
class RestJoints {
  public:
    explicit RestJoints(const World& world)
        : world_(world), assets_(world.find_resource<Assets>()) {}

    /// The joint that `entity` is attached to; null if there is none.
    const Affine* of(Entity entity) {
        const auto* const attachment = world_.find<JointAttachment>(entity);
        if (attachment == nullptr || assets_ == nullptr || !world_.alive(attachment->character)) {
            return nullptr;
        }
        const Skeleton* const character = world_.find<Skeleton>(attachment->character);
        if (character == nullptr || character->skeleton.index >= assets_->skeletons.size()) {
            return nullptr;
        }
        const auto [found, is_new] = joints_.try_emplace(character->skeleton.index);
        if (is_new) {
            found->second = find_rest_joints(assets_->skeletons[character->skeleton.index]);
        }
        return attachment->joint < found->second.size() ? &found->second[attachment->joint]
                                                        : nullptr;
    }

  private:
    const World& world_;
    const Assets* assets_;
    std::map<std::uint32_t, std::vector<Affine>> joints_;
};

/// Bounds of meshes with their initial morph weights, skinned ones in the rest pose.
class RestBounds {
  public:
    RestBounds(const World& world, const Assets& assets) : world_(world), assets_(assets) {}

    Bounds of(Entity entity, const MeshInstance& instance) {
        const MeshData& mesh = assets_.meshes[instance.mesh.index];
        const Deformed* const deformed = world_.find<Deformed>(entity);
        if (deformed == nullptr || !world_.alive(deformed->character)) {
            return mesh.bounds;
        }
        const MorphWeights* const weights = world_.find<MorphWeights>(deformed->character);
        if (weights != nullptr && deformed->first_morph < weights->weights.size()) {
            const auto own = std::span(weights->weights).subspan(deformed->first_morph);
            if (std::any_of(own.begin(), own.end(), [](float w) { return w != 0; })) {
                return posed(morph(mesh, own), *deformed);
            }
        }
        const Skeleton* const character = world_.find<Skeleton>(deformed->character);
        if (character == nullptr) {
            return mesh.bounds;
        }
        const std::array key = {
            instance.mesh.index, deformed->skin.index, character->skeleton.index};
        const auto [found, is_new] = known_.try_emplace(key);
        if (is_new) {
            found->second = posed(mesh, *deformed);
        }
        return found->second;
    }

  private:
    /// In the rest pose, if it has a skeleton.
    Bounds posed(const MeshData& mesh, const Deformed& deformed) const {
        const Skeleton* const character = world_.find<Skeleton>(deformed.character);
        if (character == nullptr || deformed.skin.index >= assets_.skins.size()
            || character->skeleton.index >= assets_.skeletons.size()) {
            return mesh.bounds;
        }
        const SkinData& skin = assets_.skins[deformed.skin.index];
        const SkeletonData& skeleton = assets_.skeletons[character->skeleton.index];
        return fits(mesh, skin, skeleton) ? posed_bounds(mesh, skin, find_rest_joints(skeleton))
                                          : mesh.bounds;
    }

    /// Positions, skin and bounds with morph weights.
    static MeshData morph(const MeshData& mesh, std::span<const float> weights) {
        MeshData morphed;
        morphed.positions = mesh.positions;
        morphed.skin = mesh.skin;
        for (std::size_t t = 0; t < std::min(mesh.morphs.size(), weights.size()); ++t) {
            const MorphTarget& target = mesh.morphs[t];
            for (std::size_t i = 0; i < target.vertices.size(); ++i) {
                morphed.positions[target.vertices[i]] += weights[t] * target.positions[i];
            }
        }
        for (const Vec3& position : morphed.positions) {
            grow(morphed.bounds, position);
        }
        return morphed;
    }

    /// Whether all joint indices are valid; a level may combine unrelated assets.
    static bool fits(const MeshData& mesh, const SkinData& skin, const SkeletonData& skeleton) {
        const auto below = [](const std::vector<std::uint16_t>& joints, std::size_t count) {
            return std::all_of(
                joints.begin(), joints.end(), [count](std::uint16_t j) { return j < count; });
        };
        return below(mesh.skin.joints, skin.joints.size())
               && below(skin.joints, skeleton.joints.size());
    }

    const World& world_;
    const Assets& assets_;
    std::map<std::array<std::uint32_t, 3>, Bounds> known_;
};

bool is_ground(const Bounds& box, const Bounds& others) {
    const Vec3 size = 2.0f * half_extent(box);
    const Vec3 rest = 2.0f * half_extent(others);
    const float width = std::max(size.x, size.z);
    return size.y <= kFlat * width && width >= kGroundWidth * std::max({rest.x, rest.z, rest.y})
           && box.max.y <= center(others).y;
}

bool is_dome(const Bounds& box, const Bounds& others) {
    const Vec3 others_center = center(others);
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
        inside =
            inside && box.min[axis] < others_center[axis] && others_center[axis] < box.max[axis];
    }
    return inside && glm::length(half_extent(box)) >= kDomeSize * glm::length(half_extent(others));
}

}  // namespace

SceneMatrices::SceneMatrices(World& world) : world_(world) {
    RestJoints joints(world);
    for (const HierarchyNode& node : hierarchy(world).nodes()) {
        const Affine* const joint = joints.of(node.entity);
        children_[node.entity] =
            of(node.parent) * (joint != nullptr ? *joint : local_matrix(world, node.entity));
    }
}

Affine SceneMatrices::of(Entity entity) const {
    const auto found = children_.find(entity);
    return found == children_.end() ? local_matrix(world_, entity) : found->second;
}

std::vector<Bounds>
find_boxes(World& world, const SceneMatrices& matrices, std::vector<Entity>* entities) {
    std::vector<Bounds> boxes;
    const Assets& assets = world.resource<Assets>();
    RestBounds rest(world, assets);
    world.query<const MeshInstance>().each([&](Entity entity, const MeshInstance& instance) {
        if (instance.mesh.index >= assets.meshes.size()) {
            return;
        }
        const Bounds box = transform_bounds(matrices.of(entity), rest.of(entity, instance));
        if (!is_empty(box)) {
            boxes.push_back(box);
            if (entities != nullptr) {
                entities->push_back(entity);
            }
        }
    });
    return boxes;
}

Bounds join_boxes(std::span<const Bounds> boxes) {
    Bounds joined;
    for (const Bounds& box : boxes) {
        grow(joined, box);
    }
    return joined;
}

std::vector<bool> find_scenery(std::span<const Bounds> boxes) {
    std::vector<std::size_t> by_size(boxes.size());
    std::iota(by_size.begin(), by_size.end(), std::size_t{0});
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) {
        return glm::length(half_extent(boxes[a])) < glm::length(half_extent(boxes[b]));
    });
    std::vector<bool> scenery(boxes.size(), false);
    Bounds smaller;  // all smaller boxes that are not scenery
    for (const std::size_t i : by_size) {
        scenery[i] =
            !is_empty(smaller) && (is_ground(boxes[i], smaller) || is_dome(boxes[i], smaller));
        if (!scenery[i]) {
            grow(smaller, boxes[i]);
        }
    }
    return scenery;
}

}  // namespace limn
