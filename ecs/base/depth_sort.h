#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Back-to-front order for alpha blending. Keys are unsigned and ascend from far to near, so that
// drawing in ascending order blends correctly.
//
// sort_by_depth is what to use: a stable least-significant-digit radix sort. 16-bit keys take two
// passes of 8 bits, 32-bit keys three of 11 (Merrill and Grimshaw, "High Performance and Scalable
// Radix Sorting", 2011). Bitonic sort (Batcher 1968) is the reference of a GPU pass; spreading its
// passes over frames is Latta's, "Building a Million Particle System", GDC 2004.

/// Ascends from far to near: 0 for NaN, which counts as farthest, then +infinity; -infinity, which
/// marks the dead, comes last. Equal for 0 and -0. Any monotonic measure of depth will do.
[[nodiscard]] std::uint32_t depth_key(float depth);

/// The same in 65,535 equal steps from `farthest` (1) to `nearest` (65,535) < farthest, clamped;
/// 0 for NaN.
[[nodiscard]] std::uint16_t depth_key16(float depth, float nearest, float farthest);

/// Memory of sort_by_depth: 4 to 16 bytes per particle. Keep it from frame to frame.
struct SortScratch {
    std::vector<std::uint32_t> packed{};
    std::vector<std::uint64_t> items[2]{};
    std::vector<std::uint32_t> slots{};
};

enum class SortThreads { One, All };

/// Sorts `order` by keys[order[i]], ascending; equal keys keep their order, as in std::stable_sort.
/// `order` holds each of 0 .. keys.size() - 1 once: pass the previous frame's order, so that
/// particles at equal depths do not swap places, or 0, 1, 2, ... The bits of the result do not
/// depend on the number of threads; a parallel sort pays from 100,000 particles on.
void sort_by_depth(
    std::span<const std::uint16_t> keys, std::span<std::uint32_t> order, SortScratch& scratch,
    SortThreads threads = SortThreads::One);
void sort_by_depth(
    std::span<const std::uint32_t> keys, std::span<std::uint32_t> order, SortScratch& scratch,
    SortThreads threads = SortThreads::One);

/// Fits the previous order to `count` particles: drops indices >= count, appends missing ones at
/// the end. Other entries keep their order.
void fit_order(std::vector<std::uint32_t>& order, std::size_t count);

// ---- bitonic
// -------------------------------------------------------------------------------------

/// key << 32 | index: all differ, so that every sort has the same result. kSortPad fills up to a
/// power of two and comes last.
using SortEntry = std::uint64_t;
inline constexpr SortEntry kSortPad = ~SortEntry{0};

/// Compares i and i xor partner, ascending where (i & run) = 0.
struct BitonicPass {
    std::uint32_t run = 2;      ///< length of the bitonic sequences being merged: 2, 4, 8, ...
    std::uint32_t partner = 1;  ///< run / 2, run / 4, ..., 1
};

/// log2 n (log2 n + 1) / 2 for n entries, a power of two; 0 for n = 1.
[[nodiscard]] std::uint32_t bitonic_pass_count(std::size_t count);

/// The pass with this number, 0 .. bitonic_pass_count - 1.
[[nodiscard]] BitonicPass bitonic_pass_at(std::uint32_t number);

/// Performs one pass in place; returns the number of comparisons, half of the entries. Their count
/// must be a power of two.
std::size_t bitonic_pass(std::span<SortEntry> entries, BitonicPass pass);

/// All passes; returns the number of comparisons. The count must be a power of two, or 0.
std::size_t bitonic_sort(std::span<SortEntry> entries);

/// A bitonic sort of which each frame does a few passes. `order` is complete at any time: that of
/// the keys when the sort began that finished last.
struct AmortizedSort {
    std::uint32_t passes_per_frame = 4;  ///< 210 passes of a million particles take 53 frames
    std::vector<std::uint32_t> order{};  ///< far to near; a permutation of 0 .. count - 1
    std::vector<SortEntry> entries{};    ///< being sorted, with the keys of the first frame
    std::uint32_t next_pass = 0;         ///< 0: the next frame reads new keys
    std::size_t frozen_count = 0;        ///< particles when the keys were read
};

/// One frame: reads all keys if the previous sort is finished, then does up to passes_per_frame
/// passes. Particles born during a sort are last in the order, the dead leave it. Returns whether
/// `order` is newly sorted.
bool step_amortized_sort(AmortizedSort& sort, std::span<const std::uint32_t> keys);

}  // namespace limn
