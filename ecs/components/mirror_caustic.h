#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Beside a MeshInstance: its surface mirrors the sun, or where there is none the first lamp, onto
/// a plane, as a ring does on a table. The mesh is drawn once more, its vertices where they send
/// the light; the finer it is, the finer the pattern.
struct MirrorCaustic {
    Vec3 normal = {0, 1, 0};  ///< of the plane, toward the mirror
    float offset = 0;         ///< of the plane: dot(normal, x) [m]
    Vec3 color = {1, 1, 1};   ///< of the light that the plane sends on
    float strength = 1;       ///< light times this is added, >= 0
    float power_plane = 3;    ///< of the cosine at the plane
    float power_surface = 3;  ///< of the cosine at the mirror
    float farthest = 1000;    ///< rays go no farther [m]
    float highest = 1e6f;     ///< what lands higher above the plane is black [m]
};

template <typename Visitor>
void visit_fields(MirrorCaustic& mirror, Visitor&& visit) {
    visit("normal", mirror.normal, {.doc = "of the plane, toward the mirror"});
    visit("offset", mirror.offset, {.doc = "of the plane along its normal", .unit = "m"});
    visit(
        "color", mirror.color,
        {.doc = "of the light that the plane sends on", .min = 0, .max = 1000});
    visit("strength", mirror.strength, {.doc = "light times this is added", .min = 0, .max = 1000});
    visit(
        "power_plane", mirror.power_plane,
        {.doc = "of the cosine at the plane", .min = 0, .max = 100});
    visit(
        "power_surface", mirror.power_surface,
        {.doc = "of the cosine at the mirror", .min = 0, .max = 100});
    visit(
        "farthest", mirror.farthest,
        {.doc = "rays go no farther", .unit = "m", .min = 0.001, .max = 1e6});
    visit(
        "highest", mirror.highest,
        {.doc = "what lands higher above the plane is black", .unit = "m", .min = 0, .max = 1e6});
}

}  // namespace limn
