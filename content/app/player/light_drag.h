#pragma once

#include "ecs/base/math.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"

#include <optional>

namespace limn {

class UndoStack;
class World;

// Aiming a light with the mouse: the light that contributes most at a point orbits it at a constant
// distance.

/// The light with a Transform of its own that is on and lights `point` [lx] most on the side toward
/// `to_viewer` (unit), ignoring its cone and occluders: a rim light counts little. Among
/// several, the first.
[[nodiscard]] std::optional<Entity>
brightest_light(const World& world, const Vec3& point, const Vec3& to_viewer);

// Transforms, centers and cameras of the next two functions are in the space of the light's parent.

/// `transform` turned about `center` by a drag of `motion` pixels in an image of `height` pixels
/// whose camera is at `world_from_camera`: a light in front of the camera follows the pointer, half
/// a turn for the height of the image. Keeps the distance and the target of the light.
[[nodiscard]] Transform turned_light(
    const Transform& transform, const Vec3& center, const Vec2& motion, float height,
    const Affine& world_from_camera);

/// `transform` moved to the same distance from `center`, in `direction` (unit) from it, shining on
/// it.
[[nodiscard]] Transform
facing_light(const Transform& transform, const Vec3& center, const Vec3& direction);

/// A drag of the brightest light: one edit from its first move to its release. The light
/// keeps its parent. `center` and the camera are in the world.
class LightDrag {
  public:
    void drag(
        World& world, UndoStack& undo, const Vec3& center, const Vec2& motion, float height,
        const Affine& world_from_camera);
    void release() { light_ = {}; }

  private:
    Entity light_;  ///< null before the first move
};

/// Turns the brightest light at `center` to shine on it from `direction`, as an edit.
void face_light(World& world, UndoStack& undo, const Vec3& center, const Vec3& direction);

}  // namespace limn
