#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// When a probe looks around again (env.update-policy).
enum class ProbeUpdate : std::uint8_t {
    Once,      ///< at the start
    Period,    ///< every `period` frames
    Movement,  ///< when it has moved by more than `threshold` since it did
    Either,    ///< whichever comes first
};

/// Shows surfaces about the entity what is around it: the scene as seen from there, without the
/// entity itself and what is below it. Metal on a moving object needs one on that object; a room
/// one in its middle. It counts fully within `radius` or `box` and fades out beyond; where several
/// reach, the smaller one comes first.
struct EnvProbe {
    float radius = 2.0f;          ///< where it counts fully [m], > 0; not used with a box
    Vec3 box = {0, 0, 0};         ///< half sides of the room it stands for, along its own axes [m];
                                  ///< 0: none, all it sees is far away
    Vec3 box_center = {0, 0, 0};  ///< in the entity's space, unscaled [m]
    float fade = 0.25f;           ///< width of the rim beyond, as a share of radius or box, > 0
    int resolution = 128;         ///< of a cube face [px], a power of two
    float near = 0.05f;           ///< near plane of its pictures [m]
    ProbeUpdate update = ProbeUpdate::Either;
    int period = 30;            ///< [frames], >= 1
    float threshold = 0.1f;     ///< [m], >= 0
    bool face_by_face = false;  ///< one face a frame instead of six, after the first time
};

/// What update_env_probes keeps.
struct EnvProbeState {
    Vec3 seen_from = {0, 0, 0};  ///< where it was when it last looked around
    std::uint32_t waited = 0;    ///< frames since then
    std::uint64_t faces = 0;     ///< due since the start; number i is face i mod 6
};

template <typename Visitor>
void visit_fields(EnvProbe& probe, Visitor&& visit) {
    visit(
        "radius", probe.radius,
        {.doc = "where it counts fully; not used with a box",
         .unit = "m",
         .min = 0.001,
         .max = 1e5});
    visit(
        "box", probe.box,
        {.doc = "half sides of the room it stands for; 0 = all is far away",
         .unit = "m",
         .min = 0,
         .max = 1e5});
    visit(
        "box_center", probe.box_center, {.doc = "of the box, in the entity's space", .unit = "m"});
    visit(
        "fade", probe.fade,
        {.doc = "width of the rim where it fades out, as a share of radius or box",
         .min = 0.001,
         .max = 10});
    visit(
        "resolution", probe.resolution,
        {.doc = "of a cube face, a power of two", .unit = "px", .min = 16, .max = 1024});
    visit("near", probe.near, {.doc = "near plane", .unit = "m", .min = 1e-4, .max = 100});
    visit(
        "update", probe.update,
        {.doc = "when it looks around again", .values = "once period movement either"});
    visit("period", probe.period, {.doc = "of period", .unit = "frames", .min = 1, .max = 1e6});
    visit("threshold", probe.threshold, {.doc = "of movement", .unit = "m", .min = 0, .max = 1e5});
    visit(
        "face_by_face", probe.face_by_face,
        {.doc = "one face a frame instead of six, after the first time"});
}

template <typename Visitor>
void visit_fields(EnvProbeState& state, Visitor&& visit) {
    visit("seen_from", state.seen_from, {.doc = "where it last looked around", .unit = "m"});
    visit("waited", state.waited, {.doc = "since then", .unit = "frames"});
    visit("faces", state.faces, {.doc = "due since the start"});
}

}  // namespace limn
