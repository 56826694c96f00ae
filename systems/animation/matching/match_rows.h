#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace limn {

// The search of motion matching: of many rows of numbers, one per frame of motion, the one nearest
// to a query. After S. Clavet, "Motion Matching and The Road to Next-Gen Animation", GDC 2016, and
// D. Holden, "Learned Motion Matching" (2020), whose boxes bound runs of rows.
// Techniques: char.motion-select

/// Numbers of a row.
inline constexpr std::size_t kMatchFeatures = 27;
/// Rows that are stored together: number k of row i of a block is at 16 k + i.
inline constexpr std::size_t kMatchBlock = 16;
/// Rows that a box bounds: those of four blocks.
inline constexpr std::size_t kMatchBox = 64;

using MatchRow = std::array<float, kMatchFeatures>;

inline constexpr std::uint32_t kNoMatch = 0xffffffffu;

/// A row and its squared distance.
struct RowMatch {
    std::uint32_t row = kNoMatch;
    float distance = std::numeric_limits<float>::infinity();
    bool operator==(const RowMatch&) const = default;
};

/// Rows in blocks; those behind the last are infinite, so that they are never the nearest. Boxes
/// are stored like rows, 16 at a time: number k of box i at 16 k + i of its block.
struct MatchRows {
    std::size_t count = 0;
    std::vector<float> blocks;
    std::vector<float> lows;   ///< least of each number in a box
    std::vector<float> highs;  ///< most of it

    [[nodiscard]] MatchRow row(std::size_t i) const;
};

/// Rows first <= i < last that a search leaves out.
struct MatchSkip {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
};

/// 136 bytes a row: with its share of a box.
[[nodiscard]] MatchRows make_match_rows(std::span<const MatchRow> rows);

/// The nearest row; the first of equal ones. Rows with a NaN are never found; kNoMatch: there is no
/// row that is nearer than `limit`, squared. All versions give the same bits: sums are in order,
/// without fused multiply-add. With boxes, rows whose box is farther than the nearest so far are
/// left out; a good `limit`, such as the distance of the row that plays, saves most of them.
[[nodiscard]] RowMatch find_nearest_row(
    const MatchRows& rows, const MatchRow& query,
    float limit = std::numeric_limits<float>::infinity(), MatchSkip skipped = {});
[[nodiscard]] RowMatch find_nearest_row_scalar(
    const MatchRows& rows, const MatchRow& query,
    float limit = std::numeric_limits<float>::infinity(), MatchSkip skipped = {});
[[nodiscard]] RowMatch find_nearest_row_boxes(
    const MatchRows& rows, const MatchRow& query,
    float limit = std::numeric_limits<float>::infinity(), MatchSkip skipped = {});

/// Squared distance, summed in order.
[[nodiscard]] float row_distance(const MatchRow& a, const MatchRow& b);

}  // namespace limn
