#include "systems/animation/skin_kernels.h"

#include "ecs/base/check.h"
#include "systems/animation/skin_scalar.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/animation/skin_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/aligned_allocator.h>
#include <hwy/highway.h>

// Quaternions are read as x y z w, dual quaternions as two of them, matrices as three rows of four.
static_assert(sizeof(limn::Quat) == 4 * sizeof(float));
static_assert(sizeof(limn::DualQuaternion) == 8 * sizeof(float));
static_assert(sizeof(limn::Affine) == 12 * sizeof(float));

// Techniques: char.morph-target, char.skin-cpu, char.skin-defects, char.skin-limits,
//     char.skin-rigid

#ifndef LIMN_SKIN_CONSTANTS
#define LIMN_SKIN_CONSTANTS
namespace limn::skin {

/// Floats per joint in the kernels' palettes: a matrix is padded to a cache line.
template <typename Joint>
inline constexpr std::size_t kStride = std::is_same_v<Joint, Affine> ? 16 : 8;

/// Identity transforms.
template <typename Joint>
inline constexpr float kNothing[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
template <>
inline constexpr float kNothing<DualQuaternion>[] = {0, 0, 0, 1, 0, 0, 0, 0};

/// Input and output of the kernels.
template <typename Joint>
struct Work {
    const SkinWeights& skin;
    std::span<const Joint> joints;
    const float* palette;  ///< the same, kStride floats per joint
    const RestVertices& rest;
    const SkinnedVertices& moved;
};

}  // namespace limn::skin
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

// Both return the first unprocessed vertex; the scalar version handles the remainder.

// No vectors, or scalable ones, which structs cannot hold.
#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE

std::size_t skin_linear_vector(const skin::Work<Affine>&, std::size_t begin, std::size_t) {
    return begin;
}
std::size_t skin_dual_vector(const skin::Work<DualQuaternion>&, std::size_t begin, std::size_t) {
    return begin;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using V = hn::Vec<Floats>;
constexpr Floats d;
constexpr hn::Rebind<std::uint32_t, Floats> words;
constexpr hn::Rebind<std::uint16_t, Floats> shorts;
constexpr hn::FixedTag<float, 4> four;

/// Vertices per batch.
constexpr std::size_t kLanes = hn::MaxLanes(d);

// ---- transposition between arrays of 3 or 4 floats per entry and one lane per entry
// --------------

#if HWY_TARGET <= HWY_AVX3  // one instruction selects any 16 of the 32 lanes of two vectors

struct LaneIndices {
    alignas(64) std::int32_t of[kLanes];
};

HWY_INLINE V pick(V a, V b, const LaneIndices& indices) {
    return V{_mm512_permutex2var_ps(a.raw, _mm512_load_si512(indices.of), b.raw)};
}

/// index(lane) for each lane.
template <typename Index>
constexpr LaneIndices make_lane_indices(Index index) {
    LaneIndices indices = {};
    for (int lane = 0; lane < 16; ++lane) {
        indices.of[lane] = index(lane);
    }
    return indices;
}

/// Component `axis` of entry `lane` within the first two of three vectors; arbitrary if it is in
/// the third.
template <int kAxis>
inline constexpr LaneIndices kFromTwo = make_lane_indices([](int lane) {
    return (3 * lane + kAxis) % 32;
});
/// Completes that: keeps lanes already found, takes the others from the third vector as second
/// table.
template <int kAxis>
inline constexpr LaneIndices kFromThird = make_lane_indices([](int lane) {
    return 3 * lane + kAxis < 32 ? lane : 3 * lane + kAxis - 16;
});

HWY_INLINE void load_entries(const float* from, V& x, V& y, V& z) {
    const V a = hn::LoadU(d, from);
    const V b = hn::LoadU(d, from + kLanes);
    const V c = hn::LoadU(d, from + 2 * kLanes);
    x = pick(pick(a, b, kFromTwo<0>), c, kFromThird<0>);
    y = pick(pick(a, b, kFromTwo<1>), c, kFromThird<1>);
    z = pick(pick(a, b, kFromTwo<2>), c, kFromThird<2>);
}

/// x and y of output vector `kVector` of three; arbitrary for z.
template <int kVector>
inline constexpr LaneIndices kXy = make_lane_indices([](int lane) {
    const int number = 16 * kVector + lane;
    return number % 3 == 2 ? 0 : number / 3 + 16 * (number % 3);
});
template <int kVector>
inline constexpr LaneIndices kXyAndZ = make_lane_indices([](int lane) {
    const int number = 16 * kVector + lane;
    return number % 3 == 2 ? 16 + number / 3 : lane;
});

HWY_INLINE void store_entries(V x, V y, V z, float* to) {
    hn::StoreU(pick(pick(x, y, kXy<0>), z, kXyAndZ<0>), d, to);
    hn::StoreU(pick(pick(x, y, kXy<1>), z, kXyAndZ<1>), d, to + kLanes);
    hn::StoreU(pick(pick(x, y, kXy<2>), z, kXyAndZ<2>), d, to + 2 * kLanes);
}

/// From two vectors of four entries each: eight x, then eight y; or z and w.
template <int kPair>
inline constexpr LaneIndices kEights = make_lane_indices([](int lane) {
    return 4 * (lane % 8) + 2 * kPair + lane / 8;
});
/// Lower or upper halves of two vectors.
template <int kHalf>
inline constexpr LaneIndices kHalves = make_lane_indices([](int lane) {
    return lane % 8 + 8 * kHalf + 16 * (lane / 8);
});

HWY_INLINE void load_entries(const float* from, V& x, V& y, V& z, V& w) {
    const V a = hn::LoadU(d, from);
    const V b = hn::LoadU(d, from + kLanes);
    const V c = hn::LoadU(d, from + 2 * kLanes);
    const V e = hn::LoadU(d, from + 3 * kLanes);
    const V xy_ab = pick(a, b, kEights<0>);
    const V xy_ce = pick(c, e, kEights<0>);
    const V zw_ab = pick(a, b, kEights<1>);
    const V zw_ce = pick(c, e, kEights<1>);
    x = hn::ConcatLowerLower(d, xy_ce, xy_ab);
    y = hn::ConcatUpperUpper(d, xy_ce, xy_ab);
    z = hn::ConcatLowerLower(d, zw_ce, zw_ab);
    w = hn::ConcatUpperUpper(d, zw_ce, zw_ab);
}

/// Interleaves a and b: a0 b0 a1 b1 ..., the lower or upper eight.
template <int kHalf>
inline constexpr LaneIndices kZipped = make_lane_indices([](int lane) {
    return 8 * kHalf + lane / 2 + 16 * (lane % 2);
});
/// The same with pairs.
template <int kHalf>
inline constexpr LaneIndices kZippedPairs = make_lane_indices([](int lane) {
    return 8 * kHalf + lane / 4 * 2 + lane % 2 + 16 * (lane / 2 % 2);
});

HWY_INLINE void store_entries(V x, V y, V z, V w, float* to) {
    const V xy0 = pick(x, y, kZipped<0>);
    const V xy1 = pick(x, y, kZipped<1>);
    const V zw0 = pick(z, w, kZipped<0>);
    const V zw1 = pick(z, w, kZipped<1>);
    hn::StoreU(pick(xy0, zw0, kZippedPairs<0>), d, to);
    hn::StoreU(pick(xy0, zw0, kZippedPairs<1>), d, to + kLanes);
    hn::StoreU(pick(xy1, zw1, kZippedPairs<0>), d, to + 2 * kLanes);
    hn::StoreU(pick(xy1, zw1, kZippedPairs<1>), d, to + 3 * kLanes);
}

#else

HWY_INLINE void load_entries(const float* from, V& x, V& y, V& z) {
    hn::LoadInterleaved3(d, from, x, y, z);
}
HWY_INLINE void load_entries(const float* from, V& x, V& y, V& z, V& w) {
    hn::LoadInterleaved4(d, from, x, y, z, w);
}
HWY_INLINE void store_entries(V x, V y, V z, float* to) {
    hn::StoreInterleaved3(x, y, z, d, to);
}
HWY_INLINE void store_entries(V x, V y, V z, V w, float* to) {
    hn::StoreInterleaved4(x, y, z, w, d, to);
}

#endif

// ---- joint influences of a batch ----------------------------------------------------------------

struct Influences {
    const std::uint32_t* first;   ///< of the vertices of the batch, and one past them
    const std::uint16_t* joints;  ///< of the first vertex
    const float* weights;
    std::uint32_t count;    ///< per vertex, 1 .. 4; 0: varying or more
    bool together = false;  ///< all vertices have the same joints
};

HWY_INLINE Influences find_influences(const SkinWeights& skin, std::size_t at) {
    const std::uint32_t* first = skin.first.data() + at;
    const std::uint16_t* joints = skin.joints.data() + first[0];
    const std::uint32_t count = first[1] - first[0];
    Influences by = {first, joints, skin.weights.data() + first[0], count};
    const auto regular =
        hn::Add(hn::Set(words, first[0]), hn::Mul(hn::Set(words, count), hn::Iota(words, 1u)));
    if (count > 4 || !hn::AllTrue(words, hn::Eq(hn::LoadU(words, first + 1), regular))) {
        by.count = 0;
    } else if (count == 1) {
        const auto one = hn::Set(shorts, joints[0]);
        by.together = hn::AllTrue(shorts, hn::Eq(hn::LoadU(shorts, joints), one));
    } else if (count > 1) {
        // Each entry equals that of the previous vertex; the last vectors overlap.
        auto same = hn::Eq(hn::LoadU(shorts, joints), hn::LoadU(shorts, joints + count));
        const std::uint16_t* last = joints + count * (kLanes - 1) - kLanes;
        for (std::uint32_t i = 1; i < count; ++i) {
            const std::uint16_t* some = std::min(joints + i * kLanes, last);
            same = hn::And(same, hn::Eq(hn::LoadU(shorts, some), hn::LoadU(shorts, some + count)));
        }
        by.together = hn::AllTrue(shorts, same);
    }
    return by;
}

// ---- means of a batch with common joints: one lane per vertex, joints are constants
// --------------

/// Called with the index of a float in a joint, returns its weighted mean.
template <std::size_t kCount>
struct Common {
    const float* joint[4] = {};
    V weight[4];

    template <typename Joint>
    HWY_INLINE Common(const skin::Work<Joint>& work, const Influences& by) {
        for (std::size_t i = 0; i < kCount; ++i) {
            joint[i] = work.palette + skin::kStride<Joint> * by.joints[i];
        }
        if constexpr (kCount == 1) {
            weight[0] = hn::LoadU(d, by.weights);
        } else if constexpr (kCount == 2) {
            hn::LoadInterleaved2(d, by.weights, weight[0], weight[1]);
        } else if constexpr (kCount == 3) {
            load_entries(by.weights, weight[0], weight[1], weight[2]);
        } else {
            load_entries(by.weights, weight[0], weight[1], weight[2], weight[3]);
        }
        if constexpr (std::is_same_v<Joint, DualQuaternion>) {
            for (std::size_t i = 1; i < kCount; ++i) {
                if (skin::turns_away(
                        work.joints[by.joints[0]].real, work.joints[by.joints[i]].real)) {
                    weight[i] = hn::Neg(weight[i]);
                }
            }
        }
    }
    template <std::size_t kLast = kCount - 1>
    HWY_INLINE V operator()(std::size_t index) const {
        const V part = hn::Mul(weight[kLast], hn::Set(d, joint[kLast][index]));
        if constexpr (kLast == 0) {
            return part;
        } else {
            return hn::Add(operator()<kLast - 1>(index), part);
        }
    }
};

// ---- means of other batches: vertex by vertex, then transposed
// -----------------------------------

/// Floats of a joint that are blended at once.
template <typename Joint>
using Some = hn::CappedTag<float, skin::kStride<Joint>>;
template <typename Joint>
using SomeV = hn::Vec<Some<Joint>>;

HWY_INLINE SomeV<Affine> weight_of(const skin::Work<Affine>&, const Influences& by, std::size_t i) {
    return hn::Set(Some<Affine>(), by.weights[i]);
}
/// Negated if its joint is in the opposite hemisphere of the first.
HWY_INLINE SomeV<DualQuaternion>
weight_of(const skin::Work<DualQuaternion>& work, const Influences& by, std::size_t i) {
    const auto p = hn::LoadU(four, work.palette + skin::kStride<DualQuaternion> * by.joints[0]);
    const auto q = hn::LoadU(four, work.palette + skin::kStride<DualQuaternion> * by.joints[i]);
    auto side = hn::Mul(p, q);
    side = hn::Add(side, hn::Shuffle1032(side));
    side = hn::Add(side, hn::Shuffle2301(side));
    const auto weight = hn::Set(four, by.weights[i]);
    const auto near = hn::IfThenElse(hn::Lt(side, hn::Zero(four)), hn::Neg(weight), weight);
#if HWY_MAX_BYTES >= 32
    return hn::Combine(Some<DualQuaternion>(), near, near);
#else
    return near;
#endif
}

template <typename Joint>
HWY_INLINE SomeV<Joint>
weighted(const skin::Work<Joint>& work, const Influences& by, std::size_t i, std::size_t at) {
    const auto weight = i == 0 ? hn::Set(Some<Joint>(), by.weights[0]) : weight_of(work, by, i);
    const float* joint = work.palette + skin::kStride<Joint> * by.joints[i];
    return hn::Mul(weight, hn::LoadU(Some<Joint>(), joint + at));
}
/// The mean of the first kCount influences.
template <std::size_t kCount, typename Joint>
HWY_INLINE SomeV<Joint>
mean_of(const skin::Work<Joint>& work, const Influences& by, std::size_t at) {
    if constexpr (kCount == 1) {
        return weighted(work, by, 0, at);
    } else {
        return hn::Add(mean_of<kCount - 1>(work, by, at), weighted(work, by, kCount - 1, at));
    }
}

/// The means of a batch, kStride floats per vertex.
template <typename Joint>
struct Rows {
    HWY_ALIGN float of[skin::kStride<Joint> * kLanes];
};

template <std::size_t kCount, typename Joint>
HWY_INLINE void find_rows(const skin::Work<Joint>& work, Influences by, Rows<Joint>& rows) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        for (std::size_t at = 0; at < skin::kStride<Joint>; at += hn::MaxLanes(Some<Joint>())) {
            hn::Store(
                mean_of<kCount>(work, by, at), Some<Joint>(),
                rows.of + skin::kStride<Joint> * lane + at);
        }
        by.joints += kCount;
        by.weights += kCount;
    }
}
/// Any number of influences per vertex, including none.
template <typename Joint>
HWY_INLINE void find_any_rows(const skin::Work<Joint>& work, Influences by, Rows<Joint>& rows) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::uint32_t count = by.first[lane + 1] - by.first[lane];
        for (std::size_t at = 0; at < skin::kStride<Joint>; at += hn::MaxLanes(Some<Joint>())) {
            auto sum = hn::LoadU(Some<Joint>(), skin::kNothing<Joint> + at);
            if (count > 0) {
                sum = weighted(work, by, 0, at);
                for (std::uint32_t i = 1; i < count; ++i) {
                    sum = hn::Add(sum, weighted(work, by, i, at));
                }
            }
            hn::Store(sum, Some<Joint>(), rows.of + skin::kStride<Joint> * lane + at);
        }
        by.joints += count;
        by.weights += count;
    }
}
template <typename Joint>
HWY_INLINE void find_rows(const skin::Work<Joint>& work, const Influences& by, Rows<Joint>& rows) {
    switch (by.count) {
    case 1:
        return find_rows<1>(work, by, rows);
    case 2:
        return find_rows<2>(work, by, rows);
    case 3:
        return find_rows<3>(work, by, rows);
    case 4:
        return find_rows<4>(work, by, rows);
    default:
        return find_any_rows(work, by, rows);
    }
}

/// Four floats of each vertex, starting at index `at`, transposed: one lane per vertex.
template <typename Joint>
HWY_INLINE void load_four(const Rows<Joint>& rows, std::size_t at, V& x, V& y, V& z, V& w) {
    constexpr std::size_t stride = skin::kStride<Joint>;
    // Vertices i, i + 4, i + 8 ...: each block of four lanes then has one of four neighbors.
    const auto quad = [&](std::size_t i) HWY_ATTR {
        const float* from = rows.of + i * stride + at;
#if HWY_MAX_BYTES >= 64
        constexpr hn::Half<Floats> half;
        return hn::Combine(
            d,
            hn::Combine(
                half, hn::Load(four, from + 12 * stride), hn::Load(four, from + 8 * stride)),
            hn::Combine(half, hn::Load(four, from + 4 * stride), hn::Load(four, from)));
#elif HWY_MAX_BYTES >= 32
        return hn::Combine(d, hn::Load(four, from + 4 * stride), hn::Load(four, from));
#else
        return hn::Load(four, from);
#endif
    };
    const V a = quad(0);
    const V b = quad(1);
    const V c = quad(2);
    const V e = quad(3);
    constexpr hn::RepartitionToWide<Floats> pairs;
    const auto xy_ab = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
    const auto xy_ce = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
    const auto zw_ab = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
    const auto zw_ce = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
    x = hn::BitCast(d, hn::InterleaveLower(pairs, xy_ab, xy_ce));
    y = hn::BitCast(d, hn::InterleaveUpper(pairs, xy_ab, xy_ce));
    z = hn::BitCast(d, hn::InterleaveLower(pairs, zw_ab, zw_ce));
    w = hn::BitCast(d, hn::InterleaveUpper(pairs, zw_ab, zw_ce));
}

// ---- the mean of each vertex of a batch ---------------------------------------------------------

/// One matrix per lane.
struct Matrices {
    V xx, xy, xz, xt;
    V yx, yy, yz, yt;
    V zx, zy, zz, zt;
};

template <std::size_t kCount>
HWY_INLINE void find_common(const skin::Work<Affine>& work, const Influences& by, Matrices& m) {
    const Common<kCount> mean(work, by);
    m.xx = mean(0);
    m.xy = mean(1);
    m.xz = mean(2);
    m.xt = mean(3);
    m.yx = mean(4);
    m.yy = mean(5);
    m.yz = mean(6);
    m.yt = mean(7);
    m.zx = mean(8);
    m.zy = mean(9);
    m.zz = mean(10);
    m.zt = mean(11);
}

HWY_INLINE void
find_means(const skin::Work<Affine>& work, const Influences& by, std::size_t, Matrices& m) {
    switch (by.together ? by.count : 0) {
    case 1:
        return find_common<1>(work, by, m);
    case 2:
        return find_common<2>(work, by, m);
    case 3:
        return find_common<3>(work, by, m);
    case 4:
        return find_common<4>(work, by, m);
    default:
        break;
    }
    Rows<Affine> rows;
    find_rows(work, by, rows);
    load_four(rows, 0, m.xx, m.xy, m.xz, m.xt);
    load_four(rows, 4, m.yx, m.yy, m.yz, m.yt);
    load_four(rows, 8, m.zx, m.zy, m.zz, m.zt);
}

/// One dual quaternion per lane, not normalized.
struct Motions {
    V x, y, z, w;
    V dx, dy, dz, dw;
};

template <std::size_t kCount>
HWY_INLINE void
find_common(const skin::Work<DualQuaternion>& work, const Influences& by, Motions& q) {
    const Common<kCount> mean(work, by);
    q.x = mean(0);
    q.y = mean(1);
    q.z = mean(2);
    q.w = mean(3);
    q.dx = mean(4);
    q.dy = mean(5);
    q.dz = mean(6);
    q.dw = mean(7);
}

HWY_INLINE V dot3(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}
/// a b - c e
HWY_INLINE V cross_part(V a, V b, V c, V e) {
    return hn::Sub(hn::Mul(a, b), hn::Mul(c, e));
}
HWY_INLINE V squared_length(const Motions& q) {
    return hn::Add(dot3(q.x, q.y, q.z, q.x, q.y, q.z), hn::Mul(q.w, q.w));
}

HWY_INLINE void
find_motions(const skin::Work<DualQuaternion>& work, const Influences& by, Motions& q) {
    switch (by.together ? by.count : 0) {
    case 1:
        return find_common<1>(work, by, q);
    case 2:
        return find_common<2>(work, by, q);
    case 3:
        return find_common<3>(work, by, q);
    case 4:
        return find_common<4>(work, by, q);
    default:
        break;
    }
    Rows<DualQuaternion> rows;
    find_rows(work, by, rows);
    load_four(rows, 0, q.x, q.y, q.z, q.w);
    load_four(rows, 4, q.dx, q.dy, q.dz, q.dw);
}

/// The same by the scalar version, which handles dual quaternions that cancel.
HWY_INLINE void
find_motions_again(const skin::Work<DualQuaternion>& work, std::size_t at, Motions& q) {
    Rows<DualQuaternion> rows;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const DualQuaternion mean = skin::mean_motion(work.skin, work.joints, at + lane);
        std::memcpy(rows.of + skin::kStride<DualQuaternion> * lane, &mean, sizeof mean);
    }
    load_four(rows, 0, q.x, q.y, q.z, q.w);
    load_four(rows, 4, q.dx, q.dy, q.dz, q.dw);
}

HWY_INLINE void find_means(
    const skin::Work<DualQuaternion>& work, const Influences& by, std::size_t at, Matrices& m) {
    Motions q;
    find_motions(work, by, q);
    const V min_length2 = hn::Set(d, skin::kNoMotion);
    if (!hn::AllTrue(d, hn::Gt(squared_length(q), min_length2))) {
        find_motions_again(work, at, q);
    }
    // 2 / |real|^2 normalizes all products.
    const V s = hn::Div(hn::Set(d, 2.0f), squared_length(q));
    const V xx = hn::Mul(s, hn::Mul(q.x, q.x));
    const V yy = hn::Mul(s, hn::Mul(q.y, q.y));
    const V zz = hn::Mul(s, hn::Mul(q.z, q.z));
    const V xy = hn::Mul(s, hn::Mul(q.x, q.y));
    const V xz = hn::Mul(s, hn::Mul(q.x, q.z));
    const V yz = hn::Mul(s, hn::Mul(q.y, q.z));
    const V wx = hn::Mul(s, hn::Mul(q.w, q.x));
    const V wy = hn::Mul(s, hn::Mul(q.w, q.y));
    const V wz = hn::Mul(s, hn::Mul(q.w, q.z));
    const V tx = hn::Add(cross_part(q.w, q.dx, q.dw, q.x), cross_part(q.y, q.dz, q.z, q.dy));
    const V ty = hn::Add(cross_part(q.w, q.dy, q.dw, q.y), cross_part(q.z, q.dx, q.x, q.dz));
    const V tz = hn::Add(cross_part(q.w, q.dz, q.dw, q.z), cross_part(q.x, q.dy, q.y, q.dx));
    const V one = hn::Set(d, 1.0f);
    m.xx = hn::Sub(one, hn::Add(yy, zz));
    m.xy = hn::Sub(xy, wz);
    m.xz = hn::Add(xz, wy);
    m.xt = hn::Mul(s, tx);
    m.yx = hn::Add(xy, wz);
    m.yy = hn::Sub(one, hn::Add(xx, zz));
    m.yz = hn::Sub(yz, wx);
    m.yt = hn::Mul(s, ty);
    m.zx = hn::Sub(xz, wy);
    m.zy = hn::Add(yz, wx);
    m.zz = hn::Sub(one, hn::Add(xx, yy));
    m.zt = hn::Mul(s, tz);
}

// ---- transformation of a batch ------------------------------------------------------------------

/// Normals and tangents of a batch.
template <typename Joint>
HWY_INLINE void turn_batch(const skin::Work<Joint>& work, const Matrices& m, std::size_t at) {
    const V one = hn::Set(d, 1.0f);
    V x;
    V y;
    V z;
    V w;

    // Normals: cofactors, then the sign of the determinant.
    const V ax = cross_part(m.yy, m.zz, m.yz, m.zy);
    const V ay = cross_part(m.yz, m.zx, m.yx, m.zz);
    const V az = cross_part(m.yx, m.zy, m.yy, m.zx);
    const V bx = cross_part(m.zy, m.xz, m.zz, m.xy);
    const V by = cross_part(m.zz, m.xx, m.zx, m.xz);
    const V bz = cross_part(m.zx, m.xy, m.zy, m.xx);
    const V cx = cross_part(m.xy, m.yz, m.xz, m.yy);
    const V cy = cross_part(m.xz, m.yx, m.xx, m.yz);
    const V cz = cross_part(m.xx, m.yy, m.xy, m.yx);
    load_entries(&work.rest.normals[at].x, x, y, z);
    V nx = dot3(ax, ay, az, x, y, z);
    V ny = dot3(bx, by, bz, x, y, z);
    V nz = dot3(cx, cy, cz, x, y, z);
    const V normal2 = dot3(nx, ny, nz, nx, ny, nz);
    const V size = hn::Add(
        hn::Add(dot3(m.xx, m.xy, m.xz, m.xx, m.xy, m.xz), dot3(m.yx, m.yy, m.yz, m.yx, m.yy, m.yz)),
        dot3(m.zx, m.zy, m.zz, m.zx, m.zy, m.zz));
    const V flat = hn::Mul(hn::Set(d, skin::kFlat), hn::Mul(size, size));
    const V side = dot3(m.xx, m.xy, m.xz, ax, ay, az);
    const V normal_unit = hn::CopySign(hn::Div(one, hn::Sqrt(normal2)), side);
    nx = hn::Mul(nx, normal_unit);
    ny = hn::Mul(ny, normal_unit);
    nz = hn::Mul(nz, normal_unit);
    if (HWY_UNLIKELY(!hn::AllTrue(d, hn::Gt(normal2, flat)))) {
        Vec3 normals[kLanes];
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            normals[lane] =
                skin::moved_normal(work.skin, work.joints, work.rest.normals[at + lane], at + lane);
        }
        hn::LoadInterleaved3(d, &normals[0].x, nx, ny, nz);
    }
    store_entries(nx, ny, nz, &work.moved.normals[at].x);

    load_entries(&work.rest.tangents[at].x, x, y, z, w);
    const V tx = dot3(m.xx, m.xy, m.xz, x, y, z);
    const V ty = dot3(m.yx, m.yy, m.yz, x, y, z);
    const V tz = dot3(m.zx, m.zy, m.zz, x, y, z);
    const V tangent2 = dot3(tx, ty, tz, tx, ty, tz);
    const V tangent_unit = hn::Div(one, hn::Sqrt(tangent2));
    const auto turned = hn::Gt(tangent2, hn::Set(d, skin::kNoLength));
    store_entries(
        hn::IfThenElse(turned, hn::Mul(tx, tangent_unit), x),
        hn::IfThenElse(turned, hn::Mul(ty, tangent_unit), y),
        hn::IfThenElse(turned, hn::Mul(tz, tangent_unit), z), w, &work.moved.tangents[at].x);
}

template <typename Joint>
HWY_INLINE void move_batch(const skin::Work<Joint>& work, const Matrices& m, std::size_t at) {
    if (!work.moved.normals.empty()) {
        turn_batch(work, m, at);
    }
    V x;
    V y;
    V z;
    load_entries(&work.rest.positions[at].x, x, y, z);
    store_entries(
        hn::Add(dot3(m.xx, m.xy, m.xz, x, y, z), m.xt),
        hn::Add(dot3(m.yx, m.yy, m.yz, x, y, z), m.yt),
        hn::Add(dot3(m.zx, m.zy, m.zz, x, y, z), m.zt), &work.moved.positions[at].x);
}

template <typename Joint>
HWY_INLINE std::size_t
move_batches(const skin::Work<Joint>& work, std::size_t begin, std::size_t end) {
    for (; begin + kLanes <= end; begin += kLanes) {
        Matrices means;
        find_means(work, find_influences(work.skin, begin), begin, means);
        move_batch(work, means, begin);
    }
    return begin;
}

std::size_t skin_linear_vector(const skin::Work<Affine>& work, std::size_t begin, std::size_t end) {
    return move_batches(work, begin, end);
}
std::size_t
skin_dual_vector(const skin::Work<DualQuaternion>& work, std::size_t begin, std::size_t end) {
    return move_batches(work, begin, end);
}

#endif  // HWY_TARGET

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(skin_linear_vector);
HWY_EXPORT(skin_dual_vector);

namespace {

void check_spans(
    const SkinWeights& skin, const RestVertices& rest, const SkinnedVertices& moved,
    std::size_t end) {
    const std::size_t count = rest.positions.size();
    const std::size_t turned = moved.normals.empty() ? 0 : count;
    LIMN_CHECK(rest.normals.size() == turned && rest.tangents.size() == turned);
    LIMN_CHECK(
        moved.positions.size() == count && moved.normals.size() == turned
        && moved.tangents.size() == turned);
    LIMN_CHECK(skin.first.size() == count + 1 && end <= count);
}

/// Palettes of the kernels, aligned to cache lines; their memory is reused.
struct PaletteMemory {
    hwy::AlignedFreeUniquePtr<float[]> data;
    std::size_t size = 0;
};

/// kStride floats per joint; valid until the next call on this thread.
template <typename Joint>
const float* make_palette(std::span<const Joint> joints) {
    thread_local PaletteMemory memory;
    constexpr std::size_t stride = skin::kStride<Joint>;
    if (memory.size < stride * joints.size()) {
        memory.size = stride * joints.size();
        memory.data = hwy::AllocateAligned<float>(memory.size);
    }
    float* const palette = memory.data.get();
    for (std::size_t i = 0; i < joints.size(); ++i) {
        std::memset(palette + stride * i, 0, stride * sizeof(float));
        std::memcpy(palette + stride * i, &joints[i], sizeof(Joint));
    }
    return palette;
}

}  // namespace

void skin_linear(
    const SkinWeights& skin, std::span<const Affine> palette, const RestVertices& rest,
    const SkinnedVertices& moved, std::size_t begin, std::size_t end) {
    check_spans(skin, rest, moved, end);
    const float* const numbers = make_palette(palette);
    const skin::Work<Affine> work = {skin, palette, numbers, rest, moved};
    const std::size_t next = HWY_DYNAMIC_DISPATCH(skin_linear_vector)(work, begin, end);
    skin_linear_scalar(skin, palette, rest, moved, next, end);
}

void skin_dual(
    const SkinWeights& skin, std::span<const DualQuaternion> palette, const RestVertices& rest,
    const SkinnedVertices& moved, std::size_t begin, std::size_t end) {
    check_spans(skin, rest, moved, end);
    const float* const numbers = make_palette(palette);
    const skin::Work<DualQuaternion> work = {skin, palette, numbers, rest, moved};
    const std::size_t next = HWY_DYNAMIC_DISPATCH(skin_dual_vector)(work, begin, end);
    skin_dual_scalar(skin, palette, rest, moved, next, end);
}

}  // namespace limn
#endif  // HWY_ONCE
