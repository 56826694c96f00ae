#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/reflect.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn {

/// How values between keys are found.
enum class TrackMode : std::uint8_t {
    Linear,  ///< straight; a rotation by slerp
    Bezier,  ///< cubic, through the control points of the keys
    Slerp,   ///< a rotation along the great arc (anim.slerp)
    Squad,   ///< a rotation along a spherical quadrangle spline (anim.squad)
};

/// What comes before the first key and after the last.
enum class TrackWrap : std::uint8_t {
    Clamp,     ///< their values
    Loop,      ///< the track again
    PingPong,  ///< the track backward, then forward again
};

/// Keys of one field of a component (anim.key-track). Floats of a key, in order:
///
///     number    linear 1: value          bezier 3: value, control before, control after
///     vector    linear 2 to 4            bezier three times that
///     rotation  linear, slerp 4: x y z w  squad 12: value, inner point before, inner point after
struct FieldTrack {
    std::string field;  ///< "point_light.radius"
    TrackMode mode = TrackMode::Linear;
    TrackWrap wrap = TrackWrap::Clamp;
    std::vector<float> times = {};  ///< [s], increasing
    std::vector<float> values = {};
};

LIMN_FIELDS(FieldTrack) {
    LIMN_FIELD(field, "component and field of the entity: point_light.radius");
    LIMN_FIELD(
        mode, .doc = "how values between keys are found; rotations: slerp or squad",
        .values = "linear bezier slerp squad");
    LIMN_FIELD(
        wrap, .doc = "what comes before the first key and after the last",
        .values = "clamp loop ping_pong");
    LIMN_FIELD(times, "since the start of the level, increasing", "s", 0, 1e6);
    LIMN_FIELD(
        values, "of all keys in order; bezier: value, control before, control after; squad: "
                "rotation x y z w, inner point before, inner point after");
}

/// Animates any fields of its entity: colors, radii, angles, positions, rotations.
struct KeyTrack {
    std::vector<FieldTrack> tracks;
};

LIMN_FIELDS(KeyTrack) {
    LIMN_FIELD(tracks, "one per field");
}

/// Floats per key; 0: the mode is not for this type.
[[nodiscard]] std::size_t floats_per_key(FieldType type, TrackMode mode);

/// Where the value of a track goes.
struct TrackTarget {
    const ComponentInfo* component = nullptr;
    const FieldInfo* field = nullptr;
    std::uint32_t offset = 0;  ///< of the field in the component [bytes]
};

/// Fails with one line: no such field, a mode that is not for its type, times that do not increase
/// (with the index of the key), the wrong number of values, values that are not finite. A track
/// without keys is valid and changes nothing.
[[nodiscard]] Result<TrackTarget> find_track_target(const FieldTrack& track);

/// What a KeyTrack was checked to be; never saved.
struct KeyTrackState {
    std::vector<TrackTarget> targets;  ///< of each track; without a field: invalid
};
template <>
struct ComponentTraits<KeyTrackState> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
};

/// The value at `time` [s] of a valid track with keys: as many numbers as the field has.
[[nodiscard]] Vec4 track_value(const FieldTrack& track, FieldType type, double time);

}  // namespace limn
