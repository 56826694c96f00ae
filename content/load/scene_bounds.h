#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"

#include <span>
#include <unordered_map>
#include <vector>

namespace limn {

class World;

// Bounds of a scene before its first step: from Transforms, since WorldTransforms have not been
// computed yet.

/// World matrices of a scene that has been loaded.
class SceneMatrices {
  public:
    explicit SceneMatrices(World& world);

    /// world_from_local; the identity without a Transform.
    [[nodiscard]] Affine of(Entity entity) const;

  private:
    const World& world_;
    std::unordered_map<Entity, Affine> children_;  ///< of entities with a parent
};

/// World-space bounds of everything drawn, a box for each mesh instance, skinned ones in the rest
/// pose [m]. Needs the resource Assets. `entities` receives the entity of each.
[[nodiscard]] std::vector<Bounds>
find_boxes(World& world, const SceneMatrices& matrices, std::vector<Entity>* entities = nullptr);

/// Bounds of all boxes; may be empty.
[[nodiscard]] Bounds join_boxes(std::span<const Bounds> boxes);

/// Whether a mesh is scenery around or below the rest of a model instead of the subject: a ground
/// plane or a sky dome. Below: a flat box at the bottom, 2.5 times as wide as all smaller
/// ones together. Around: a box thirty times as large as those, which contains their center.
[[nodiscard]] std::vector<bool> find_scenery(std::span<const Bounds> boxes);

}  // namespace limn
