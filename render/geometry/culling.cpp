#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/geometry/culling.cpp"
#include "render/geometry/culling.h"

#include "ecs/base/check.h"

#include <glm/geometric.hpp>
#include <hwy/foreach_target.h>  // compiles what follows once for every instruction set
#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void cull_boxes_simd(
    const Frustum& frustum, const BoxBlock& boxes, int count, std::uint8_t* visible) {
    const hn::ScalableTag<float> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    alignas(64) std::int32_t inside[hn::MaxLanes(d)];
    const hn::RebindToSigned<decltype(d)> di;

    for (int i = 0; i < count; i += lanes) {
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

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

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
    HWY_DYNAMIC_DISPATCH(cull_boxes_simd)(frustum, boxes, count, visible.data());
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
