#include "systems/particles/collider_bounds.h"

#include "ecs/base/check.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/particles/collider_bounds.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#ifndef LIMN_COLLIDER_BOUNDS
#define LIMN_COLLIDER_BOUNDS
namespace limn::collider_bounds {

inline constexpr float kSkin = 0x1p-20f;  // of coordinates: 8 units in the last place

}  // namespace limn::collider_bounds
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {
namespace {

// Returns how many of `count` it has tested; the scalar version handles the remainder.

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE  // no vectors, or none that structs can hold

std::size_t find_near_vector(
    const ParticlePaths&, std::size_t, std::size_t, std::span<const ColliderBounds>, std::uint32_t*,
    std::size_t&) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using Words = hn::RebindToUnsigned<Floats>;
using V = hn::Vec<Floats>;
using M = hn::Mask<Floats>;
constexpr Floats d;
constexpr Ints di;
constexpr Words du;

struct V3 {
    V x, y, z;
};

HWY_INLINE V set(float x) {
    return hn::Set(d, x);
}
HWY_INLINE V dot(const V3& a, const V3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 set(const Vec3& v) {
    return {set(v.x), set(v.y), set(v.z)};
}
HWY_INLINE V3 minus(const V3& a, const V3& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V largest_of(const V3& v) {
    return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
}
HWY_INLINE V3
load(std::span<const float> x, std::span<const float> y, std::span<const float> z, std::size_t i) {
    return {hn::LoadU(d, x.data() + i), hn::LoadU(d, y.data() + i), hn::LoadU(d, z.data() + i)};
}

/// Beyond one of the two sides of a slab at both ends.
HWY_INLINE M beyond(V from, V to, float min, float max, V grow) {
    const V low = hn::Sub(set(min), grow);
    const V high = hn::Add(set(max), grow);
    return hn::Or(
        hn::And(hn::Lt(from, low), hn::Lt(to, low)), hn::And(hn::Gt(from, high), hn::Gt(to, high)));
}

HWY_INLINE M far_from_box(const Bounds& box, const V3& from, const V3& to, V grow) {
    return hn::Or(
        hn::Or(
            beyond(from.x, to.x, box.min.x, box.max.x, grow),
            beyond(from.y, to.y, box.min.y, box.max.y, grow)),
        beyond(from.z, to.z, box.min.z, box.max.z, grow));
}

HWY_INLINE M far_above_field(
    const ColliderBounds& bounds, const V3& from, const V3& to, const V3& path, V grow) {
    const HeightCollider& field = bounds.field;
    const V zero = hn::Zero(d);
    const auto coordinate = [&](V at, float origin, float cell, int points) {
        const V u = hn::Mul(hn::Sub(at, set(origin)), set(1.0f / cell));
        const V last = set(static_cast<float>(points - 1));
        const V above = hn::IfThenElse(hn::Gt(u, zero), u, zero);  // NaN: 0
        return hn::IfThenElse(hn::Lt(above, last), above, last);
    };
    const V x = coordinate(from.x, field.origin.x, field.cell.x, field.width);
    const V z = coordinate(from.z, field.origin.z, field.cell.y, field.depth);
    const auto i = hn::Min(hn::ConvertTo(di, x), hn::Set(di, field.width - 2));
    const auto j = hn::Min(hn::ConvertTo(di, z), hn::Set(di, field.depth - 2));
    const V fx = hn::Sub(x, hn::ConvertTo(d, i));
    const V fz = hn::Sub(z, hn::ConvertTo(d, j));
    const auto index = hn::Add(hn::Mul(j, hn::Set(di, field.width)), i);
    const float* const heights = field.heights.data();
    const V h00 = hn::GatherIndex(d, heights, index);
    const V h10 = hn::GatherIndex(d, heights + 1, index);
    const V h01 = hn::GatherIndex(d, heights + field.width, index);
    const V h11 = hn::GatherIndex(d, heights + field.width + 1, index);
    const V back = hn::Add(h00, hn::Mul(hn::Sub(h10, h00), fx));
    const V front = hn::Add(h01, hn::Mul(hn::Sub(h11, h01), fx));
    const V surface =
        hn::Add(set(field.origin.y), hn::Add(back, hn::Mul(hn::Sub(front, back), fz)));
    const V rise = hn::Add(
        hn::Mul(hn::Abs(path.x), set(bounds.slope.x)),
        hn::Mul(hn::Abs(path.z), set(bounds.slope.y)));
    const V highest = hn::Add(hn::Add(surface, rise), grow);
    return hn::And(hn::Gt(from.y, highest), hn::Gt(to.y, highest));
}

HWY_INLINE M far_from(
    const ColliderBounds& bounds, const V3& from, const V3& to, const V3& path, V radius,
    V margin) {
    const V grow = hn::Mul(hn::Add(radius, margin), set(bounds.stretch));
    switch (bounds.kind) {
    case ColliderBounds::Kind::Plane: {
        const V3 normal = set(bounds.normal);
        const V level = hn::Add(set(bounds.offset), grow);
        return hn::And(hn::Gt(dot(from, normal), level), hn::Gt(dot(to, normal), level));
    }
    case ColliderBounds::Kind::Hollow: {
        const V inner = hn::Max(hn::Sub(set(bounds.radius), grow), hn::Zero(d));
        const V3 a = minus(from, set(bounds.center));
        const V3 b = minus(to, set(bounds.center));
        const V inner2 = hn::Mul(inner, inner);
        return hn::And(hn::Lt(dot(a, a), inner2), hn::Lt(dot(b, b), inner2));
    }
    case ColliderBounds::Kind::Field: {
        const M far = far_from_box(bounds.box, from, to, grow);
        return hn::AllTrue(d, far) ? far
                                   : hn::Or(far, far_above_field(bounds, from, to, path, grow));
    }
    case ColliderBounds::Kind::Box:
        break;
    }
    return far_from_box(bounds.box, from, to, grow);
}

std::size_t find_near_vector(
    const ParticlePaths& paths, std::size_t first, std::size_t count,
    std::span<const ColliderBounds> bounds, std::uint32_t* out, std::size_t& found) {
    const std::size_t lanes = hn::Lanes(d);
    std::size_t done = 0;
    for (; done + lanes <= count; done += lanes) {
        const std::size_t i = first + done;
        const V3 from = load(paths.x0, paths.y0, paths.z0, i);
        const V3 to = load(paths.x1, paths.y1, paths.z1, i);
        const V3 path = minus(to, from);
        const V radius =
            paths.radius.empty() ? set(paths.one_radius) : hn::LoadU(d, paths.radius.data() + i);
        const V sum =
            hn::Add(hn::Add(hn::Add(from.x, from.y), from.z), hn::Add(hn::Add(to.x, to.y), to.z));
        M near = hn::Not(hn::Eq(hn::Sub(sum, sum), hn::Zero(d)));  // not finite
        const V size =
            hn::Mul(set(collider_bounds::kSkin), hn::Add(largest_of(from), largest_of(path)));
        const V skin = hn::Max(set(paths.skin), size);
        const V margin = hn::Add(skin, skin);
        for (const ColliderBounds& each : bounds) {
            near = hn::Or(near, hn::Not(far_from(each, from, to, path, radius, margin)));
        }
        if (!hn::AllFalse(d, near)) {
            const auto numbers = hn::Iota(du, static_cast<std::uint32_t>(i));
            const auto mask = hn::RebindMask(du, near);
            hn::StoreU(hn::Compress(numbers, mask), du, out + found);
            found += hn::CountTrue(du, mask);
        }
    }
    return done;
}

#endif  // HWY_TARGET

}  // namespace
}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(find_near_vector);

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// 4 radii beyond the end of the path, as first_contact tests, and one for the ball itself.
constexpr float kMeshRadii = 5;

float largest_of(const Vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

ColliderBounds bounds_of_shape(const PlaneCollider& plane) {
    return {
        .kind = ColliderBounds::Kind::Plane,
        .normal = normalize_or(plane.normal, Vec3(0, 1, 0)),
        .offset = plane.offset};
}

ColliderBounds bounds_of_shape(const SphereCollider& sphere) {
    if (sphere.inverted) {
        return {
            .kind = ColliderBounds::Kind::Hollow, .center = sphere.center, .radius = sphere.radius};
    }
    return {.box = {sphere.center - Vec3(sphere.radius), sphere.center + Vec3(sphere.radius)}};
}

ColliderBounds bounds_of_shape(const BoxCollider& box) {
    const Mat4 m = to_mat4(box.world_from_box);
    const Vec3 center(m[3]);
    Vec3 half(0);
    for (int axis = 0; axis < 3; ++axis) {
        half += glm::abs(Vec3(m[axis])) * box.half[axis];
    }
    return {.box = {center - half, center + half}};
}

ColliderBounds bounds_of_shape(const HeightCollider& field) {
    if (field.width < 2 || field.depth < 2) {
        return {};
    }
    LIMN_CHECK(field.heights.size() >= static_cast<std::size_t>(field.width * field.depth));
    ColliderBounds bounds = {.kind = ColliderBounds::Kind::Field, .field = field};
    float highest = -kInfinity;
    Vec2 rise(0);  // per cell; NaN compares false
    for (int j = 0; j < field.depth; ++j) {
        const float* const row = field.heights.data() + j * field.width;
        const float* const next = row + (j + 1 < field.depth ? field.width : 0);
        for (int i = 0; i < field.width; ++i) {
            const float across = std::abs(row[std::min(i + 1, field.width - 1)] - row[i]);
            const float along = std::abs(next[i] - row[i]);
            highest = row[i] > highest ? row[i] : highest;
            rise.x = across > rise.x ? across : rise.x;
            rise.y = along > rise.y ? along : rise.y;
        }
    }
    bounds.slope = rise / field.cell;
    const float x = static_cast<float>(field.width - 1) * field.cell.x;
    const float z = static_cast<float>(field.depth - 1) * field.cell.y;
    const Vec3 origin = field.origin;
    bounds.box = {
        {origin.x, -kInfinity, origin.z}, {origin.x + x, origin.y + highest, origin.z + z}};
    // A ball touches the tangent plane of its cell: on slopes, higher than a radius above.
    bounds.stretch = 1 + bounds.slope.x + bounds.slope.y;
    return bounds;
}

ColliderBounds bounds_of_shape(const MeshCollider& mesh) {
    ColliderBounds bounds = {.stretch = kMeshRadii};
    if (mesh.bvh != nullptr && !mesh.bvh->nodes.empty()) {
        const MeshBvh::Node& root = mesh.bvh->nodes[0];
        for (std::size_t child = 0; child < MeshBvh::kChildren; ++child) {
            if (root.child[child] != MeshBvh::kNoChild) {
                const auto& b = root.bounds;
                grow(bounds.box, Vec3(b[0][0][child], b[0][1][child], b[0][2][child]));
                grow(bounds.box, Vec3(b[1][0][child], b[1][1][child], b[1][2][child]));
            }
        }
    }
    return bounds;
}

// ---- the same as above, for one particle
// ---------------------------------------------------------

bool beyond(float from, float to, float min, float max, float grow) {
    const float low = min - grow;
    const float high = max + grow;
    return (from < low && to < low) || (from > high && to > high);
}

bool far_from_box(const Bounds& box, const Vec3& from, const Vec3& to, float grow) {
    return beyond(from.x, to.x, box.min.x, box.max.x, grow)
           || beyond(from.y, to.y, box.min.y, box.max.y, grow)
           || beyond(from.z, to.z, box.min.z, box.max.z, grow);
}

bool far_above_field(
    const ColliderBounds& bounds, const Vec3& from, const Vec3& to, const Vec3& path, float grow) {
    const HeightCollider& field = bounds.field;
    const auto coordinate = [](float at, float origin, float cell, int points) {
        const float u = (at - origin) * (1.0f / cell);
        const auto last = static_cast<float>(points - 1);
        const float above = u > 0 ? u : 0.0f;  // NaN: 0
        return above < last ? above : last;
    };
    const float x = coordinate(from.x, field.origin.x, field.cell.x, field.width);
    const float z = coordinate(from.z, field.origin.z, field.cell.y, field.depth);
    const int i = std::min(static_cast<int>(x), field.width - 2);
    const int j = std::min(static_cast<int>(z), field.depth - 2);
    const float fx = x - static_cast<float>(i);
    const float fz = z - static_cast<float>(j);
    const float* const h = field.heights.data() + j * field.width + i;
    const float back = h[0] + (h[1] - h[0]) * fx;
    const float front = h[field.width] + (h[field.width + 1] - h[field.width]) * fx;
    const float surface = field.origin.y + (back + (front - back) * fz);
    const float rise = std::abs(path.x) * bounds.slope.x + std::abs(path.z) * bounds.slope.y;
    const float highest = surface + rise + grow;
    return from.y > highest && to.y > highest;
}

float dot(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

bool is_far(
    const ColliderBounds& bounds, const Vec3& from, const Vec3& to, float radius, float margin) {
    const float grow = (radius + margin) * bounds.stretch;
    switch (bounds.kind) {
    case ColliderBounds::Kind::Plane: {
        const float level = bounds.offset + grow;
        return dot(from, bounds.normal) > level && dot(to, bounds.normal) > level;
    }
    case ColliderBounds::Kind::Hollow: {
        const float inner = std::max(bounds.radius - grow, 0.0f);
        const Vec3 a = from - bounds.center;
        const Vec3 b = to - bounds.center;
        return dot(a, a) < inner * inner && dot(b, b) < inner * inner;
    }
    case ColliderBounds::Kind::Field:
        return far_from_box(bounds.box, from, to, grow)
               || far_above_field(bounds, from, to, to - from, grow);
    case ColliderBounds::Kind::Box:
        break;
    }
    return far_from_box(bounds.box, from, to, grow);
}

std::size_t find_near_from(
    const ParticlePaths& paths, std::size_t first, std::size_t end,
    std::span<const ColliderBounds> bounds, std::uint32_t* out, std::size_t found) {
    for (std::size_t i = first; i < end; ++i) {
        const Vec3 from(paths.x0[i], paths.y0[i], paths.z0[i]);
        const Vec3 to(paths.x1[i], paths.y1[i], paths.z1[i]);
        const float radius = paths.radius.empty() ? paths.one_radius : paths.radius[i];
        const auto touches = [&](const ColliderBounds& each) {
            return may_touch(each, from, to, radius, paths.skin);
        };
        const bool unknown = !is_finite(from) || !is_finite(to);
        if (unknown || std::any_of(bounds.begin(), bounds.end(), touches)) {
            out[found++] = static_cast<std::uint32_t>(i);
        }
    }
    return found;
}

}  // namespace

ColliderBounds find_collider_bounds(const Collider& collider) {
    return std::visit([](const auto& shape) { return bounds_of_shape(shape); }, collider);
}

float skin_of(const Vec3& from, const Vec3& to, float skin) {
    return std::max(skin, collider_bounds::kSkin * (largest_of(from) + largest_of(to - from)));
}

bool may_touch(
    const ColliderBounds& bounds, const Vec3& from, const Vec3& to, float radius, float skin) {
    const float margin = 2 * skin_of(from, to, skin);
    return !is_finite(from) || !is_finite(to) || !is_far(bounds, from, to, radius, margin);
}

std::size_t find_near(
    const ParticlePaths& paths, std::size_t first, std::size_t count,
    std::span<const ColliderBounds> bounds, std::uint32_t* found) {
    std::size_t near = 0;
    const std::size_t done =
        HWY_DYNAMIC_DISPATCH(find_near_vector)(paths, first, count, bounds, found, near);
    return find_near_from(paths, first + done, first + count, bounds, found, near);
}

std::size_t find_near_scalar(
    const ParticlePaths& paths, std::size_t first, std::size_t count,
    std::span<const ColliderBounds> bounds, std::uint32_t* found) {
    return find_near_from(paths, first, first + count, bounds, found, 0);
}

}  // namespace limn
#endif  // HWY_ONCE
