#pragma once

#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"

#include <glm/matrix.hpp>

namespace limn {

/// World matrices of entities from current Transforms, in the phases of a step that come before
/// update_transforms.
class Placements {
  public:
    Placements(const Query<const Transform>& transforms, const Query<const Parent>& parents)
        : transforms_(transforms), parents_(parents) {}

    [[nodiscard]] bool has(Entity entity) const { return transforms_.contains(entity); }

    /// The topmost parent, or the entity itself.
    [[nodiscard]] Entity root(Entity entity) const {
        const Parent* parent = parents_.find<const Parent>(entity);
        while (parent != nullptr && has(parent->entity)) {
            entity = parent->entity;
            parent = parents_.find<const Parent>(entity);
        }
        return entity;
    }

    [[nodiscard]] Affine world(Entity entity) const {
        Affine matrix;
        while (const Transform* const transform = transforms_.find<const Transform>(entity)) {
            const Affine local =
                affine_from(transform->position, transform->rotation, transform->scale);
            matrix = local * matrix;
            const Parent* const parent = parents_.find<const Parent>(entity);
            if (parent == nullptr) {
                break;
            }
            entity = parent->entity;
        }
        return matrix;
    }

  private:
    const Query<const Transform>& transforms_;
    const Query<const Parent>& parents_;
};

/// False for a matrix that has none: a scale of 0, or not finite.
[[nodiscard]] inline bool find_inverse(const Affine& matrix, Affine& inverse) {
    const Mat4 m = to_mat4(matrix);
    if (!(std::abs(glm::determinant(m)) > 1e-20f)) {
        return false;
    }
    inverse = to_affine(glm::inverse(m));
    return true;
}

}  // namespace limn
