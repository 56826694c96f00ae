#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace limn {

/// A bit set of the rows of one chunk, indexed from the chunk's first row. Trivial type:
/// `RowMask mask;` is uninitialized, `RowMask mask{};` is empty.
struct RowMask {
    static constexpr std::uint32_t kRows = 1024;
    static constexpr std::uint32_t kWordRows = 64;

    std::array<std::uint64_t, kRows / kWordRows> words;

    /// The rows below `count` <= 1024.
    [[nodiscard]] static constexpr RowMask first(std::uint32_t count) {
        RowMask mask;
        for (std::uint32_t w = 0; w < mask.words.size(); ++w) {
            const std::uint32_t below = w * kWordRows;
            mask.words[w] = count >= below + kWordRows ? ~std::uint64_t{0}
                            : count > below            ? bit(count) - 1
                                                       : 0;
        }
        return mask;
    }

    [[nodiscard]] constexpr bool test(std::uint32_t row) const {
        return (words[row / kWordRows] & bit(row)) != 0;
    }
    constexpr void set(std::uint32_t row) { words[row / kWordRows] |= bit(row); }
    constexpr void reset(std::uint32_t row) { words[row / kWordRows] &= ~bit(row); }
    /// The rows begin .. end - 1.
    constexpr void set(std::uint32_t begin, std::uint32_t end) {
        const RowMask before = first(begin);
        const RowMask within = first(end);
        for (std::size_t w = 0; w < words.size(); ++w) {
            words[w] |= within.words[w] & ~before.words[w];
        }
    }

    [[nodiscard]] constexpr std::uint32_t count() const {
        int total = 0;
        for (const std::uint64_t word : words) {
            total += std::popcount(word);
        }
        return static_cast<std::uint32_t>(total);
    }
    [[nodiscard]] constexpr bool any() const {
        std::uint64_t found = 0;
        for (const std::uint64_t word : words) {
            found |= word;
        }
        return found != 0;
    }
    /// Whether all 1024 rows are set.
    [[nodiscard]] constexpr bool all() const {
        std::uint64_t common = ~std::uint64_t{0};
        for (const std::uint64_t word : words) {
            common &= word;
        }
        return common == ~std::uint64_t{0};
    }

    /// Calls function(row) for every set row, ascending. Full 64-row words are a plain loop.
    template <typename F>
    constexpr void for_each(F&& function) const {
        for (std::uint32_t w = 0; w < words.size(); ++w) {
            const std::uint32_t first_row = w * kWordRows;
            std::uint64_t bits = words[w];
            if (bits == ~std::uint64_t{0}) {
                for (std::uint32_t row = first_row; row < first_row + kWordRows; ++row) {
                    function(row);
                }
                continue;
            }
            for (; bits != 0; bits &= bits - 1) {
                function(first_row + static_cast<std::uint32_t>(std::countr_zero(bits)));
            }
        }
    }
    /// Calls function(begin, end) for every maximal run of set rows, ascending.
    template <typename F>
    constexpr void ranges(F&& function) const {
        std::uint32_t begin = next(0, 0);
        while (begin < kRows) {
            const std::uint32_t end = next(begin, ~std::uint64_t{0});
            function(begin, end);
            begin = next(end, 0);
        }
    }

    constexpr RowMask& operator&=(const RowMask& other) {
        for (std::size_t w = 0; w < words.size(); ++w) {
            words[w] &= other.words[w];
        }
        return *this;
    }
    constexpr RowMask& operator|=(const RowMask& other) {
        for (std::size_t w = 0; w < words.size(); ++w) {
            words[w] |= other.words[w];
        }
        return *this;
    }
    /// Removes the rows of `other`.
    constexpr RowMask& operator-=(const RowMask& other) {
        for (std::size_t w = 0; w < words.size(); ++w) {
            words[w] &= ~other.words[w];
        }
        return *this;
    }
    bool operator==(const RowMask&) const = default;

  private:
    [[nodiscard]] static constexpr std::uint64_t bit(std::uint32_t row) {
        return std::uint64_t{1} << row % kWordRows;
    }
    /// The first row from `from` on that is set or, if `inverse` is all ones, that is not.
    [[nodiscard]] constexpr std::uint32_t next(std::uint32_t from, std::uint64_t inverse) const {
        while (from < kRows) {
            const std::uint64_t bits = (words[from / kWordRows] ^ inverse) >> from % kWordRows;
            if (bits != 0) {
                return from + static_cast<std::uint32_t>(std::countr_zero(bits));
            }
            from = (from / kWordRows + 1) * kWordRows;
        }
        return kRows;
    }
};

}  // namespace limn
