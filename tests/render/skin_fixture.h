#pragma once

#include "bench/oracles/skin_oracle.h"
#include "bench/oracles/skin_readback.h"
#include "bench/oracles/skin_shapes.h"
#include "ecs/base/rotation.h"
#include "ecs/components/animation.h"
#include "tests/render/scene_fixture.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace limn::test {

using oracle::add_morphs;
using oracle::add_weights;
using oracle::make_chain;
using oracle::make_tube;
using oracle::random_joints;

/// Characters made by hand.
class SkinScene : public Scene {
  public:
    SkinId add_skin(SkinData skin) {
        auto& assets = world.resource<Assets>();
        assets.skins.push_back(std::move(skin));
        return {static_cast<std::uint32_t>(assets.skins.size() - 1)};
    }
    /// An entity that is its own character.
    Entity pose(
        MeshId mesh, MaterialId material, SkinId skin, Pose pose,
        Skinning skinning = Skinning::Linear) {
        const Entity entity = place(mesh, material, {});
        world.add(entity, std::move(pose));
        world.add(entity, Deformed{entity, skin, 0, skinning});
        return entity;
    }
    const MeshData& mesh_of(Entity entity) {
        return world.resource<Assets>().meshes[world.get<MeshInstance>(entity).mesh.index];
    }
    /// The oracle's vertices of an entity with its own pose.
    std::vector<oracle::SkinnedVertex> want(Entity entity, bool before = false) {
        const Deformed& deformed = world.get<Deformed>(entity);
        std::vector<glm::dmat4> matrices;
        if (deformed.skin.index != kNoAsset) {
            const Pose& pose = world.get<Pose>(entity);
            matrices = oracle::skin_matrices(
                world.resource<Assets>().skins[deformed.skin.index],
                before ? pose.previous : pose.joints);
        }
        std::vector<float> weights;
        if (const auto* morphs = world.find<MorphWeights>(entity)) {
            weights = before ? morphs->previous : morphs->weights;
            weights.erase(weights.begin(), weights.begin() + deformed.first_morph);
        }
        return oracle::skin_vertices(mesh_of(entity), matrices, weights, deformed.skinning);
    }
};

/// Length of the diagonal of the bounding box.
inline float size_of(const std::vector<Vec3>& positions) {
    Bounds box;
    for (const Vec3& p : positions) {
        grow(box, p);
    }
    return glm::length(box.max - box.min);
}

/// Largest distance from the oracle's positions, relative to the box.
inline double
largest_error(const std::vector<Vec3>& got, const std::vector<oracle::SkinnedVertex>& want) {
    double largest = got.size() == want.size() ? 0.0 : INFINITY;
    for (std::size_t i = 0; i < got.size() && i < want.size(); ++i) {
        largest = std::max(largest, glm::distance(glm::dvec3(got[i]), want[i].position));
    }
    return largest / size_of(got);
}

}  // namespace limn::test
