#pragma once

#include "ecs/base/math.h"
#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"

namespace limn {

// The camera in the player's hands. It is no entity: it moves while the simulation is paused and
// never changes what a level does. C goes round its three modes, and each takes over where the one
// before stood, so the picture never jumps except back to the level's camera. How it moves is in
// systems/fly_camera_system.h and systems/orbit_camera_system.h.

enum class CameraMode : std::uint8_t {
    Level,  ///< the level's own camera and path
    Fly,    ///< first person, moved by keys and mouse
    Orbit,  ///< third person: circles a point, which follows an entity if one is selected
};

struct PlayerCamera {
    CameraMode mode = CameraMode::Level;
    bool started = false;  ///< it has a pose
    Camera lens;
    Affine pose;      ///< world from camera, of this picture
    Affine previous;  ///< of the picture before
    FlyCamera fly;
    OrbitCamera orbit;
    Transform place;         ///< while flying
    Vec3 glide = {0, 0, 0};  ///< Input::move, eased in and out
    Vec3 focus = {0, 0, 0};  ///< point that orbit looks at now; follows its target with a lag [m]
};

/// The name of the mode for the HUD.
[[nodiscard]] const char* camera_mode_name(CameraMode mode);

/// Moves a flying camera by `input` for `dt` real seconds. Speed eases in and out within a tenth of
/// a second; the wheel changes `fly.speed`.
void step_fly(PlayerCamera& camera, const Input& input, float dt);

/// Turns and zooms a circling camera about `target`, which it follows with `orbit.follow`
/// (engine.camera-lag).
void step_orbit(PlayerCamera& camera, const Input& input, const Vec3& target, float dt);

/// Flies on from `pose`, upright.
void start_fly(PlayerCamera& camera, const Affine& pose);

/// Circles `target` from where `pose` is, and turns toward it.
void start_orbit(PlayerCamera& camera, const Affine& pose, const Vec3& target);

}  // namespace limn
