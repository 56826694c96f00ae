#include "systems/animation/deformer_kernels.h"

#include "ecs/components/deformers.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/animation/deformer_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Techniques: face.ffd, face.pull, face.waters-muscle

#ifndef LIMN_DEFORMER_CONSTANTS
#define LIMN_DEFORMER_CONSTANTS
namespace limn::deformer {

// M. Abramowitz and I. Stegun, "Handbook of Mathematical Functions", 1964: the arc cosine within
// 2e-8 (4.4.46; GLSL's own may be off by 1e-4), the sine of up to a right angle within 2e-9
// (4.3.97), as functions of x and of x^2. Both versions evaluate them identically.
inline constexpr float kArcCosine[] = {-0.0012624911f, 0.0066700901f,  -0.0170881256f,
                                       0.0308918810f,  -0.0501743046f, 0.0889789874f,
                                       -0.2145988016f, 1.5707963050f};
inline constexpr float kSine[] = {-0.0000000239f, 0.0000027526f,  -0.0001984090f,
                                  0.0083333315f,  -0.1666666664f, 1.0f};
inline constexpr float kRightAngle = 0.5f * kPi;

}  // namespace limn::deformer
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

// Returns the first point that is not processed; the scalar version handles the remainder.

#if HWY_TARGET == HWY_SCALAR  // no vectors here

std::size_t deform_points_vector(std::span<const Vec4>, std::span<Vec3>) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using V = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;
constexpr Floats d;

namespace {

HWY_INLINE V set(float value) {
    return hn::Set(d, value);
}
HWY_INLINE V dot3(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}
HWY_INLINE V dot3(const Vec4& a, V bx, V by, V bz) {
    return dot3(set(a.x), set(a.y), set(a.z), bx, by, bz);
}

template <std::size_t kCount>
HWY_INLINE V polynomial(const float (&terms)[kCount], V x) {
    V sum = set(terms[0]);
    for (std::size_t i = 1; i < kCount; ++i) {
        sum = hn::Add(hn::Mul(sum, x), set(terms[i]));
    }
    return sum;
}
HWY_INLINE V arc_cosine(V x) {
    return hn::Mul(hn::Sqrt(hn::Sub(set(1.0f), x)), polynomial(deformer::kArcCosine, x));
}
HWY_INLINE V sine_of_quarters(V quarters) {
    const V x = hn::Mul(set(deformer::kRightAngle), quarters);
    return hn::Mul(x, polynomial(deformer::kSine, hn::Mul(x, x)));
}
HWY_INLINE V squared_cosine_of_quarters(V quarters) {
    const V cosine = sine_of_quarters(hn::Sub(set(1.0f), quarters));
    return hn::Mul(cosine, cosine);
}

/// A vector of points, and the pulls on them.
struct Points {
    V x, y, z;
    V pull_x, pull_y, pull_z;
    V farthest;
};

/// Adds `strength` times a vector where `pulls`, `distance` its length.
HWY_INLINE void add_pull(Points& p, Mask pulls, V strength, V x, V y, V z, V distance) {
    p.pull_x = hn::Add(p.pull_x, hn::IfThenElseZero(pulls, hn::Mul(strength, x)));
    p.pull_y = hn::Add(p.pull_y, hn::IfThenElseZero(pulls, hn::Mul(strength, y)));
    p.pull_z = hn::Add(p.pull_z, hn::IfThenElseZero(pulls, hn::Mul(strength, z)));
    p.farthest = hn::Max(p.farthest, hn::IfThenElseZero(pulls, distance));
}

HWY_INLINE void add_muscle(const Vec4* record, Points& p) {
    const V x = hn::Sub(set(record[1].x), p.x);
    const V y = hn::Sub(set(record[1].y), p.y);
    const V z = hn::Sub(set(record[1].z), p.z);
    const V distance = hn::Sqrt(dot3(x, y, z, x, y, z));
    const V inner_radius = set(record[1].w);
    const V outer_radius = set(record[2].w);
    Mask pulls = hn::And(hn::Gt(distance, hn::Zero(d)), hn::Lt(distance, outer_radius));
    if (hn::AllFalse(d, pulls)) {
        return;
    }
    const V one = set(1.0f);
    const V cosine = hn::Div(hn::Neg(dot3(record[2], x, y, z)), distance);
    const V off_axis = hn::Div(arc_cosine(hn::Clamp(cosine, hn::Zero(d), one)), set(record[0].z));
    pulls = hn::And(pulls, hn::Lt(off_axis, one));
    if (hn::AllFalse(d, pulls)) {
        return;
    }
    const V beyond = hn::Max(
        hn::Div(hn::Sub(distance, inner_radius), hn::Sub(outer_radius, inner_radius)), hn::Zero(d));
    const V rise = sine_of_quarters(hn::Min(hn::Div(distance, inner_radius), one));
    const V strength = hn::Mul(
        hn::Mul(rise, squared_cosine_of_quarters(beyond)), squared_cosine_of_quarters(off_axis));
    add_pull(p, pulls, hn::Div(hn::Mul(set(record[0].y), strength), distance), x, y, z, distance);
}

HWY_INLINE void add_sphincter(const Vec4* record, Points& p) {
    const V x = hn::Sub(set(record[1].x), p.x);
    const V y = hn::Sub(set(record[1].y), p.y);
    const V z = hn::Sub(set(record[1].z), p.z);
    const V qx = dot3(record[2], x, y, z);
    const V qy = dot3(record[3], x, y, z);
    const V qz = dot3(record[4], x, y, z);
    const V strength = hn::Sub(set(1.0f), hn::Sqrt(dot3(qx, qy, qz, qx, qy, qz)));
    const Mask pulls = hn::Gt(strength, hn::Zero(d));
    if (hn::AllFalse(d, pulls)) {
        return;
    }
    const Vec3 deep = record[4].w * Vec3(record[4]);
    const V depth = dot3(Vec4(deep, 0.0f), x, y, z);
    const V in_x = hn::Sub(x, hn::Mul(depth, set(deep.x)));
    const V in_y = hn::Sub(y, hn::Mul(depth, set(deep.y)));
    const V in_z = hn::Sub(z, hn::Mul(depth, set(deep.z)));
    add_pull(
        p, pulls, hn::Mul(set(record[0].y), strength), in_x, in_y, in_z,
        hn::Sqrt(dot3(in_x, in_y, in_z, in_x, in_y, in_z)));
}

/// Moves the points by their pulls.
HWY_INLINE void follow_pulls(Points& p) {
    const V length = hn::Sqrt(dot3(p.pull_x, p.pull_y, p.pull_z, p.pull_x, p.pull_y, p.pull_z));
    const Mask too_far = hn::Gt(length, p.farthest);
    const V scale = hn::IfThenElse(too_far, hn::Div(p.farthest, length), set(1.0f));
    p.x = hn::Add(p.x, hn::Mul(scale, p.pull_x));
    p.y = hn::Add(p.y, hn::Mul(scale, p.pull_y));
    p.z = hn::Add(p.z, hn::Mul(scale, p.pull_z));
}

HWY_INLINE void find_bernstein(V t, V (&b)[4]) {
    const V s = hn::Sub(set(1.0f), t);
    const V three = set(3.0f);
    b[0] = hn::Mul(hn::Mul(s, s), s);
    b[1] = hn::Mul(hn::Mul(hn::Mul(three, t), s), s);
    b[2] = hn::Mul(hn::Mul(hn::Mul(three, t), t), s);
    b[3] = hn::Mul(hn::Mul(t, t), t);
}

HWY_INLINE Mask within_one(V q) {
    return hn::And(hn::Ge(q, hn::Zero(d)), hn::Le(q, set(1.0f)));
}

HWY_INLINE void pass_lattice(const Vec4* record, Points& p) {
    const V x = hn::Sub(p.x, set(record[1].x));
    const V y = hn::Sub(p.y, set(record[1].y));
    const V z = hn::Sub(p.z, set(record[1].z));
    const V qx = dot3(record[2], x, y, z);
    const V qy = dot3(record[3], x, y, z);
    const V qz = dot3(record[4], x, y, z);
    const Mask inside = hn::And(within_one(qx), hn::And(within_one(qy), within_one(qz)));
    if (hn::AllFalse(d, inside)) {
        return;
    }
    V bu[4];
    V bv[4];
    V bw[4];
    find_bernstein(qx, bu);
    find_bernstein(qy, bv);
    find_bernstein(qz, bw);
    V to_x = p.x;
    V to_y = p.y;
    V to_z = p.z;
    for (std::size_t point = 0; point < kLatticePoints; ++point) {
        const Vec4& offset = record[5 + point];
        if (Vec3(offset) != Vec3(0)) {
            const V weight = hn::Mul(hn::Mul(bu[point % 4], bv[point / 4 % 4]), bw[point / 16]);
            to_x = hn::Add(to_x, hn::Mul(weight, set(offset.x)));
            to_y = hn::Add(to_y, hn::Mul(weight, set(offset.y)));
            to_z = hn::Add(to_z, hn::Mul(weight, set(offset.z)));
        }
    }
    p.x = hn::IfThenElse(inside, to_x, p.x);
    p.y = hn::IfThenElse(inside, to_y, p.y);
    p.z = hn::IfThenElse(inside, to_z, p.z);
}

HWY_INLINE void pass_tug(const Vec4* record, Points& p) {
    const V x = hn::Sub(p.x, set(record[1].x));
    const V y = hn::Sub(p.y, set(record[1].y));
    const V z = hn::Sub(p.z, set(record[1].z));
    const V left = hn::Sub(set(1.0f), hn::Mul(set(record[1].w), dot3(x, y, z, x, y, z)));
    const Mask inside = hn::Gt(left, hn::Zero(d));
    if (hn::AllFalse(d, inside)) {
        return;
    }
    const V falloff = hn::IfThenElseZero(inside, hn::Mul(hn::Mul(left, left), left));
    p.x = hn::IfThenElse(inside, hn::Add(p.x, hn::Mul(falloff, set(record[0].y))), p.x);
    p.y = hn::IfThenElse(inside, hn::Add(p.y, hn::Mul(falloff, set(record[0].z))), p.y);
    p.z = hn::IfThenElse(inside, hn::Add(p.z, hn::Mul(falloff, set(record[0].w))), p.z);
}

}  // namespace

std::size_t deform_points_vector(std::span<const Vec4> packed, std::span<Vec3> points) {
    const std::size_t lanes = hn::Lanes(d);
    std::size_t at = 0;
    for (; at + lanes <= points.size(); at += lanes) {
        const V none = hn::Zero(d);
        Points p = {none, none, none, none, none, none, none};
        hn::LoadInterleaved3(d, &points[at].x, p.x, p.y, p.z);
        std::size_t i = 1;
        while (i < packed.size() && packed[i].x < kLattice) {
            if (packed[i].x == kMuscle) {
                add_muscle(&packed[i], p);
                i += kMuscleTexels;
            } else {
                add_sphincter(&packed[i], p);
                i += kSphincterTexels;
            }
        }
        follow_pulls(p);
        while (i < packed.size()) {
            if (packed[i].x == kLattice) {
                pass_lattice(&packed[i], p);
                i += kLatticeTexels;
            } else {
                pass_tug(&packed[i], p);
                i += kTugTexels;
            }
        }
        hn::StoreInterleaved3(p.x, p.y, p.z, d, &points[at].x);
    }
    return at;
}

#endif

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(deform_points_vector);

namespace {

/// Sum of the pulls of muscles, and the distance to the farthest point that they pull to.
struct Pull {
    Vec3 sum{0};
    float farthest = 0.0f;
};

template <std::size_t kCount>
float polynomial(const float (&terms)[kCount], float x) {
    float sum = terms[0];
    for (std::size_t i = 1; i < kCount; ++i) {
        sum = sum * x + terms[i];
    }
    return sum;
}

/// For 0 <= x <= 1.
float arc_cosine(float x) {
    return std::sqrt(1.0f - x) * polynomial(deformer::kArcCosine, x);
}

/// Sine of 0 .. 1 right angles.
float sine_of_quarters(float quarters) {
    const float x = deformer::kRightAngle * quarters;
    return x * polynomial(deformer::kSine, x * x);
}

float squared_cosine_of_quarters(float quarters) {
    return square(sine_of_quarters(1.0f - quarters));
}

void add_muscle(const Vec4* record, const Vec3& p, Pull& pull) {
    const Vec3 to_attachment = Vec3(record[1]) - p;
    const float distance = glm::length(to_attachment);
    const float inner_radius = record[1].w;
    const float outer_radius = record[2].w;
    if (!(distance > 0.0f) || distance >= outer_radius) {
        return;
    }
    const float cosine = -glm::dot(to_attachment, Vec3(record[2])) / distance;
    const float off_axis = arc_cosine(std::clamp(cosine, 0.0f, 1.0f)) / record[0].z;
    if (off_axis >= 1.0f) {
        return;
    }
    const float beyond = std::max((distance - inner_radius) / (outer_radius - inner_radius), 0.0f);
    const float rise = sine_of_quarters(std::min(distance / inner_radius, 1.0f));
    const float strength =
        rise * squared_cosine_of_quarters(beyond) * squared_cosine_of_quarters(off_axis);
    pull.sum += (record[0].y * strength / distance) * to_attachment;
    pull.farthest = std::max(pull.farthest, distance);
}

void add_sphincter(const Vec4* record, const Vec3& p, Pull& pull) {
    const Vec3 to_center = Vec3(record[1]) - p;
    const Vec3 q(
        glm::dot(Vec3(record[2]), to_center), glm::dot(Vec3(record[3]), to_center),
        glm::dot(Vec3(record[4]), to_center));
    const float strength = 1.0f - glm::length(q);
    if (strength <= 0.0f) {
        return;
    }
    const Vec3 deep = record[4].w * Vec3(record[4]);
    const Vec3 inward = to_center - glm::dot(to_center, deep) * deep;
    pull.sum += record[0].y * strength * inward;
    pull.farthest = std::max(pull.farthest, glm::length(inward));
}

std::array<float, 4> bernstein(float t) {
    const float s = 1.0f - t;
    return {s * s * s, 3.0f * t * s * s, 3.0f * t * t * s, t * t * t};
}

Vec3 through_lattice(const Vec4* record, const Vec3& p) {
    const Vec3 from_origin = p - Vec3(record[1]);
    const Vec3 q(
        glm::dot(Vec3(record[2]), from_origin), glm::dot(Vec3(record[3]), from_origin),
        glm::dot(Vec3(record[4]), from_origin));
    if (glm::any(glm::lessThan(q, Vec3(0))) || glm::any(glm::greaterThan(q, Vec3(1)))) {
        return p;
    }
    const std::array<float, 4> bu = bernstein(q.x);
    const std::array<float, 4> bv = bernstein(q.y);
    const std::array<float, 4> bw = bernstein(q.z);
    Vec3 moved = p;
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t i = 0; i < 4; ++i) {
                const Vec3 offset(record[5 + i + 4 * j + 16 * k]);
                if (offset != Vec3(0)) {
                    moved += bu[i] * bv[j] * bw[k] * offset;
                }
            }
        }
    }
    return moved;
}

Vec3 through_tug(const Vec4* record, const Vec3& p) {
    const Vec3 from = p - Vec3(record[1]);
    const float left = 1.0f - record[1].w * glm::dot(from, from);
    const Vec3 offset(record[0].y, record[0].z, record[0].w);
    return left > 0.0f ? p + left * left * left * offset : p;
}

}  // namespace

Vec3 deform_point(std::span<const Vec4> packed, const Vec3& point) {
    Pull pull;
    std::size_t i = 1;
    while (i < packed.size() && packed[i].x < kLattice) {
        if (packed[i].x == kMuscle) {
            add_muscle(&packed[i], point, pull);
            i += kMuscleTexels;
        } else {
            add_sphincter(&packed[i], point, pull);
            i += kSphincterTexels;
        }
    }
    const float length = glm::length(pull.sum);
    Vec3 moved = point + (length > pull.farthest ? (pull.farthest / length) * pull.sum : pull.sum);
    while (i < packed.size()) {
        if (packed[i].x == kLattice) {
            moved = through_lattice(&packed[i], moved);
            i += kLatticeTexels;
        } else {
            moved = through_tug(&packed[i], moved);
            i += kTugTexels;
        }
    }
    return moved;
}

Vec3 deform_normal(std::span<const Vec4> packed, const Vec3& point, const Vec3& normal) {
    if (packed.empty()) {
        return normal;
    }
    const Vec3 helper = std::abs(normal.x) < 0.5f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 s = glm::normalize(glm::cross(helper, normal));
    const Vec3 t = glm::cross(normal, s);
    const float step = packed[0].y;
    const auto difference = [&](const Vec3& direction) {
        return deform_point(packed, point + step * direction)
               - deform_point(packed, point - step * direction);
    };
    const Vec3 turned = glm::cross(difference(s), difference(t));
    const float length = glm::length(turned);
    return length > 0.0f ? turned / length : normal;
}

void deform_points(std::span<const Vec4> packed, std::span<Vec3> points) {
    if (!packed.empty()) {
        const std::size_t next = HWY_DYNAMIC_DISPATCH(deform_points_vector)(packed, points);
        deform_points_scalar(packed, points.subspan(next));
    }
}

void deform_points_scalar(std::span<const Vec4> packed, std::span<Vec3> points) {
    for (Vec3& point : points) {
        point = deform_point(packed, point);
    }
}

}  // namespace limn
#endif  // HWY_ONCE
