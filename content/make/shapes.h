#pragma once

#include "ecs/components/surface.h"

#include <vector>

namespace limn {

// Meshes with a formula. Each shape is a struct of parameters that a level file may set, and a
// function that makes the mesh: unit normals and tangents from the formula, not from differences;
// images upright and unmirrored seen from outside (w = +1, see surface_grid.h); +y up; centered at
// the origin. Closed shapes are watertight: vertices at seams have the same position to the bit.

/// A ball with longitude and latitude as texture coordinates; the seam is at -z, the image's top at
/// +y.
struct SphereShape {
    float radius = 0.5f;  ///< [m], > 0
    int segments = 64;    ///< around the axis, >= 3
    int rings = 32;       ///< from pole to pole, >= 2
};

/// A box with edges rounded by circular arcs; every side shows the whole image.
struct BoxShape {
    Vec3 size = {1, 1, 1};   ///< [m], > 0
    float bevel = 0.0f;      ///< radius of the edges [m], 0 .. half the smallest size
    int bevel_segments = 4;  ///< steps of a rounded edge on each of its two sides, >= 1
    int divisions = 1;       ///< quads along the flat part of a side, >= 1
    bool metric = false;     ///< texture coordinates are meters: the image repeats every meter
};

/// A ring around +y; u runs around the axis, v around the tube, the image's middle row outside.
struct TorusShape {
    float radius = 0.35f;  ///< from the center to the middle of the tube [m], > tube
    float tube = 0.15f;    ///< radius of the tube [m], > 0
    int segments = 64;     ///< around the axis, >= 3
    int sides = 32;        ///< around the tube, >= 3
};

/// A rectangle in the x-z plane that faces +y; the image's top is at -z.
struct PlaneShape {
    Vec2 size = {1, 1};   ///< along x and z [m], > 0
    int divisions = 1;    ///< quads along each side, >= 1
    bool metric = false;  ///< texture coordinates are meters: the image repeats every meter
};

/// A tube around +y, closed by two discs.
struct CylinderShape {
    float radius = 0.5f;  ///< [m], > 0
    float height = 1.0f;  ///< [m], > 0
    int segments = 64;    ///< around the axis, >= 3
    int divisions = 1;    ///< along the height, >= 1
    bool caps = true;     ///< with its two discs
};

/// A cone around +y, its tip (or the smaller disc) on top.
struct ConeShape {
    float radius = 0.5f;      ///< below [m], > 0
    float top_radius = 0.0f;  ///< above [m], >= 0; 0 = a tip
    float height = 1.0f;      ///< [m], > 0
    int segments = 64;        ///< around the axis, >= 3
    int divisions = 8;        ///< along the height, >= 1
    bool caps = true;         ///< with its discs
};

/// A disc in the x-z plane that faces +y, or a ring; the image is cut out, not bent.
struct DiscShape {
    float radius = 0.5f;        ///< [m], > 0
    float inner_radius = 0.0f;  ///< of the hole [m], 0 .. radius
    int segments = 64;          ///< around the axis, >= 3
    int divisions = 1;          ///< from the middle outwards, >= 1
};

/// A profile turned around +y: balusters, columns, bowls, flames. Its lobes make bundles of shafts
/// of a column: the radius is that of the profile times 1 + lobe_depth cos(lobes azimuth).
struct LatheShape {
    /// Points (radius, height), from below upwards; >= 2. Radii are >= 0.
    std::vector<Vec2> profile = {{0.5f, 0.0f}, {0.35f, 0.2f}, {0.35f, 0.8f}, {0.5f, 1.0f}};
    int segments = 32;        ///< around the axis, >= 3
    float crease = 0.6f;      ///< where the profile turns by more, there is an edge [rad], 0 .. pi
    int lobes = 0;            ///< around the axis, 0 = round
    float lobe_depth = 0.1f;  ///< 0 .. 0.5
    bool caps = true;         ///< closed where the profile does not end on the axis
};

[[nodiscard]] MeshData make_sphere(const SphereShape& shape);
[[nodiscard]] MeshData make_box(const BoxShape& shape);
[[nodiscard]] MeshData make_torus(const TorusShape& shape);
[[nodiscard]] MeshData make_plane(const PlaneShape& shape);
[[nodiscard]] MeshData make_cylinder(const CylinderShape& shape);
[[nodiscard]] MeshData make_cone(const ConeShape& shape);
[[nodiscard]] MeshData make_disc(const DiscShape& shape);
[[nodiscard]] MeshData make_lathe(const LatheShape& shape);

template <typename Visitor>
void visit_fields(SphereShape& shape, Visitor&& visit) {
    visit("radius", shape.radius, {.doc = "from the center", .unit = "m", .min = 1e-4, .max = 1e5});
    visit("segments", shape.segments, {.doc = "around the axis", .min = 3, .max = 2048});
    visit("rings", shape.rings, {.doc = "from pole to pole", .min = 2, .max = 1024});
}

template <typename Visitor>
void visit_fields(BoxShape& shape, Visitor&& visit) {
    visit("size", shape.size, {.doc = "along x, y and z", .unit = "m", .min = 1e-4, .max = 1e5});
    visit(
        "bevel", shape.bevel,
        {.doc = "radius of the edges, at most half the smallest size",
         .unit = "m",
         .min = 0,
         .max = 1e5});
    visit(
        "bevel_segments", shape.bevel_segments,
        {.doc = "steps of half a rounded edge", .min = 1, .max = 64});
    visit(
        "divisions", shape.divisions,
        {.doc = "quads along the flat part of a side", .min = 1, .max = 1024});
    visit("metric", shape.metric, {.doc = "the image repeats every meter"});
}

template <typename Visitor>
void visit_fields(TorusShape& shape, Visitor&& visit) {
    visit(
        "radius", shape.radius,
        {.doc = "from the center to the middle of the tube", .unit = "m", .min = 1e-4, .max = 1e5});
    visit(
        "tube", shape.tube,
        {.doc = "radius of the tube, at most radius", .unit = "m", .min = 1e-4, .max = 1e5});
    visit("segments", shape.segments, {.doc = "around the axis", .min = 3, .max = 2048});
    visit("sides", shape.sides, {.doc = "around the tube", .min = 3, .max = 1024});
}

template <typename Visitor>
void visit_fields(PlaneShape& shape, Visitor&& visit) {
    visit("size", shape.size, {.doc = "along x and z", .unit = "m", .min = 1e-4, .max = 1e5});
    visit("divisions", shape.divisions, {.doc = "quads along each side", .min = 1, .max = 2048});
    visit("metric", shape.metric, {.doc = "the image repeats every meter"});
}

template <typename Visitor>
void visit_fields(CylinderShape& shape, Visitor&& visit) {
    visit("radius", shape.radius, {.doc = "of the tube", .unit = "m", .min = 1e-4, .max = 1e5});
    visit("height", shape.height, {.doc = "along y", .unit = "m", .min = 1e-4, .max = 1e5});
    visit("segments", shape.segments, {.doc = "around the axis", .min = 3, .max = 2048});
    visit("divisions", shape.divisions, {.doc = "along the height", .min = 1, .max = 1024});
    visit("caps", shape.caps, {.doc = "closed above and below"});
}

template <typename Visitor>
void visit_fields(ConeShape& shape, Visitor&& visit) {
    visit("radius", shape.radius, {.doc = "below", .unit = "m", .min = 1e-4, .max = 1e5});
    visit(
        "top_radius", shape.top_radius,
        {.doc = "above; 0 = a tip", .unit = "m", .min = 0, .max = 1e5});
    visit("height", shape.height, {.doc = "along y", .unit = "m", .min = 1e-4, .max = 1e5});
    visit("segments", shape.segments, {.doc = "around the axis", .min = 3, .max = 2048});
    visit("divisions", shape.divisions, {.doc = "along the height", .min = 1, .max = 1024});
    visit("caps", shape.caps, {.doc = "closed above and below"});
}

template <typename Visitor>
void visit_fields(DiscShape& shape, Visitor&& visit) {
    visit("radius", shape.radius, {.doc = "of the outline", .unit = "m", .min = 1e-4, .max = 1e5});
    visit(
        "inner_radius", shape.inner_radius,
        {.doc = "of the hole, less than radius", .unit = "m", .min = 0, .max = 1e5});
    visit("segments", shape.segments, {.doc = "around the axis", .min = 3, .max = 2048});
    visit("divisions", shape.divisions, {.doc = "from the middle outwards", .min = 1, .max = 1024});
}

template <typename Visitor>
void visit_fields(LatheShape& shape, Visitor&& visit) {
    visit(
        "profile", shape.profile,
        {.doc = "points (radius, height), from below upwards",
         .unit = "m",
         .min = -1e5,
         .max = 1e5});
    visit("segments", shape.segments, {.doc = "around the axis", .min = 3, .max = 2048});
    visit(
        "crease", shape.crease,
        {.doc = "where the profile turns by more, there is an edge",
         .unit = "rad",
         .min = 0,
         .max = 3.1416});
    visit("lobes", shape.lobes, {.doc = "around the axis; 0 = round", .min = 0, .max = 256});
    visit(
        "lobe_depth", shape.lobe_depth,
        {.doc = "how far they stand out, of the radius", .min = 0, .max = 0.5});
    visit("caps", shape.caps, {.doc = "closed where the profile does not end on the axis"});
}

}  // namespace limn
