#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// Techniques: env.update-policy

/// When a probe is captured again (env.update-policy).
enum class ProbeUpdate : std::uint8_t {
    Once,      ///< only at the start
    Period,    ///< every `period` frames
    Movement,  ///< when it has moved by more than `threshold` since the last capture
    Either,    ///< whichever comes first
};

/// Environment probe: a cube map of the scene from the entity's position, without the entity and
/// its descendants, for reflections on nearby surfaces. Place one on each moving metal object and
/// one in the center of a room. Its influence is full within `radius` or `box` and fades out
/// beyond; where several overlap, smaller ones take precedence.
struct EnvProbe {
    float radius = 2.0f;
    Vec3 box = {0, 0, 0};  ///< half extents of the parallax-correction box along local axes [m]; 0:
                           ///< none, the environment is infinitely far away
    Vec3 box_center = {0, 0, 0};
    float fade = 0.25f;
    int resolution = 128;
    float near = 0.05f;
    ProbeUpdate update = ProbeUpdate::Either;
    int period = 30;
    float threshold = 0.1f;
    bool face_by_face = false;
};

LIMN_FIELDS(EnvProbe) {
    LIMN_FIELD(radius, "radius of full influence; unused with a box", "m", 0.001, 1e5);
    LIMN_FIELD(box, "half extents of the parallax-correction box; 0: infinitely far", "m", 0, 1e5);
    LIMN_FIELD(box_center, "center of the box in the entity's local space", "m");
    LIMN_FIELD(fade, "width of the fade-out zone as a fraction of radius or box", "", 0.001, 10);
    LIMN_FIELD(resolution, "resolution of a cube map face, a power of two", "px", 16, 1024);
    LIMN_FIELD(near, "near plane of the capture", "m", 1e-4, 100);
    LIMN_FIELD(
        update, .doc = "when the probe is captured again", .values = "once period movement either");
    LIMN_FIELD(period, "frames between captures with update period", "frames", 1, 1e6);
    LIMN_FIELD(threshold, "distance that triggers a capture with update movement", "m", 0, 1e5);
    LIMN_FIELD(face_by_face, "after the first capture, one face per frame instead of six");
}

/// Internal state of update_env_probes.
struct EnvProbeState {
    Vec3 capture_position = {0, 0, 0};
    std::uint32_t frames_since_capture = 0;
    std::uint64_t faces = 0;
};

LIMN_FIELDS(EnvProbeState) {
    LIMN_FIELD(
        capture_position, .doc = "position of the last capture", .unit = "m",
        .renamed = "seen_from");
    LIMN_FIELD(
        frames_since_capture, .doc = "frames since the last capture", .unit = "frames",
        .renamed = "waited");
    LIMN_FIELD(faces, "cube map faces scheduled since the start");
}

}  // namespace limn
