#include "systems/faces/wrinkle_batch.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "systems/faces/wrinkle_fold.h"
#include "systems/faces/wrinkle_measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/faces/wrinkle_batch.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/aligned_allocator.h>
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

// Techniques: wrinkle.compression.integration, wrinkle.natural-width

#ifndef LIMN_WRINKLE_BATCH
#define LIMN_WRINKLE_BATCH
namespace limn::wrinkle {

/// Faces that are measured at once. A row has one number per face.
inline constexpr std::size_t kFaces = 8;

/// Up to eight faces with one mesh; memory of the rows is reused.
struct Batch {
    std::span<const WrinkleRest> rests;
    std::span<const float> resting;  ///< per vertex, or empty
    std::size_t vertices = 0;
    std::array<const float*, kFaces> from = {};  ///< positions; unused lanes repeat the last face
    std::array<float*, kFaces> to = {};          ///< intensities; null: unused lane
    alignas(64) std::array<float, kFaces> lambda = {};
    alignas(64) std::array<float, kFaces> beta = {};
    alignas(64) std::array<float, kFaces> resting_weight = {};
    float* positions = nullptr;              ///< row 3 v + axis
    float* triangles = nullptr;              ///< a row per triangle
    std::array<float*, 3> compression = {};  ///< a row per vertex, of each rest
};

}  // namespace limn::wrinkle
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE  // whose vectors have other sizes

bool measure_batch(const wrinkle::Batch&) {
    return false;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
constexpr hn::CappedTag<float, wrinkle::kFaces> d;
constexpr hn::FixedTag<float, 4> four;
using V = hn::Vec<decltype(d)>;
constexpr std::size_t kLanes = hn::MaxLanes(d);  // a row is one vector, or two

/// Transposes a 4x4 matrix.
template <typename Load, typename Store>
HWY_INLINE void transpose_four(Load load, Store store) {
    constexpr hn::RepartitionToWide<decltype(four)> pairs;
    const auto a = load(0);
    const auto b = load(1);
    const auto c = load(2);
    const auto e = load(3);
    const auto ab_low = hn::BitCast(pairs, hn::InterleaveLower(four, a, b));
    const auto ce_low = hn::BitCast(pairs, hn::InterleaveLower(four, c, e));
    const auto ab_high = hn::BitCast(pairs, hn::InterleaveUpper(four, a, b));
    const auto ce_high = hn::BitCast(pairs, hn::InterleaveUpper(four, c, e));
    store(0, hn::BitCast(four, hn::InterleaveLower(pairs, ab_low, ce_low)));
    store(1, hn::BitCast(four, hn::InterleaveUpper(pairs, ab_low, ce_low)));
    store(2, hn::BitCast(four, hn::InterleaveLower(pairs, ab_high, ce_high)));
    store(3, hn::BitCast(four, hn::InterleaveUpper(pairs, ab_high, ce_high)));
}

/// Eight arrays to rows.
HWY_INLINE void interleave(const wrinkle::Batch& batch) {
    const std::size_t count = 3 * batch.vertices;
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        for (std::size_t face = 0; face < wrinkle::kFaces; face += 4) {
            transpose_four(
                [&](std::size_t k) HWY_ATTR { return hn::LoadU(four, batch.from[face + k] + i); },
                [&](std::size_t k, hn::Vec<decltype(four)> row) HWY_ATTR {
                    hn::Store(row, four, batch.positions + wrinkle::kFaces * (i + k) + face);
                });
        }
    }
    for (; i < count; ++i) {
        for (std::size_t face = 0; face < wrinkle::kFaces; ++face) {
            batch.positions[wrinkle::kFaces * i + face] = batch.from[face][i];
        }
    }
}

/// find_compression of all faces; square roots of it if lengths are averaged.
HWY_INLINE void measure_triangles(const WrinkleRest& rest, const wrinkle::Batch& batch) {
    const V infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    const V one = hn::Set(d, 1.0f);
    for (std::size_t t = 0; t < rest.across.size(); ++t) {
        if (rest.across[t] == Vec2{0, 0}) {
            continue;  // has no weight at any vertex
        }
        const float* const a = batch.positions + 3 * wrinkle::kFaces * rest.corners[3 * t];
        const float* const b = batch.positions + 3 * wrinkle::kFaces * rest.corners[3 * t + 1];
        const float* const c = batch.positions + 3 * wrinkle::kFaces * rest.corners[3 * t + 2];
        const V x = hn::Set(d, rest.across[t].x);
        const V y = hn::Set(d, rest.across[t].y);
        for (std::size_t lane = 0; lane < wrinkle::kFaces; lane += kLanes) {
            const auto square_along = [&](std::size_t axis) HWY_ATTR {
                const std::size_t at = axis * wrinkle::kFaces + lane;
                const V origin = hn::Load(d, a + at);
                const V chord = hn::Add(
                    hn::Mul(x, hn::Sub(hn::Load(d, b + at), origin)),
                    hn::Mul(y, hn::Sub(hn::Load(d, c + at), origin)));
                return hn::Mul(chord, chord);
            };
            const V found = hn::Add(hn::Add(square_along(0), square_along(1)), square_along(2));
            V finite = hn::IfThenElse(hn::Lt(found, infinity), found, one);
            if (t >= rest.stretch_from) {
                finite = hn::Max(hn::Sub(finite, one), hn::Zero(d));
            }
            hn::Store(
                rest.mean_length ? hn::Sqrt(finite) : finite, d,
                batch.triangles + wrinkle::kFaces * t + lane);
        }
    }
}

/// average_compression of all faces.
HWY_INLINE void
average_triangles(const WrinkleRest& rest, const wrinkle::Batch& batch, float* vertices) {
    for (std::size_t v = 0; v < batch.vertices; ++v) {
        const std::uint32_t first = rest.first[v];
        const std::uint32_t last = rest.first[v + 1];
        for (std::size_t lane = 0; lane < wrinkle::kFaces; lane += kLanes) {
            V sum = first == last ? hn::Set(d, 1.0f) : hn::Zero(d);
            for (std::uint32_t i = first; i < last; ++i) {
                const std::size_t triangle = rest.around[i].corner / 3;
                sum = hn::Add(
                    sum, hn::Mul(
                             hn::Set(d, rest.around[i].weight),
                             hn::Load(d, batch.triangles + wrinkle::kFaces * triangle + lane)));
            }
            hn::Store(
                rest.mean_length ? hn::Mul(sum, sum) : sum, d,
                vertices + wrinkle::kFaces * v + lane);
        }
    }
}

/// Compression of the lanes of a row, in the shortest direction of three.
HWY_INLINE V compression_at(const wrinkle::Batch& batch, std::size_t at) {
    const V along_u = hn::Load(d, batch.compression[0] + at);
    if (batch.rests.size() == 1) {
        return along_u;
    }
    const V along_v = hn::Load(d, batch.compression[1] + at);
    const V half = hn::Set(d, 0.5f);
    const V mean = hn::Mul(half, hn::Add(along_u, along_v));
    const V shear = hn::Sub(hn::Load(d, batch.compression[2] + at), mean);
    const V difference = hn::Mul(half, hn::Sub(along_u, along_v));
    const V radius = hn::Sqrt(hn::Add(hn::Mul(difference, difference), hn::Mul(shear, shear)));
    return hn::Max(hn::Sub(mean, radius), hn::Zero(d));
}

/// (1 - p) / (1 + p) with p = (lambda ratio)^beta.
HWY_INLINE V intensity_of(V ratio, V lambda, V beta) {
    // Limits of the logarithm and the exponential; beyond them the intensity is 1 or -1 already.
    const V scaled = hn::Clamp(hn::Mul(lambda, ratio), hn::Set(d, 1e-37f), hn::Set(d, 1e37f));
    const V exponent =
        hn::Clamp(hn::Mul(beta, hn::Log(d, scaled)), hn::Set(d, -80.0f), hn::Set(d, 80.0f));
    const V power = hn::Exp(d, exponent);
    const V one = hn::Set(d, 1.0f);
    return hn::Div(hn::Sub(one, power), hn::Add(one, power));
}

/// rested_ratio of the lanes of a row.
HWY_INLINE V
rested_ratio_of(const wrinkle::Batch& batch, std::size_t v, std::size_t lane, V ratio) {
    const V weight = hn::Load(d, batch.resting_weight.data() + lane);
    const V length = hn::Sub(hn::Set(d, 1.0f), hn::Mul(weight, hn::Set(d, batch.resting[v])));
    return hn::Mul(ratio, hn::Mul(length, length));
}

/// Whether these vertices have no triangles with a direction and no folds at rest.
HWY_INLINE bool is_smooth(const wrinkle::Batch& batch, std::size_t v, std::size_t count) {
    if (batch.rests.empty()) {
        return true;
    }
    for (std::size_t i = v; i < v + count && !batch.resting.empty(); ++i) {
        if (batch.resting[i] != 0) {
            return false;
        }
    }
    return batch.rests[0].first[v] == batch.rests[0].first[v + count];
}

/// Rows to eight arrays of intensities.
HWY_INLINE void write_intensities(const wrinkle::Batch& batch) {
    HWY_ALIGN float rows[4 * wrinkle::kFaces];
    HWY_ALIGN float at_rest[wrinkle::kFaces];
    for (std::size_t lane = 0; lane < wrinkle::kFaces; lane += kLanes) {
        const V intensity = intensity_of(
            hn::Set(d, 1.0f), hn::Load(d, batch.lambda.data() + lane),
            hn::Load(d, batch.beta.data() + lane));
        hn::Store(intensity, d, at_rest + lane);
    }
    for (std::size_t v = 0; v < batch.vertices; v += 4) {
        const std::size_t count = std::min<std::size_t>(4, batch.vertices - v);
        if (is_smooth(batch, v, count)) {
            for (std::size_t face = 0; face < wrinkle::kFaces; ++face) {
                if (float* const to = batch.to[face]; to != nullptr) {
                    std::fill_n(to + v, count, at_rest[face]);
                }
            }
            continue;
        }
        for (std::size_t i = 0; i < count * wrinkle::kFaces; i += kLanes) {
            const std::size_t lane = i % wrinkle::kFaces;
            const V measured = compression_at(batch, wrinkle::kFaces * v + i);
            const V ratio = batch.resting.empty()
                                ? measured
                                : rested_ratio_of(batch, v + i / wrinkle::kFaces, lane, measured);
            hn::Store(
                intensity_of(
                    ratio, hn::Load(d, batch.lambda.data() + lane),
                    hn::Load(d, batch.beta.data() + lane)),
                d, rows + i);
        }
        for (std::size_t face = 0; face < wrinkle::kFaces; face += 4) {
            const auto write = [&](std::size_t k, hn::Vec<decltype(four)> four_vertices) HWY_ATTR {
                if (float* const to = batch.to[face + k]; to != nullptr) {
                    if (count == 4) {
                        hn::StoreU(four_vertices, four, to + v);
                    } else {
                        HWY_ALIGN float some[4];
                        hn::Store(four_vertices, four, some);
                        std::copy_n(some, count, to + v);
                    }
                }
            };
            transpose_four(
                [&](std::size_t k) HWY_ATTR {
                    return hn::Load(four, rows + wrinkle::kFaces * std::min(k, count - 1) + face);
                },
                write);
        }
    }
}

/// False on CPUs without suitable vectors.
bool measure_batch(const wrinkle::Batch& batch) {
    interleave(batch);
    for (std::size_t i = 0; i < batch.rests.size(); ++i) {
        measure_triangles(batch.rests[i], batch);
        average_triangles(batch.rests[i], batch, batch.compression[i]);
    }
    write_intensities(batch);
    return true;
}

#endif

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(measure_batch);

namespace {

/// A buffer that grows on demand.
struct FoldRows {
    hwy::AlignedFreeUniquePtr<float[]> data;
    std::size_t size = 0;
};

/// Buffers of a batch.
struct BatchMemory {
    FoldRows positions;
    FoldRows triangles;
    std::array<FoldRows, 3> compression;
};

float* make_rows(FoldRows& rows, std::size_t count) {
    if (rows.size < wrinkle::kFaces * count) {
        rows.size = wrinkle::kFaces * count;
        rows.data = hwy::AllocateAligned<float>(rows.size);
    }
    return rows.data.get();
}

void check_faces(
    std::span<const WrinkleRest> rests, std::span<const CrowdFace> faces,
    std::span<const float> resting) {
    LIMN_CHECK(rests.empty() || rests.size() == 1 || rests.size() == 3);
    LIMN_CHECK(resting.empty() || !rests.empty());
    for (const CrowdFace& face : faces) {
        LIMN_CHECK(resting.empty() || resting.size() == face.deformed.size());
        LIMN_CHECK(face.deformed.size() == faces[0].deformed.size());
        LIMN_CHECK(face.intensity.size() == face.deformed.size());
        for (const WrinkleRest& rest : rests) {
            LIMN_CHECK(face.deformed.size() + 1 == rest.first.size());
        }
    }
}

void measure(
    std::span<const WrinkleRest> rests, std::span<const CrowdFace> faces,
    std::span<const float> resting) {
    thread_local BatchMemory memory;  // reused
    wrinkle::Batch batch;
    batch.rests = rests;
    batch.resting = resting;
    batch.vertices = faces[0].deformed.size();
    for (std::size_t lane = 0; lane < wrinkle::kFaces; ++lane) {
        const CrowdFace& face = faces[std::min(lane, faces.size() - 1)];
        batch.from[lane] = &face.deformed.data()->x;
        batch.to[lane] = lane < faces.size() ? face.intensity.data() : nullptr;
        batch.lambda[lane] = face.lambda;
        batch.beta[lane] = face.beta;
        batch.resting_weight[lane] = face.resting_weight;
    }
    batch.positions = make_rows(memory.positions, 3 * batch.vertices);
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < rests.size(); ++i) {
        triangles = std::max(triangles, rests[i].across.size());
        batch.compression[i] = make_rows(memory.compression[i], batch.vertices);
    }
    batch.triangles = make_rows(memory.triangles, triangles);
    if (!HWY_DYNAMIC_DISPATCH(measure_batch)(batch)) {
        find_intensities_scalar(rests, faces, resting);
    }
}

}  // namespace

void find_intensities(
    std::span<const WrinkleRest> rests, std::span<const CrowdFace> faces,
    std::span<const float> resting) {
    check_faces(rests, faces, resting);
    if (faces.empty() || faces[0].deformed.empty()) {
        return;
    }
    parallel_for(faces.size(), wrinkle::kFaces, [&](std::size_t begin, std::size_t end) {
        measure(rests, faces.subspan(begin, end - begin), resting);
    });
}

void find_intensities_scalar(
    std::span<const WrinkleRest> rests, std::span<const CrowdFace> faces,
    std::span<const float> resting) {
    check_faces(rests, faces, resting);
    for (const CrowdFace& face : faces) {
        const std::vector<float> ratio = vertex_compression(rests, face.deformed);
        for (std::size_t v = 0; v < ratio.size(); ++v) {
            const float fold = resting.empty() ? 0 : face.resting_weight * resting[v];
            face.intensity[v] =
                wrinkle_intensity(rested_ratio(ratio[v], fold), face.lambda, face.beta);
        }
    }
}

}  // namespace limn
#endif  // HWY_ONCE
