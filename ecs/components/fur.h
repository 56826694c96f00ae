#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// With a MeshInstance: a coat of fur (render/geometry/fur_list.h). It follows skins and morph
/// targets, and casts shadows into maps. Where the mesh has vertex colors, their alpha scales its
/// length; at 0 the skin is bare. Its shading is that of its material: `hair` is made for it.
/// Techniques: shade.fur
struct Fur {
    float length = 0.03f;
    std::int32_t shells = 24;
    float density = 500.0f;
    float thickness = 0.9f;
    float shortest = 0.5f;
    Vec3 comb = {0, 0, 0};
    float droop = 0.4f;
    float wave = 1.0f;
    float unruly = 0.25f;
    float root = 0.4f;
    Vec3 tip = {1, 1, 1};
    float variation = 0.3f;
    MaterialId material = {};
    bool fins = false;
};

LIMN_FIELDS(Fur) {
    LIMN_FIELD(
        length, "thickness of the coat, along normals, in the space of the mesh; 0: none", "m", 0,
        100);
    LIMN_FIELD(
        shells, "layers from the skin, where none is drawn, to the tips: the cost of the coat", "",
        2, 64);
    LIMN_FIELD(density, "strands per meter, along and across", "1/m", 1, 1e5);
    LIMN_FIELD(
        thickness, "of a strand at its root, relative to the distance of strands", "", 0, 1.4);
    LIMN_FIELD(shortest, "length of the shortest strands; that of the longest is 1", "", 0.05, 1);
    LIMN_FIELD(
        comb, "how far tips lie from their roots along the surface, in lengths and in the space of "
              "the mesh: the direction of the coat");
    LIMN_FIELD(droop, "the same toward the ground, wherever that is as the mesh turns", "", 0, 10);
    LIMN_FIELD(wave, "how far tips are out of line, together with those around", "", 0, 4);
    LIMN_FIELD(
        unruly, "how much the directions of single strands differ, for highlights", "", 0, 2);
    LIMN_FIELD(root, "brightness at the skin, where strands shade each other", "", 0, 1);
    LIMN_FIELD(
        tip, .doc = "color of tips, multiplied by that of roots", .min = 0, .max = 4,
        .color = true);
    LIMN_FIELD(variation, "of brightness between strands", "", 0, 1);
    LIMN_FIELD(material, "of the coat; none: that of the mesh");
    LIMN_FIELD(
        fins,
        "the mesh is one of `fins`, seen where the surface is seen edge-on, instead of shells");
}

}  // namespace limn
