#include "systems/motion_kernels.h"

#include "ecs/base/check.h"

#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/motion_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Fields are read and written as floats with these strides.
static_assert(sizeof(limn::Transform) == 10 * sizeof(float));
static_assert(sizeof(limn::WorldTransform) == 12 * sizeof(float));
static_assert(sizeof(limn::PreviousWorldTransform) == 12 * sizeof(float));
static_assert(sizeof(limn::Spin) == 4 * sizeof(float));

// Techniques: shade.stream-kernel

#ifndef LIMN_MOTION_CONSTANTS
#define LIMN_MOTION_CONSTANTS
namespace limn::motion {

inline constexpr double kTwoOverPi = 0.63661977236758134308;
inline constexpr double kHalfPi = 1.57079632679489661923;

// sin x = x + x^3 (s0 + s1 x^2 + s2 x^4), cos x = 1 - x^2/2 + x^4 (c0 + c1 x^2 + c2 x^4), |x| <=
// pi/4
inline constexpr float kSin0 = -1.6666654611e-1f;
inline constexpr float kSin1 = 8.3321608736e-3f;
inline constexpr float kSin2 = -1.9515295891e-4f;
inline constexpr float kCos0 = 4.166664568298827e-2f;
inline constexpr float kCos1 = -1.388731625493765e-3f;
inline constexpr float kCos2 = 2.443315711809948e-5f;

}  // namespace limn::motion
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {
namespace {

// Each returns the number of entities processed; the scalar version handles the remainder.

#if HWY_TARGET == HWY_SCALAR  // no vectors here

std::size_t compose_worlds_vector(
    std::span<const Transform>, std::span<WorldTransform>, std::span<PreviousWorldTransform>) {
    return 0;
}
std::size_t turn_rotations_vector(std::span<const Spin>, float, std::span<Transform>) {
    return 0;
}
std::size_t sway_positions_vector(const SwayArrays&, double, std::span<Transform>) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using V = hn::Vec<Floats>;
using HalfFloats = hn::Half<Floats>;
using Doubles = hn::Rebind<double, HalfFloats>;
constexpr Floats d;

/// Sine and cosine of the reduced angle, and the number of quarter turns removed, modulo 4.
struct SinCos {
    V sin;
    V cos;
    V quarter;
};

HWY_INLINE SinCos sin_cos_of_rest(V x, V quarter) {
    const V x2 = hn::Mul(x, x);
    const V s = hn::Add(
        hn::Mul(hn::Add(hn::Mul(hn::Set(d, motion::kSin2), x2), hn::Set(d, motion::kSin1)), x2),
        hn::Set(d, motion::kSin0));
    const V c = hn::Add(
        hn::Mul(hn::Add(hn::Mul(hn::Set(d, motion::kCos2), x2), hn::Set(d, motion::kCos1)), x2),
        hn::Set(d, motion::kCos0));
    const V sin = hn::Add(hn::Mul(hn::Mul(s, x2), x), x);
    const V cos = hn::Add(
        hn::Sub(hn::Set(d, 1.0f), hn::Mul(hn::Set(d, 0.5f), x2)), hn::Mul(hn::Mul(c, x2), x2));
    return {sin, cos, quarter};
}

/// Reduces frequency * time + phase by whole quarter turns, in double precision.
HWY_INLINE void reduce_half(
    hn::Vec<HalfFloats> frequency, double time, hn::Vec<HalfFloats> phase,
    hn::Vec<HalfFloats>& rest, hn::Vec<HalfFloats>& quarter) {
    const Doubles dd;
    const HalfFloats dh;
    const auto angle =
        hn::Add(hn::Mul(hn::PromoteTo(dd, frequency), hn::Set(dd, time)), hn::PromoteTo(dd, phase));
    const auto turns = hn::Round(hn::Mul(angle, hn::Set(dd, motion::kTwoOverPi)));
    const auto whole = hn::Floor(hn::Mul(turns, hn::Set(dd, 0.25)));
    rest = hn::DemoteTo(dh, hn::Sub(angle, hn::Mul(turns, hn::Set(dd, motion::kHalfPi))));
    quarter = hn::DemoteTo(dh, hn::Sub(turns, hn::Mul(whole, hn::Set(dd, 4.0))));
}

HWY_INLINE SinCos sin_cos_parts(V frequency, double time, V phase) {
    const HalfFloats dh;
    hn::Vec<HalfFloats> rest[2];
    hn::Vec<HalfFloats> quarter[2];
    reduce_half(hn::LowerHalf(dh, frequency), time, hn::LowerHalf(dh, phase), rest[0], quarter[0]);
    reduce_half(hn::UpperHalf(dh, frequency), time, hn::UpperHalf(dh, phase), rest[1], quarter[1]);
    return sin_cos_of_rest(
        hn::Combine(d, rest[1], rest[0]), hn::Combine(d, quarter[1], quarter[0]));
}

/// 0: sin, 1: cos, 2: -sin, 3: -cos.
HWY_INLINE V pick_sine(const SinCos& parts) {
    const auto odd =
        hn::Or(hn::Eq(parts.quarter, hn::Set(d, 1.0f)), hn::Eq(parts.quarter, hn::Set(d, 3.0f)));
    const V value = hn::IfThenElse(odd, parts.cos, parts.sin);
    return hn::IfThenElse(hn::Ge(parts.quarter, hn::Set(d, 2.0f)), hn::Neg(value), value);
}

/// 0: cos, 1: -sin, 2: -cos, 3: sin.
HWY_INLINE V pick_cosine(const SinCos& parts) {
    const auto odd =
        hn::Or(hn::Eq(parts.quarter, hn::Set(d, 1.0f)), hn::Eq(parts.quarter, hn::Set(d, 3.0f)));
    const auto negative =
        hn::Or(hn::Eq(parts.quarter, hn::Set(d, 1.0f)), hn::Eq(parts.quarter, hn::Set(d, 2.0f)));
    const V value = hn::IfThenElse(odd, parts.sin, parts.cos);
    return hn::IfThenElse(negative, hn::Neg(value), value);
}

/// Loads four consecutive floats of each struct of `Stride` floats, starting at `first`, one vector
/// per field. Goes through the stack in 16-byte pieces, which is faster than gather instructions.
template <int Stride>
HWY_INLINE void load_fields(const float* first, V& a, V& b, V& c, V& e) {
    HWY_ALIGN float staged[4 * hn::MaxLanes(Floats())];
    const hn::FixedTag<float, 4> d4;
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
        hn::Store(hn::LoadU(d4, first + Stride * lane), d4, staged + 4 * lane);
    }
    hn::LoadInterleaved4(d, staged, a, b, c, e);
}

std::size_t compose_worlds_vector(
    std::span<const Transform> local, std::span<WorldTransform> world,
    std::span<PreviousWorldTransform> previous) {
    const std::size_t lanes = hn::Lanes(d);
    HWY_ALIGN float rows[3][4 * hn::MaxLanes(Floats())];
    const V one = hn::Set(d, 1.0f);
    const V two = hn::Set(d, 2.0f);
    std::size_t first = 0;
    for (; first + lanes <= local.size(); first += lanes) {
        const float* in = reinterpret_cast<const float*>(&local[first]);
        V px;
        V py;
        V pz;
        V qx;
        V qy;
        V qz;
        V qw;
        V sx;
        V sy;
        V sz;
        load_fields<10>(in, px, py, pz, qx);
        load_fields<10>(in + 3, qx, qy, qz, qw);
        load_fields<10>(in + 6, qw, sx, sy, sz);

        // The same operations as glm::mat3_cast, in the same order.
        const V xx = hn::Mul(qx, qx);
        const V yy = hn::Mul(qy, qy);
        const V zz = hn::Mul(qz, qz);
        const V xz = hn::Mul(qx, qz);
        const V xy = hn::Mul(qx, qy);
        const V yz = hn::Mul(qy, qz);
        const V wx = hn::Mul(qw, qx);
        const V wy = hn::Mul(qw, qy);
        const V wz = hn::Mul(qw, qz);
        hn::StoreInterleaved4(
            hn::Mul(hn::Sub(one, hn::Mul(two, hn::Add(yy, zz))), sx),
            hn::Mul(hn::Mul(two, hn::Sub(xy, wz)), sy), hn::Mul(hn::Mul(two, hn::Add(xz, wy)), sz),
            px, d, rows[0]);
        hn::StoreInterleaved4(
            hn::Mul(hn::Mul(two, hn::Add(xy, wz)), sx),
            hn::Mul(hn::Sub(one, hn::Mul(two, hn::Add(xx, zz))), sy),
            hn::Mul(hn::Mul(two, hn::Sub(yz, wx)), sz), py, d, rows[1]);
        hn::StoreInterleaved4(
            hn::Mul(hn::Mul(two, hn::Sub(xz, wy)), sx), hn::Mul(hn::Mul(two, hn::Add(yz, wx)), sy),
            hn::Mul(hn::Sub(one, hn::Mul(two, hn::Add(xx, yy))), sz), pz, d, rows[2]);

        for (std::size_t lane = 0; lane < lanes; ++lane) {
            float* now = &world[first + lane].world.row[0].x;
            float* before = &previous[first + lane].world.row[0].x;
            const bool fresh = is_unset(previous[first + lane]);
            const hn::FixedTag<float, 4> d4;
            const auto r0 = hn::Load(d4, rows[0] + 4 * lane);
            const auto r1 = hn::Load(d4, rows[1] + 4 * lane);
            const auto r2 = hn::Load(d4, rows[2] + 4 * lane);
            if (HWY_UNLIKELY(fresh)) {
                hn::StoreU(r0, d4, before);
                hn::StoreU(r1, d4, before + 4);
                hn::StoreU(r2, d4, before + 8);
            } else {
                hn::StoreU(hn::LoadU(d4, now), d4, before);
                hn::StoreU(hn::LoadU(d4, now + 4), d4, before + 4);
                hn::StoreU(hn::LoadU(d4, now + 8), d4, before + 8);
            }
            hn::StoreU(r0, d4, now);
            hn::StoreU(r1, d4, now + 4);
            hn::StoreU(r2, d4, now + 8);
        }
    }
    return first;
}

std::size_t
turn_rotations_vector(std::span<const Spin> spin, float dt, std::span<Transform> transform) {
    const std::size_t lanes = hn::Lanes(d);
    HWY_ALIGN float turned[4 * hn::MaxLanes(Floats())];
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, 1.0f);
    const V half_dt = hn::Set(d, 0.5f * dt);
    std::size_t first = 0;
    for (; first + lanes <= spin.size(); first += lanes) {
        V ax;
        V ay;
        V az;
        V speed;
        hn::LoadInterleaved4(d, reinterpret_cast<const float*>(&spin[first]), ax, ay, az, speed);
        const SinCos parts = sin_cos_parts(hn::Mul(speed, half_dt), 1.0, zero);
        const V sin = pick_sine(parts);
        const V length2 = hn::Add(hn::Add(hn::Mul(ax, ax), hn::Mul(ay, ay)), hn::Mul(az, az));
        const auto turns = hn::Gt(length2, zero);
        const V scale = hn::IfThenElse(turns, hn::Div(sin, hn::Sqrt(length2)), zero);
        const V bw = hn::IfThenElse(turns, pick_cosine(parts), one);
        const V bx = hn::Mul(ax, scale);
        const V by = hn::Mul(ay, scale);
        const V bz = hn::Mul(az, scale);

        const float* in = reinterpret_cast<const float*>(&transform[first]);
        V qx;
        V qy;
        V qz;
        V qw;
        load_fields<10>(in + 3, qx, qy, qz, qw);
        const V rx = hn::Sub(
            hn::Add(hn::Add(hn::Mul(qw, bx), hn::Mul(qx, bw)), hn::Mul(qy, bz)), hn::Mul(qz, by));
        const V ry = hn::Sub(
            hn::Add(hn::Add(hn::Mul(qw, by), hn::Mul(qy, bw)), hn::Mul(qz, bx)), hn::Mul(qx, bz));
        const V rz = hn::Sub(
            hn::Add(hn::Add(hn::Mul(qw, bz), hn::Mul(qz, bw)), hn::Mul(qx, by)), hn::Mul(qy, bx));
        const V rw = hn::Sub(
            hn::Sub(hn::Sub(hn::Mul(qw, bw), hn::Mul(qx, bx)), hn::Mul(qy, by)), hn::Mul(qz, bz));
        const V norm2 = hn::Add(
            hn::Add(hn::Add(hn::Mul(rx, rx), hn::Mul(ry, ry)), hn::Mul(rz, rz)), hn::Mul(rw, rw));
        const V unit = hn::Div(one, hn::Sqrt(norm2));
        hn::StoreInterleaved4(
            hn::Mul(rx, unit), hn::Mul(ry, unit), hn::Mul(rz, unit), hn::Mul(rw, unit), d, turned);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            std::memcpy(&transform[first + lane].rotation, turned + 4 * lane, 4 * sizeof(float));
        }
    }
    return first;
}

std::size_t
sway_positions_vector(const SwayArrays& sway, double time, std::span<Transform> transform) {
    const std::size_t lanes = hn::Lanes(d);
    HWY_ALIGN float moved[3 * hn::MaxLanes(Floats())];
    std::size_t first = 0;
    for (; first + lanes <= sway.size(); first += lanes) {
        const auto load = [&](const SwayArrays::Axes& field, int axis) {
            return hn::LoadU(d, field[axis].data() + first);
        };
        V position[3];
        for (int axis = 0; axis < 3; ++axis) {
            const SinCos parts =
                sin_cos_parts(load(sway.frequency, axis), time, load(sway.phase, axis));
            position[axis] = hn::Add(
                load(sway.center, axis), hn::Mul(load(sway.amplitude, axis), pick_sine(parts)));
        }
        hn::StoreInterleaved3(position[0], position[1], position[2], d, moved);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            std::memcpy(&transform[first + lane].position, moved + 3 * lane, 3 * sizeof(float));
        }
    }
    return first;
}

#endif  // HWY_TARGET

}  // namespace
}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(compose_worlds_vector);
HWY_EXPORT(turn_rotations_vector);
HWY_EXPORT(sway_positions_vector);

namespace {

/// Scalar version of sin_cos_parts.
struct ScalarSinCos {
    float sin;
    float cos;
    int quarter;
};

ScalarSinCos sin_cos_parts(double angle) {
    const double turns = std::nearbyint(angle * motion::kTwoOverPi);
    const double whole = std::floor(turns * 0.25);
    const float x = static_cast<float>(angle - turns * motion::kHalfPi);
    const float x2 = x * x;
    const float s = (motion::kSin2 * x2 + motion::kSin1) * x2 + motion::kSin0;
    const float c = (motion::kCos2 * x2 + motion::kCos1) * x2 + motion::kCos0;
    return {
        s * x2 * x + x, (1.0f - 0.5f * x2) + c * x2 * x2, static_cast<int>(turns - whole * 4.0)};
}

float pick_sine(const ScalarSinCos& parts) {
    const float value = parts.quarter % 2 != 0 ? parts.cos : parts.sin;
    return parts.quarter >= 2 ? -value : value;
}

float pick_cosine(const ScalarSinCos& parts) {
    const float value = parts.quarter % 2 != 0 ? parts.sin : parts.cos;
    return parts.quarter == 1 || parts.quarter == 2 ? -value : value;
}

}  // namespace

float sine(double angle) {
    return pick_sine(sin_cos_parts(angle));
}
float cosine(double angle) {
    return pick_cosine(sin_cos_parts(angle));
}

void compose_worlds_scalar(
    std::span<const Transform> local, std::span<WorldTransform> world,
    std::span<PreviousWorldTransform> previous) {
    for (std::size_t i = 0; i < local.size(); ++i) {
        const Affine next = affine_from(local[i].position, local[i].rotation, local[i].scale);
        previous[i].world = is_unset(previous[i]) ? next : world[i].world;
        world[i].world = next;
    }
}

void turn_rotations_scalar(std::span<const Spin> spin, float dt, std::span<Transform> transform) {
    const float half_dt = 0.5f * dt;
    for (std::size_t i = 0; i < spin.size(); ++i) {
        const Vec3& a = spin[i].axis;
        const ScalarSinCos parts = sin_cos_parts(static_cast<double>(spin[i].speed * half_dt));
        const float length2 = a.x * a.x + a.y * a.y + a.z * a.z;
        const float scale = length2 > 0 ? pick_sine(parts) / std::sqrt(length2) : 0.0f;
        const float bw = length2 > 0 ? pick_cosine(parts) : 1.0f;
        const float bx = a.x * scale;
        const float by = a.y * scale;
        const float bz = a.z * scale;
        Quat& q = transform[i].rotation;
        const float rx = q.w * bx + q.x * bw + q.y * bz - q.z * by;
        const float ry = q.w * by + q.y * bw + q.z * bx - q.x * bz;
        const float rz = q.w * bz + q.z * bw + q.x * by - q.y * bx;
        const float rw = q.w * bw - q.x * bx - q.y * by - q.z * bz;
        const float unit = 1.0f / std::sqrt(rx * rx + ry * ry + rz * rz + rw * rw);
        q = Quat(rw * unit, rx * unit, ry * unit, rz * unit);
    }
}

SwayArrays SwayArrays::subspan(std::size_t first, std::size_t count) const {
    SwayArrays part = *this;
    for (Axes* field : {&part.center, &part.amplitude, &part.frequency, &part.phase}) {
        for (std::span<const float>& axis : *field) {
            axis = axis.subspan(first, count);
        }
    }
    return part;
}

void sway_positions_scalar(const SwayArrays& sway, double time, std::span<Transform> transform) {
    for (std::size_t i = 0; i < sway.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const double angle = static_cast<double>(sway.frequency[axis][i]) * time
                                 + static_cast<double>(sway.phase[axis][i]);
            transform[i].position[axis] =
                sway.center[axis][i] + sway.amplitude[axis][i] * pick_sine(sin_cos_parts(angle));
        }
    }
}

void compose_worlds(
    std::span<const Transform> local, std::span<WorldTransform> world,
    std::span<PreviousWorldTransform> previous) {
    LIMN_CHECK(local.size() == world.size() && local.size() == previous.size());
    const std::size_t done = HWY_DYNAMIC_DISPATCH(compose_worlds_vector)(local, world, previous);
    compose_worlds_scalar(local.subspan(done), world.subspan(done), previous.subspan(done));
}

void turn_rotations(std::span<const Spin> spin, float dt, std::span<Transform> transform) {
    LIMN_CHECK(spin.size() == transform.size());
    const std::size_t done = HWY_DYNAMIC_DISPATCH(turn_rotations_vector)(spin, dt, transform);
    turn_rotations_scalar(spin.subspan(done), dt, transform.subspan(done));
}

void sway_positions(const SwayArrays& sway, double time, std::span<Transform> transform) {
    LIMN_CHECK(sway.size() == transform.size());
    const std::size_t done = HWY_DYNAMIC_DISPATCH(sway_positions_vector)(sway, time, transform);
    sway_positions_scalar(sway.subspan(done, sway.size() - done), time, transform.subspan(done));
}

}  // namespace limn
#endif  // HWY_ONCE
