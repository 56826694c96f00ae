#include "systems/animation/matching/match_rows.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/animation/matching/match_rows.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Techniques: char.motion-select

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR  // no vectors here

RowMatch
find_row_vector(const MatchRows& rows, const MatchRow& query, float limit, MatchSkip skipped) {
    return find_nearest_row_scalar(rows, query, limit, skipped);
}

RowMatch find_row_boxes(
    const MatchRows& rows, const MatchRow& query, float limit, MatchSkip skipped,
    std::span<float>) {
    return find_nearest_row_scalar(rows, query, limit, skipped);
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using MatchFloats = hn::CappedTag<float, kMatchBlock>;
using MatchVector = hn::Vec<MatchFloats>;
constexpr MatchFloats d;

/// Numbers after which a block is given up if all of its rows are too far already.
constexpr std::size_t kMatchChecks[] = {9, 18, kMatchFeatures};

/// Nearest rows by lane.
struct LaneBest {
    MatchVector distance;
    hn::Vec<hn::RebindToUnsigned<MatchFloats>> row;
};

/// Squared distances of the rows of a part of a block; false if none is below `bound`.
HWY_INLINE bool
part_distance(const float* block, const float* query, MatchVector bound, MatchVector& sum) {
    sum = hn::Zero(d);
    std::size_t k = 0;
    for (const std::size_t end : kMatchChecks) {
        for (; k < end; ++k) {
            const MatchVector off =
                hn::Sub(hn::LoadU(d, block + k * kMatchBlock), hn::Set(d, query[k]));
            sum = hn::Add(sum, hn::Mul(off, off));
        }
        if (hn::AllFalse(d, hn::Lt(sum, bound))) {
            return false;
        }
    }
    return true;
}

HWY_INLINE void visit_blocks(
    const float* blocks, std::size_t first, std::size_t last, const float* query, MatchSkip skipped,
    LaneBest& best) {
    const hn::RebindToUnsigned<MatchFloats> du;
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t b = first; b < last; ++b) {
        const float* const block = blocks + b * kMatchBlock * kMatchFeatures;
        for (std::size_t lane = 0; lane < kMatchBlock; lane += lanes) {
            MatchVector sum;
            if (!part_distance(block + lane, query, best.distance, sum)) {
                continue;
            }
            const auto row = hn::Iota(du, static_cast<std::uint32_t>(b * kMatchBlock + lane));
            const auto since = hn::Sub(row, hn::Set(du, skipped.first));
            const auto is_skipped = hn::Lt(since, hn::Set(du, skipped.last - skipped.first));
            const auto nearer =
                hn::AndNot(hn::RebindMask(d, is_skipped), hn::Lt(sum, best.distance));
            best.distance = hn::IfThenElse(nearer, sum, best.distance);
            best.row = hn::IfThenElse(hn::RebindMask(du, nearer), row, best.row);
        }
    }
}

/// The nearest of all lanes, the first row of equal ones.
HWY_INLINE RowMatch reduce_lanes(const LaneBest& best) {
    float distances[kMatchBlock];
    std::uint32_t rows[kMatchBlock];
    hn::StoreU(best.distance, d, distances);
    hn::StoreU(best.row, hn::RebindToUnsigned<MatchFloats>(), rows);
    RowMatch nearest;
    nearest.distance = distances[0];
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
        if (distances[i] < nearest.distance
            || (distances[i] == nearest.distance && rows[i] < nearest.row)) {
            nearest = {rows[i], distances[i]};
        }
    }
    return nearest;
}

HWY_INLINE LaneBest no_lanes(float limit) {
    return {hn::Set(d, limit), hn::Set(hn::RebindToUnsigned<MatchFloats>(), kNoMatch)};
}

RowMatch
find_row_vector(const MatchRows& rows, const MatchRow& query, float limit, MatchSkip skipped) {
    LaneBest best = no_lanes(limit);
    const std::size_t blocks = rows.blocks.size() / (kMatchBlock * kMatchFeatures);
    visit_blocks(rows.blocks.data(), 0, blocks, query.data(), skipped, best);
    return reduce_lanes(best);
}

/// Squared distances to 16 boxes.
HWY_INLINE void
box_distances(const float* lows, const float* highs, const float* query, float* distances) {
    const MatchVector zero = hn::Zero(d);
    for (std::size_t lane = 0; lane < kMatchBlock; lane += hn::Lanes(d)) {
        MatchVector sum = zero;
        for (std::size_t k = 0; k < kMatchFeatures; ++k) {
            const MatchVector at = hn::Set(d, query[k]);
            const MatchVector below = hn::Sub(hn::LoadU(d, lows + k * kMatchBlock + lane), at);
            const MatchVector above = hn::Sub(at, hn::LoadU(d, highs + k * kMatchBlock + lane));
            const MatchVector off = hn::Max(hn::Max(below, above), zero);
            sum = hn::Add(sum, hn::Mul(off, off));
        }
        hn::StoreU(sum, d, distances + lane);
    }
}

RowMatch find_row_boxes(
    const MatchRows& rows, const MatchRow& query, float limit, MatchSkip skipped,
    std::span<float> distances) {
    constexpr std::size_t kBlocks = kMatchBox / kMatchBlock;
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < distances.size(); i += kMatchBlock) {
        box_distances(
            &rows.lows[i * kMatchFeatures], &rows.highs[i * kMatchFeatures], query.data(),
            &distances[i]);
        for (std::size_t k = i; k < i + kMatchBlock; ++k) {
            nearest = distances[k] < distances[nearest] ? k : nearest;
        }
    }
    // What the nearest box holds rules out most of the others. Then in order, so that the first of
    // equal rows is found.
    const float* const blocks = rows.blocks.data();
    LaneBest best = no_lanes(limit);
    visit_blocks(blocks, nearest * kBlocks, (nearest + 1) * kBlocks, query.data(), skipped, best);
    const float least = reduce_lanes(best).distance;
    RowMatch found;
    found.distance = least < limit ? std::nextafter(least, INFINITY) : limit;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        if (!(distances[i] < found.distance)) {
            continue;
        }
        best = no_lanes(found.distance);
        visit_blocks(blocks, i * kBlocks, (i + 1) * kBlocks, query.data(), skipped, best);
        const RowMatch here = reduce_lanes(best);
        found = here.row != kNoMatch ? here : found;
    }
    return found;
}

#endif  // HWY_TARGET

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(find_row_vector);
HWY_EXPORT(find_row_boxes);

namespace {

std::size_t rounded_up(std::size_t count, std::size_t unit) {
    return (count + unit - 1) / unit * unit;
}

std::size_t number_at(std::size_t row, std::size_t k) {
    const std::size_t block = row / kMatchBlock;
    return (block * kMatchFeatures + k) * kMatchBlock + row % kMatchBlock;
}

}  // namespace

MatchRow MatchRows::row(std::size_t i) const {
    MatchRow row{};
    for (std::size_t k = 0; k < kMatchFeatures; ++k) {
        row[k] = blocks[number_at(i, k)];
    }
    return row;
}

MatchRows make_match_rows(std::span<const MatchRow> rows) {
    MatchRows made;
    made.count = rows.size();
    const std::size_t boxes = rounded_up((rows.size() + kMatchBox - 1) / kMatchBox, kMatchBlock);
    made.blocks.assign(rounded_up(rows.size(), kMatchBox) * kMatchFeatures, INFINITY);
    made.lows.assign(boxes * kMatchFeatures, INFINITY);
    made.highs.assign(boxes * kMatchFeatures, -INFINITY);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t k = 0; k < kMatchFeatures; ++k) {
            const float number = rows[i][k];
            made.blocks[number_at(i, k)] = number;
            float& low = made.lows[number_at(i / kMatchBox, k)];
            float& high = made.highs[number_at(i / kMatchBox, k)];
            low = number < low ? number : low;
            high = number > high ? number : high;
        }
    }
    return made;
}

float row_distance(const MatchRow& a, const MatchRow& b) {
    float sum = 0;
    for (std::size_t k = 0; k < kMatchFeatures; ++k) {
        const float off = a[k] - b[k];
        sum += off * off;
    }
    return sum;
}

RowMatch find_nearest_row_scalar(
    const MatchRows& rows, const MatchRow& query, float limit, MatchSkip skipped) {
    RowMatch best;
    best.distance = limit;
    for (std::size_t i = 0; i < rows.count; ++i) {
        if (i >= skipped.first && i < skipped.last) {
            continue;
        }
        const float distance = row_distance(rows.row(i), query);
        if (distance < best.distance) {
            best = {static_cast<std::uint32_t>(i), distance};
        }
    }
    return best;
}

RowMatch
find_nearest_row(const MatchRows& rows, const MatchRow& query, float limit, MatchSkip skipped) {
    return HWY_DYNAMIC_DISPATCH(find_row_vector)(rows, query, limit, skipped);
}

RowMatch find_nearest_row_boxes(
    const MatchRows& rows, const MatchRow& query, float limit, MatchSkip skipped) {
    thread_local std::vector<float> distances;
    distances.resize(rows.lows.size() / kMatchFeatures);
    return rows.count > 0
               ? HWY_DYNAMIC_DISPATCH(find_row_boxes)(rows, query, limit, skipped, distances)
               : RowMatch{kNoMatch, limit};
}

}  // namespace limn
#endif  // HWY_ONCE
