#include "systems/particles/birth_kernels.h"

#include "systems/particles/birth_constants.h"
#include "systems/particles/emitter_pose.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/particles/birth_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
// Techniques: particle.generation-shape

namespace limn::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR  // no SIMD

std::size_t draw_births_vector(
    const BirthDraw&, const BirthRun&, std::uint32_t, std::size_t, std::uint64_t,
    const BirthColumns&) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Words = hn::RebindToUnsigned<Floats>;
using Ints = hn::RebindToSigned<Floats>;
using Longs = hn::Repartition<std::uint64_t, Words>;
using V = hn::Vec<Floats>;
using U = hn::Vec<Words>;
using L = hn::Vec<Longs>;
constexpr Floats d;
constexpr Words du;
constexpr Ints di;
constexpr Longs dl;

HWY_INLINE V constant(float value) {
    return hn::Set(d, value);
}

/// Random for as many consecutive births as there are lanes. Of the 64 bits of a lane of L, only
/// the lower half counts: Philox multiplies 32 bits to 64, separately in the even and the odd
/// lanes. It draws eight words at a time, which is what most births need: two blocks of four, whose
/// rounds do not depend on each other.
class LaneRandom {
  public:
    HWY_INLINE LaneRandom(const Random& first, U numbers)
        : counter_(first.counter()), key_(first.key()), even_(hn::BitCast(dl, numbers)),
          odd_(hn::ShiftRight<32>(even_)) {}

    HWY_INLINE U word() {
        if (left_ == 0) {
            draw();
        }
        return words_[8 - left_--];
    }
    HWY_INLINE V uniform() {
        return hn::Mul(
            hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<8>(word()))), constant(0x1p-24f));
    }
    /// -1 .. 1
    HWY_INLINE V both_signs() {
        return hn::Add(constant(-1.0f), hn::Mul(constant(2.0f), uniform()));
    }

  private:
    struct Counter {
        L c0, c1, c2, c3;

        HWY_INLINE void round(L key0, L key1) {
            const L a = hn::MulEven(hn::Set(du, 0xd2511f53u), hn::BitCast(du, c0));
            const L b = hn::MulEven(hn::Set(du, 0xcd9e8d57u), hn::BitCast(du, c2));
            c0 = hn::Xor3(hn::ShiftRight<32>(b), c1, key0);
            c2 = hn::Xor3(hn::ShiftRight<32>(a), c3, key1);
            c1 = b;
            c3 = a;
        }
    };
    HWY_INLINE Counter begin(std::uint32_t block, L numbers) const {
        return {
            hn::Set(dl, counter_[0] + block), numbers, hn::Set(dl, counter_[2]),
            hn::Set(dl, counter_[3])};
    }
    HWY_INLINE static U join(L even, L odd) {
        return hn::OddEven(hn::BitCast(du, hn::ShiftLeft<32>(odd)), hn::BitCast(du, even));
    }
    HWY_INLINE void draw() {
        Counter even_a = begin(0, even_);
        Counter odd_a = begin(0, odd_);
        Counter even_b = begin(1, even_);
        Counter odd_b = begin(1, odd_);
        PhiloxKey key = key_;
        for (int i = 0; i < 10; ++i) {
            const L key0 = hn::Set(dl, key[0]);
            const L key1 = hn::Set(dl, key[1]);
            even_a.round(key0, key1);
            odd_a.round(key0, key1);
            even_b.round(key0, key1);
            odd_b.round(key0, key1);
            key[0] += 0x9e3779b9u;
            key[1] += 0xbb67ae85u;
        }
        words_[0] = join(even_a.c0, odd_a.c0);
        words_[1] = join(even_a.c1, odd_a.c1);
        words_[2] = join(even_a.c2, odd_a.c2);
        words_[3] = join(even_a.c3, odd_a.c3);
        words_[4] = join(even_b.c0, odd_b.c0);
        words_[5] = join(even_b.c1, odd_b.c1);
        words_[6] = join(even_b.c2, odd_b.c2);
        words_[7] = join(even_b.c3, odd_b.c3);
        counter_[0] += 2;
        left_ = 8;
    }

    PhiloxCounter counter_;
    PhiloxKey key_;
    L even_;
    L odd_;
    U words_[8];
    int left_ = 0;
};

struct V2 {
    V x, y;
};
struct V3 {
    V x, y, z;
};
HWY_INLINE V3 splat(const Vec3& v) {
    return {constant(v.x), constant(v.y), constant(v.z)};
}
HWY_INLINE V3 add(const V3& a, const V3& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE V3 subtract(const V3& a, const V3& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V3 multiply(const V3& a, const V3& b) {
    return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
HWY_INLINE V3 scale(const V3& a, V b) {
    return {hn::Mul(a.x, b), hn::Mul(a.y, b), hn::Mul(a.z, b)};
}
HWY_INLINE V dot(const V3& a) {
    return hn::Add(hn::Add(hn::Mul(a.x, a.x), hn::Mul(a.y, a.y)), hn::Mul(a.z, a.z));
}
HWY_INLINE V3 normalize_or(const V3& a, const V3& fallback) {
    const V length2 = dot(a);
    const auto good = hn::And(
        hn::Gt(length2, constant(births::kMinLength2)),
        hn::Lt(length2, constant(std::numeric_limits<float>::infinity())));
    const V length = hn::Sqrt(length2);
    return {
        hn::IfThenElse(good, hn::Div(a.x, length), fallback.x),
        hn::IfThenElse(good, hn::Div(a.y, length), fallback.y),
        hn::IfThenElse(good, hn::Div(a.z, length), fallback.z)};
}

struct Row {
    V x, y, z, w;
};
struct AffineRows {
    Row row[3];
};
HWY_INLINE Row row_at(const Vec4& before, const Vec4& now, bool moves, V at) {
    if (!moves) {
        return {constant(now.x), constant(now.y), constant(now.z), constant(now.w)};
    }
    const auto mix = [at](float a, float b)
                         HWY_ATTR { return hn::Add(constant(a), hn::Mul(constant(b - a), at)); };
    return {mix(before.x, now.x), mix(before.y, now.y), mix(before.z, now.z), mix(before.w, now.w)};
}
HWY_INLINE V transform(const Row& row, const V3& v, V w) {
    return hn::Add(
        hn::Add(hn::Mul(row.x, v.x), hn::Mul(row.y, v.y)), hn::Add(hn::Mul(row.z, v.z), w));
}
HWY_INLINE V3 transform_point(const AffineRows& affine, const V3& v) {
    return {
        transform(affine.row[0], v, affine.row[0].w), transform(affine.row[1], v, affine.row[1].w),
        transform(affine.row[2], v, affine.row[2].w)};
}
HWY_INLINE V3 transform_vector(const AffineRows& affine, const V3& v) {
    const V zero = hn::Zero(d);
    return {
        transform(affine.row[0], v, hn::Mul(affine.row[0].w, zero)),
        transform(affine.row[1], v, hn::Mul(affine.row[1].w, zero)),
        transform(affine.row[2], v, hn::Mul(affine.row[2].w, zero))};
}

/// Cosine and sine.
HWY_INLINE V2 turn_point(V turn) {
    const V turned = hn::Mul(constant(4.0f), turn);
    const V quarters = hn::Floor(hn::Add(turned, constant(0.5f)));
    const V x = hn::Mul(hn::Sub(turned, quarters), constant(births::kQuarterTurn));
    const V x2 = hn::Mul(x, x);
    const auto series = [x2](const float* c) HWY_ATTR {
        const V last = hn::Add(constant(c[1]), hn::Mul(x2, constant(c[2])));
        return hn::Add(constant(c[0]), hn::Mul(x2, last));
    };
    const V sine = hn::Add(x, hn::Mul(hn::Mul(x, x2), series(births::kSine)));
    const V cosine = hn::Add(
        hn::Sub(constant(1.0f), hn::Mul(constant(0.5f), x2)),
        hn::Mul(hn::Mul(x2, x2), series(births::kCosine)));
    const auto quarter = hn::ConvertTo(di, quarters);
    const auto one = hn::Set(di, 1);
    const auto two = hn::Set(di, 2);
    const auto odd = hn::RebindMask(d, hn::Eq(hn::And(quarter, one), one));
    const auto negative = [two](auto which) HWY_ATTR {
        return hn::BitCast(d, hn::ShiftLeft<30>(hn::And(which, two)));
    };
    return {
        hn::Xor(hn::IfThenElse(odd, sine, cosine), negative(hn::Add(quarter, one))),
        hn::Xor(hn::IfThenElse(odd, cosine, sine), negative(quarter))};
}

HWY_INLINE V cube_root(V x) {
    const V bits = hn::ConvertTo(d, hn::BitCast(di, x));
    const auto third = hn::ConvertTo(di, hn::Mul(bits, constant(births::kThird)));
    V y = hn::BitCast(d, hn::Add(third, hn::Set(di, births::kCubeRootBits)));
    for (int i = 0; i < 2; ++i) {
        const V y3 = hn::Mul(hn::Mul(y, y), y);
        const V up = hn::Add(y3, hn::Add(x, x));
        const V down = hn::Add(hn::Add(y3, y3), x);
        y = hn::Mul(y, hn::Div(up, down));
    }
    return y;
}

HWY_INLINE V exp_of_fraction(V x) {
    const V r = hn::Mul(constant(0.5f), x);
    V sum = constant(births::kExp[0]);
    for (int i = 1; i < births::kExpTerms; ++i) {
        sum = hn::Add(constant(births::kExp[i]), hn::Mul(r, sum));
    }
    const V one = constant(1.0f);
    const V root = hn::Add(one, hn::Mul(r, hn::Add(one, hn::Mul(r, sum))));
    return hn::Mul(root, root);
}

/// On a ring or a sphere of unit directions: at height y.
HWY_INLINE V3 direction_at(V y, LaneRandom& random) {
    const V2 at = turn_point(random.uniform());
    const V left = hn::Sub(constant(1.0f), hn::Mul(y, y));
    const V radius = hn::Sqrt(hn::Max(left, hn::Zero(d)));
    return {hn::Mul(radius, at.x), y, hn::Mul(radius, at.y)};
}
HWY_INLINE V2 sample_disc(LaneRandom& random) {
    const V radius = hn::Sqrt(random.uniform());
    const V2 at = turn_point(random.uniform());
    return {hn::Mul(radius, at.x), hn::Mul(radius, at.y)};
}
HWY_INLINE V3 random_vector(LaneRandom& random) {
    const V x = random.both_signs();
    const V y = random.both_signs();
    return {x, y, random.both_signs()};
}

HWY_INLINE V3 sample_shape(EmitterShape shape, const Vec3& size, LaneRandom& random) {
    const V zero = hn::Zero(d);
    switch (shape) {
    case EmitterShape::Point:
        break;
    case EmitterShape::Ball: {
        const V radius = cube_root(random.uniform());
        const V y = random.both_signs();
        return multiply(splat(size), scale(direction_at(y, random), radius));
    }
    case EmitterShape::Sphere: {
        const V y = random.both_signs();
        V3 direction = direction_at(y, random);
        if (size.x == 0 || size.y == 0 || size.z == 0) {
            const V3 used = {
                size.x != 0 ? direction.x : zero, size.y != 0 ? direction.y : zero,
                size.z != 0 ? direction.z : zero};
            direction = normalize_or(used, {zero, zero, zero});
        }
        return multiply(splat(size), direction);
    }
    case EmitterShape::Disc: {
        const V2 p = sample_disc(random);
        return multiply(splat(size), {p.x, zero, p.y});
    }
    case EmitterShape::Circle: {
        const V2 at = turn_point(random.uniform());
        return multiply(splat(size), {at.x, zero, at.y});
    }
    case EmitterShape::Box:
        return multiply(splat(size), random_vector(random));
    case EmitterShape::Torus: {
        const V2 disc = sample_disc(random);
        const V width = constant(size.y);
        const V2 tube = {hn::Mul(width, disc.x), hn::Mul(width, disc.y)};
        const V2 at = turn_point(random.uniform());
        return {
            hn::Mul(hn::Add(constant(size.x), tube.x), at.x), tube.y,
            hn::Mul(hn::Add(constant(size.z), tube.x), at.y)};
    }
    }
    return {zero, zero, zero};
}

HWY_INLINE V spread(float mean, float width, LaneRandom& random) {
    return hn::Add(constant(mean), hn::Mul(constant(width), random.both_signs()));
}

/// Attributes of the lanes' births.
struct Lanes {
    V3 position;
    V3 velocity;
    V age;
    V life;
    U look;
};

/// False if the lanes need different branches, or if one is not finite.
HWY_INLINE bool
draw_lanes(const BirthDraw& draw, float lowest, V at, LaneRandom& random, Lanes& born) {
    const ParticleEmitter& emitter = *draw.emitter;
    const ParticleStep& step = draw.rewind.step;
    const EmitterPose& ends = draw.pose;
    const AffineRows world = {
        {row_at(ends.before.row[0], ends.now.row[0], draw.moves, at),
         row_at(ends.before.row[1], ends.now.row[1], draw.moves, at),
         row_at(ends.before.row[2], ends.now.row[2], draw.moves, at)}};

    V3 local = sample_shape(emitter.shape, emitter.size, random);
    V3 direction;
    const V zero = hn::Zero(d);
    const auto at_center =
        hn::And(hn::And(hn::Eq(local.x, zero), hn::Eq(local.y, zero)), hn::Eq(local.z, zero));
    if (emitter.direction != EmitterDirection::Radial || hn::AllTrue(d, at_center)) {
        const V y = hn::Sub(constant(1.0f), hn::Mul(random.uniform(), constant(1.0f - lowest)));
        direction = direction_at(y, random);
    } else if (hn::AllFalse(d, at_center)) {
        direction = scale(local, hn::Div(constant(1.0f), hn::Sqrt(dot(local))));
    } else {
        return false;
    }
    const V3 up = {zero, constant(1.0f), zero};
    const V3 aim = normalize_or(transform_vector(world, direction), up);
    V3 now = scale(aim, spread(emitter.speed, emitter.speed_spread, random));
    born.life = spread(emitter.life, emitter.life_spread, random);
    born.look = random.word();
    if (emitter.size_spread != Vec3(0)) {
        local = add(local, multiply(splat(emitter.size_spread), random_vector(random)));
    }
    if (emitter.velocity_spread != Vec3(0)) {
        const V3 more = multiply(splat(emitter.velocity_spread), random_vector(random));
        now = add(now, transform_vector(world, more));
    }
    now = add(now, splat(draw.added));

    // as Rewind
    const V time = hn::Mul(at, constant(step.dt));
    const V3 air = splat(step.air);
    const float drag = draw.rewind.drag;
    const V undo = drag > 0 ? exp_of_fraction(hn::Mul(at, constant(drag))) : constant(1.0f);
    born.velocity =
        subtract(add(air, scale(subtract(now, air), undo)), scale(splat(step.gravity), time));
    const V3 mean = add(
        scale(born.velocity, constant(step.old_weight)), scale(now, constant(1 - step.old_weight)));
    born.position = subtract(transform_point(world, local), scale(mean, time));
    born.age = hn::Neg(time);

    const V sum =
        hn::Add(hn::Add(hn::Add(born.position.x, born.position.y), born.position.z), born.life);
    return hn::AllTrue(d, hn::Lt(hn::Abs(sum), constant(std::numeric_limits<float>::infinity())));
}

std::size_t draw_births_vector(
    const BirthDraw& draw, const BirthRun& run, std::uint32_t first, std::size_t count,
    std::uint64_t number, const BirthColumns& out) {
    const std::size_t n = hn::Lanes(d);
    const Random random = attributes_random(draw.seed, draw.subject, number);
    const float lowest = lowest_of_cone(cone_of(*draw.emitter));
    std::size_t i = 0;
    while (i < count) {
        const std::size_t part = std::min(n, count - i);
#if HWY_MEM_OPS_MIGHT_FAULT
        if (part < n) {
            break;
        }
#endif
        const U index = hn::Iota(du, static_cast<std::uint32_t>(i));
        const auto in_run = hn::Add(index, hn::Set(du, first));
        const V since = hn::Mul(hn::ConvertTo(d, hn::BitCast(di, in_run)), constant(run.spacing));
        const V at =
            hn::Min(hn::Max(hn::Add(constant(run.first), since), hn::Zero(d)), constant(1.0f));
        LaneRandom lanes(random, hn::Add(index, hn::Set(du, random.counter()[1])));
        Lanes born;
        if (!draw_lanes(draw, lowest, at, lanes, born)) {
            break;
        }
        const auto used = hn::FirstN(d, part);
        const auto store = [&](V values, float* column) HWY_ATTR {
            if (part < n) {
                hn::BlendedStore(values, used, d, column + i);
            } else {
                hn::StoreU(values, d, column + i);
            }
        };
        store(born.position.x, out.x);
        store(born.position.y, out.y);
        store(born.position.z, out.z);
        store(born.velocity.x, out.vx);
        store(born.velocity.y, out.vy);
        store(born.velocity.z, out.vz);
        store(born.age, out.age);
        store(born.life, out.life);
        if (part < n) {
            hn::BlendedStore(born.look, hn::FirstN(du, part), du, out.look + i);
        } else {
            hn::StoreU(born.look, du, out.look + i);
        }
        i += part;
    }
    return i;
}

#endif

}  // namespace
}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(draw_births_vector);

std::size_t draw_births(
    const BirthDraw& draw, const BirthRun& run, std::uint32_t first, std::size_t count,
    std::uint64_t number, const BirthColumns& out) {
    // Lanes count the numbers in 32 bits, and convert indices to floats as signed ones.
    constexpr std::uint64_t kNumbers = std::uint64_t{1} << 32;
    constexpr std::uint64_t kInstants = std::uint64_t{1} << 31;
    const std::uint64_t instants = first < kInstants ? kInstants - first : 0;
    const std::uint64_t limit = std::min({count, kNumbers - number % kNumbers, instants});
    return HWY_DYNAMIC_DISPATCH(draw_births_vector)(
        draw, run, first, static_cast<std::size_t>(limit), number, out);
}

}  // namespace limn
#endif  // HWY_ONCE
