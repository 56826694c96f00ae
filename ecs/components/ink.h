#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstddef>

namespace limn {

/// Colors that Material::ramp may have.
inline constexpr std::size_t kMaxToonBands = 16;

// What makes a level look drawn: outlines of meshes, lines where the image has edges, and hatching.
// Surfaces in flat colors are the shading model `toon`.
// Techniques: tex.hatching, tex.ink-lines, tex.toon-outline

/// With a MeshInstance: its outline, the back faces of the mesh inflated along its normals
/// (tex.toon-outline). Hard edges, where vertices share a position but not a normal, split the
/// outline open: bevel them. It casts no shadow.
struct ToonOutline {
    float width = 0.01f;
    MaterialId material = {};
};

LIMN_FIELDS(ToonOutline) {
    LIMN_FIELD(width, "of the line, in the space of the mesh", "m", 0, 1000);
    LIMN_FIELD(
        material, "of the line: unlit and single-sided; its base color, or emission to glow");
}

/// Resource: lines where depth, normals or materials of the image have edges (tex.ink-lines). None
/// if absent or of width 0.
struct InkLines {
    float width = 1.5f;
    Vec3 color = {0.012f, 0.011f, 0.016f};
    float opacity = 1.0f;
    float depth = 0.02f;
    float angle = radians(35.0f);
    bool materials = true;

    bool operator==(const InkLines&) const = default;
};

LIMN_FIELDS(InkLines) {
    LIMN_FIELD(width, "in pixels of an image 720 lines high", "", 0, 8);
    LIMN_FIELD(color, .doc = "of the ink", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(opacity, "of the ink", "", 0, 1);
    LIMN_FIELD(
        depth,
        "a line where the distance to the plane of a neighboring pixel is more than this fraction "
        "of that to the camera",
        "", 1e-4, 10);
    LIMN_FIELD(angle, "a line where normals turn by more; 180 degrees: nowhere", "rad", 0, kPi);
    LIMN_FIELD(materials, "lines between materials, too");
}

/// Resource: surfaces with the shading model `toon` in their base color, their shade as strokes of
/// ink along u and v (tex.hatching). None if absent or of opacity 0.
struct Hatching {
    float opacity = 1.0f;
    Vec3 color = {0.012f, 0.011f, 0.016f};
    float white = 1.0f;
    float wash = 0.0f;

    bool operator==(const Hatching&) const = default;
};

LIMN_FIELDS(Hatching) {
    LIMN_FIELD(opacity, "of the strokes", "", 0, 1);
    LIMN_FIELD(color, .doc = "of the ink", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(white, "luminance of a white surface that needs no strokes", "cd/m^2", 1e-4, 1e6);
    LIMN_FIELD(wash, "how much of the shading stays below the strokes", "", 0, 1);
}

}  // namespace limn
