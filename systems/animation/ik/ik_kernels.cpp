#include "systems/animation/ik/ik_kernels.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cmath>

// Vectors are members of structs here, which those of unknown size cannot be.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/animation/ik/ik_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Techniques: char.ik-ccd, char.ik-pinv, char.ik-two-link

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The solvers are templates of a number type: Lanes, or float for the scalar versions. Below, "a
// number" is one of each chain.

constexpr hn::ScalableTag<float> d;

struct Lanes {
    hn::Vec<decltype(d)> v;
};
HWY_INLINE Lanes operator+(Lanes a, Lanes b) {
    return {hn::Add(a.v, b.v)};
}
HWY_INLINE Lanes operator-(Lanes a, Lanes b) {
    return {hn::Sub(a.v, b.v)};
}
HWY_INLINE Lanes operator*(Lanes a, Lanes b) {
    return {hn::Mul(a.v, b.v)};
}
HWY_INLINE Lanes operator/(Lanes a, Lanes b) {
    return {hn::Div(a.v, b.v)};
}
HWY_INLINE Lanes root_of(Lanes a) {
    return {hn::Sqrt(a.v)};
}
HWY_INLINE float root_of(float a) {
    return std::sqrt(a);
}
/// `yes` where a > b, else `no`; also where one of them is NaN.
HWY_INLINE Lanes if_greater(Lanes a, Lanes b, Lanes yes, Lanes no) {
    return {hn::IfThenElse(hn::Gt(a.v, b.v), yes.v, no.v)};
}
HWY_INLINE float if_greater(float a, float b, float yes, float no) {
    return a > b ? yes : no;
}
HWY_INLINE void load(const float* from, Lanes& to) {
    to.v = hn::LoadU(d, from);
}
HWY_INLINE void load(const float* from, float& to) {
    to = *from;
}
HWY_INLINE void store(Lanes value, float* to) {
    hn::StoreU(value.v, d, to);
}
HWY_INLINE void store(float value, float* to) {
    *to = value;
}
template <typename F>
HWY_INLINE F number(float value);
template <>
HWY_INLINE Lanes number<Lanes>(float value) {
    return {hn::Set(d, value)};
}
template <>
HWY_INLINE float number<float>(float value) {
    return value;
}
template <typename F>
HWY_INLINE F larger(F a, F b) {
    return if_greater(a, b, a, b);
}
template <typename F>
HWY_INLINE F smaller(F a, F b) {
    return if_greater(b, a, a, b);
}

template <typename F>
struct Vec {
    F x;
    F y;
    F z;
};
template <typename F>
HWY_INLINE Vec<F> operator+(Vec<F> a, Vec<F> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename F>
HWY_INLINE Vec<F> operator-(Vec<F> a, Vec<F> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename F>
HWY_INLINE Vec<F> operator*(F s, Vec<F> a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <typename F>
HWY_INLINE F dot(Vec<F> a, Vec<F> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename F>
HWY_INLINE Vec<F> cross(Vec<F> a, Vec<F> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename F>
HWY_INLINE Vec<F> if_greater(F a, F b, Vec<F> yes, Vec<F> no) {
    return {
        if_greater(a, b, yes.x, no.x), if_greater(a, b, yes.y, no.y),
        if_greater(a, b, yes.z, no.z)};
}

template <typename F>
HWY_INLINE Vec<F> load_vec(const Vec3Lanes& from, std::size_t i) {
    Vec<F> v;
    load(&from.x[i], v.x);
    load(&from.y[i], v.y);
    load(&from.z[i], v.z);
    return v;
}
template <typename F>
HWY_INLINE void store_vec(Vec<F> v, Vec3Lanes& to, std::size_t i) {
    store(v.x, &to.x[i]);
    store(v.y, &to.y[i]);
    store(v.z, &to.z[i]);
}

/// A vector perpendicular to `n`, at least half as long.
template <typename F>
HWY_INLINE Vec<F> perpendicular(Vec<F> n) {
    const F zero = number<F>(0);
    const F half = number<F>(0.5f);
    return if_greater(
        n.x * n.x, half * dot(n, n), Vec<F>{n.y, zero - n.x, zero}, Vec<F>{zero, n.z, zero - n.y});
}

template <typename F>
struct Turn {
    Vec<F> v;
    F w;
};

/// The shortest arc from a to b as a unit quaternion; `size`: the product of their lengths.
template <typename F>
HWY_INLINE Turn<F> shortest_arc(Vec<F> a, Vec<F> b, F size) {
    const F one = number<F>(1);
    const F zero = number<F>(0);
    Vec<F> v = cross(a, b);
    F w = size + dot(a, b);
    // Opposite: half a turn about a perpendicular; one of them zero: none.
    const F length2 = w * w + dot(v, v);
    const F least = number<F>(1e-12f) * size * size;
    v = if_greater(length2, least, v, perpendicular(a));
    w = if_greater(length2, least, w, zero);
    const F tiny = number<F>(1e-30f);
    v = if_greater(size, tiny, v, Vec<F>{zero, zero, zero});
    w = if_greater(size, tiny, w, one);
    const F scale = one / root_of(w * w + dot(v, v));
    return {scale * v, scale * w};
}

template <typename F>
HWY_INLINE Vec<F> rotate(Turn<F> q, Vec<F> b) {
    const Vec<F> c = cross(q.v, b);
    const F two = number<F>(2);
    return b + two * (q.w * c + cross(q.v, c));
}

template <typename F>
HWY_INLINE void store_turn(Turn<F> q, QuatLanes& to, std::size_t i) {
    store(q.v.x, &to.x[i]);
    store(q.v.y, &to.y[i]);
    store(q.v.z, &to.z[i]);
    store(q.w, &to.w[i]);
}

template <typename F>
HWY_INLINE void solve_two_link_at(TwoLinkBatch& batch, std::size_t i) {
    const F zero = number<F>(0);
    const F one = number<F>(1);
    const Vec<F> root = load_vec<F>(batch.root, i);
    const Vec<F> middle = load_vec<F>(batch.middle, i);
    const Vec<F> upper = middle - root;
    const Vec<F> lower = load_vec<F>(batch.tip, i) - middle;
    const Vec<F> way = load_vec<F>(batch.target, i) - root;
    const F upper2 = dot(upper, upper);
    const F lower2 = dot(lower, lower);
    const F upper1 = root_of(upper2);
    const F lower1 = root_of(lower2);
    const F far = root_of(dot(way, way));
    const F tiny = number<F>(1e-12f);
    const F far_one = one / larger(far, tiny);
    const Vec<F> n = if_greater(far, tiny, far_one * way, Vec<F>{zero, zero, one});
    const F difference = larger(upper1 - lower1, lower1 - upper1);
    const F distance = larger(smaller(far, upper1 + lower1), difference);

    // The elbow: its foot on the line, and its distance from it toward the pole.
    const F ratio = (upper2 - lower2 + distance * distance) / larger(distance + distance, tiny);
    const F along = larger(smaller(ratio, upper1), zero - upper1);
    const F radius = root_of(larger(upper2 - along * along, zero));
    const Vec<F> pole = load_vec<F>(batch.pole, i);
    const Vec<F> beside = pole - dot(pole, n) * n;
    const F beside2 = dot(beside, beside);
    const Vec<F> up =
        if_greater(beside2, number<F>(1e-8f) * dot(pole, pole), beside, perpendicular(n));
    const Vec<F> elbow = along * n + (radius / root_of(dot(up, up))) * up;

    const Turn<F> first = shortest_arc(upper, elbow, upper2);
    const Turn<F> second = shortest_arc(rotate(first, lower), distance * n - elbow, lower2);
    store_turn(first, batch.upper, i);
    store_turn(second, batch.lower, i);
}

template <typename F>
HWY_INLINE void aim_at(AimBatch& batch, std::size_t i) {
    const Vec<F> forward = load_vec<F>(batch.forward, i);
    const Vec<F> wanted = load_vec<F>(batch.wanted, i);
    const F size = root_of(dot(forward, forward) * dot(wanted, wanted));
    store_turn(shortest_arc(forward, wanted, size), batch.rotation, i);
}

/// The bones of one chain, in registers or near them.
template <typename F>
struct Chain {
    Vec<F> root;
    Vec<F> bones[ChainBatch::kMaxLinks];
    Vec<F> goal;
};

template <typename F>
HWY_INLINE void load_chain(const ChainBatch& batch, std::size_t i, Chain<F>& chain) {
    chain.root = load_vec<F>(batch.points, i);
    Vec<F> last = chain.root;
    for (std::size_t k = 0; k < batch.links; ++k) {
        const Vec<F> next = load_vec<F>(batch.points, (k + 1) * batch.count + i);
        chain.bones[k] = next - last;
        last = next;
    }
    chain.goal = load_vec<F>(batch.goals, i);
}

template <typename F>
HWY_INLINE void store_chain(const Chain<F>& chain, ChainBatch& batch, std::size_t i) {
    Vec<F> point = chain.root;
    for (std::size_t k = 0; k < batch.links; ++k) {
        point = point + chain.bones[k];
        store_vec(point, batch.points, (k + 1) * batch.count + i);
    }
}

template <typename F>
HWY_INLINE Vec<F> tip_of(const Chain<F>& chain, std::size_t links) {
    Vec<F> tip = chain.root;
    for (std::size_t k = 0; k < links; ++k) {
        tip = tip + chain.bones[k];
    }
    return tip;
}

template <typename F>
HWY_INLINE F length_of(const Chain<F>& chain, std::size_t links) {
    F length = number<F>(0);
    for (std::size_t k = 0; k < links; ++k) {
        length = length + root_of(dot(chain.bones[k], chain.bones[k]));
    }
    return length;
}

template <typename F>
HWY_INLINE void solve_chain_dls_at(ChainBatch& batch, const ChainOptions& options, std::size_t i) {
    const F one = number<F>(1);
    const F two = number<F>(2);
    const F half = number<F>(0.5f);
    const std::size_t links = batch.links;
    Chain<F> chain;
    load_chain(batch, i, chain);
    const F lambda = number<F>(options.damping) * length_of(chain, links);
    const F lambda2 = lambda * lambda + number<F>(1e-12f);
    Vec<F> ways[ChainBatch::kMaxLinks];  // from each joint to the tip
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
        // J J^T, symmetric.
        F xx = lambda2;
        F yy = lambda2;
        F zz = lambda2;
        F xy = number<F>(0);
        F xz = number<F>(0);
        F yz = number<F>(0);
        Vec<F> r = {number<F>(0), number<F>(0), number<F>(0)};
        for (std::size_t k = links; k-- > 0;) {
            r = r + chain.bones[k];
            ways[k] = r;
            const F x2 = r.x * r.x;
            const F y2 = r.y * r.y;
            const F z2 = r.z * r.z;
            xx = xx + (y2 + z2);
            yy = yy + (x2 + z2);
            zz = zz + (x2 + y2);
            xy = xy - r.x * r.y;
            xz = xz - r.x * r.z;
            yz = yz - r.y * r.z;
        }
        const Vec<F> left = chain.goal - (chain.root + r);
        // Cramer's rule: rows of the adjugate.
        const Vec<F> a = {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy};
        const Vec<F> b = {a.y, xx * zz - xz * xz, xy * xz - xx * yz};
        const Vec<F> c = {a.z, b.z, xx * yy - xy * xy};
        const F reciprocal = half / (xx * a.x + xy * a.y + xz * a.z);
        const Vec<F> y = reciprocal * Vec<F>{dot(a, left), dot(b, left), dot(c, left)};
        // Half the turn of each joint adds to those of the joints before it (Cayley's map).
        Vec<F> turn = {number<F>(0), number<F>(0), number<F>(0)};
        for (std::size_t k = 0; k < links; ++k) {
            turn = turn + cross(ways[k], y);
            const Vec<F> bone = chain.bones[k];
            const Vec<F> once = cross(turn, bone);
            const F scale = two / (one + dot(turn, turn));
            chain.bones[k] = bone + scale * (once + cross(turn, once));
        }
    }
    store_chain(chain, batch, i);
}

template <typename F>
HWY_INLINE void
solve_chain_fabrik_at(ChainBatch& batch, const ChainOptions& options, std::size_t i) {
    const F tiny = number<F>(1e-12f);
    const std::size_t links = batch.links;
    Vec<F> points[ChainBatch::kMaxLinks + 1];
    F lengths[ChainBatch::kMaxLinks];
    for (std::size_t k = 0; k <= links; ++k) {
        points[k] = load_vec<F>(batch.points, k * batch.count + i);
    }
    for (std::size_t k = 0; k < links; ++k) {
        const Vec<F> bone = points[k + 1] - points[k];
        lengths[k] = root_of(dot(bone, bone));
    }
    const Vec<F> root = points[0];
    const Vec<F> goal = load_vec<F>(batch.goals, i);
    const Vec<F> up = {number<F>(0), number<F>(1), number<F>(0)};
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
        points[links] = goal;
        for (std::size_t k = links; k-- > 0;) {
            const Vec<F> way = points[k] - points[k + 1];
            const F size = root_of(dot(way, way));
            const Vec<F> bone =
                if_greater(size, tiny, (lengths[k] / larger(size, tiny)) * way, lengths[k] * up);
            points[k] = points[k + 1] + bone;
        }
        points[0] = root;
        for (std::size_t k = 0; k < links; ++k) {
            const Vec<F> way = points[k + 1] - points[k];
            const F size = root_of(dot(way, way));
            const Vec<F> bone =
                if_greater(size, tiny, (lengths[k] / larger(size, tiny)) * way, lengths[k] * up);
            points[k + 1] = points[k] + bone;
        }
    }
    for (std::size_t k = 1; k <= links; ++k) {
        store_vec(points[k], batch.points, k * batch.count + i);
    }
}

template <typename F>
HWY_INLINE void solve_chain_ccd_at(ChainBatch& batch, const ChainOptions& options, std::size_t i) {
    const F zero = number<F>(0);
    const F one = number<F>(1);
    const std::size_t links = batch.links;
    Chain<F> chain;
    load_chain(batch, i, chain);
    Turn<F> turns[ChainBatch::kMaxLinks];
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
        Vec<F> tip = tip_of(chain, links);
        Vec<F> point = tip;
        for (std::size_t k = links; k-- > 0;) {
            // Joint k, whose place the turns so far have not changed, seen from the old tip.
            point = point - chain.bones[k];
            const Vec<F> from = tip - point;
            const Vec<F> to = chain.goal - point;
            const F size = root_of(dot(from, from) * dot(to, to));
            const F w = size + dot(from, to);
            const Vec<F> v = cross(from, to);
            const F length2 = w * w + dot(v, v);
            const F least = number<F>(1e-12f) * size * size + number<F>(1e-30f);
            const F scale = one / root_of(larger(length2, least));
            const F used = if_greater(length2, least, scale, zero);  // opposite: it stays
            turns[k] = {used * v, if_greater(length2, least, scale * w, one)};
            tip = point + rotate(turns[k], from);
        }
        // A bone is turned by all joints before it.
        Turn<F> all = turns[0];
        chain.bones[0] = rotate(all, chain.bones[0]);
        for (std::size_t k = 1; k < links; ++k) {
            const Turn<F> q = turns[k];
            const F w = all.w * q.w - dot(all.v, q.v);
            all.v = all.w * q.v + q.w * all.v + cross(all.v, q.v);
            all.w = w;
            chain.bones[k] = rotate(all, chain.bones[k]);
        }
    }
    store_chain(chain, batch, i);
}

// Each returns the number of chains it has solved: those in whole vectors.

std::size_t two_links_vector(TwoLinkBatch& batch) {
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= batch.root.size(); i += hn::Lanes(d)) {
        solve_two_link_at<Lanes>(batch, i);
    }
    return i;
}

std::size_t aim_vector(AimBatch& batch) {
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= batch.forward.size(); i += hn::Lanes(d)) {
        aim_at<Lanes>(batch, i);
    }
    return i;
}

std::size_t chains_dls_vector(ChainBatch& batch, const ChainOptions& options) {
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= batch.count; i += hn::Lanes(d)) {
        solve_chain_dls_at<Lanes>(batch, options, i);
    }
    return i;
}

std::size_t chains_fabrik_vector(ChainBatch& batch, const ChainOptions& options) {
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= batch.count; i += hn::Lanes(d)) {
        solve_chain_fabrik_at<Lanes>(batch, options, i);
    }
    return i;
}

std::size_t chains_ccd_vector(ChainBatch& batch, const ChainOptions& options) {
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= batch.count; i += hn::Lanes(d)) {
        solve_chain_ccd_at<Lanes>(batch, options, i);
    }
    return i;
}

#if HWY_TARGET == HWY_STATIC_TARGET  // the scalar versions, once

void two_links_rest(TwoLinkBatch& batch, std::size_t first) {
    for (std::size_t i = first; i < batch.root.size(); ++i) {
        solve_two_link_at<float>(batch, i);
    }
}

void aim_rest(AimBatch& batch, std::size_t first) {
    for (std::size_t i = first; i < batch.forward.size(); ++i) {
        aim_at<float>(batch, i);
    }
}

void chains_dls_rest(ChainBatch& batch, const ChainOptions& options, std::size_t first) {
    for (std::size_t i = first; i < batch.count; ++i) {
        solve_chain_dls_at<float>(batch, options, i);
    }
}

void chains_fabrik_rest(ChainBatch& batch, const ChainOptions& options, std::size_t first) {
    for (std::size_t i = first; i < batch.count; ++i) {
        solve_chain_fabrik_at<float>(batch, options, i);
    }
}

void chains_ccd_rest(ChainBatch& batch, const ChainOptions& options, std::size_t first) {
    for (std::size_t i = first; i < batch.count; ++i) {
        solve_chain_ccd_at<float>(batch, options, i);
    }
}

#endif

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(two_links_vector);
HWY_EXPORT(aim_vector);
HWY_EXPORT(chains_dls_vector);
HWY_EXPORT(chains_fabrik_vector);
HWY_EXPORT(chains_ccd_vector);

namespace {

void check_batch(const ChainBatch& batch) {
    LIMN_CHECK(batch.links >= 1 && batch.links <= ChainBatch::kMaxLinks);
    LIMN_CHECK(batch.points.size() == (batch.links + 1) * batch.count);
    LIMN_CHECK(batch.goals.size() == batch.count);
}

}  // namespace

void TwoLinkBatch::resize(std::size_t count) {
    for (Vec3Lanes* lanes : {&root, &middle, &tip, &target, &pole}) {
        lanes->resize(count);
    }
    upper.resize(count);
    lower.resize(count);
}

void AimBatch::resize(std::size_t count) {
    forward.resize(count);
    wanted.resize(count);
    rotation.resize(count);
}

void ChainBatch::resize(std::size_t new_links, std::size_t new_count) {
    links = new_links;
    count = new_count;
    points.resize((links + 1) * count);
    goals.resize(count);
}

void solve_two_links(TwoLinkBatch& batch) {
    HWY_STATIC_DISPATCH(two_links_rest)(batch, HWY_DYNAMIC_DISPATCH(two_links_vector)(batch));
}
void solve_two_links_scalar(TwoLinkBatch& batch) {
    HWY_STATIC_DISPATCH(two_links_rest)(batch, 0);
}

void aim(AimBatch& batch) {
    HWY_STATIC_DISPATCH(aim_rest)(batch, HWY_DYNAMIC_DISPATCH(aim_vector)(batch));
}
void aim_scalar(AimBatch& batch) {
    HWY_STATIC_DISPATCH(aim_rest)(batch, 0);
}

void solve_chains_dls(ChainBatch& batch, const ChainOptions& options) {
    check_batch(batch);
    const std::size_t done = HWY_DYNAMIC_DISPATCH(chains_dls_vector)(batch, options);
    HWY_STATIC_DISPATCH(chains_dls_rest)(batch, options, done);
}
void solve_chains_dls_scalar(ChainBatch& batch, const ChainOptions& options) {
    check_batch(batch);
    HWY_STATIC_DISPATCH(chains_dls_rest)(batch, options, 0);
}

void solve_chains_fabrik(ChainBatch& batch, const ChainOptions& options) {
    check_batch(batch);
    const std::size_t done = HWY_DYNAMIC_DISPATCH(chains_fabrik_vector)(batch, options);
    HWY_STATIC_DISPATCH(chains_fabrik_rest)(batch, options, done);
}
void solve_chains_fabrik_scalar(ChainBatch& batch, const ChainOptions& options) {
    check_batch(batch);
    HWY_STATIC_DISPATCH(chains_fabrik_rest)(batch, options, 0);
}

void solve_chains_ccd(ChainBatch& batch, const ChainOptions& options) {
    check_batch(batch);
    const std::size_t done = HWY_DYNAMIC_DISPATCH(chains_ccd_vector)(batch, options);
    HWY_STATIC_DISPATCH(chains_ccd_rest)(batch, options, done);
}
void solve_chains_ccd_scalar(ChainBatch& batch, const ChainOptions& options) {
    check_batch(batch);
    HWY_STATIC_DISPATCH(chains_ccd_rest)(batch, options, 0);
}

}  // namespace limn
#endif  // HWY_ONCE
