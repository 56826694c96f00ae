#pragma once

#include "ecs/base/math.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"

#include <optional>

namespace limn {

class UndoStack;
class World;

// Directing a light by the mouse: the light that matters most at a point turns about it, as if held
// on a string.

/// The light with a Transform of its own that is on and lights `point` [lx] most on the side toward
/// `to_viewer` (unit), its cone and what stands in its way aside: a rim light counts for little. Of
/// several, the first.
[[nodiscard]] std::optional<Entity>
brightest_light(const World& world, const Vec3& point, const Vec3& to_viewer);

// Places, centers and cameras of the next two are in one space, that of the light's parent.

/// `place` turned about `center` by a drag of `motion` pixels in an image of `height` pixels whose
/// camera is at `world_from_camera`: a light before the camera follows the pointer, half a turn for
/// the height of the image. Keeps the distance, and what the light looks at.
[[nodiscard]] Transform turned_light(
    const Transform& place, const Vec3& center, const Vec2& motion, float height,
    const Affine& world_from_camera);

/// `place` at the same distance from `center`, in `direction` (unit) from it, shining on it.
[[nodiscard]] Transform
facing_light(const Transform& place, const Vec3& center, const Vec3& direction);

/// A drag of the brightest light: one edit from its first move to its release. What carries the
/// light goes on to do so. `center` and the camera are in the world.
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
