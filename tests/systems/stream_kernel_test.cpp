#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "systems/motion_kernels.h"
#include "systems/transform_system.h"
#include "tests/systems/sway_table.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

// One kernel, many elements that know nothing of each other (shade.stream-kernel): neither the
// order nor the grouping of the work affects the result.

namespace limn::stream_kernel_test {
namespace {

/// Entities that sway and rotate, with world matrices.
struct Elements {
    std::vector<Sway> sway;
    std::vector<Spin> spin;
    std::vector<Transform> local;
    std::vector<WorldTransform> world;
    std::vector<PreviousWorldTransform> previous;
};

Elements make_elements(std::size_t count) {
    Random random(11, 0, name_hash("stream"), 0);
    const auto vector = [&] {
        const float x = random.uniform(-1, 1);
        const float y = random.uniform(-1, 1);
        return Vec3(x, y, random.uniform(-1, 1));
    };
    Elements all;
    for (std::size_t i = 0; i < count; ++i) {
        Sway sway;
        sway.center = vector();
        sway.amplitude = vector();
        sway.phase = vector();
        all.sway.push_back(sway);
        Spin spin;
        spin.axis = vector();
        all.spin.push_back(spin);
        Transform local;
        local.scale = vector();
        all.local.push_back(local);
    }
    all.world.resize(count);
    all.previous.resize(count);
    return all;
}

/// Steps elements begin .. end.
void step(Elements& all, std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    const std::span local = std::span(all.local).subspan(begin, count);
    sway_positions(test::SwayTable(std::span(all.sway).subspan(begin, count)).arrays(), 3.7, local);
    turn_rotations(std::span<const Spin>(all.spin).subspan(begin, count), 0.02f, local);
    compose_worlds(
        local, std::span(all.world).subspan(begin, count),
        std::span(all.previous).subspan(begin, count));
}

bool same_bits(const std::vector<WorldTransform>& a, const std::vector<WorldTransform>& b) {
    return a.size() == b.size()
           && std::memcmp(a.data(), b.data(), a.size() * sizeof(WorldTransform)) == 0;
}

constexpr std::size_t kCount = 3001;

}  // namespace

TEST_CASE(
    "stream_kernel: in chunks of any size, forward or backward, the bits are the same"
    * technique("shade.stream-kernel")) {
    Elements whole = make_elements(kCount);
    step(whole, 0, kCount);
    for (const std::size_t piece : {1u, 7u, 64u, 1000u, 4096u}) {
        Elements forward = make_elements(kCount);
        Elements backward = make_elements(kCount);
        for (std::size_t begin = 0; begin < kCount; begin += piece) {
            step(forward, begin, std::min(begin + piece, kCount));
        }
        for (std::size_t end = kCount; end > 0; end -= std::min(piece, end)) {
            step(backward, end - std::min(piece, end), end);
        }
        CHECK(same_bits(forward.world, whole.world));
        CHECK(same_bits(backward.world, whole.world));
    }
}

TEST_CASE(
    "stream_kernel: permuted inputs give permuted outputs" * technique("shade.stream-kernel")) {
    Elements whole = make_elements(kCount);
    std::vector<std::size_t> order(kCount);
    std::iota(order.begin(), order.end(), std::size_t{0});
    Random random(12, 0, name_hash("order"), 0);
    for (std::size_t i = kCount - 1; i > 0; --i) {
        std::swap(order[i], order[random.below(static_cast<std::uint32_t>(i + 1))]);
    }
    Elements permuted = make_elements(kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
        permuted.sway[i] = whole.sway[order[i]];
        permuted.spin[i] = whole.spin[order[i]];
        permuted.local[i] = whole.local[order[i]];
    }
    step(whole, 0, kCount);
    step(permuted, 0, kCount);
    std::vector<WorldTransform> want(kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
        want[i] = whole.world[order[i]];
    }
    CHECK(same_bits(permuted.world, want));
    CHECK_FALSE(same_bits(permuted.world, whole.world));
}

TEST_CASE(
    "stream_kernel: 1 to 16 threads place 20000 entities with the same bits"
    * technique("shade.stream-kernel")) {
    const int threads = thread_count();
    std::vector<WorldTransform> one;
    for (const int count : {1, 2, 3, 5, 8, 16}) {
        set_thread_count(count);
        World world;
        Elements all = make_elements(20'000);
        for (const Transform& local : all.local) {
            world.create(local, WorldTransform{}, PreviousWorldTransform{});
        }
        Schedule schedule;
        schedule.add<update_transforms>();
        schedule.run(world);
        std::vector<WorldTransform> matrices;
        std::as_const(world).query<const WorldTransform>().each(
            [&](const WorldTransform& at) { matrices.push_back(at); });
        if (one.empty()) {
            one = matrices;
        }
        CHECK(same_bits(matrices, one));
    }
    CHECK(one.size() == 20'000);
    set_thread_count(threads);
}

}  // namespace limn::stream_kernel_test
