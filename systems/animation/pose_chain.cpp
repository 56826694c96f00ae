#include "systems/animation/pose_chain.h"

#include "ecs/base/check.h"
#include "systems/animation/crowd_frames.h"

#include <algorithm>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/animation/pose_chain.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Techniques: char.local-global, char.pose-eval

#ifndef LIMN_POSE_CHAIN_SHARED
#define LIMN_POSE_CHAIN_SHARED
namespace limn::crowd {

static_assert(sizeof(Affine) == 12 * sizeof(float));

/// How many joints of a run are among the first `joints`, at least one.
inline std::size_t length_within(const TrackRun& run, std::size_t joints) {
    return std::min<std::size_t>(run.count, joints - run.first);
}

/// Where the rows of each character are and where its matrices go.
struct Lanes {
    const float* rows[kPoseLanes];
    float* joints[kPoseLanes];
    std::size_t stride;  ///< of the rows
    std::size_t count;   ///< characters; the others are copies that write to a place of their own
};

}  // namespace limn::crowd
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE  // no vectors, or of unknown length

std::size_t crowd_vector_floats() {
    return 1;
}
bool sample_rows(const CrowdClip&, float, PoseRows&) {
    return false;
}
bool blend_rows(const PoseRows&, const PoseRows&, float, PoseRows&) {
    return false;
}
bool multiply_rows(const CrowdRig&, const crowd::Lanes&, const Affine*, float*) {
    return false;
}

#else

#undef LIMN_CROWD_LAMBDA  // once for each target
#define LIMN_CROWD_LAMBDA HWY_ATTR __attribute__((always_inline))

namespace hn = hwy::HWY_NAMESPACE;
using CrowdFloats = hn::CappedTag<float, kPoseLanes>;
using CrowdVector = hn::Vec<CrowdFloats>;
constexpr CrowdFloats kFloats;
constexpr std::size_t kWidth = hn::MaxLanes(kFloats);

std::size_t crowd_vector_floats() {
    return kWidth;
}

template <typename V>
struct CrowdQuat {
    V x;
    V y;
    V z;
    V w;
};

template <typename V>
HWY_INLINE V mix(V a, V b, V u) {
    return hn::Add(a, hn::Mul(hn::Sub(b, a), u));
}

template <typename V>
HWY_INLINE CrowdQuat<V> mix(const CrowdQuat<V>& a, const CrowdQuat<V>& b, V u) {
    return {mix(a.x, b.x, u), mix(a.y, b.y, u), mix(a.z, b.z, u), mix(a.w, b.w, u)};
}

template <typename V>
HWY_INLINE V dot(const CrowdQuat<V>& a, const CrowdQuat<V>& b) {
    return hn::Add(
        hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)),
        hn::Add(hn::Mul(a.z, b.z), hn::Mul(a.w, b.w)));
}

template <typename V>
HWY_INLINE CrowdQuat<V> scale(const CrowdQuat<V>& q, V factor) {
    return {hn::Mul(q.x, factor), hn::Mul(q.y, factor), hn::Mul(q.z, factor), hn::Mul(q.w, factor)};
}

/// Of a quaternion between two unpacked ones.
template <typename D>
HWY_INLINE hn::Vec<D> inverse_length(D d, hn::Vec<D> length2) {
    const auto left =
        hn::Sub(hn::Set(d, 1.0f), hn::Mul(length2, hn::Set(d, 1.0f / crowd::kPackedLength2)));
    const auto next = [&](hn::Vec<D> sum, float coefficient)
                          HWY_ATTR { return hn::Add(hn::Mul(sum, left), hn::Set(d, coefficient)); };
    const auto& c = crowd::kInverseRoot;
    return next(next(next(hn::Set(d, c[3]), c[2]), c[1]), c[0]);
}

/// Rotations whose words are in rows of `width`.
template <typename D>
HWY_INLINE CrowdQuat<hn::Vec<D>> unpack(D d, const std::uint16_t* words, std::size_t width) {
    using V = hn::Vec<D>;
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::int16_t, D> dh;
    const auto* const signed_words = reinterpret_cast<const std::int16_t*>(words);
    const auto word0 = hn::PromoteTo(di, hn::LoadU(dh, signed_words));
    const auto word1 = hn::PromoteTo(di, hn::LoadU(dh, signed_words + width));
    const auto word2 = hn::PromoteTo(di, hn::LoadU(dh, signed_words + 2 * width));
    const V a = hn::ConvertTo(d, word0);
    const V b = hn::ConvertTo(d, word1);
    const V c = hn::ConvertTo(d, word2);
    const V sum = hn::Add(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Mul(c, c));
    const V size = hn::Sqrt(hn::Sub(hn::Set(d, crowd::kPackedLength2), sum));
    const V largest = hn::Xor(size, hn::BitCast(d, hn::ShiftLeft<31>(word2)));  // its sign
    const auto one = hn::Set(di, 1);
    const auto bit0 = hn::RebindMask(d, hn::TestBit(word0, one));
    const auto bit1 = hn::RebindMask(d, hn::TestBit(word1, one));
    return {
        hn::IfThenElse(hn::Or(bit0, bit1), a, largest),
        hn::IfThenElse(bit1, b, hn::IfThenElse(bit0, largest, a)),
        hn::IfThenElse(bit1, hn::IfThenElse(bit0, c, largest), b),
        hn::IfThenElse(hn::And(bit0, bit1), largest, c)};
}

/// Calls put(d, i, count) for vectors of `count` <= Lanes(d) of the elements i .. size: whole ones,
/// then a smaller one for the rest.
template <typename D, typename Put>
HWY_INLINE void each_vector(D d, std::size_t i, std::size_t size, const Put& put) {
    constexpr std::size_t kLanes = hn::MaxLanes(D());
    for (; i + kLanes <= size; i += kLanes) {
        put(d, i, kLanes);
    }
    if (i == size) {
        return;
    }
    if constexpr (kLanes > 4) {
        if (size - i <= kLanes / 2) {
            each_vector(hn::Half<D>(), i, size, put);
            return;
        }
    }
    put(d, i, size - i);
}

/// The first `count` lanes, or all.
template <typename D>
HWY_INLINE void store_first(D d, hn::Vec<D> v, std::size_t count, float* to) {
    if (count == hn::MaxLanes(D())) {
        hn::StoreU(v, d, to);
    } else {
        hn::BlendedStore(v, hn::FirstN(d, count), d, to);
    }
}

/// The animated rotations of the first `joints`.
HWY_INLINE void sample_rotations(
    const CrowdTracks& tracks, const crowd::FramePair& at, std::size_t joints, float* rows,
    std::size_t stride) {
    const std::size_t width = tracks.animated;
    const std::uint16_t* const frame = tracks.frames.data() + 3 * width * at.first;
    const std::size_t next = 3 * width * at.step;
    for (const TrackRun& run : tracks.runs) {
        if (run.first >= joints) {
            break;
        }
        const std::uint16_t* const words = frame + run.track;
        float* const out = rows + run.first;
        each_vector(
            kFloats, 0, crowd::length_within(run, joints),
            [=](auto d, std::size_t i, std::size_t count) LIMN_CROWD_LAMBDA {
                const auto mixed =
                    mix(unpack(d, words + i, width), unpack(d, words + next + i, width),
                        hn::Set(d, at.u));
                const auto q = scale(mixed, inverse_length(d, dot(mixed, mixed)));
                store_first(d, q.x, count, out + i);
                store_first(d, q.y, count, out + stride + i);
                store_first(d, q.z, count, out + 2 * stride + i);
                store_first(d, q.w, count, out + 3 * stride + i);
            });
    }
}

HWY_INLINE void sample_translations(
    const CrowdTracks& tracks, const crowd::FramePair& at, std::size_t joints, float* rows,
    std::size_t stride) {
    const std::size_t width = tracks.animated;
    const std::uint16_t* const frame = tracks.frames.data() + 3 * width * at.first;
    const std::size_t next = 3 * width * at.step;
    for (const TrackRun& run : tracks.runs) {
        if (run.first >= joints) {
            break;
        }
        const std::uint16_t* words = frame + run.track;
        const float* range = tracks.ranges.data() + run.track;
        float* out = rows + run.first;
        for (int axis = 0; axis < 3; ++axis) {
            each_vector(
                kFloats, 0, crowd::length_within(run, joints),
                [=](auto d, std::size_t i, std::size_t count) LIMN_CROWD_LAMBDA {
                    const hn::Rebind<std::uint16_t, decltype(d)> dh;
                    const hn::RebindToSigned<decltype(d)> di;
                    const auto from = hn::PromoteTo(di, hn::LoadU(dh, words + i));
                    const auto to = hn::PromoteTo(di, hn::LoadU(dh, words + next + i));
                    const auto steps =
                        mix(hn::ConvertTo(d, from), hn::ConvertTo(d, to), hn::Set(d, at.u));
                    const auto value = hn::Add(
                        hn::Mul(steps, hn::LoadU(d, range + 3 * width + i)),
                        hn::LoadU(d, range + i));
                    store_first(d, value, count, out + i);
                });
            words += width;
            range += width;
            out += stride;
        }
    }
}

/// The first `size` joints of rows.
HWY_INLINE void blend_block(
    const float* a, const float* b, std::size_t size, std::size_t stride, float weight,
    float* out) {
    const auto blend = [=](auto d, std::size_t i, std::size_t count) LIMN_CROWD_LAMBDA {
        using V = hn::Vec<decltype(d)>;
        const V u = hn::Set(d, weight);
        const auto load = [&](const float* rows, std::size_t row)
                              HWY_ATTR { return hn::LoadU(d, rows + row * stride + i); };
        const CrowdQuat<V> p = {load(a, 0), load(a, 1), load(a, 2), load(a, 3)};
        CrowdQuat<V> q = {load(b, 0), load(b, 1), load(b, 2), load(b, 3)};
        const V sign = hn::And(dot(p, q), hn::Set(d, -0.0f));
        q = {hn::Xor(q.x, sign), hn::Xor(q.y, sign), hn::Xor(q.z, sign), hn::Xor(q.w, sign)};
        const CrowdQuat<V> sum = mix(p, q, u);
        const CrowdQuat<V> mixed = scale(sum, hn::Div(hn::Set(d, 1.0f), hn::Sqrt(dot(sum, sum))));
        store_first(d, mixed.x, count, out + i);
        store_first(d, mixed.y, count, out + stride + i);
        store_first(d, mixed.z, count, out + 2 * stride + i);
        store_first(d, mixed.w, count, out + 3 * stride + i);
        for (std::size_t row = 4; row < PoseRows::kRows; ++row) {
            store_first(d, mix(load(a, row), load(b, row), u), count, out + row * stride + i);
        }
    };
    each_vector(kFloats, 0, size, blend);
}

/// Block b of the vector, of 128 bits, is from from[4 b] + offset.
template <typename D>
HWY_INLINE hn::Vec<D> load_blocks(D d, const float* const* from, std::size_t offset) {
    if constexpr (hn::MaxLanes(D()) <= 4) {
        return hn::LoadU(d, *from + offset);
    } else {
        const hn::Half<D> half;
        return hn::Combine(
            d, load_blocks(half, from + hn::MaxLanes(half), offset),
            load_blocks(half, from, offset));
    }
}

/// Rows of 3x4 matrices of as many characters as a vector has lanes, or four vectors of 4x4 blocks.
/// Not an array: compilers keep its vectors in registers.
struct CrowdRow {
    CrowdVector x;
    CrowdVector y;
    CrowdVector z;
    CrowdVector w;
};

/// Pairs of blocks of `even` go to to[8 b] + offset, those of `odd` to to[8 b + 4], blocks of
/// `last` after each.
template <typename D>
HWY_INLINE void store_pairs(
    D d, hn::Vec<D> even, hn::Vec<D> odd, hn::Vec<D> last, float* const* to, std::size_t offset) {
    const hn::Half<D> half;
    if constexpr (hn::MaxLanes(D()) == 8) {
        hn::StoreU(even, d, to[0] + offset);
        hn::StoreU(hn::LowerHalf(half, last), half, to[0] + offset + 8);
        hn::StoreU(odd, d, to[4] + offset);
        hn::StoreU(hn::UpperHalf(half, last), half, to[4] + offset + 8);
    } else {
        store_pairs(
            half, hn::LowerHalf(half, even), hn::LowerHalf(half, odd), hn::LowerHalf(half, last),
            to, offset);
        store_pairs(
            half, hn::UpperHalf(half, even), hn::UpperHalf(half, odd), hn::UpperHalf(half, last),
            to + 8, offset);
    }
}

/// Blocks b of three vectors, one after another, go to to[4 b] + offset.
HWY_INLINE void
store_blocks(CrowdVector a, CrowdVector b, CrowdVector c, float* const* to, std::size_t offset) {
    if constexpr (kWidth <= 4) {
        float* const first = *to + offset;
        hn::StoreU(a, kFloats, first);
        hn::StoreU(b, kFloats, first + 4);
        hn::StoreU(c, kFloats, first + 8);
    } else {
        store_pairs(
            kFloats, hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a),
            hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a)), c, to, offset);
    }
}

/// Transposes the 4x4 matrices that four vectors have in each of their blocks.
HWY_INLINE CrowdRow transpose(const CrowdRow& v) {
    const hn::Repartition<double, CrowdFloats> pairs;
    const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(kFloats, v.x, v.y));
    const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(kFloats, v.x, v.y));
    const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(kFloats, v.z, v.w));
    const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(kFloats, v.z, v.w));
    return {
        hn::BitCast(kFloats, hn::InterleaveLower(pairs, low01, low23)),
        hn::BitCast(kFloats, hn::InterleaveUpper(pairs, low01, low23)),
        hn::BitCast(kFloats, hn::InterleaveLower(pairs, high01, high23)),
        hn::BitCast(kFloats, hn::InterleaveUpper(pairs, high01, high23))};
}

/// Row `a` of a matrix times another one.
HWY_INLINE CrowdRow
multiply_row(const CrowdRow& a, const CrowdRow& b0, const CrowdRow& b1, const CrowdRow& b2) {
    const auto column = [&a](CrowdVector p, CrowdVector q, CrowdVector r) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(a.x, p), hn::Mul(a.y, q)), hn::Mul(a.z, r));
    };
    return {
        column(b0.x, b1.x, b2.x), column(b0.y, b1.y, b2.y), column(b0.z, b1.z, b2.z),
        hn::Add(column(b0.w, b1.w, b2.w), a.w)};
}

HWY_INLINE CrowdRow load_row(const float* from) {
    return {
        hn::Load(kFloats, from), hn::Load(kFloats, from + kWidth),
        hn::Load(kFloats, from + 2 * kWidth), hn::Load(kFloats, from + 3 * kWidth)};
}

HWY_INLINE void store_row(const CrowdRow& row, float* to) {
    hn::Store(row.x, kFloats, to);
    hn::Store(row.y, kFloats, to + kWidth);
    hn::Store(row.z, kFloats, to + 2 * kWidth);
    hn::Store(row.w, kFloats, to + 3 * kWidth);
}

/// The same number in all lanes.
HWY_INLINE CrowdRow broadcast_row(const Vec4& row) {
    return {
        hn::Set(kFloats, row.x), hn::Set(kFloats, row.y), hn::Set(kFloats, row.z),
        hn::Set(kFloats, row.w)};
}

HWY_INLINE void scale_row(CrowdRow& row, const Vec3& scale) {
    row.x = hn::Mul(row.x, hn::Set(kFloats, scale.x));
    row.y = hn::Mul(row.y, hn::Set(kFloats, scale.y));
    row.z = hn::Mul(row.z, hn::Set(kFloats, scale.z));
}

/// Vectors of a joint's local transform, kWidth floats each.
using CrowdLocal = float[PoseRows::kRows][kWidth];

/// One joint of the characters in lanes: from its local transform to what is stored.
HWY_INLINE void finish_joint(
    const CrowdRig& rig, std::size_t joint, const CrowdLocal& local, const Affine* bind,
    float* slots, float* const* joints) {
    constexpr std::size_t kSlot = 12 * kWidth;
    constexpr std::size_t kRow = 4 * kWidth;
    const CrowdVector one = hn::Set(kFloats, 1.0f);
    const CrowdVector two = hn::Set(kFloats, 2.0f);
    const CrowdRow q = load_row(local[0]);
    const CrowdVector xx = hn::Mul(q.x, q.x);
    const CrowdVector yy = hn::Mul(q.y, q.y);
    const CrowdVector zz = hn::Mul(q.z, q.z);
    const CrowdVector xz = hn::Mul(q.x, q.z);
    const CrowdVector xy = hn::Mul(q.x, q.y);
    const CrowdVector yz = hn::Mul(q.y, q.z);
    const CrowdVector wx = hn::Mul(q.w, q.x);
    const CrowdVector wy = hn::Mul(q.w, q.y);
    const CrowdVector wz = hn::Mul(q.w, q.z);
    // Like affine_from(): T R S.
    CrowdRow row0 = {
        hn::Sub(one, hn::Mul(two, hn::Add(yy, zz))), hn::Mul(two, hn::Sub(xy, wz)),
        hn::Mul(two, hn::Add(xz, wy)), hn::Load(kFloats, local[4])};
    CrowdRow row1 = {
        hn::Mul(two, hn::Add(xy, wz)), hn::Sub(one, hn::Mul(two, hn::Add(xx, zz))),
        hn::Mul(two, hn::Sub(yz, wx)), hn::Load(kFloats, local[5])};
    CrowdRow row2 = {
        hn::Mul(two, hn::Sub(xz, wy)), hn::Mul(two, hn::Add(yz, wx)),
        hn::Sub(one, hn::Mul(two, hn::Add(xx, yy))), hn::Load(kFloats, local[6])};
    if (rig.scaled[joint] != 0) {
        scale_row(row0, rig.scales[joint]);
        scale_row(row1, rig.scales[joint]);
        scale_row(row2, rig.scales[joint]);
    }
    if (rig.parent_slots[joint] != CrowdRig::kNoSlot) {
        const float* const parent = slots + rig.parent_slots[joint] * kSlot;
        const CrowdRow product0 = multiply_row(load_row(parent), row0, row1, row2);
        const CrowdRow product1 = multiply_row(load_row(parent + kRow), row0, row1, row2);
        row2 = multiply_row(load_row(parent + 2 * kRow), row0, row1, row2);
        row0 = product0;
        row1 = product1;
    }
    if (rig.slots[joint] != CrowdRig::kNoSlot) {
        float* const own = slots + rig.slots[joint] * kSlot;
        store_row(row0, own);
        store_row(row1, own + kRow);
        store_row(row2, own + 2 * kRow);
    }
    if (bind != nullptr) {
        const CrowdRow bind0 = broadcast_row(bind[joint].row[0]);
        const CrowdRow bind1 = broadcast_row(bind[joint].row[1]);
        const CrowdRow bind2 = broadcast_row(bind[joint].row[2]);
        row0 = multiply_row(row0, bind0, bind1, bind2);
        row1 = multiply_row(row1, bind0, bind1, bind2);
        row2 = multiply_row(row2, bind0, bind1, bind2);
    }
    row0 = transpose(row0);
    row1 = transpose(row1);
    row2 = transpose(row2);
    store_blocks(row0.x, row1.x, row2.x, joints, 12 * joint);
    store_blocks(row0.y, row1.y, row2.y, joints + 1, 12 * joint);
    store_blocks(row0.z, row1.z, row2.z, joints + 2, 12 * joint);
    store_blocks(row0.w, row1.w, row2.w, joints + 3, 12 * joint);
}

/// Joints begin .. end, whose rows begin with `begin`, of all characters.
HWY_INLINE void multiply_block(
    const CrowdRig& rig, const crowd::Lanes& lanes, std::size_t begin, std::size_t end,
    const Affine* bind, float* slots) {
    alignas(64) CrowdLocal locals[4];
    for (std::size_t group = 0; group < lanes.count; group += kWidth) {
        float* const own_slots = slots + rig.slot_count * 12 * group;
        const float* const* const rows = lanes.rows + group;
        for (std::size_t quad = begin; quad < end; quad += 4) {
            for (std::size_t row = 0; row < PoseRows::kRows; ++row) {
                const std::size_t offset = row * lanes.stride + (quad - begin);
                const CrowdRow v = transpose(
                    {load_blocks(kFloats, rows, offset), load_blocks(kFloats, rows + 1, offset),
                     load_blocks(kFloats, rows + 2, offset),
                     load_blocks(kFloats, rows + 3, offset)});
                hn::Store(v.x, kFloats, locals[0][row]);
                hn::Store(v.y, kFloats, locals[1][row]);
                hn::Store(v.z, kFloats, locals[2][row]);
                hn::Store(v.w, kFloats, locals[3][row]);
            }
            const std::size_t count = end - quad < 4 ? end - quad : 4;
            for (std::size_t k = 0; k < count; ++k) {
                finish_joint(rig, quad + k, locals[k], bind, own_slots, lanes.joints + group);
            }
        }
    }
}

bool sample_rows(const CrowdClip& clip, float time, PoseRows& rows) {
    const crowd::FramePair at = crowd::find_frames(clip, time);
    crowd::copy_all_constants(clip, rows);
    sample_rotations(clip.rotations, at, rows.joints, rows.values.data(), rows.stride);
    sample_translations(
        clip.translations, at, rows.joints, rows.values.data() + 4 * rows.stride, rows.stride);
    return true;
}

bool blend_rows(const PoseRows& a, const PoseRows& b, float weight, PoseRows& out) {
    blend_block(a.values.data(), b.values.data(), a.joints, a.stride, weight, out.values.data());
    return true;
}

bool multiply_rows(
    const CrowdRig& rig, const crowd::Lanes& lanes, const Affine* bind, float* slots) {
    multiply_block(rig, lanes, 0, rig.joints(), bind, slots);
    return true;
}

#endif  // HWY_TARGET

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(crowd_vector_floats);
HWY_EXPORT(sample_rows);
HWY_EXPORT(blend_rows);
HWY_EXPORT(multiply_rows);

namespace {

constexpr std::size_t kMinLanes = 3;  ///< characters for which vectors of them are faster

/// Matrices that the lanes of the last group write which no character has.
struct CrowdScratch {
    std::vector<float> slots;
    std::vector<float> unused;
    std::vector<PoseRows> rows;

    void reserve(const CrowdRig& rig) {
        const std::size_t slot_floats = rig.slot_count * 12 * kPoseLanes + kPoseLanes;
        if (slots.size() < slot_floats) {
            slots.resize(slot_floats);
        }
        if (unused.size() < 12 * rig.joints()) {
            unused.resize(12 * rig.joints());
        }
        rows.resize(kPoseLanes + 1);
    }
    [[nodiscard]] float* aligned_slots() {
        const auto address = reinterpret_cast<std::uintptr_t>(slots.data());
        return slots.data() + (64 - address % 64) % 64 / sizeof(float);
    }
};

CrowdScratch& crowd_scratch(const CrowdRig& rig) {
    thread_local CrowdScratch scratch;
    scratch.reserve(rig);
    return scratch;
}

void sample_character(
    const CrowdCharacter& character, std::size_t joints, PoseRows& rows, PoseRows& next) {
    sample_crowd_clip(*character.clip, character.time, rows, joints);
    if (character.next != nullptr) {
        sample_crowd_clip(*character.next, character.next_time, next, joints);
        blend_poses(rows, next, character.weight, rows);
    }
}

}  // namespace

CrowdRig make_crowd_rig(const SkeletonData& skeleton, std::size_t max_joints) {
    CrowdRig rig;
    const std::size_t joints = std::min(skeleton.parents.size(), max_joints);
    const auto first = [joints](const auto& of) {
        return std::vector(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(joints));
    };
    rig.parents = first(skeleton.parents);
    rig.scales = first(skeleton.rest.scales);
    rig.slots.assign(joints, CrowdRig::kNoSlot);
    rig.parent_slots.assign(joints, CrowdRig::kNoSlot);
    std::vector<std::size_t> last_child(joints, 0);  // 0: none, since the root is no child
    for (std::size_t j = 0; j < joints; ++j) {
        rig.scaled.push_back(rig.scales[j] == Vec3(1) ? 0 : 1);
        if (rig.parents[j] >= 0) {
            last_child[static_cast<std::size_t>(rig.parents[j])] = j;
        }
    }
    std::vector<std::uint16_t> unused;
    for (std::size_t j = 0; j < joints; ++j) {
        if (rig.parents[j] >= 0) {
            const auto parent = static_cast<std::size_t>(rig.parents[j]);
            rig.parent_slots[j] = rig.slots[parent];
            if (last_child[parent] == j) {
                unused.push_back(rig.slots[parent]);  // may become this joint's own
            }
        }
        if (last_child[j] == 0) {
            continue;
        }
        if (unused.empty()) {
            unused.push_back(static_cast<std::uint16_t>(rig.slot_count++));
        }
        rig.slots[j] = unused.back();
        unused.pop_back();
    }
    return rig;
}

void sample_crowd_clip(const CrowdClip& clip, float time, PoseRows& rows, std::size_t max_joints) {
    rows.resize(std::min(clip.joints, max_joints));
    if (!HWY_DYNAMIC_DISPATCH(sample_rows)(clip, time, rows)) {
        sample_crowd_clip_scalar(clip, time, rows, max_joints);
    }
}

void blend_poses(const PoseRows& a, const PoseRows& b, float weight, PoseRows& out) {
    LIMN_CHECK(a.joints == b.joints);
    out.resize(a.joints);
    if (!HWY_DYNAMIC_DISPATCH(blend_rows)(a, b, weight, out)) {
        blend_poses_scalar(a, b, weight, out);
    }
}

void compute_crowd_joints(
    const CrowdRig& rig, std::span<const PoseRows* const> rows, std::span<Affine* const> joints,
    std::span<const Affine> joint_from_mesh) {
    LIMN_CHECK(rows.size() == joints.size());
    LIMN_CHECK(joint_from_mesh.empty() || joint_from_mesh.size() == rig.joints());
    CrowdScratch& scratch = crowd_scratch(rig);
    for (std::size_t begin = 0; begin < rows.size(); begin += kPoseLanes) {
        crowd::Lanes lanes = {};
        lanes.count = std::min(kPoseLanes, rows.size() - begin);
        lanes.stride = rows[begin]->stride;
        for (std::size_t c = 0; c < kPoseLanes; ++c) {
            const bool exists = c < lanes.count;
            lanes.rows[c] = rows[exists ? begin + c : begin]->values.data();
            lanes.joints[c] = exists ? &joints[begin + c]->row[0].x : scratch.unused.data();
        }
        if (lanes.count < kMinLanes
            || !HWY_DYNAMIC_DISPATCH(multiply_rows)(
                rig, lanes, joint_from_mesh.data(), scratch.aligned_slots())) {
            for (std::size_t c = 0; c < lanes.count; ++c) {
                compute_crowd_joints(
                    rig, *rows[begin + c], {joints[begin + c], rig.joints()}, joint_from_mesh);
            }
        }
    }
}

void pose_crowd(
    const CrowdRig& rig, std::span<const CrowdCharacter> characters,
    std::span<const Affine> joint_from_mesh) {
    std::vector<PoseRows>& rows = crowd_scratch(rig).rows;
    for (std::size_t begin = 0; begin < characters.size(); begin += kPoseLanes) {
        const auto group =
            characters.subspan(begin, std::min(kPoseLanes, characters.size() - begin));
        const PoseRows* local[kPoseLanes];
        Affine* joints[kPoseLanes];
        for (std::size_t c = 0; c < group.size(); ++c) {
            sample_character(group[c], rig.joints(), rows[c], rows[kPoseLanes]);
            local[c] = &rows[c];
            joints[c] = group[c].joints;
        }
        compute_crowd_joints(
            rig, std::span(local, group.size()), std::span(joints, group.size()), joint_from_mesh);
    }
}

std::size_t pose_vector_floats() {
    return HWY_DYNAMIC_DISPATCH(crowd_vector_floats)();
}

}  // namespace limn
#endif  // HWY_ONCE
