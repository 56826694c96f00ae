#include "systems/animation/skin_kernels.h"

#include "ecs/base/check.h"
#include "ecs/base/rotation.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/animation/skin_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Quaternions are read as x y z w, a dual one as two of them, a matrix as three rows of four.
static_assert(sizeof(limn::Quat) == 4 * sizeof(float));
static_assert(sizeof(limn::DualQuaternion) == 8 * sizeof(float));
static_assert(sizeof(limn::Affine) == 12 * sizeof(float));

#ifndef LIMN_SKIN_CONSTANTS
#define LIMN_SKIN_CONSTANTS
namespace limn::skin {

/// Squared length, as a share of what the matrix does to volumes: below, there is no normal.
inline constexpr float kFlat = 1e-12f;
/// Squared length of a vector without a direction.
inline constexpr float kNoLength = 1e-30f;
/// The rows of a matrix, and a quaternion, that change nothing.
inline constexpr float kUnmoved[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
inline constexpr float kUnturned[4] = {0, 0, 0, 1};
/// Squared length of a mean of screw motions that cancel each other.
inline constexpr float kNoMotion = 1e-12f;

}  // namespace limn::skin
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

// Both return the first vertex that they have not done; the rest is for the scalar version.

#if HWY_TARGET == HWY_SCALAR  // no vectors here

std::size_t skin_linear_vector(
    const SkinWeights&,
    std::span<const Affine>,
    const RestVertices&,
    const MovedVertices&,
    std::size_t begin,
    std::size_t) {
    return begin;
}
std::size_t skin_dual_vector(
    const SkinWeights&,
    std::span<const DualQuaternion>,
    const RestVertices&,
    const MovedVertices&,
    std::size_t begin,
    std::size_t) {
    return begin;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using V = hn::Vec<Floats>;
constexpr Floats d;
using Four = hn::FixedTag<float, 4>;
constexpr Four four;
constexpr std::size_t kMostLanes = hn::MaxLanes(d);

/// Vertices whose means are made before the first of them is moved: what is stored in fours and
/// loaded in lanes must have left the store buffer, or the loads wait for it.
constexpr std::size_t kBlock = 4;

/// Three vectors of four numbers for each vertex of a block, one list behind the other.
struct Batch {
    HWY_ALIGN float rows[3][4 * kMostLanes * kBlock];
};

HWY_INLINE V dot3(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}
/// a b - c e
HWY_INLINE V cross_part(V a, V b, V c, V e) {
    return hn::Sub(hn::Mul(a, b), hn::Mul(c, e));
}

/// Moves the vertices from `at` on by a matrix each; false: one of them is for the scalar version,
/// and nothing is done.
HWY_INLINE bool move_vertices(
    V xx,
    V xy,
    V xz,
    V xt,
    V yx,
    V yy,
    V yz,
    V yt,
    V zx,
    V zy,
    V zz,
    V zt,
    const RestVertices& rest,
    const MovedVertices& moved,
    std::size_t at) {
    V x;
    V y;
    V z;
    V w;
    // Normals: cofactors, then the sign of the determinant.
    const V ax = cross_part(yy, zz, yz, zy);
    const V ay = cross_part(yz, zx, yx, zz);
    const V az = cross_part(yx, zy, yy, zx);
    const V bx = cross_part(zy, xz, zz, xy);
    const V by = cross_part(zz, xx, zx, xz);
    const V bz = cross_part(zx, xy, zy, xx);
    const V cx = cross_part(xy, yz, xz, yy);
    const V cy = cross_part(xz, yx, xx, yz);
    const V cz = cross_part(xx, yy, xy, yx);
    hn::LoadInterleaved3(d, &rest.normals[at].x, x, y, z);
    const V nx = dot3(ax, ay, az, x, y, z);
    const V ny = dot3(bx, by, bz, x, y, z);
    const V nz = dot3(cx, cy, cz, x, y, z);
    const V normal2 = dot3(nx, ny, nz, nx, ny, nz);
    const V size = hn::Add(
        hn::Add(dot3(xx, xy, xz, xx, xy, xz), dot3(yx, yy, yz, yx, yy, yz)),
        dot3(zx, zy, zz, zx, zy, zz));
    const V least = hn::Mul(hn::Set(d, skin::kFlat), hn::Mul(size, size));

    hn::LoadInterleaved4(d, &rest.tangents[at].x, x, y, z, w);
    const V tx = dot3(xx, xy, xz, x, y, z);
    const V ty = dot3(yx, yy, yz, x, y, z);
    const V tz = dot3(zx, zy, zz, x, y, z);
    const V tangent2 = dot3(tx, ty, tz, tx, ty, tz);
    const auto bad = hn::Or(
        hn::Not(hn::Gt(normal2, least)), hn::Not(hn::Gt(tangent2, hn::Set(d, skin::kNoLength))));
    if (!hn::AllFalse(d, bad)) {
        return false;
    }

    const V one = hn::Set(d, 1.0f);
    const V side = dot3(xx, xy, xz, ax, ay, az);
    const V normal_unit = hn::CopySign(hn::Div(one, hn::Sqrt(normal2)), side);
    const V tangent_unit = hn::Div(one, hn::Sqrt(tangent2));
    hn::StoreInterleaved4(
        hn::Mul(tx, tangent_unit),
        hn::Mul(ty, tangent_unit),
        hn::Mul(tz, tangent_unit),
        w,
        d,
        &moved.tangents[at].x);
    hn::StoreInterleaved3(
        hn::Mul(nx, normal_unit),
        hn::Mul(ny, normal_unit),
        hn::Mul(nz, normal_unit),
        d,
        &moved.normals[at].x);
    hn::LoadInterleaved3(d, &rest.positions[at].x, x, y, z);
    hn::StoreInterleaved3(
        hn::Add(dot3(xx, xy, xz, x, y, z), xt),
        hn::Add(dot3(yx, yy, yz, x, y, z), yt),
        hn::Add(dot3(zx, zy, zz, x, y, z), zt),
        d,
        &moved.positions[at].x);
    return true;
}

/// Where lists begin; kept apart from the lists, which every store of a vector might change for all
/// that a compiler knows.
template <typename Joint>
struct Lists {
    const std::uint32_t* first;
    const std::uint16_t* joints;
    const float* weights;
    const Joint* palette;

    Lists(const SkinWeights& skin, std::span<const Joint> matrices)
        : first(skin.first.data()), joints(skin.joints.data()), weights(skin.weights.data()),
          palette(matrices.data()) {}
};

/// The rows of the mean matrix of vertex `v` go to `place` of the batch.
HWY_INLINE void
store_mean_matrix(const Lists<Affine> lists, std::size_t v, Batch& batch, std::size_t place) {
#if HWY_MAX_BYTES >= 32  // two rows are one vector
    constexpr hn::FixedTag<float, 8> two;
#endif
    std::uint32_t i = lists.first[v];
    const std::uint32_t last = lists.first[v + 1];
    if (i == last) {
        for (std::size_t row = 0; row < 3; ++row) {
            const auto unmoved = hn::LoadU(four, skin::kUnmoved + 4 * row);
            hn::Store(unmoved, four, batch.rows[row] + 4 * place);
        }
        return;
    }
    const float* row = &lists.palette[lists.joints[i]].row[0].x;
#if HWY_MAX_BYTES >= 32
    auto weight = hn::Set(two, lists.weights[i]);
    auto xy = hn::Mul(weight, hn::LoadU(two, row));
    auto z = hn::Mul(hn::LowerHalf(four, weight), hn::LoadU(four, row + 8));
    for (++i; i < last; ++i) {
        row = &lists.palette[lists.joints[i]].row[0].x;
        weight = hn::Set(two, lists.weights[i]);
        xy = hn::Add(xy, hn::Mul(weight, hn::LoadU(two, row)));
        z = hn::Add(z, hn::Mul(hn::LowerHalf(four, weight), hn::LoadU(four, row + 8)));
    }
    const auto x = hn::LowerHalf(four, xy);
    const auto y = hn::UpperHalf(four, xy);
#else
    auto weight = hn::Set(four, lists.weights[i]);
    auto x = hn::Mul(weight, hn::LoadU(four, row));
    auto y = hn::Mul(weight, hn::LoadU(four, row + 4));
    auto z = hn::Mul(weight, hn::LoadU(four, row + 8));
    for (++i; i < last; ++i) {
        row = &lists.palette[lists.joints[i]].row[0].x;
        weight = hn::Set(four, lists.weights[i]);
        x = hn::Add(x, hn::Mul(weight, hn::LoadU(four, row)));
        y = hn::Add(y, hn::Mul(weight, hn::LoadU(four, row + 4)));
        z = hn::Add(z, hn::Mul(weight, hn::LoadU(four, row + 8)));
    }
#endif
    hn::Store(x, four, batch.rows[0] + 4 * place);
    hn::Store(y, four, batch.rows[1] + 4 * place);
    hn::Store(z, four, batch.rows[2] + 4 * place);
}

std::size_t skin_linear_vector(
    const SkinWeights& skin,
    std::span<const Affine> palette,
    const RestVertices& rest,
    const MovedVertices& moved,
    std::size_t begin,
    std::size_t end) {
    const std::size_t lanes = hn::Lanes(d);
    const Lists<Affine> lists(skin, palette);
    Batch batch;
    while (begin + lanes <= end) {
        const std::size_t block = std::min(kBlock, (end - begin) / lanes) * lanes;
        for (std::size_t lane = 0; lane < block; ++lane) {
            store_mean_matrix(lists, begin + lane, batch, lane);
        }
        for (std::size_t at = 0; at < block; at += lanes) {
            V xx;
            V xy;
            V xz;
            V xt;
            V yx;
            V yy;
            V yz;
            V yt;
            V zx;
            V zy;
            V zz;
            V zt;
            hn::LoadInterleaved4(d, batch.rows[0] + 4 * at, xx, xy, xz, xt);
            hn::LoadInterleaved4(d, batch.rows[1] + 4 * at, yx, yy, yz, yt);
            hn::LoadInterleaved4(d, batch.rows[2] + 4 * at, zx, zy, zz, zt);
            if (!move_vertices(
                    xx, xy, xz, xt, yx, yy, yz, yt, zx, zy, zz, zt, rest, moved, begin + at)) {
                skin_linear_scalar(skin, palette, rest, moved, begin + at, begin + at + lanes);
            }
        }
        begin += block;
    }
    return begin;
}

std::size_t skin_dual_vector(
    const SkinWeights& skin,
    std::span<const DualQuaternion> palette,
    const RestVertices& rest,
    const MovedVertices& moved,
    std::size_t begin,
    std::size_t end) {
    const std::size_t lanes = hn::Lanes(d);
    const V one = hn::Set(d, 1.0f);
    const V two = hn::Set(d, 2.0f);
    const Lists<DualQuaternion> lists(skin, palette);
    Batch batch;
    while (begin + lanes <= end) {
        const std::size_t block = std::min(kBlock, (end - begin) / lanes) * lanes;
        for (std::size_t lane = 0; lane < block; ++lane) {
            std::uint32_t i = lists.first[begin + lane];
            const std::uint32_t last = lists.first[begin + lane + 1];
            auto real = hn::LoadU(four, skin::kUnturned);
            auto dual = hn::Zero(four);
            if (i < last) {
                const DualQuaternion& start = lists.palette[lists.joints[i]];
                real = hn::Mul(hn::Set(four, lists.weights[i]), hn::LoadU(four, &start.real.x));
                dual = hn::Mul(hn::Set(four, lists.weights[i]), hn::LoadU(four, &start.dual.x));
                for (++i; i < last; ++i) {
                    const DualQuaternion& next = lists.palette[lists.joints[i]];
                    const Quat& p = next.real;
                    const Quat& q = start.real;
                    const float side = ((p.x * q.x + p.y * q.y) + p.z * q.z) + p.w * q.w;
                    const auto weight =
                        hn::Set(four, side < 0.0f ? -lists.weights[i] : lists.weights[i]);
                    real = hn::Add(real, hn::Mul(weight, hn::LoadU(four, &next.real.x)));
                    dual = hn::Add(dual, hn::Mul(weight, hn::LoadU(four, &next.dual.x)));
                }
            }
            hn::Store(real, four, batch.rows[0] + 4 * lane);
            hn::Store(dual, four, batch.rows[1] + 4 * lane);
        }
        for (std::size_t lane = 0; lane < block; lane += lanes) {
            const std::size_t at = begin + lane;
            V x;
            V y;
            V z;
            V w;
            V dx;
            V dy;
            V dz;
            V dw;
            hn::LoadInterleaved4(d, batch.rows[0] + 4 * lane, x, y, z, w);
            hn::LoadInterleaved4(d, batch.rows[1] + 4 * lane, dx, dy, dz, dw);
            const V length2 = hn::Add(dot3(x, y, z, x, y, z), hn::Mul(w, w));
            if (!hn::AllTrue(d, hn::Gt(length2, hn::Set(d, skin::kNoMotion)))) {
                skin_dual_scalar(skin, palette, rest, moved, at, at + lanes);
                continue;
            }
            // 2 / |real|^2 takes the length out of all products.
            const V s = hn::Div(two, length2);
            const V xx = hn::Mul(s, hn::Mul(x, x));
            const V yy = hn::Mul(s, hn::Mul(y, y));
            const V zz = hn::Mul(s, hn::Mul(z, z));
            const V xy = hn::Mul(s, hn::Mul(x, y));
            const V xz = hn::Mul(s, hn::Mul(x, z));
            const V yz = hn::Mul(s, hn::Mul(y, z));
            const V wx = hn::Mul(s, hn::Mul(w, x));
            const V wy = hn::Mul(s, hn::Mul(w, y));
            const V wz = hn::Mul(s, hn::Mul(w, z));
            const V tx = hn::Add(cross_part(w, dx, dw, x), cross_part(y, dz, z, dy));
            const V ty = hn::Add(cross_part(w, dy, dw, y), cross_part(z, dx, x, dz));
            const V tz = hn::Add(cross_part(w, dz, dw, z), cross_part(x, dy, y, dx));
            if (!move_vertices(
                    hn::Sub(one, hn::Add(yy, zz)),
                    hn::Sub(xy, wz),
                    hn::Add(xz, wy),
                    hn::Mul(s, tx),
                    hn::Add(xy, wz),
                    hn::Sub(one, hn::Add(xx, zz)),
                    hn::Sub(yz, wx),
                    hn::Mul(s, ty),
                    hn::Sub(xz, wy),
                    hn::Add(yz, wx),
                    hn::Sub(one, hn::Add(xx, yy)),
                    hn::Mul(s, tz),
                    rest,
                    moved,
                    at)) {
                skin_dual_scalar(skin, palette, rest, moved, at, at + lanes);
            }
        }
        begin += block;
    }
    return begin;
}

#endif  // HWY_TARGET

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(skin_linear_vector);
HWY_EXPORT(skin_dual_vector);

namespace {

float dot3(const Vec3& a, const Vec3& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vec3 turn(const Affine& m, const Vec3& v) {
    return {dot3(Vec3(m.row[0]), v), dot3(Vec3(m.row[1]), v), dot3(Vec3(m.row[2]), v)};
}

/// `strongest` is the matrix of the joint with the largest weight.
template <typename Strongest>
void move_vertex(
    const Affine& m,
    const Strongest& strongest,
    const RestVertices& rest,
    const MovedVertices& moved,
    std::size_t v) {
    const Vec3 x(m.row[0]);
    const Vec3 y(m.row[1]);
    const Vec3 z(m.row[2]);
    const Vec3 a = cross(y, z);
    const Vec3 rest_normal = rest.normals[v];
    const Vec3 n = {
        dot3(a, rest_normal), dot3(cross(z, x), rest_normal), dot3(cross(x, y), rest_normal)};
    const float normal2 = dot3(n, n);
    const float size = (dot3(x, x) + dot3(y, y)) + dot3(z, z);
    moved.normals[v] = normal2 > skin::kFlat * (size * size)
                           ? n * std::copysign(1.0f / std::sqrt(normal2), dot3(x, a))
                           : normalize_or(turn(strongest(), rest_normal), rest_normal);
    const Vec4 rest_tangent = rest.tangents[v];
    const Vec3 t = turn(m, Vec3(rest_tangent));
    const float tangent2 = dot3(t, t);
    const Vec3 tangent =
        tangent2 > skin::kNoLength ? t * (1.0f / std::sqrt(tangent2)) : Vec3(rest_tangent);
    moved.tangents[v] = Vec4(tangent, rest_tangent.w);
    moved.positions[v] = turn(m, rest.positions[v]) + Vec3(m.row[0].w, m.row[1].w, m.row[2].w);
}

std::uint32_t strongest_joint(const SkinWeights& skin, std::size_t v) {
    const auto first = skin.weights.begin();
    const auto found = std::max_element(first + skin.first[v], first + skin.first[v + 1]);
    return skin.joints[static_cast<std::size_t>(found - first)];
}

/// Of any length; none: `real` has no length.
Affine matrix_of(const DualQuaternion& motion) {
    const auto [w, x, y, z] =
        std::tuple(motion.real.w, motion.real.x, motion.real.y, motion.real.z);
    const auto [dw, dx, dy, dz] =
        std::tuple(motion.dual.w, motion.dual.x, motion.dual.y, motion.dual.z);
    const float s = 2.0f / (((x * x + y * y) + z * z) + w * w);
    const float xx = s * (x * x);
    const float yy = s * (y * y);
    const float zz = s * (z * z);
    const float xy = s * (x * y);
    const float xz = s * (x * z);
    const float yz = s * (y * z);
    const float wx = s * (w * x);
    const float wy = s * (w * y);
    const float wz = s * (w * z);
    Affine m;
    m.row[0] = {1.0f - (yy + zz), xy - wz, xz + wy, s * ((w * dx - dw * x) + (y * dz - z * dy))};
    m.row[1] = {xy + wz, 1.0f - (xx + zz), yz - wx, s * ((w * dy - dw * y) + (z * dx - x * dz))};
    m.row[2] = {xz - wy, yz + wx, 1.0f - (xx + yy), s * ((w * dz - dw * z) + (x * dy - y * dx))};
    return m;
}

Affine mean_matrix(
    const SkinWeights& skin, std::span<const Affine> palette, std::uint32_t i, std::uint32_t last) {
    Affine mean;
    if (i < last) {
        for (int row = 0; row < 3; ++row) {
            mean.row[row] = skin.weights[i] * palette[skin.joints[i]].row[row];
        }
        for (++i; i < last; ++i) {
            for (int row = 0; row < 3; ++row) {
                mean.row[row] += skin.weights[i] * palette[skin.joints[i]].row[row];
            }
        }
    }
    return mean;
}

DualQuaternion mean_motion(
    const SkinWeights& skin,
    std::span<const DualQuaternion> palette,
    std::uint32_t i,
    std::uint32_t last) {
    DualQuaternion mean;
    if (i == last) {
        return mean;
    }
    const DualQuaternion& start = palette[skin.joints[i]];
    mean.real = skin.weights[i] * start.real;
    mean.dual = skin.weights[i] * start.dual;
    for (++i; i < last; ++i) {
        const DualQuaternion& next = palette[skin.joints[i]];
        const Quat& p = next.real;
        const Quat& q = start.real;
        // q and -q turn alike, but their mean does not.
        const float side = ((p.x * q.x + p.y * q.y) + p.z * q.z) + p.w * q.w;
        const float weight = side < 0.0f ? -skin.weights[i] : skin.weights[i];
        mean.real += weight * next.real;
        mean.dual += weight * next.dual;
    }
    const Quat& r = mean.real;
    const float length2 = ((r.x * r.x + r.y * r.y) + r.z * r.z) + r.w * r.w;
    return length2 > skin::kNoMotion ? mean : start;
}

void check_spans(
    const SkinWeights& skin,
    const RestVertices& rest,
    const MovedVertices& moved,
    std::size_t end) {
    const std::size_t count = rest.positions.size();
    LIMN_CHECK(rest.normals.size() == count && rest.tangents.size() == count);
    LIMN_CHECK(
        moved.positions.size() == count && moved.normals.size() == count
        && moved.tangents.size() == count);
    LIMN_CHECK(skin.first.size() == count + 1 && end <= count);
}

}  // namespace

void find_palette(const SkinData& skin, std::span<const Affine> joints, std::span<Affine> palette) {
    LIMN_CHECK(palette.size() == skin.joints.size());
    for (std::size_t i = 0; i < palette.size(); ++i) {
        palette[i] = joints[skin.joints[i]] * skin.joint_from_mesh[i];
    }
}

void find_dual_palette(std::span<const Affine> palette, std::span<DualQuaternion> duals) {
    LIMN_CHECK(palette.size() == duals.size());
    for (std::size_t i = 0; i < palette.size(); ++i) {
        const Affine& m = palette[i];
        Mat3 axes;
        for (int k = 0; k < 3; ++k) {
            axes[k] = Vec3(m.row[0][k], m.row[1][k], m.row[2][k]);
        }
        const Quat real = rotation_in(axes).value_or(Quat(1, 0, 0, 0));
        const Quat way(0, m.row[0].w, m.row[1].w, m.row[2].w);
        duals[i] = {real, 0.5f * (way * real)};
    }
}

void skin_linear_scalar(
    const SkinWeights& skin,
    std::span<const Affine> palette,
    const RestVertices& rest,
    const MovedVertices& moved,
    std::size_t begin,
    std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
        const Affine mean = mean_matrix(skin, palette, skin.first[v], skin.first[v + 1]);
        move_vertex(
            mean, [&] { return palette[strongest_joint(skin, v)]; }, rest, moved, v);
    }
}

void skin_dual_scalar(
    const SkinWeights& skin,
    std::span<const DualQuaternion> palette,
    const RestVertices& rest,
    const MovedVertices& moved,
    std::size_t begin,
    std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
        const Affine mean = matrix_of(mean_motion(skin, palette, skin.first[v], skin.first[v + 1]));
        move_vertex(
            mean, [&] { return matrix_of(palette[strongest_joint(skin, v)]); }, rest, moved, v);
    }
}

void skin_linear(
    const SkinWeights& skin,
    std::span<const Affine> palette,
    const RestVertices& rest,
    const MovedVertices& moved,
    std::size_t begin,
    std::size_t end) {
    check_spans(skin, rest, moved, end);
    const std::size_t next =
        HWY_DYNAMIC_DISPATCH(skin_linear_vector)(skin, palette, rest, moved, begin, end);
    skin_linear_scalar(skin, palette, rest, moved, next, end);
}

void skin_dual(
    const SkinWeights& skin,
    std::span<const DualQuaternion> palette,
    const RestVertices& rest,
    const MovedVertices& moved,
    std::size_t begin,
    std::size_t end) {
    check_spans(skin, rest, moved, end);
    const std::size_t next =
        HWY_DYNAMIC_DISPATCH(skin_dual_vector)(skin, palette, rest, moved, begin, end);
    skin_dual_scalar(skin, palette, rest, moved, next, end);
}

void add_morphs(
    std::span<const MorphTarget> morphs,
    std::span<const float> weights,
    const MovedVertices& vertices) {
    const std::size_t count = std::min(morphs.size(), weights.size());
    for (std::size_t t = 0; t < count; ++t) {
        const MorphTarget& morph = morphs[t];
        const float weight = weights[t];
        if (weight == 0.0f) {
            continue;
        }
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            const std::uint32_t v = morph.vertices[i];
            vertices.positions[v] += weight * morph.positions[i];
            if (!morph.normals.empty()) {
                vertices.normals[v] += weight * morph.normals[i];
            }
            if (!morph.tangents.empty()) {
                vertices.tangents[v] += Vec4(weight * morph.tangents[i], 0.0f);
            }
        }
    }
}

SkinWeights limit_influences(const SkinWeights& skin, std::size_t most) {
    LIMN_CHECK(most > 0);
    SkinWeights limited;
    std::vector<std::uint32_t> kept;
    for (std::size_t v = 0; v + 1 < skin.first.size(); ++v) {
        kept.clear();
        for (std::uint32_t i = skin.first[v]; i < skin.first[v + 1]; ++i) {
            kept.push_back(i);
        }
        std::stable_sort(kept.begin(), kept.end(), [&](std::uint32_t a, std::uint32_t b) {
            return skin.weights[a] > skin.weights[b];
        });
        kept.resize(std::min(kept.size(), most));
        std::sort(kept.begin(), kept.end());  // by joint again
        float sum = 0.0f;
        for (const std::uint32_t i : kept) {
            sum += skin.weights[i];
        }
        limited.first.push_back(static_cast<std::uint32_t>(limited.joints.size()));
        for (const std::uint32_t i : kept) {
            limited.joints.push_back(skin.joints[i]);
            limited.weights.push_back(skin.weights[i] / sum);
        }
    }
    limited.first.push_back(static_cast<std::uint32_t>(limited.joints.size()));
    return limited;
}

}  // namespace limn
#endif  // HWY_ONCE
