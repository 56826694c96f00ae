#include "ecs/base/rng.h"
#include "ecs/row_mask.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bitset>
#include <cstdint>
#include <sstream>  // a bitset prints itself
#include <utility>
#include <vector>

using namespace limn;

namespace {

constexpr std::uint32_t kRows = RowMask::kRows;

/// A mask and what it should hold; a fraction of the words is full or empty.
struct Sample {
    RowMask mask{};
    std::bitset<kRows> bits;
};

Sample random_sample(Random& rng) {
    Sample sample;
    for (std::uint32_t row = 0; row < kRows; ++row) {
        if (row % RowMask::kWordRows == 0 && rng.below(3) == 0) {
            const bool full = rng.below(2) == 0;
            for (std::uint32_t i = 0; full && i < RowMask::kWordRows; ++i) {
                sample.mask.set(row + i);
                sample.bits.set(row + i);
            }
            row += RowMask::kWordRows - 1;
        } else if (rng.below(2) == 0) {
            sample.mask.set(row);
            sample.bits.set(row);
        }
    }
    return sample;
}

std::vector<std::uint32_t> rows_of(const std::bitset<kRows>& bits) {
    std::vector<std::uint32_t> rows;
    for (std::uint32_t row = 0; row < kRows; ++row) {
        if (bits.test(row)) {
            rows.push_back(row);
        }
    }
    return rows;
}

}  // namespace

TEST_CASE("row mask: it holds the rows that were set and no others, in order") {
    Random rng(41, 0, 0, 0);
    for (int round = 0; round < 200; ++round) {
        const Sample sample = random_sample(rng);
        std::vector<std::uint32_t> found;
        sample.mask.for_each([&](std::uint32_t row) { found.push_back(row); });
        CHECK(found == rows_of(sample.bits));
        CHECK(sample.mask.count() == sample.bits.count());
        CHECK(sample.mask.any() == sample.bits.any());
        CHECK(sample.mask.all() == sample.bits.all());
        for (std::uint32_t row = 0; row < kRows; ++row) {
            REQUIRE(sample.mask.test(row) == sample.bits.test(row));
        }
    }
}

TEST_CASE("row mask: ranges are the longest runs of what for_each visits") {
    Random rng(42, 0, 0, 0);
    for (int round = 0; round < 200; ++round) {
        const Sample sample = random_sample(rng);
        std::bitset<kRows> covered;
        std::uint32_t last_end = 0;
        bool is_first = true;
        sample.mask.ranges([&](std::uint32_t begin, std::uint32_t end) {
            CHECK(begin < end);
            CHECK((is_first || begin > last_end));  // else the two runs were one
            for (std::uint32_t row = begin; row < end; ++row) {
                covered.set(row);
            }
            last_end = end;
            is_first = false;
        });
        CHECK(covered == sample.bits);
    }
}

TEST_CASE("row mask: first(n) and set(begin, end) are the rows they say, at every edge of a word") {
    for (const std::uint32_t count : {0u, 1u, 63u, 64u, 65u, 127u, 128u, 1023u, 1024u}) {
        RowMask expected{};
        for (std::uint32_t row = 0; row < count; ++row) {
            expected.set(row);
        }
        CHECK(RowMask::first(count) == expected);
        CHECK(RowMask::first(count).all() == (count == kRows));
        CHECK(RowMask::first(count).any() == (count > 0));
        for (const std::uint32_t begin : {0u, 1u, 62u, 64u, 100u, 1023u}) {
            RowMask range{};
            range.set(7);
            range.set(begin, std::max(begin, count));
            std::vector<std::uint32_t> rows;
            range.for_each([&](std::uint32_t row) { rows.push_back(row); });
            RowMask slow{};
            slow.set(7);
            for (std::uint32_t row = begin; row < count; ++row) {
                slow.set(row);
            }
            CHECK(range == slow);
        }
    }
}

TEST_CASE("row mask: the operators are those of sets") {
    Random rng(43, 0, 0, 0);
    for (int round = 0; round < 50; ++round) {
        const Sample a = random_sample(rng);
        const Sample b = random_sample(rng);
        const auto check = [](const RowMask& mask, const std::bitset<kRows>& bits) {
            for (std::uint32_t row = 0; row < kRows; ++row) {
                REQUIRE(mask.test(row) == bits.test(row));
            }
        };
        RowMask both = a.mask;
        both &= b.mask;
        check(both, a.bits & b.bits);
        RowMask either = a.mask;
        either |= b.mask;
        check(either, a.bits | b.bits);
        RowMask without = a.mask;
        without -= b.mask;
        check(without, a.bits & ~b.bits);
        either -= b.mask;
        CHECK(either == without);
        RowMask reset = a.mask;
        b.mask.for_each([&](std::uint32_t row) { reset.reset(row); });
        CHECK(reset == without);
    }
}
