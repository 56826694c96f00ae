#pragma once

#include "ecs/base/math.h"
#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"

#include <optional>

namespace limn {

class World;

// The user-controlled camera. It is not an entity: it moves while the simulation is paused and
// never affects the level. C cycles through its three modes; each starts from the pose of the
// previous one, so that the view jumps only when it returns to the level's camera. The motion
// itself is in systems/fly_camera_system.h and systems/orbit_camera_system.h.

enum class CameraMode : std::uint8_t {
    Level,  ///< the level's own camera and path
    Fly,    ///< first person, moved by keys and mouse
    Orbit,  ///< third person: orbits a point, which follows an entity if one is selected
};

struct PlayerCamera {
    CameraMode mode = CameraMode::Level;
    bool started = false;  ///< `pose` is valid
    Camera lens;
    Affine pose;      ///< world from camera, of this frame
    Affine previous;  ///< of the previous frame
    FlyCamera fly;
    OrbitCamera orbit;
    Transform fly_pose;          ///< pose while flying
    float unit = 1.0f;           ///< unit of the limits of distances and speeds [m]
    Vec3 glide = {0, 0, 0};      ///< MoveInput::move, eased in and out
    float view_distance = 5.0f;  ///< distance to what a flying camera looks at, smoothed [m]
    float pace = 0.6f;           ///< flying speed as a multiple of `view_distance` [1/s]
    Vec3 aim = {0, 0, 0};        ///< target of the orbit if it follows no entity [m]
    Vec3 focus = {0, 0, 0};  ///< point that the orbit looks at; follows its target with a lag [m]
};

inline constexpr float kEyeHeight =
    0.15f;  ///< minimum height of a flying camera above the floor [PlayerCamera::unit]

/// The name of the mode for the HUD.
[[nodiscard]] const char* camera_mode_name(CameraMode mode);

/// Moves a flying camera by `input` for `dt` real seconds, at `pace` times `view_distance` per
/// second; the wheel changes `pace`. Speed eases in and out within
/// a tenth of a second.
void step_fly(PlayerCamera& camera, const MoveInput& input, float dt);

/// Lets `view_distance` follow the distance ahead [m] within some tenths of a second; if nothing is
/// ahead, the scene's radius.
void update_view_distance(PlayerCamera& camera, float ahead, float scene_radius, float dt);

/// Keeps a flying camera above the floor unless it is steered down: no nearer than
/// kEyeHeight where `floor`, the distance [m] from its `previous` position straight down, is known.
void stop_at_floor(PlayerCamera& camera, std::optional<float> floor);

/// The distance at which a box of `radius` [m] fills most of an image of `aspect` = width / height,
/// in the narrower direction of the image.
[[nodiscard]] float framing_distance(const PlayerCamera& camera, float radius, float aspect);

/// Rotates and zooms an orbiting camera about `target`, which it follows with `orbit.follow`
/// (engine.camera-lag).
void step_orbit(PlayerCamera& camera, const MoveInput& input, const Vec3& target, float dt);

/// Moves an orbiting camera and its aim across the image, so that what is at its focus follows the
/// pointer: `motion` in pixels of an image of `height` pixels.
void pan_orbit(PlayerCamera& camera, const Vec2& motion, float height);

/// The level's camera to see by: `current` until an event has switched it off and another one on.
[[nodiscard]] Entity follow_active_camera(const World& world, Entity current);

/// Starts flying from `pose`, made upright.
void start_fly(PlayerCamera& camera, const Affine& pose);

/// Starts orbiting `target` from the position of `pose`, looking at it.
void start_orbit(PlayerCamera& camera, const Affine& pose, const Vec3& target);

}  // namespace limn
