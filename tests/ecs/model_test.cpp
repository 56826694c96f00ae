#include "ecs/base/jobs.h"
#include "tests/ecs/model_world.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>

// A world beside plain maps (model_reference.h), driven through a million random operations
// (model_world.h); every few hundred of them both must say the same (model_compare.h).
//
// A failure says which seed and operation it was. To see it again:
//     LIMN_MODEL_SEED=3 LIMN_MODEL_OPERATIONS=52301 limn_ecs_tests --test-case="model:*"

using namespace limn;
using namespace limn::test;

namespace {

#if defined(LIMN_SANITIZED)
constexpr std::uint64_t kCompareEvery = 16000;
#else
constexpr std::uint64_t kCompareEvery = 1500;
#endif
constexpr std::uint32_t kSeeds = 5;
constexpr std::uint64_t kOperations = 200'000;

/// A number from the environment.
std::uint64_t setting(const char* name, std::uint64_t otherwise) {
    const char* const text = std::getenv(name);
    return text != nullptr && *text != '\0' ? std::strtoull(text, nullptr, 10) : otherwise;
}

struct ThreadCount {
    int before = thread_count();
    explicit ThreadCount(int threads) { set_thread_count(threads); }
    ~ThreadCount() { set_thread_count(before); }
};

void print(std::uint32_t seed, const model::ModelWorld& world) {
    std::printf(
        "model: seed %u: %llu operations, %llu comparisons:", seed,
        static_cast<unsigned long long>(world.done()),
        static_cast<unsigned long long>(world.comparisons()));
    for (const auto& [what, count] : world.counts()) {
        std::printf(" %s %llu,", what.c_str(), static_cast<unsigned long long>(count));
    }
    std::printf("\b\n");
}

/// The counts around multiples of 1024 that were not met.
std::string missing(const std::set<std::uint32_t>& counts, std::uint32_t chunks) {
    std::string missing;
    for (std::uint32_t k = 1; k <= chunks; ++k) {
        for (const std::uint32_t rows : {k * 1024 - 1, k * 1024, k * 1024 + 1}) {
            missing += counts.contains(rows) ? "" : std::to_string(rows) + " ";
        }
    }
    return missing;
}

}  // namespace

TEST_CASE("model: a world and plain maps agree after a million random operations") {
    const ThreadCount threads(4);
    const std::uint64_t only = setting("LIMN_MODEL_SEED", 0);
    const std::uint64_t operations = setting("LIMN_MODEL_OPERATIONS", kOperations);
    std::set<std::uint32_t> row_counts;
    std::set<std::uint32_t> sparse_counts;
    std::uint64_t total = 0;
    const int before = ModelTally::living;
    for (std::uint64_t seed = only != 0 ? only : 1; seed <= (only != 0 ? only : kSeeds); ++seed) {
        {
            model::ModelWorld world(static_cast<std::uint32_t>(seed), kCompareEvery);
            INFO("LIMN_MODEL_SEED=", seed, " LIMN_MODEL_OPERATIONS=", world.done());
            world.run(operations);
            print(static_cast<std::uint32_t>(seed), world);
            row_counts.insert(world.row_counts().begin(), world.row_counts().end());
            sparse_counts.insert(world.sparse_counts().begin(), world.sparse_counts().end());
            total += world.done();
        }
        CHECK(ModelTally::living == before);
    }
    std::printf("model: %llu operations\n", static_cast<unsigned long long>(total));
    if (only == 0 && operations >= kOperations) {
        CHECK(total >= 1'000'000);
        CHECK(missing(row_counts, 3) == "");
        CHECK(missing(sparse_counts, 1) == "");
    }
}
