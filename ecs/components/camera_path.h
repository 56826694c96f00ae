#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <optional>
#include <vector>

namespace limn {

// A keyframed camera: position over time, and what it looks at. Positions are interpolated by a
// centripetal Catmull-Rom spline, which has no cusps or self-intersections within a segment
// (Yuksel, Schaefer and Keyser 2011). Keys fix the time at which the camera passes; between them
// the arc length is a monotone cubic of time (Fritsch and Butland 1984), so that speed is
// continuous, the camera never moves backward, and it rests between two keys at the same position.

/// What determines the orientation of the camera.
enum class CameraAim : std::uint8_t {
    LookAt,    ///< looks at the keys' `look_at`, interpolated smoothly
    Rotation,  ///< the keys' `rotation`, interpolated spherically
    Target,    ///< looks at an entity
};

struct CameraKey {
    float time = 0.0f;
    Vec3 position = {0, 0, 0};
    Vec3 look_at = {0, 0, 0};
    Quat rotation = {1, 0, 0, 0};
    float roll = 0.0f;
};

LIMN_FIELDS(CameraKey) {
    LIMN_FIELD(time, "since the start of the level; greater than the previous key's", "s", 0, 1e6);
    LIMN_FIELD(position, "position, relative to the camera's parent", "m");
    LIMN_FIELD(look_at, "point to look at, with aim look_at", "m");
    LIMN_FIELD(rotation, "rotation with aim rotation: x y z w, or [yaw, pitch, roll] in degrees");
    LIMN_FIELD(roll, "roll about the view axis, positive to the left", "rad");
}

/// Animates the Transform of its entity. After the last key the camera stays there or, with `loop`,
/// starts over; the last key of a loop should equal the first.
struct CameraPath {
    std::vector<CameraKey> keys;
    CameraAim aim = CameraAim::LookAt;
    Entity target;
    bool upright = true;
    bool loop = false;
    bool enabled = true;
};

LIMN_FIELDS(CameraPath) {
    LIMN_FIELD(keys, "keyframes, in order of time");
    LIMN_FIELD(aim, .doc = "what determines the orientation", .values = "look_at rotation target");
    LIMN_FIELD(target, "entity to look at with aim target, by name");
    LIMN_FIELD(upright, "level horizon: no roll except the keys' own");
    LIMN_FIELD(loop, "starts over after the last key");
    LIMN_FIELD(enabled, "whether the path moves the camera");
}

struct CameraPose {
    Vec3 position = {0, 0, 0};
    Quat rotation = {1, 0, 0, 0};
};

/// Pose at `time` [s]. `target` is the point that CameraAim::Target looks at, in the space of the
/// positions. Without keys: the origin, looking along -z. Keys whose time does not increase are
/// reached instantly.
[[nodiscard]] CameraPose
camera_pose(const CameraPath& path, double time, const Vec3& target = {0, 0, 0});

/// The last time in (`from`, `to`] [s] at which the camera jumps: at keys whose time does not
/// increase, and where a loop starts over at another pose than that of its last key.
[[nodiscard]] std::optional<double> camera_cut(const CameraPath& path, double from, double to);

/// Time from the first key to the last [s].
[[nodiscard]] double camera_duration(const CameraPath& path);

/// Rotation of a camera that looks along `direction` with a level horizon, then rolled by `roll`
/// [rad]. A vertical direction is treated as tilted up or down from -z; one of length 0 gives -z.
[[nodiscard]] Quat look_along(const Vec3& direction, float roll = 0.0f);

/// `rotation` with the same view axis and no roll (anim.camera-upright).
[[nodiscard]] Quat upright_rotation(const Quat& rotation);

}  // namespace limn
