// The search of motion matching: with vectors and with boxes it finds what the plain loop finds.

#include "ecs/base/rng.h"
#include "systems/animation/matching/match_rows.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace limn::match_rows_test {

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Rows along a path, so that neighbors are alike as frames of a clip are.
std::vector<MatchRow> make_path(std::size_t count, std::uint32_t seed) {
    Random random(seed, 0, name_hash("match rows"), 0);
    std::vector<MatchRow> rows(count);
    MatchRow at{};
    for (MatchRow& row : rows) {
        for (float& number : at) {
            number = 0.97f * number + random.uniform(-0.25f, 0.25f);
        }
        row = at;
    }
    return rows;
}

MatchRow random_query(Random& random, float size) {
    MatchRow query{};
    for (float& number : query) {
        number = random.uniform(-size, size);
    }
    return query;
}

/// The definition, in rows as they were given.
RowMatch nearest_of(
    const std::vector<MatchRow>& rows, const MatchRow& query, float limit, MatchSkip skipped = {}) {
    RowMatch best;
    best.distance = limit;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (i >= skipped.first && i < skipped.last) {
            continue;
        }
        const float distance = row_distance(rows[i], query);
        if (distance < best.distance) {
            best = {static_cast<std::uint32_t>(i), distance};
        }
    }
    return best;
}

void check_all(
    const std::vector<MatchRow>& rows, const MatchRow& query, float limit = INFINITY,
    MatchSkip skipped = {}) {
    const MatchRows made = make_match_rows(rows);
    const RowMatch expected = nearest_of(rows, query, limit, skipped);
    CHECK(find_nearest_row_scalar(made, query, limit, skipped) == expected);
    CHECK(find_nearest_row(made, query, limit, skipped) == expected);
    CHECK(find_nearest_row_boxes(made, query, limit, skipped) == expected);
}

}  // namespace

TEST_CASE("match rows: all searches find the same row with the same bits, for any number of rows") {
    Random random(2, 0, name_hash("match queries"), 0);
    for (const std::size_t count :
         {std::size_t{1}, std::size_t{15}, std::size_t{16}, std::size_t{17}, std::size_t{63},
          std::size_t{64}, std::size_t{65}, std::size_t{1023}, std::size_t{1024}, std::size_t{1025},
          std::size_t{3001}}) {
        const std::vector<MatchRow> rows = make_path(count, static_cast<std::uint32_t>(count));
        for (int i = 0; i < 40; ++i) {
            const MatchRow query = random_query(random, i % 2 == 0 ? 0.6f : 3.0f);
            check_all(rows, query);
            check_all(rows, query, 12.0f);
            const std::uint32_t nearest = nearest_of(rows, query, INFINITY).row;
            check_all(rows, query, INFINITY, {nearest, nearest + 1});
            check_all(rows, query, INFINITY, {nearest - std::min(nearest, 40u), nearest + 9});
        }
    }
}

TEST_CASE("match rows: the nearest row of a row is itself, the first of equal ones") {
    std::vector<MatchRow> rows = make_path(700, 3);
    for (std::size_t i = 0; i < rows.size(); i += 23) {
        const MatchRows made = make_match_rows(rows);
        CHECK(find_nearest_row_boxes(made, rows[i]) == RowMatch{static_cast<std::uint32_t>(i), 0});
    }
    rows[130] = rows[20];  // equal rows: of another box, of the same block
    rows[131] = rows[20];
    rows[560] = rows[558];
    check_all(rows, rows[20]);
    CHECK(find_nearest_row_boxes(make_match_rows(rows), rows[131]).row == 20);
    CHECK(find_nearest_row(make_match_rows(rows), rows[560]).row == 558);
}

TEST_CASE("match rows: nothing nearer than the limit, no rows, numbers that are not finite") {
    std::vector<MatchRow> rows = make_path(200, 4);
    const float distance = nearest_of(rows, MatchRow{}, INFINITY).distance;
    check_all(rows, MatchRow{}, distance);
    check_all(rows, MatchRow{}, 0);
    CHECK(find_nearest_row_boxes(make_match_rows(rows), MatchRow{}, distance).row == kNoMatch);
    CHECK(find_nearest_row_boxes(make_match_rows({}), MatchRow{}).row == kNoMatch);
    CHECK(find_nearest_row(make_match_rows({}), MatchRow{}).row == kNoMatch);
    rows[77].fill(kNan);
    rows[78][5] = INFINITY;
    check_all(rows, MatchRow{});
    MatchRow query{};
    query[26] = kNan;
    check_all(rows, query);
    for (MatchRow& row : rows) {
        row[3] = kNan;
    }
    check_all(rows, MatchRow{});
}

TEST_CASE("match rows: a row reads as it was made") {
    const std::vector<MatchRow> rows = make_path(90, 5);
    const MatchRows made = make_match_rows(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CHECK(made.row(i) == rows[i]);
    }
}

}  // namespace limn::match_rows_test
