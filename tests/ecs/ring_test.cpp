#include "ecs/base/ring.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <deque>

namespace limn::ring_test {
namespace {

struct Numbers {
    std::array<int, 10> slots = {};
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    Ring<int> ring = {slots, first, count};
};

}  // namespace

TEST_CASE(
    "ring: index 0 is the oldest item; a full one takes no more, an empty one has none to remove"
    * technique("engine.containers")) {
    Numbers numbers;
    CHECK_FALSE(numbers.ring.pop_front());
    for (const int number : {1, 2, 3}) {
        CHECK(numbers.ring.push_back(number));
    }
    CHECK(numbers.ring.pop_front());
    CHECK(numbers.ring[0] == 2);
    CHECK(numbers.ring.size() == 2);
    while (!numbers.ring.is_full()) {
        CHECK(numbers.ring.push_back(9));
    }
    const Numbers before = numbers;
    CHECK_FALSE(numbers.ring.push_back(7));
    CHECK(numbers.slots == before.slots);
    CHECK(numbers.first == before.first);
    CHECK(numbers.count == 10);
}

TEST_CASE("ring: the order holds across the end of its slots" * technique("engine.containers")) {
    Numbers numbers;
    std::deque<int> expected;
    for (int i = 0; i < 1000; ++i) {
        if ((i * 7 + i / 13) % 3 != 0 && expected.size() < numbers.slots.size()) {
            REQUIRE(numbers.ring.push_back(i));
            expected.push_back(i);
        } else if (!expected.empty()) {
            REQUIRE(numbers.ring.pop_front());
            expected.pop_front();
        }
        REQUIRE(numbers.ring.size() == expected.size());
        for (std::uint32_t k = 0; k < numbers.ring.size(); ++k) {
            REQUIRE(numbers.ring[k] == expected[k]);
        }
    }
    CHECK(numbers.first > 0);
}

TEST_CASE("ring: over constant slots it is read") {
    Numbers numbers;
    numbers.ring.push_back(5);
    const Numbers& constant = numbers;
    const Ring<const int> view(constant.slots, constant.first, constant.count);
    CHECK(view[0] == 5);
    CHECK(view.size() == 1);
}

}  // namespace limn::ring_test
