#pragma once

#include "ecs/components/surface.h"

#include <vector>

namespace limn {

// Analytic meshes. Each shape is a struct of parameters that a level file may set, and a function
// that makes the mesh: unit normals and tangents in closed form, not from differences; images
// upright and unmirrored when viewed from outside (w = +1, see surface_grid.h); +y up; centered at
// the origin. Closed shapes are watertight: vertices at seams have bit-identical positions.

/// A sphere with longitude and latitude as texture coordinates; the seam is at -z, the image's top
/// at +y.
struct SphereShape {
    float radius = 0.5f;
    int segments = 64;
    int rings = 32;
};

LIMN_FIELDS(SphereShape) {
    LIMN_FIELD(radius, "from the center", "m", 1e-4, 1e5);
    LIMN_FIELD(segments, "around the axis", "", 3, 2048);
    LIMN_FIELD(rings, "from pole to pole", "", 2, 1024);
}

/// A box with edges rounded by circular arcs; every side shows the whole image.
struct BoxShape {
    Vec3 size = {1, 1, 1};
    float bevel = 0.0f;
    int bevel_segments = 4;
    int divisions = 1;
    bool metric = false;
};

LIMN_FIELDS(BoxShape) {
    LIMN_FIELD(size, "along x, y and z", "m", 1e-4, 1e5);
    LIMN_FIELD(bevel, "radius of the edges, at most half the smallest size", "m", 0, 1e5);
    LIMN_FIELD(bevel_segments, "segments of each half of a rounded edge", "", 1, 64);
    LIMN_FIELD(divisions, "quads along the flat part of a side", "", 1, 1024);
    LIMN_FIELD(metric, "the image repeats every meter");
}

/// A ring around +y; u runs around the axis, v around the tube, the image's central row outside.
struct TorusShape {
    float radius = 0.35f;
    float tube = 0.15f;
    int segments = 64;
    int sides = 32;
};

LIMN_FIELDS(TorusShape) {
    LIMN_FIELD(radius, "from the center to the center line of the tube", "m", 1e-4, 1e5);
    LIMN_FIELD(tube, "radius of the tube, at most radius", "m", 1e-4, 1e5);
    LIMN_FIELD(segments, "around the axis", "", 3, 2048);
    LIMN_FIELD(sides, "around the tube", "", 3, 1024);
}

/// A rectangle in the x-z plane that faces +y; the image's top is at -z.
struct PlaneShape {
    Vec2 size = {1, 1};
    int divisions = 1;
    bool metric = false;
};

LIMN_FIELDS(PlaneShape) {
    LIMN_FIELD(size, "along x and z", "m", 1e-4, 1e5);
    LIMN_FIELD(divisions, "quads along each side", "", 1, 2048);
    LIMN_FIELD(metric, "the image repeats every meter");
}

/// An equilateral triangle in the x-y plane that faces +z, a corner on top.
struct TriangleShape {
    float radius = 0.5f;
    int divisions = 1;
};

LIMN_FIELDS(TriangleShape) {
    LIMN_FIELD(radius, "from the center to the corners", "m", 1e-4, 1e5);
    LIMN_FIELD(divisions, "of each side; their square is the number of facets", "", 1, 1024);
}

/// A regular dodecahedron: twelve pentagons of three triangles, or the first of them, from +z on,
/// without those at the back. Its normals are radial.
struct DodecahedronShape {
    float radius = 0.5f;
    int faces = 12;
};

LIMN_FIELDS(DodecahedronShape) {
    LIMN_FIELD(radius, "from the center to the corners", "m", 1e-4, 1e5);
    LIMN_FIELD(
        faces, "number of pentagons; fewer: those at the back, at -z, are left out", "", 1, 12);
}

/// A tube around +y, closed by two discs.
struct CylinderShape {
    float radius = 0.5f;
    float height = 1.0f;
    int segments = 64;
    int divisions = 1;
    bool caps = true;
};

LIMN_FIELDS(CylinderShape) {
    LIMN_FIELD(radius, "of the tube", "m", 1e-4, 1e5);
    LIMN_FIELD(height, "along y", "m", 1e-4, 1e5);
    LIMN_FIELD(segments, "around the axis", "", 3, 2048);
    LIMN_FIELD(divisions, "along the height", "", 1, 1024);
    LIMN_FIELD(caps, "closed above and below");
}

/// A cone around +y, its tip (or the upper disc) on top.
struct ConeShape {
    float radius = 0.5f;
    float top_radius = 0.0f;
    float height = 1.0f;
    int segments = 64;
    int divisions = 8;
    bool caps = true;
};

LIMN_FIELDS(ConeShape) {
    LIMN_FIELD(radius, "at the bottom", "m", 1e-4, 1e5);
    LIMN_FIELD(top_radius, "at the top; 0 = a tip", "m", 0, 1e5);
    LIMN_FIELD(height, "along y", "m", 1e-4, 1e5);
    LIMN_FIELD(segments, "around the axis", "", 3, 2048);
    LIMN_FIELD(divisions, "along the height", "", 1, 1024);
    LIMN_FIELD(caps, "closed above and below");
}

/// A disc in the x-z plane that faces +y, or a ring, with a planar mapping of the image.
struct DiscShape {
    float radius = 0.5f;
    float inner_radius = 0.0f;
    int segments = 64;
    int divisions = 1;
};

LIMN_FIELDS(DiscShape) {
    LIMN_FIELD(radius, "of the outline", "m", 1e-4, 1e5);
    LIMN_FIELD(inner_radius, "of the hole, less than radius", "m", 0, 1e5);
    LIMN_FIELD(segments, "around the axis", "", 3, 2048);
    LIMN_FIELD(divisions, "from the center outwards", "", 1, 1024);
}

/// A profile revolved around +y: balusters, columns, bowls, flames. Lobes make clustered columns:
/// the radius is that of the profile times 1 + lobe_depth cos(lobes azimuth).
struct LatheShape {
    std::vector<Vec2> profile = {{0.5f, 0.0f}, {0.35f, 0.2f}, {0.35f, 0.8f}, {0.5f, 1.0f}};
    int segments = 32;
    float crease = 0.6f;
    int lobes = 0;
    float lobe_depth = 0.1f;
    bool caps = true;
};

LIMN_FIELDS(LatheShape) {
    LIMN_FIELD(profile, "points (radius, height), from bottom to top", "m", -1e5, 1e5);
    LIMN_FIELD(segments, "around the axis", "", 3, 2048);
    LIMN_FIELD(crease, "a sharp edge where the profile turns by more", "rad", 0, 3.1416);
    LIMN_FIELD(lobes, "around the axis; 0 = round", "", 0, 256);
    LIMN_FIELD(lobe_depth, "amplitude / radius", "", 0, 0.5);
    LIMN_FIELD(caps, "closed where the profile does not end on the axis");
}

[[nodiscard]] MeshData make_sphere(const SphereShape& shape);
[[nodiscard]] MeshData make_box(const BoxShape& shape);
[[nodiscard]] MeshData make_torus(const TorusShape& shape);
[[nodiscard]] MeshData make_plane(const PlaneShape& shape);
[[nodiscard]] MeshData make_triangle(const TriangleShape& shape);
[[nodiscard]] MeshData make_dodecahedron(const DodecahedronShape& shape);
[[nodiscard]] MeshData make_cylinder(const CylinderShape& shape);
[[nodiscard]] MeshData make_cone(const ConeShape& shape);
[[nodiscard]] MeshData make_disc(const DiscShape& shape);
[[nodiscard]] MeshData make_lathe(const LatheShape& shape);

}  // namespace limn
