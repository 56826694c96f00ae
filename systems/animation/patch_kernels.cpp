#include "systems/animation/patch_kernels.h"

#include "ecs/base/check.h"
#include "systems/animation/surface_patches.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/animation/patch_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
// Techniques: face.bids-rebuild

namespace limn::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR  // no vectors here

void move_by_patches_vector(const SurfaceShape& shape, std::span<Vec3> positions) {
    move_by_patches_scalar(shape, positions);
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using V = hn::Vec<Floats>;
constexpr Floats d;
constexpr std::size_t kMaxLanes = hn::MaxLanes(d);

namespace {

/// Squared lengths below which a vector has no direction, as in evaluate_patch and normalize_or.
constexpr float kMinNormal = 1e-20f;
constexpr float kMinTangent = 1e-30f;

struct V3 {
    V x, y, z;
};

HWY_INLINE V3 all(const Vec4& p) {
    return {hn::Set(d, p.x), hn::Set(d, p.y), hn::Set(d, p.z)};
}
HWY_INLINE V3 add(const V3& a, const V3& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE V3 subtract(const V3& a, const V3& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V3 scale(V by, const V3& a) {
    return {hn::Mul(by, a.x), hn::Mul(by, a.y), hn::Mul(by, a.z)};
}
HWY_INLINE V dot(const V3& a, const V3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 cross(const V3& a, const V3& b) {
    return {
        hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
        hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
        hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}

/// Barycentric coordinates.
struct Barycentric {
    V u, v, w;
};

/// Leaves of each position the share that does not move.
void scale_by_rest(std::span<const SurfaceAnchor> anchors, std::span<Vec3> positions) {
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (anchors[v].patch != kNoPatch) {
            float stays = 1.0f - anchors[v].share;
            for (std::size_t a = anchors[v].next; a != 0; a = anchors[a].next) {
                stays -= anchors[a].share;
            }
            positions[v] *= stays;
        }
    }
}

/// One step of de Casteljau.
HWY_INLINE V3 mix(const Barycentric& at, const V3& a, const V3& b, const V3& c) {
    return add(add(scale(at.u, a), scale(at.v, b)), scale(at.w, c));
}

/// Anchors of some vertices, side by side.
struct Lanes {
    HWY_ALIGN float u[kMaxLanes];
    HWY_ALIGN float v[kMaxLanes];
    HWY_ALIGN float x[kMaxLanes];
    HWY_ALIGN float y[kMaxLanes];
    HWY_ALIGN float z[kMaxLanes];
};

/// Position, and derivatives by u and v.
struct Point {
    V3 position, by_u, by_v;
};

/// Weight of an offset, 12 c^2 a^2 b / (a + b), and its derivatives by c, a and b.
struct Weight {
    V value, c, a, b;
};

HWY_INLINE Weight bend_weight(V c, V a, V b) {
    const V one = hn::Set(d, 1.0f);
    const V sum = hn::Add(a, b);
    const auto at_corner = hn::Le(sum, hn::Set(d, 1e-12f));
    const V ratio = hn::Clamp(hn::Div(a, hn::IfThenElse(at_corner, one, sum)), hn::Zero(d), one);
    const V p = hn::IfThenElse(at_corner, hn::Set(d, 0.5f), ratio);
    const V g = hn::Mul(hn::Mul(a, b), p);
    const V c2 = hn::Mul(hn::Mul(hn::Set(d, 12.0f), c), c);
    return {
        hn::Mul(c2, g), hn::Mul(hn::Mul(hn::Set(d, 24.0f), c), g),
        hn::Mul(c2, hn::Mul(hn::Mul(b, p), hn::Sub(hn::Set(d, 2.0f), p))),
        hn::Mul(c2, hn::Mul(a, hn::Mul(p, p)))};
}

/// Adds the offset for the coordinates c, a and b, in this order.
HWY_INLINE void add_bend(Point& at, const V3& offset, V value, V by_u, V by_v) {
    at.position = add(at.position, scale(value, offset));
    at.by_u = add(at.by_u, scale(by_u, offset));
    at.by_v = add(at.by_v, scale(by_v, offset));
}

/// Adds the six offsets. Derivatives by u and v are those by the three coordinates, less that by w.
HWY_INLINE void add_bends(const Vec4* bends, const Barycentric& on, Point& at) {
    const Weight uv = bend_weight(on.u, on.v, on.w);
    add_bend(at, all(bends[0]), uv.value, hn::Sub(uv.c, uv.b), hn::Sub(uv.a, uv.b));
    const Weight vu = bend_weight(on.v, on.u, on.w);
    add_bend(at, all(bends[1]), vu.value, hn::Sub(vu.a, vu.b), hn::Sub(vu.c, vu.b));
    const Weight vw = bend_weight(on.v, on.w, on.u);
    add_bend(at, all(bends[2]), vw.value, hn::Sub(vw.b, vw.a), hn::Sub(vw.c, vw.a));
    const Weight wv = bend_weight(on.w, on.v, on.u);
    add_bend(at, all(bends[3]), wv.value, hn::Sub(wv.b, wv.c), hn::Sub(wv.a, wv.c));
    const Weight wu = bend_weight(on.w, on.u, on.v);
    add_bend(at, all(bends[4]), wu.value, hn::Sub(wu.a, wu.c), hn::Sub(wu.b, wu.c));
    const Weight uw = bend_weight(on.u, on.w, on.v);
    add_bend(at, all(bends[5]), uw.value, hn::Sub(uw.c, uw.a), hn::Sub(uw.b, uw.a));
}

/// Like evaluate_patch, plus the anchor's offset. False if a vertex has no normal or no tangent,
/// because markers coincide: the scalar version handles that.
HWY_INLINE bool move_lanes(const Vec4* patch, Lanes& lanes) {
    Barycentric at = {hn::Load(d, lanes.u), hn::Load(d, lanes.v), hn::Zero(d)};
    at.w = hn::Sub(hn::Sub(hn::Set(d, 1.0f), at.u), at.v);
    const auto step = [&](std::size_t a, std::size_t b, std::size_t c)
                          HWY_ATTR { return mix(at, all(patch[a]), all(patch[b]), all(patch[c])); };
    const V3 q200 = step(0, 3, 8);
    const V3 q020 = step(4, 1, 5);
    const V3 q002 = step(7, 6, 2);
    const V3 q110 = step(3, 4, 9);
    const V3 q011 = step(9, 5, 6);
    const V3 q101 = step(8, 9, 7);
    const V3 r100 = mix(at, q200, q110, q101);
    const V3 r010 = mix(at, q110, q020, q011);
    const V3 r001 = mix(at, q101, q011, q002);
    const V three = hn::Set(d, 3.0f);
    Point on = {
        mix(at, r100, r010, r001), scale(three, subtract(r100, r001)),
        scale(three, subtract(r010, r001))};
    add_bends(patch + kPatchPoints, at, on);
    const V3 sum = mix(at, step(16, 19, 21), step(19, 17, 20), step(21, 20, 18));
    const V length2 = dot(sum, sum);
    if (!hn::AllTrue(d, hn::Gt(length2, hn::Set(d, kMinNormal)))) {
        return false;
    }
    const V3 normal = scale(hn::Div(hn::Set(d, 1.0f), hn::Sqrt(length2)), sum);
    V3 p = on.position;
    const V x = hn::Load(d, lanes.x);
    const V y = hn::Load(d, lanes.y);
    // Most are perpendicularly above the surface.
    if (!hn::AllTrue(d, hn::And(hn::Eq(x, hn::Zero(d)), hn::Eq(y, hn::Zero(d))))) {
        const V3 along = subtract(on.by_u, scale(dot(on.by_u, normal), normal));
        const V along2 = dot(along, along);
        if (!hn::AllTrue(d, hn::Gt(along2, hn::Set(d, kMinTangent)))) {
            return false;
        }
        const V3 tangent = scale(hn::Div(hn::Set(d, 1.0f), hn::Sqrt(along2)), along);
        p = add(p, add(scale(x, tangent), scale(y, cross(normal, tangent))));
    }
    p = add(p, scale(hn::Load(d, lanes.z), normal));
    hn::Store(p.x, d, lanes.x);
    hn::Store(p.y, d, lanes.y);
    hn::Store(p.z, d, lanes.z);
    return true;
}

/// Adds what anchors of one patch, at most as many as there are lanes, share of the motion.
HWY_INLINE void add_moved(
    const SurfaceShape& shape, std::span<const std::uint32_t> which, std::span<Vec3> positions) {
    Lanes lanes;
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {  // spare lanes repeat the last one
        const SurfaceAnchor& anchor = shape.anchors[which[std::min(i, which.size() - 1)]];
        lanes.u[i] = anchor.u;
        lanes.v[i] = anchor.v;
        lanes.x[i] = anchor.offset.x;
        lanes.y[i] = anchor.offset.y;
        lanes.z[i] = anchor.offset.z;
    }
    const std::size_t patch = shape.anchors[which[0]].patch;
    const bool moved = move_lanes(&shape.patches[patch * kPatchTexels], lanes);
    for (std::size_t i = 0; i < which.size(); ++i) {
        const SurfaceAnchor& anchor = shape.anchors[which[i]];
        positions[anchor.vertex] += anchor.share
                                    * (moved ? Vec3(lanes.x[i], lanes.y[i], lanes.z[i])
                                             : anchored_point(anchor, shape.patches));
    }
}

}  // namespace

void move_by_patches_vector(const SurfaceShape& shape, std::span<Vec3> positions) {
    const std::span<const std::uint32_t> order = shape.order;
    scale_by_rest(shape.anchors, positions);
    for (std::size_t i = 0; i < order.size();) {
        const std::uint32_t patch = shape.anchors[order[i]].patch;
        std::size_t count = 1;
        while (count < hn::Lanes(d) && i + count < order.size()
               && shape.anchors[order[i + count]].patch == patch) {
            ++count;
        }
        add_moved(shape, order.subspan(i, count), positions);
        i += count;
    }
}

#endif

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(move_by_patches_vector);

std::vector<std::uint32_t> order_by_patch(std::span<const SurfaceAnchor> anchors) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < anchors.size(); ++i) {
        if (anchors[i].patch != kNoPatch) {
            order.push_back(i);
        }
    }
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return anchors[a].patch < anchors[b].patch;
    });
    return order;
}

void move_by_patches(const SurfaceShape& shape, std::span<Vec3> positions) {
    LIMN_CHECK(shape.anchors.size() >= positions.size());
    HWY_DYNAMIC_DISPATCH(move_by_patches_vector)(shape, positions);
}

void move_by_patches_scalar(const SurfaceShape& shape, std::span<Vec3> positions) {
    follow_patches(shape.anchors, shape.patches, positions, {}, {});
}

}  // namespace limn
#endif  // HWY_ONCE
