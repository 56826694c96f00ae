#include "ecs/base/rng.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <set>
#include <vector>

using namespace limn;

TEST_CASE("rng: Philox4x32-10 gives the known answers of Random123") {
    CHECK(
        philox4x32({0, 0, 0, 0}, {0, 0})
        == PhiloxCounter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
    CHECK(
        philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff})
        == PhiloxCounter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
    CHECK(
        philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0})
        == PhiloxCounter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("rng: the same key gives the same numbers, in any order of calls") {
    Random first(1, 2, 3, 4);
    Random other(1, 3, 3, 4);
    Random again(1, 2, 3, 4);
    for (int i = 0; i < 100; ++i) {
        const std::uint32_t word = first.word();
        static_cast<void>(other.word());
        CHECK(word == again.word());
    }
}

TEST_CASE("rng: seed, subject, system and frame each change every number") {
    const std::vector<Random> keys = {
        Random(1, 2, 3, 4),
        Random(2, 2, 3, 4),
        Random(1, 2 + (1ull << 32), 3, 4),  // the same slot, another generation
        Random(1, 3, 3, 4),
        Random(1, 2, 4, 4),
        Random(1, 2, 3, 5),
        Random(1, 2, 3, 4 + (1ull << 32)),
        Random(1 + (1ull << 32), 2, 3, 4)};
    std::set<std::uint32_t> words;
    for (Random random : keys) {
        for (int i = 0; i < 1000; ++i) {
            words.insert(random.word());
        }
    }
    CHECK(words.size() >= keys.size() * 1000 - 20);  // birthdays: 0.0075 expected
}

TEST_CASE("rng: uniform stays in 0 <= x < 1 with the mean and variance of an even spread") {
    Random random(7, 0, 0, 0);
    double sum = 0;
    double squares = 0;
    constexpr int kCount = 1'000'000;
    for (int i = 0; i < kCount; ++i) {
        const float x = random.uniform();
        REQUIRE(x >= 0.0f);
        REQUIRE(x < 1.0f);
        sum += x;
        squares += double{x} * x;
    }
    const double mean = sum / kCount;
    CHECK(mean == test::near(0.5).epsilon(0.002));
    CHECK(squares / kCount - mean * mean == test::near(1.0 / 12.0).epsilon(0.005));
}

TEST_CASE("rng: below gives every number about equally often and no other") {
    Random random(8, 0, 0, 0);
    std::vector<int> counts(7);
    for (int i = 0; i < 70'000; ++i) {
        const std::uint32_t n = random.below(7);
        REQUIRE(n < 7);
        ++counts[n];
    }
    for (const int count : counts) {
        CHECK(std::abs(count - 10'000) < 500);  // 5 standard deviations
    }
    CHECK(Random(1, 2, 3, 4).below(1) == 0);
}

TEST_CASE("rng: normal has mean 0 and standard deviation 1, and is finite") {
    Random random(9, 0, 0, 0);
    double sum = 0;
    double squares = 0;
    constexpr int kCount = 200'000;
    for (int i = 0; i < kCount; ++i) {
        const float x = random.normal();
        REQUIRE(std::isfinite(x));
        sum += x;
        squares += double{x} * x;
    }
    CHECK(std::abs(sum / kCount) < 0.012);
    CHECK(squares / kCount == test::near(1.0).epsilon(0.02));
}

TEST_CASE("rng: directions are unit vectors without a preferred side; discs are filled evenly") {
    Random random(10, 0, 0, 0);
    Vec3 sum = {0, 0, 0};
    int inner = 0;
    constexpr int kCount = 100'000;
    for (int i = 0; i < kCount; ++i) {
        const Vec3 d = random.direction();
        REQUIRE(glm::dot(d, d) == test::near(1.0f).epsilon(1e-5));
        sum += d;
        const Vec2 p = random.in_disc();
        REQUIRE(glm::dot(p, p) <= 1.0f);
        inner += glm::dot(p, p) < 0.25f ? 1 : 0;  // half the radius: a quarter of the area
    }
    CHECK(std::sqrt(glm::dot(sum, sum)) / kCount < 0.01f);
    CHECK(inner / static_cast<double>(kCount) == test::near(0.25).epsilon(0.03));
}
