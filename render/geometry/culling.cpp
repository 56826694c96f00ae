#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/geometry/culling.cpp"
#include "render/geometry/culling.h"

#include "ecs/base/check.h"

#include <glm/geometric.hpp>
#include <hwy/foreach_target.h>  // compiles what follows once for every instruction set
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Boxes first .. count - 1; `first` is a multiple of the lanes.
void cull_boxes_simd(
    const Frustum& frustum, const BoxBlock& boxes, int first, int count, std::uint8_t* visible) {
    const hn::ScalableTag<float> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    alignas(64) std::int32_t inside[hn::MaxLanes(d)];
    const hn::RebindToSigned<decltype(d)> di;

    for (int i = first; i < count; i += lanes) {
        const auto cx = hn::Load(d, boxes.center_x + i);
        const auto cy = hn::Load(d, boxes.center_y + i);
        const auto cz = hn::Load(d, boxes.center_z + i);
        const auto hx = hn::Load(d, boxes.half_x + i);
        const auto hy = hn::Load(d, boxes.half_y + i);
        const auto hz = hn::Load(d, boxes.half_z + i);
        auto nearest = hn::Set(d, INFINITY);
        for (const Vec4& p : frustum.planes) {
            // Signed distance of the box's farthest corner along the plane's normal; the products
            // are summed in the order of the scalar version, without fused steps, so that both
            // agree to the last bit.
            const auto extent = hn::Add(
                hn::Add(
                    hn::Mul(hx, hn::Set(d, std::abs(p.x))), hn::Mul(hy, hn::Set(d, std::abs(p.y)))),
                hn::Mul(hz, hn::Set(d, std::abs(p.z))));
            const auto along = hn::Add(
                hn::Add(
                    hn::Add(hn::Mul(cx, hn::Set(d, p.x)), hn::Mul(cy, hn::Set(d, p.y))),
                    hn::Mul(cz, hn::Set(d, p.z))),
                hn::Set(d, p.w));
            nearest = hn::Min(nearest, hn::Add(along, extent));
        }
        const auto one = hn::Set(di, 1);
        const auto mask = hn::RebindMask(di, hn::Ge(nearest, hn::Zero(d)));
        hn::Store(hn::IfThenElseZero(mask, one), di, inside);
        const int left = count - i < lanes ? count - i : lanes;
        for (int k = 0; k < left; ++k) {
            visible[i + k] = static_cast<std::uint8_t>(inside[k]);
        }
    }
}

/// Smallest and largest coordinates along one axis, of each group and of all.
void bound_axis(
    const float* centers, const float* halves, int count, int axis, BlockBounds& around) {
    const hn::ScalableTag<float> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    alignas(64) float lows[hn::MaxLanes(d)];
    alignas(64) float highs[hn::MaxLanes(d)];
    for (int first = 0; first < count; first += kCullGroup) {
        const int end = std::min(first + kCullGroup, count);
        auto low = hn::Set(d, INFINITY);
        auto high = hn::Set(d, -INFINITY);
        for (int i = first; i < end; i += lanes) {
            const auto c = hn::Load(d, centers + i);
            const auto h = hn::Abs(hn::Load(d, halves + i));
            const auto used = hn::FirstN(d, static_cast<std::size_t>(end - i));
            low = hn::IfThenElse(used, hn::Min(low, hn::Sub(c, h)), low);
            high = hn::IfThenElse(used, hn::Max(high, hn::Add(c, h)), high);
        }
        hn::Store(low, d, lows);
        hn::Store(high, d, highs);
        Bounds& group = around.groups[first / kCullGroup];
        group.min[axis] = *std::min_element(lows, lows + lanes);
        group.max[axis] = *std::max_element(highs, highs + lanes);
        around.all.min[axis] = std::min(around.all.min[axis], group.min[axis]);
        around.all.max[axis] = std::max(around.all.max[axis], group.max[axis]);
    }
}

void bound_boxes_simd(const BoxBlock& boxes, int count, BlockBounds& around) {
    bound_axis(boxes.center_x, boxes.half_x, count, 0, around);
    bound_axis(boxes.center_y, boxes.half_y, count, 1, around);
    bound_axis(boxes.center_z, boxes.half_z, count, 2, around);
}

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(bound_boxes_simd);
HWY_EXPORT(cull_boxes_simd);

Frustum make_frustum(const Mat4& clip_from_world) {
    const Mat4 rows = glm::transpose(clip_from_world);
    Frustum frustum = {{
        rows[3] + rows[0],  // x >= -w
        rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
        rows[3] - rows[2],  // depth <= 1: beyond the near plane
    }};
    for (Vec4& plane : frustum.planes) {
        plane /= std::max(glm::length(Vec3(plane)), 1e-20f);
    }
    return frustum;
}

void cull_boxes(
    const Frustum& frustum, const BoxBlock& boxes, int count, std::span<std::uint8_t> visible) {
    LIMN_CHECK(count <= kCullBlock && visible.size() >= static_cast<std::size_t>(count));
    HWY_DYNAMIC_DISPATCH(cull_boxes_simd)(frustum, boxes, 0, count, visible.data());
}

Containment contains(const Frustum& frustum, const Bounds& box) {
    if (is_empty(box)) {
        return Containment::Outside;
    }
    constexpr float kRounding = 1e-5f;  // of the terms of a distance
    const Vec3 c = center(box);
    const Vec3 h = half_extent(box);
    bool inside = true;
    for (const Vec4& plane : frustum.planes) {
        const Vec3 away = glm::abs(Vec3(plane));
        const float extent = glm::dot(away, h);
        const float distance = glm::dot(Vec3(plane), c) + plane.w;
        const float rounding =
            kRounding * (extent + glm::dot(away, glm::abs(c)) + std::abs(plane.w));
        if (distance + extent < -rounding) {
            return Containment::Outside;
        }
        inside = inside && distance - extent > rounding;  // false for what is not finite
    }
    return inside ? Containment::Inside : Containment::Partly;
}

BlockBounds bounds_around(const BoxBlock& boxes, int count) {
    LIMN_CHECK(count <= kCullBlock);
    BlockBounds around;
    HWY_DYNAMIC_DISPATCH(bound_boxes_simd)(boxes, count, around);
    return around;
}

int cull_boxes_within(
    const Frustum& frustum, const BlockBounds& around, const BoxBlock& boxes, int count,
    std::span<std::uint8_t> visible) {
    LIMN_CHECK(count <= kCullBlock && visible.size() >= static_cast<std::size_t>(count));
    const auto fill = [&visible](int first, int size, Containment whole) {
        std::fill_n(
            visible.begin() + first, size,
            static_cast<std::uint8_t>(whole == Containment::Inside ? 1 : 0));
    };
    int tested = 1;
    if (const Containment all = contains(frustum, around.all); all != Containment::Partly) {
        fill(0, count, all);
        return tested;
    }
    for (int first = 0; first < count; first += kCullGroup) {
        const int size = std::min(count - first, kCullGroup);
        const Containment group = contains(frustum, around.groups[first / kCullGroup]);
        ++tested;
        if (group != Containment::Partly) {
            fill(first, size, group);
            continue;
        }
        HWY_DYNAMIC_DISPATCH(cull_boxes_simd)
        (frustum, boxes, first, first + size, visible.data());
        tested += size;
    }
    return tested;
}

void cull_boxes_by_distance(
    const Vec3& center, float radius, const BoxBlock& boxes, int count,
    std::span<std::uint8_t> visible) {
    for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec3 c = boxes.center(k);
        const Vec3 h = boxes.half(k);
        visible[k] &= sphere_touches(center, radius, {c - h, c + h});
    }
}

void cull_visible_boxes(
    const Frustum& frustum, const BoxBlock& boxes, int count, std::span<std::uint8_t> visible) {
    std::uint8_t inside[kCullBlock];
    cull_boxes(frustum, boxes, count, inside);
    for (int i = 0; i < count; ++i) {
        visible[static_cast<std::size_t>(i)] &= inside[i];
    }
}

void cull_boxes_scalar(
    const Frustum& frustum, const BoxBlock& boxes, int count, std::span<std::uint8_t> visible) {
    LIMN_CHECK(count <= kCullBlock && visible.size() >= static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        float nearest = INFINITY;
        for (const Vec4& p : frustum.planes) {
            const float extent = boxes.half_x[i] * std::abs(p.x) + boxes.half_y[i] * std::abs(p.y)
                                 + boxes.half_z[i] * std::abs(p.z);
            const float along =
                boxes.center_x[i] * p.x + boxes.center_y[i] * p.y + boxes.center_z[i] * p.z + p.w;
            nearest = std::min(nearest, along + extent);
        }
        visible[static_cast<std::size_t>(i)] = nearest >= 0.0f ? 1 : 0;
    }
}

}  // namespace limn
#endif
