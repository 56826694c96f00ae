#include "content/app/player/label_layout.h"

#include <doctest/doctest.h>

#include <cstddef>
#include <vector>

namespace limn::label_layout_test {

TEST_CASE("labels: none covers another, and what has no room is left out") {
    LabelLayout layout;
    const Vec2 size(60, 13);
    CHECK(*layout.place({100, 100}, size, 5) == Vec2(105, 93.5f));
    std::vector<Vec2> placed = {{105, 93.5f}};
    std::size_t left_out = 0;
    for (int i = 0; i < 30; ++i) {
        const Vec2 point(100 + 7 * (i % 6), 100 + 5 * (i / 6));
        if (const auto corner = layout.place(point, size, 5)) {
            for (const Vec2& other : placed) {
                const bool covers = corner->x < other.x + size.x && other.x < corner->x + size.x
                                    && corner->y < other.y + size.y && other.y < corner->y + size.y;
                CHECK(!covers);
            }
            placed.push_back(*corner);
        } else {
            ++left_out;
        }
    }
    CHECK(placed.size() > 4);
    CHECK(left_out > 10);
    CHECK(layout.place({500, 100}, size, 5) == Vec2(505, 93.5f));
}

TEST_CASE("labels: left of the middle they are left of their points, where there is room") {
    LabelLayout layout(300);
    const Vec2 size(60, 13);
    CHECK(layout.place({200, 100}, size, 5) == Vec2(135, 93.5f));
    CHECK(layout.place({200, 100}, size, 5) == Vec2(205, 93.5f));
    CHECK(layout.place({400, 200}, size, 5) == Vec2(405, 193.5f));
}

}  // namespace limn::label_layout_test
