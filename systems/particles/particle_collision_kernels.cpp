#include "systems/particles/particle_collision_kernels.h"

#include "ecs/base/check.h"

#include <glm/geometric.hpp>
#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/particles/particle_collision_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Techniques: particle.constraints

#ifndef LIMN_PARTICLE_SURFACES
#define LIMN_PARTICLE_SURFACES
namespace limn::particle_surface {

/// Colliders and responses as the kernels read them.
struct Response {
    float bounce, friction;
};
struct Plane {
    Vec3 normal;
    float level;
};
struct Sphere {
    Vec3 center;
    float radius, radius2;
    bool inverted;
};
struct Field {
    Vec3 origin;     ///< y: raised by the radius of the particles
    Vec2 per_meter;  ///< 1 / cell
    Vec2 last;       ///< grid coordinates of the last point
    int width, last_i, last_j;
    std::span<const float> heights;
};

}  // namespace limn::particle_surface
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {
namespace {

using namespace particle_surface;

// Each returns the number of particles processed; the scalar version handles the remainder.

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE  // no vectors, or none that structs can hold

std::size_t plane_vector(const ParticleColumns&, const Plane&, const Response&) {
    return 0;
}
std::size_t sphere_vector(const ParticleColumns&, const Sphere&, const Response&) {
    return 0;
}
std::size_t field_vector(const ParticleColumns&, const Field&, const Response&) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using M = hn::Mask<Floats>;
constexpr Floats d;
constexpr Ints ints;

struct V3 {
    V x, y, z;
};

HWY_INLINE V3 set(const Vec3& v) {
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
HWY_INLINE V dot(const V3& a, const V3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 load(
    const std::span<float>& x, const std::span<float>& y, const std::span<float>& z,
    std::size_t i) {
    return {hn::LoadU(d, x.data() + i), hn::LoadU(d, y.data() + i), hn::LoadU(d, z.data() + i)};
}

/// Writes the new velocities of particles that are `inside` and not leaving.
HWY_INLINE void respond_lanes(
    const ParticleColumns& p, std::size_t i, M inside, const V3& normal, const Response& response) {
    const V3 v = load(p.vx, p.vy, p.vz, i);
    const V speed = dot(v, normal);
    const M enters = hn::And(inside, hn::Lt(speed, hn::Zero(d)));
    const auto write = [&](float* to, V component, V along) {
        const V across = hn::Mul(speed, along);
        const V after = hn::Sub(
            hn::Mul(hn::Set(d, response.friction), hn::Sub(component, across)),
            hn::Mul(hn::Set(d, response.bounce), across));
        hn::StoreU(hn::IfThenElse(enters, after, component), d, to + i);
    };
    write(p.vx.data(), v.x, normal.x);
    write(p.vy.data(), v.y, normal.y);
    write(p.vz.data(), v.z, normal.z);
}

/// Calls touch(i) for those whole vectors for which may_touch(i). Few may: their velocities, which
/// are not read otherwise, are prefetched before the first one is needed. Returns the number of
/// particles in whole vectors.
template <typename MayTouch, typename Touch>
HWY_INLINE std::size_t each_touched(const ParticleColumns& p, MayTouch may_touch, Touch touch) {
    constexpr std::size_t kBlock = 2048;
    const std::size_t lanes = hn::Lanes(d);
    const std::size_t end = p.px.size() / lanes * lanes;
    std::array<std::size_t, kBlock / 4 + 1> touched;  // vectors have 4 lanes or more
    for (std::size_t begin = 0; begin < end; begin += kBlock) {
        std::size_t count = 0;
        for (std::size_t i = begin; i < std::min(begin + kBlock, end); i += lanes) {
            touched[count] = i;
            count += may_touch(i) ? 1 : 0;
        }
        for (std::size_t k = 0; k < count; ++k) {
            hwy::Prefetch(p.vx.data() + touched[k]);
            hwy::Prefetch(p.vy.data() + touched[k]);
            hwy::Prefetch(p.vz.data() + touched[k]);
        }
        for (std::size_t k = 0; k < count; ++k) {
            touch(touched[k]);
        }
    }
    return end;
}

std::size_t plane_vector(const ParticleColumns& p, const Plane& plane, const Response& response) {
    const V3 normal = set(plane.normal);
    const V level = hn::Set(d, plane.level);
    const auto distance_of = [&](const V3& at) HWY_ATTR { return hn::Sub(dot(at, normal), level); };
    const auto may_touch = [&](std::size_t i) HWY_ATTR {
        return !hn::AllFalse(d, hn::Lt(distance_of(load(p.px, p.py, p.pz, i)), hn::Zero(d)));
    };
    return each_touched(p, may_touch, [&](std::size_t i) HWY_ATTR {
        const V3 at = load(p.px, p.py, p.pz, i);
        const V distance = distance_of(at);
        const M inside = hn::Lt(distance, hn::Zero(d));
        const auto write = [&](float* to, V component, V along) HWY_ATTR {
            const V out = hn::Sub(component, hn::Mul(distance, along));
            hn::StoreU(hn::IfThenElse(inside, out, component), d, to + i);
        };
        write(p.px.data(), at.x, normal.x);
        write(p.py.data(), at.y, normal.y);
        write(p.pz.data(), at.z, normal.z);
        respond_lanes(p, i, inside, normal, response);
    });
}

std::size_t
sphere_vector(const ParticleColumns& p, const Sphere& sphere, const Response& response) {
    const V3 center = set(sphere.center);
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, 1.0f);
    const V radius = hn::Set(d, sphere.radius);
    const V radius2 = hn::Set(d, sphere.radius2);
    const auto offset_of = [&](const V3& at) HWY_ATTR {
        return V3{hn::Sub(at.x, center.x), hn::Sub(at.y, center.y), hn::Sub(at.z, center.z)};
    };
    const auto is_inside = [&](V length2) HWY_ATTR {
        return sphere.inverted ? hn::Gt(length2, radius2) : hn::Lt(length2, radius2);
    };
    const auto may_touch = [&](std::size_t i) HWY_ATTR {
        const V3 offset = offset_of(load(p.px, p.py, p.pz, i));
        return !hn::AllFalse(d, is_inside(dot(offset, offset)));
    };
    return each_touched(p, may_touch, [&](std::size_t i) HWY_ATTR {
        const V3 at = load(p.px, p.py, p.pz, i);
        const V3 offset = offset_of(at);
        const V length2 = dot(offset, offset);
        const M inside = is_inside(length2);
        const M off_center = hn::Gt(length2, zero);
        const V scale = hn::IfThenElseZero(off_center, hn::Div(one, hn::Sqrt(length2)));
        V3 outward = {
            hn::Mul(offset.x, scale), hn::IfThenElse(off_center, hn::Mul(offset.y, scale), one),
            hn::Mul(offset.z, scale)};
        const auto write = [&](float* to, V component, V origin, V along) HWY_ATTR {
            const V out = hn::Add(origin, hn::Mul(radius, along));
            hn::StoreU(hn::IfThenElse(inside, out, component), d, to + i);
        };
        write(p.px.data(), at.x, center.x, outward.x);
        write(p.py.data(), at.y, center.y, outward.y);
        write(p.pz.data(), at.z, center.z, outward.z);
        if (sphere.inverted) {
            outward = {hn::Neg(outward.x), hn::Neg(outward.y), hn::Neg(outward.z)};
        }
        respond_lanes(p, i, inside, outward, response);
    });
}

/// An upper bound of the surface, rounding included; NaN does not count, since nothing is below it.
/// Infinity if reading all points would take longer than it saves.
HWY_INLINE float find_highest(const Field& field, std::size_t particles) {
    const std::size_t lanes = hn::Lanes(d);
    if (particles < field.heights.size() || field.heights.size() < lanes) {
        return std::numeric_limits<float>::infinity();
    }
    V highest = hn::Set(d, std::numeric_limits<float>::lowest());
    V largest = hn::Zero(d);
    for (std::size_t i = 0; i < field.heights.size(); i += lanes) {
        // The last vector overlaps the one before.
        const std::size_t at = std::min(i, field.heights.size() - lanes);
        const V height = hn::LoadU(d, field.heights.data() + at);
        highest = hn::IfThenElse(hn::Gt(height, highest), height, highest);
        largest = hn::IfThenElse(hn::Gt(hn::Abs(height), largest), hn::Abs(height), largest);
    }
    constexpr float kRounding = 1e-5f;
    const float size = hn::GetLane(hn::MaxOfLanes(d, largest)) + std::abs(field.origin.y);
    return hn::GetLane(hn::MaxOfLanes(d, highest)) + field.origin.y + kRounding * size;
}

/// The heights at the corners of each lane's cell. Copying pairs of neighbors takes half the time
/// of four gathers.
HWY_INLINE void
load_corners(const Field& field, hn::Vec<Ints> index, V& h00, V& h10, V& h01, V& h11) {
    HWY_ALIGN std::int32_t first[hn::MaxLanes(d)];
    HWY_ALIGN float corners[4 * hn::MaxLanes(d)];
    hn::Store(index, ints, first);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
        const float* const row = field.heights.data() + first[lane];
        std::memcpy(corners + 4 * lane, row, 2 * sizeof(float));
        std::memcpy(corners + 4 * lane + 2, row + field.width, 2 * sizeof(float));
    }
    hn::LoadInterleaved4(d, corners, h00, h10, h01, h11);
}

std::size_t field_vector(const ParticleColumns& p, const Field& field, const Response& response) {
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, 1.0f);
    const V highest = hn::Set(d, find_highest(field, p.px.size()));
    const auto may_touch = [&](std::size_t i) HWY_ATTR {
        return !hn::AllFalse(d, hn::Lt(hn::LoadU(d, p.py.data() + i), highest));
    };
    return each_touched(p, may_touch, [&](std::size_t i) HWY_ATTR {
        const V3 at = load(p.px, p.py, p.pz, i);
        const V x =
            hn::Mul(hn::Sub(at.x, hn::Set(d, field.origin.x)), hn::Set(d, field.per_meter.x));
        const V z =
            hn::Mul(hn::Sub(at.z, hn::Set(d, field.origin.z)), hn::Set(d, field.per_meter.y));
        const M in_grid = hn::And(
            hn::And(hn::Ge(x, zero), hn::Le(x, hn::Set(d, field.last.x))),
            hn::And(hn::Ge(z, zero), hn::Le(z, hn::Set(d, field.last.y))));
        const M low = hn::And(in_grid, hn::Lt(at.y, highest));
        if (hn::AllFalse(d, low)) {
            return;
        }
        const auto cell_x =
            hn::Min(hn::ConvertTo(ints, hn::IfThenElseZero(low, x)), hn::Set(ints, field.last_i));
        const auto cell_z =
            hn::Min(hn::ConvertTo(ints, hn::IfThenElseZero(low, z)), hn::Set(ints, field.last_j));
        const V fx = hn::Sub(x, hn::ConvertTo(d, cell_x));
        const V fz = hn::Sub(z, hn::ConvertTo(d, cell_z));
        const auto index = hn::Add(hn::Mul(cell_z, hn::Set(ints, field.width)), cell_x);
        V h00;
        V h10;
        V h01;
        V h11;
        load_corners(field, index, h00, h10, h01, h11);
        const V along_x = hn::Sub(h10, h00);
        const V along_z = hn::Sub(h01, h00);
        const V twist = hn::Sub(hn::Sub(h11, h10), along_z);
        const V slope_x = hn::Add(along_x, hn::Mul(twist, fz));
        const V surface = hn::Add(
            hn::Add(hn::Add(h00, hn::Mul(slope_x, fx)), hn::Mul(along_z, fz)),
            hn::Set(d, field.origin.y));
        const M inside = hn::And(low, hn::Lt(at.y, surface));
        if (hn::AllFalse(d, inside)) {
            return;
        }
        hn::StoreU(hn::IfThenElse(inside, surface, at.y), d, p.py.data() + i);
        const V slope_z = hn::Add(along_z, hn::Mul(twist, fx));
        const V nx = hn::Mul(hn::Neg(slope_x), hn::Set(d, field.per_meter.x));
        const V nz = hn::Mul(hn::Neg(slope_z), hn::Set(d, field.per_meter.y));
        const V scale =
            hn::Div(one, hn::Sqrt(hn::Add(hn::Add(hn::Mul(nx, nx), one), hn::Mul(nz, nz))));
        respond_lanes(p, i, inside, {hn::Mul(nx, scale), scale, hn::Mul(nz, scale)}, response);
    });
}

#endif  // HWY_TARGET

}  // namespace
}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(plane_vector);
HWY_EXPORT(sphere_vector);
HWY_EXPORT(field_vector);

namespace {

using namespace particle_surface;

Response prepare(const SurfaceResponse& response) {
    return {std::clamp(response.bounce, 0.0f, 1.0f), std::clamp(response.friction, 0.0f, 1.0f)};
}

Plane prepare(const PlaneCollider& plane, float radius) {
    return {normalize_or(plane.normal, Vec3(0, 1, 0)), plane.offset + radius};
}

Sphere prepare(const SphereCollider& sphere, float radius) {
    const float touch =
        std::max(sphere.inverted ? sphere.radius - radius : sphere.radius + radius, 0.0f);
    return {sphere.center, touch, touch * touch, sphere.inverted};
}

Field prepare(const HeightCollider& field, float radius) {
    LIMN_CHECK(field.width >= 2 && field.depth >= 2);
    LIMN_CHECK(field.heights.size() >= static_cast<std::size_t>(field.width * field.depth));
    return {
        .origin = field.origin + Vec3(0, radius, 0),
        .per_meter = 1.0f / field.cell,
        .last = {static_cast<float>(field.width - 1), static_cast<float>(field.depth - 1)},
        .width = field.width,
        .last_i = field.width - 2,
        .last_j = field.depth - 2,
        .heights = field.heights};
}

void check_sizes(const ParticleColumns& p) {
    const std::size_t count = p.px.size();
    LIMN_CHECK(p.py.size() == count && p.pz.size() == count && p.vx.size() == count);
    LIMN_CHECK(p.vy.size() == count && p.vz.size() == count);
}

void respond_one(const ParticleColumns& p, std::size_t i, const Vec3& n, const Response& response) {
    const float speed = p.vx[i] * n.x + p.vy[i] * n.y + p.vz[i] * n.z;
    if (speed < 0) {
        const Vec3 across = speed * n;
        p.vx[i] = response.friction * (p.vx[i] - across.x) - response.bounce * across.x;
        p.vy[i] = response.friction * (p.vy[i] - across.y) - response.bounce * across.y;
        p.vz[i] = response.friction * (p.vz[i] - across.z) - response.bounce * across.z;
    }
}

void collide_from(
    const ParticleColumns& p, const Plane& plane, const Response& response, std::size_t begin) {
    const Vec3 n = plane.normal;
    for (std::size_t i = begin; i < p.px.size(); ++i) {
        const float distance = p.px[i] * n.x + p.py[i] * n.y + p.pz[i] * n.z - plane.level;
        if (distance < 0) {
            p.px[i] -= distance * n.x;
            p.py[i] -= distance * n.y;
            p.pz[i] -= distance * n.z;
            respond_one(p, i, n, response);
        }
    }
}

void collide_from(
    const ParticleColumns& p, const Sphere& sphere, const Response& response, std::size_t begin) {
    for (std::size_t i = begin; i < p.px.size(); ++i) {
        const Vec3 delta = Vec3(p.px[i], p.py[i], p.pz[i]) - sphere.center;
        const float length2 = delta.x * delta.x + delta.y * delta.y + delta.z * delta.z;
        if (sphere.inverted ? length2 > sphere.radius2 : length2 < sphere.radius2) {
            const Vec3 outward = length2 > 0 ? delta * (1.0f / std::sqrt(length2)) : Vec3(0, 1, 0);
            p.px[i] = sphere.center.x + sphere.radius * outward.x;
            p.py[i] = sphere.center.y + sphere.radius * outward.y;
            p.pz[i] = sphere.center.z + sphere.radius * outward.z;
            respond_one(p, i, sphere.inverted ? -outward : outward, response);
        }
    }
}

void collide_from(
    const ParticleColumns& p, const Field& field, const Response& response, std::size_t begin) {
    for (std::size_t i = begin; i < p.px.size(); ++i) {
        const float x = (p.px[i] - field.origin.x) * field.per_meter.x;
        const float z = (p.pz[i] - field.origin.z) * field.per_meter.y;
        if (!(x >= 0 && x <= field.last.x && z >= 0 && z <= field.last.y)) {
            continue;
        }
        const int cell_x = std::min(static_cast<int>(x), field.last_i);
        const int cell_z = std::min(static_cast<int>(z), field.last_j);
        const float fx = x - static_cast<float>(cell_x);
        const float fz = z - static_cast<float>(cell_z);
        const float* const h = field.heights.data() + cell_z * field.width + cell_x;
        const float along_x = h[1] - h[0];
        const float along_z = h[field.width] - h[0];
        const float twist = h[field.width + 1] - h[1] - along_z;
        const float slope_x = along_x + twist * fz;
        const float surface = h[0] + slope_x * fx + along_z * fz + field.origin.y;
        if (p.py[i] < surface) {
            p.py[i] = surface;
            const float slope_z = along_z + twist * fx;
            const float nx = -slope_x * field.per_meter.x;
            const float nz = -slope_z * field.per_meter.y;
            const float scale = 1.0f / std::sqrt(nx * nx + 1.0f + nz * nz);
            respond_one(p, i, {nx * scale, scale, nz * scale}, response);
        }
    }
}

}  // namespace

void collide_plane(
    const ParticleColumns& particles, const PlaneCollider& plane, const SurfaceResponse& response,
    float radius) {
    check_sizes(particles);
    const Plane surface = prepare(plane, radius);
    const Response kept = prepare(response);
    const std::size_t done = HWY_DYNAMIC_DISPATCH(plane_vector)(particles, surface, kept);
    collide_from(particles, surface, kept, done);
}

void collide_plane_scalar(
    const ParticleColumns& particles, const PlaneCollider& plane, const SurfaceResponse& response,
    float radius) {
    check_sizes(particles);
    collide_from(particles, prepare(plane, radius), prepare(response), 0);
}

void collide_sphere(
    const ParticleColumns& particles, const SphereCollider& sphere, const SurfaceResponse& response,
    float radius) {
    check_sizes(particles);
    const Sphere surface = prepare(sphere, radius);
    const Response kept = prepare(response);
    const std::size_t done = HWY_DYNAMIC_DISPATCH(sphere_vector)(particles, surface, kept);
    collide_from(particles, surface, kept, done);
}

void collide_sphere_scalar(
    const ParticleColumns& particles, const SphereCollider& sphere, const SurfaceResponse& response,
    float radius) {
    check_sizes(particles);
    collide_from(particles, prepare(sphere, radius), prepare(response), 0);
}

void collide_height_field(
    const ParticleColumns& particles, const HeightCollider& field, const SurfaceResponse& response,
    float radius) {
    check_sizes(particles);
    const Field surface = prepare(field, radius);
    const Response kept = prepare(response);
    const std::size_t done = HWY_DYNAMIC_DISPATCH(field_vector)(particles, surface, kept);
    collide_from(particles, surface, kept, done);
}

void collide_height_field_scalar(
    const ParticleColumns& particles, const HeightCollider& field, const SurfaceResponse& response,
    float radius) {
    check_sizes(particles);
    collide_from(particles, prepare(field, radius), prepare(response), 0);
}

}  // namespace limn
#endif  // HWY_ONCE
