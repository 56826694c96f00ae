#include "ecs/base/rng.h"
#include "systems/crowd/walker_kernels.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace limn::walker_kernels_test {

namespace {

struct SortedWalkers {
    AgentGrid grid;
    WalkerColumns columns;
    float max_radius = 0;

    /// Within a square of `half` to each side; every `same`th at the place of another one.
    SortedWalkers(std::size_t count, float half, float range, std::size_t same) {
        std::vector<Vec2> points;
        std::vector<std::uint64_t> keys;
        Random random(count, 0, 0, 0);
        for (std::size_t i = 0; i < count; ++i) {
            Vec2 point;
            point.x = random.uniform(-half, half);
            point.y = random.uniform(-half, half);
            points.push_back(i % same == same - 1 ? points[i / 2] : point);
            keys.push_back(i);
        }
        build_agent_grid(points, keys, 2, grid);
        columns.resize(count);
        for (std::size_t slot = 0; slot < count; ++slot) {
            columns.x[slot] = points[grid.order[slot]].x;
            columns.y[slot] = points[grid.order[slot]].y;
            columns.keys[slot] = keys[grid.order[slot]];
            columns.vx[slot] = random.below(8) == 0 ? 0.0f : random.uniform(-2.0f, 2.0f);
            columns.vy[slot] = columns.vx[slot] == 0 ? 0.0f : random.uniform(-2.0f, 2.0f);
            columns.radius[slot] = random.uniform(0.0f, 0.5f);
            columns.weight[slot] = random.below(2) == 0 ? 1.0f : random.uniform(0.1f, 4.0f);
            columns.side[slot] = random.below(4) == 0 ? -1.0f : 1.0f;
            columns.range[slot] = random.below(5) == 0 ? 0.5f * range : range;
            columns.preferred_x[slot] = random.uniform(-1.5f, 1.5f);
            columns.preferred_y[slot] = random.uniform(-1.5f, 1.5f);
            columns.max_speed[slot] = random.uniform(0.0f, 2.0f);
            columns.horizon[slot] = random.uniform(0.5f, 3.0f);
            max_radius = std::max(max_radius, columns.radius[slot]);
        }
    }
    [[nodiscard]] WalkerScene scene() const {
        return {
            .grid = grid,
            .columns = columns,
            .contact_time = 0.2f,
            .personal = 0.02f,
            .contact_reach = 0.06f,
            .max_radius = max_radius};
    }
    [[nodiscard]] std::size_t size() const { return grid.order.size(); }
};

/// The half-planes of all walkers, the numbers that are in use alone, and the contacts.
struct AvoidResult {
    std::vector<float> numbers;
    std::vector<std::uint32_t> words;
    WalkerContacts contacts;
};

template <typename Avoid>
AvoidResult avoid_all(const SortedWalkers& walkers, const Avoid& avoid) {
    AvoidResult result;
    const WalkerScene scene = walkers.scene();
    for (std::size_t begin = 0; begin < walkers.size(); begin += kWalkerBatch) {
        const std::size_t end = std::min(begin + kWalkerBatch, walkers.size());
        WalkerPlanes planes;
        avoid(scene, begin, end, result.contacts, planes);
        for (std::size_t lane = 0; lane < end - begin; ++lane) {
            for (std::size_t k = 0; k < planes.count[lane]; ++k) {
                result.numbers.insert(
                    result.numbers.end(),
                    {planes.normal_x[k][lane], planes.normal_y[k][lane], planes.offset[k][lane]});
            }
            result.numbers.insert(
                result.numbers.end(), {planes.start_x[lane], planes.start_y[lane]});
            result.words.insert(result.words.end(), {planes.count[lane], planes.is_met[lane]});
        }
    }
    return result;
}

void check_same_bits(const AvoidResult& found, const AvoidResult& expected) {
    REQUIRE(found.words == expected.words);
    REQUIRE(found.contacts.begins == expected.contacts.begins);
    REQUIRE(found.contacts.others == expected.contacts.others);
    REQUIRE(found.numbers.size() == expected.numbers.size());
    REQUIRE(
        std::memcmp(
            found.numbers.data(), expected.numbers.data(), sizeof(float) * expected.numbers.size())
        == 0);
}

}  // namespace

TEST_CASE(
    "walker kernels: vectors of every width give the bits of the scalar version"
    * technique("char.flock")) {
    const SortedWalkers crowds[] = {
        {1, 1, 5, 9},       // alone
        {17, 1, 5, 3},      // in fewer cells than the table has
        {1003, 32, 5, 50},  // a street
        {700, 10, 5, 50},   // a throng
        {400, 3, 5, 2},     // more near ones than a list holds
        {500, 15, 200, 9},  // who see everybody
        {300, 30, 0.1f, 9}  // who see nobody
    };
    for (const SortedWalkers& crowd : crowds) {
        const AvoidResult expected = avoid_all(crowd, avoid_neighbors_scalar);
        for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
            hwy::SetSupportedTargetsForTest(left & -left);
            check_same_bits(avoid_all(crowd, avoid_neighbors), expected);
        }
        hwy::SetSupportedTargetsForTest(0);
        check_same_bits(avoid_all(crowd, avoid_neighbors), expected);
    }
}

TEST_CASE("walker kernels: the ten nearest that comparing all finds, and all who may touch") {
    for (const float half : {32.0f, 10.0f, 3.0f}) {
        const SortedWalkers crowd(600, half, 5, 1000);
        const WalkerColumns& columns = crowd.columns;
        const AvoidResult found = avoid_all(crowd, avoid_neighbors);
        std::size_t contact = 0;
        std::size_t next = 0;
        for (std::size_t i = 0; i < crowd.size(); ++i) {
            std::vector<std::pair<float, std::size_t>> near;
            std::size_t touching = 0;
            for (std::size_t j = 0; j < crowd.size(); ++j) {
                const float distance =
                    std::hypot(columns.x[i] - columns.x[j], columns.y[i] - columns.y[j]);
                if (i != j && distance < columns.range[i]) {
                    near.emplace_back(distance, j);
                }
                if (i != j && distance < columns.radius[i] + columns.radius[j] + 0.0599f) {
                    ++touching;
                }
            }
            std::ranges::sort(near);
            const std::size_t count = std::min(near.size(), kMaxNeighbors);
            REQUIRE(found.words[2 * i] == count);
            for (std::size_t k = 0; k < count; ++k) {
                const std::size_t j = near[k].second;
                const VelocityPlane plane = avoid_walker(
                    {{columns.x[i], columns.y[i]},
                     {columns.vx[i], columns.vy[i]},
                     columns.radius[i] + 0.02f},
                    {{columns.x[j], columns.y[j]},
                     {columns.vx[j], columns.vy[j]},
                     columns.radius[j]},
                    {.horizon = columns.horizon[i],
                     .share = columns.weight[j] / (columns.weight[i] + columns.weight[j]),
                     .side = columns.side[i] == columns.side[j] ? columns.side[i] : 0.0f});
                const float* const numbers = found.numbers.data() + next;
                // Those that are nearly as far may be in either order.
                const bool is_tied =
                    (k > 0 && near[k].first < near[k - 1].first * (1 + 1e-4f))
                    || (k + 1 < near.size() && near[k + 1].first < near[k].first * (1 + 1e-4f));
                CHECK((is_tied || (numbers[0] == plane.normal.x && numbers[2] == plane.offset)));
                next += 3;
            }
            next += 2;
            const std::size_t listed =
                (i + 1 < crowd.size() ? found.contacts.begins[i + 1] : found.contacts.others.size())
                - found.contacts.begins[i];
            CHECK(listed >= touching);
            contact += touching;
        }
        CHECK(contact > 0);
    }
}

}  // namespace limn::walker_kernels_test
