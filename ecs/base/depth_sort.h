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
// passes of 8 bits, 32-bit keys three of 9, or of 11 where they differ by 2^27 or more (Merrill
// and Grimshaw, "High Performance and Scalable Radix Sorting", 2011). The GPU uses a bitonic sort
// (Batcher 1968): render/particles/gpu_particle_sort.h.

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

// ---- passes of a bitonic sort

/// Entries i and i xor partner are swapped where they are out of order: descending if i & run,
/// else ascending.
struct BitonicPass {
    std::uint32_t run = 2;      ///< length of the bitonic sequences being merged: 2, 4, 8, ...
    std::uint32_t partner = 1;  ///< run / 2, run / 4, ..., 1
};

/// log2 n (log2 n + 1) / 2 for n entries, a power of two; 0 for n = 1.
[[nodiscard]] std::uint32_t bitonic_pass_count(std::size_t count);

/// The pass with this number, 0 .. bitonic_pass_count - 1.
[[nodiscard]] BitonicPass bitonic_pass_at(std::uint32_t number);

}  // namespace limn
