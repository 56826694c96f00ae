#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <vector>

namespace limn {

// A camera on rails: where it is at which time, and what it looks at. The way through the keys is a
// centripetal Catmull-Rom spline, which neither loops nor leaves the way between two keys (Yuksel,
// Schaefer and Keyser 2011). Keys fix the time at which the camera passes; between them the way
// grows with a monotone cubic (Fritsch and Butland 1984), so that speed has no steps, the camera
// never goes back, and stands still between two keys at the same place.

/// What turns the camera.
enum class CameraAim : std::uint8_t {
    LookAt,    ///< toward the keys' `look_at`, which moves smoothly
    Rotation,  ///< the keys' `rotation`, by spherical interpolation
    Target,    ///< toward an entity
};

struct CameraKey {
    float time = 0.0f;             ///< since the level began [s], more than the key before
    Vec3 position = {0, 0, 0};     ///< relative to the camera's parent, as Transform [m]
    Vec3 look_at = {0, 0, 0};      ///< of CameraAim::LookAt [m]
    Quat rotation = {1, 0, 0, 0};  ///< of CameraAim::Rotation
    float roll = 0.0f;             ///< about the view axis, to the left [rad]
};

/// Moves the Transform beside it. After the last key the camera stays there or, with `loop`, begins
/// anew; the last key of a loop should equal the first.
struct CameraPath {
    std::vector<CameraKey> keys;
    CameraAim aim = CameraAim::LookAt;
    Entity target;        ///< of CameraAim::Target
    bool upright = true;  ///< no roll but the keys' own (anim.camera-upright)
    bool loop = false;
    bool enabled = true;
};

struct CameraPose {
    Vec3 position = {0, 0, 0};
    Quat rotation = {1, 0, 0, 0};
};

/// Where the camera is at `time` [s]. `target` is where CameraAim::Target looks, in the space of
/// the positions. No keys: the origin, looking along -z. Keys whose time does not grow take none.
[[nodiscard]] CameraPose
camera_pose(const CameraPath& path, double time, const Vec3& target = {0, 0, 0});

/// From the first key to the last [s].
[[nodiscard]] double camera_duration(const CameraPath& path);

/// A camera at the origin that looks along `direction`, its right side level, rolled by `roll`
/// [rad]. Straight up and down, and for a direction of length 0, -z is taken for what is ahead or
/// above.
[[nodiscard]] Quat look_along(const Vec3& direction, float roll = 0.0f);

/// `rotation` with the same view axis and no roll (anim.camera-upright).
[[nodiscard]] Quat upright_rotation(const Quat& rotation);

template <typename Visitor>
void visit_fields(CameraKey& key, Visitor&& visit) {
    visit(
        "time", key.time,
        {.doc = "since the level began, more than the key before",
         .unit = "s",
         .min = 0,
         .max = 1e6});
    visit("position", key.position, {.doc = "relative to the camera's parent", .unit = "m"});
    visit("look_at", key.look_at, {.doc = "point of aim look_at", .unit = "m"});
    visit(
        "rotation", key.rotation,
        {.doc = "of aim rotation: x y z w, or [yaw, pitch, roll] in degrees"});
    visit("roll", key.roll, {.doc = "about the view axis, to the left", .unit = "rad"});
}

template <typename Visitor>
void visit_fields(CameraPath& path, Visitor&& visit) {
    visit("keys", path.keys, {.doc = "places and times, in order"});
    visit("aim", path.aim, {.doc = "what turns the camera", .values = "look_at rotation target"});
    visit("target", path.target, {.doc = "entity of aim target, by name"});
    visit("upright", path.upright, {.doc = "no roll but the keys' own"});
    visit("loop", path.loop, {.doc = "begins anew after the last key"});
    visit("enabled", path.enabled, {.doc = "moves the camera"});
}

}  // namespace limn
