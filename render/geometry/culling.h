#pragma once

#include "ecs/base/math.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cstdint>
#include <span>

namespace limn {

// Frustum culling: the world-space box of every mesh instance against the five planes of the view
// frustum (there is no far plane). Conservative: a box is culled only if it lies wholly outside one
// plane, so no visible box is ever lost; boxes near the frustum's edges may survive though not
// visible.
//
// The kernel works on structure-of-arrays blocks with Highway; tests compare it with the scalar
// version.
//
// Blocks have a box around all of their boxes, and one around each group of neighbors: where that
// is outside the frustum, or wholly inside, none of its boxes is tested by itself. Neighbors are
// rows of one archetype, so that what was made together, as by a repeat, is culled together.
//
// Techniques: engine.hier-bounds, fakephong.pipeline

inline constexpr int kFrustumPlanes = 5;

/// Points with dot(plane.xyz, p) + plane.w >= 0 are inside; left, right, bottom, top, near.
struct Frustum {
    Vec4 planes[kFrustumPlanes];
};

/// Contains everything.
inline constexpr Frustum kEverywhere = {
    {{0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}}};

/// From a matrix with a reversed-depth, infinite projection.
[[nodiscard]] Frustum make_frustum(const Mat4& clip_from_world);

/// World-space boxes of up to one logical chunk, as center and half extent.
inline constexpr int kCullBlock = 1024;
struct BoxBlock {
    alignas(64) float center_x[kCullBlock];
    alignas(64) float center_y[kCullBlock];
    alignas(64) float center_z[kCullBlock];
    alignas(64) float half_x[kCullBlock];
    alignas(64) float half_y[kCullBlock];
    alignas(64) float half_z[kCullBlock];

    [[nodiscard]] Vec3 center(std::size_t i) const {
        return {center_x[i], center_y[i], center_z[i]};
    }
    [[nodiscard]] Vec3 half(std::size_t i) const { return {half_x[i], half_y[i], half_z[i]}; }
    void set(std::size_t i, const Vec3& center, const Vec3& half) {
        center_x[i] = center.x;
        center_y[i] = center.y;
        center_z[i] = center.z;
        half_x[i] = half.x;
        half_y[i] = half.y;
        half_z[i] = half.z;
    }
};

/// Half extent of the box around a box of half extent `h` after `transform` (Arvo 1990).
[[nodiscard]] inline Vec3 transform_half_extent(const Affine& transform, const Vec3& h) {
    Vec3 half;
    for (int i = 0; i < 3; ++i) {
        const Vec4& r = transform.row[i];
        half[i] = std::abs(r.x) * h.x + std::abs(r.y) * h.y + std::abs(r.z) * h.z;
    }
    return half;
}

/// The box around `box` after `transform`.
[[nodiscard]] inline Bounds transform_bounds(const Affine& transform, const Bounds& box) {
    const Vec3 c = transform_point(transform, center(box));
    const Vec3 half = transform_half_extent(transform, half_extent(box));
    return {c - half, c + half};
}

/// visible[i] = 1 if box i of the first `count` may be visible, else 0.
void cull_boxes(
    const Frustum& frustum, const BoxBlock& boxes, int count, std::span<std::uint8_t> visible);

/// What a frustum has of a box. A box so near to a plane that rounding decides is Partly.
enum class Containment : std::uint8_t { Outside, Partly, Inside };
[[nodiscard]] Containment contains(const Frustum& frustum, const Bounds& box);

/// Boxes around the boxes of a block: of all, and of each group of neighbors (engine.hier-bounds).
inline constexpr int kCullGroup = 64;
struct BlockBounds {
    Bounds all;
    Bounds groups[kCullBlock / kCullGroup];
};
/// Of the first `count` boxes. With one that cannot be drawn, of negative half extent, a group
/// never decides for its boxes.
[[nodiscard]] BlockBounds bounds_around(const BoxBlock& boxes, int count);

/// cull_boxes() with the same result: boxes are tested only where the box around all, and that of
/// their group, is neither outside nor inside. Returns how many boxes of any kind it has tested.
int cull_boxes_within(
    const Frustum& frustum, const BlockBounds& around, const BoxBlock& boxes, int count,
    std::span<std::uint8_t> visible);

/// Whether the sphere touches the box (shadow.caster-cull); one of infinite radius touches all.
[[nodiscard]] inline bool
sphere_touches(const Vec3& sphere_center, float radius, const Bounds& box) {
    const Vec3 outside =
        glm::max(glm::abs(sphere_center - center(box)) - half_extent(box), Vec3(0));
    return glm::dot(outside, outside) <= radius * radius;
}

/// Clears visible[i] where the sphere does not touch box i.
void cull_boxes_by_distance(
    const Vec3& center, float radius, const BoxBlock& boxes, int count,
    std::span<std::uint8_t> visible);

/// Clears visible[i] where box i lies outside this additional frustum.
void cull_visible_boxes(
    const Frustum& frustum, const BoxBlock& boxes, int count, std::span<std::uint8_t> visible);

/// Scalar reference for cull_boxes.
void cull_boxes_scalar(
    const Frustum& frustum, const BoxBlock& boxes, int count, std::span<std::uint8_t> visible);

}  // namespace limn
