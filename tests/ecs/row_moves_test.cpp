#include "ecs/archetype.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <new>
#include <random>
#include <string>
#include <vector>

using namespace limn;
using namespace limn::test;

namespace {

template <typename... Ts>
std::vector<ComponentId> ids() {
    std::vector<ComponentId> all = {component_id<Ts>...};
    std::sort(all.begin(), all.end());
    return all;
}

template <typename T>
T& value(Archetype& rows, std::uint32_t row) {
    return reinterpret_cast<T*>(rows.column(rows.column_of(component_id<T>)).data)[row];
}

template <typename T>
void put(Archetype& rows, std::uint32_t row, T component) {
    if (rows.column_of(component_id<T>) >= 0) {
        ::new (static_cast<void*>(&value<T>(rows, row))) T(std::move(component));
    }
}

/// A row whose components say which entity it belongs to.
void append_row(Archetype& rows, std::uint32_t number) {
    const std::uint32_t row = rows.append(Entity{number, 1}, 1);
    const float x = static_cast<float>(number);
    put(rows, row, Position{x, x + 1, x + 2});
    put(rows, row, Mass{x});
    put(rows, row, Counted(static_cast<int>(number)));
    // Long enough to be outside of the string.
    put(rows, row, Label{"the label of a row: " + std::to_string(number), {1}});
}

bool row_is_sound(Archetype& rows, std::uint32_t row) {
    const std::uint32_t number = rows.entities()[row].index;
    const float x = static_cast<float>(number);
    const auto has = [&](ComponentId id) { return rows.column_of(id) >= 0; };
    return (!has(component_id<Position>) || value<Position>(rows, row).z == x + 2)
           && (!has(component_id<Mass>) || value<Mass>(rows, row).value == x)
           && (!has(component_id<Counted>)
               || value<Counted>(rows, row).value == static_cast<int>(number))
           && (!has(component_id<Label>)
               || value<Label>(rows, row).text == "the label of a row: " + std::to_string(number));
}

void check_rows(Archetype& rows, const std::vector<std::uint32_t>& expected) {
    REQUIRE(rows.size() == expected.size());
    bool same = true;
    for (std::uint32_t row = 0; row < rows.size(); ++row) {
        same = same && rows.entities()[row].index == expected[row] && row_is_sound(rows, row);
    }
    CHECK(same);
}

std::vector<std::uint32_t> numbers(std::uint32_t first, std::uint32_t count) {
    std::vector<std::uint32_t> all(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        all[i] = first + i;
    }
    return all;
}

/// Each row with probability `fraction`, neighbors mostly together.
std::vector<RowRange> some_ranges(std::uint32_t rows, double fraction, std::mt19937& random) {
    std::vector<RowRange> ranges;
    for (std::uint32_t row = 0; row < rows;) {
        const std::uint32_t count =
            std::min(random() % 3 == 0 ? 1 + std::uint32_t(random() % 700) : 1, rows - row);
        if (std::uniform_real_distribution<double>(0, 1)(random) < fraction) {
            ranges.push_back({row, count});
        }
        row += count;
    }
    return ranges;
}

/// What close_gaps says it does, on a list.
void close_gaps_of(std::vector<std::uint32_t>& rows, const std::vector<RowRange>& gaps) {
    std::vector<bool> gone(rows.size());
    for (const RowRange& gap : gaps) {
        std::fill_n(gone.begin() + gap.first, gap.count, true);
    }
    const auto left = static_cast<std::size_t>(std::count(gone.begin(), gone.end(), false));
    std::size_t from = left;
    for (std::size_t row = 0; row < left; ++row) {
        if (gone[row]) {
            while (gone[from]) {
                ++from;
            }
            rows[row] = rows[from++];
        }
    }
    rows.resize(left);
}

constexpr std::uint32_t kSizes[] = {1,    2,    15,   16,   17,   300,  1023,
                                    1024, 1025, 2047, 2048, 2049, 3072, 5000};

}  // namespace

TEST_CASE("row moves: ranges arrive in order with their values, and gaps are filled from the end") {
    Counted::living = 0;
    std::mt19937 random(7);
    std::vector<RowMove> moves;
    for (const std::uint32_t size : kSizes) {
        for (const double fraction : {0.05, 0.5, 0.95, 1.0}) {
            CAPTURE(size);
            CAPTURE(fraction);
            BlockPool blocks;
            // Mass only goes, Counted only comes: what comes is raw memory.
            Archetype from(0, ids<Position, Label, Mass>(), blocks);
            Archetype to(1, ids<Position, Label, Counted, Marked>(), blocks);
            for (std::uint32_t i = 0; i < size; ++i) {
                append_row(from, i);
            }
            append_row(to, 100'000);
            append_row(to, 100'001);
            std::vector<std::uint32_t> left = numbers(0, size);
            std::vector<std::uint32_t> arrived = {100'000, 100'001};

            const std::vector<RowRange> ranges = some_ranges(size, fraction, random);
            CHECK(to.append_from(from, ranges, 5) == 2);
            for (std::uint32_t row = 2; row < to.size(); ++row) {
                put(to, row, Counted(static_cast<int>(to.entities()[row].index)));
            }
            for (const RowRange& range : ranges) {
                for (std::uint32_t i = 0; i < range.count; ++i) {
                    arrived.push_back(range.first + i);
                }
            }
            from.close_gaps(ranges, 6, moves);
            close_gaps_of(left, ranges);
            check_rows(to, arrived);
            check_rows(from, left);
            for (const RowMove& move : moves) {
                CHECK(move.to + move.count <= from.size());
                CHECK(move.from >= from.size());
                CHECK(from.structure_version(move.to / kChunkRows) == 6);
            }
            if (!ranges.empty()) {
                CHECK(to.structure_version((to.size() - 1) / kChunkRows) == 5);
                CHECK(from.structure_version(ranges.front().first / kChunkRows) == 6);
            }
        }
    }
    CHECK(Counted::living == 0);
}

TEST_CASE("row moves: rows of a gap are already destroyed, so nothing is destroyed twice") {
    Counted::living = 0;
    {
        BlockPool blocks;
        Archetype rows(0, ids<Counted, Position>(), blocks);
        for (std::uint32_t i = 0; i < 2500; ++i) {
            append_row(rows, i);
        }
        const RowRange gaps[] = {{10, 1000}, {1024, 1}, {2400, 100}};
        for (const RowRange& gap : gaps) {
            rows.destroy_components(gap.first, gap.count);
        }
        std::vector<RowMove> moves;
        rows.close_gaps(gaps, 2, moves);
        CHECK(rows.size() == 1399);
        CHECK(Counted::living == 1399);
    }
    CHECK(Counted::living == 0);
}

TEST_CASE("row moves: an empty archetype takes over the columns of a large one") {
    Counted::living = 0;
    for (const std::uint32_t size : {1024u, 1025u, 2048u, 5000u}) {
        for (const std::uint32_t rows_before : {0u, 1u, 4000u}) {
            CAPTURE(size);
            BlockPool blocks;
            Archetype from(0, ids<Position, Counted, Label>(), blocks);
            Archetype to(1, ids<Position, Mass, Label>(), blocks);
            for (std::uint32_t i = 0; i < rows_before; ++i) {
                append_row(to, i);
            }
            to.clear(2);
            for (std::uint32_t i = 0; i < size; ++i) {
                append_row(from, i);
            }
            const std::byte* const positions =
                from.column(from.column_of(component_id<Position>)).data;
            REQUIRE(to.adopt_rows(from, 9));
            CHECK(to.column(to.column_of(component_id<Position>)).data == positions);
            CHECK(Counted::living == 0);
            CHECK(from.size() == 0);
            for (std::uint32_t row = 0; row < size; ++row) {
                put(to, row, Mass{static_cast<double>(row)});
            }
            check_rows(to, numbers(0, size));
            CHECK(to.structure_version((size - 1) / kChunkRows) == 9);
            CHECK(from.structure_version((size - 1) / kChunkRows) == 9);
            // Both grow on as if nothing had happened.
            for (std::uint32_t i = 0; i < 3000; ++i) {
                append_row(to, size + i);
                append_row(from, i);
            }
            check_rows(to, numbers(0, size + 3000));
            check_rows(from, numbers(0, 3000));
            CHECK_FALSE(to.adopt_rows(from, 10));
        }
    }
    CHECK(Counted::living == 0);
}
