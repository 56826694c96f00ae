// Sorting particles on the GPU, against std::stable_sort.

#include "ecs/base/depth_sort.h"
#include "ecs/base/rng.h"
#include "render/particles/gpu_particle_sort.h"
#include "render/particles/particle_list.h"
#include "tests/near.h"
#include "tests/render/render_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace limn::test::gpu_particle_sort_test {
namespace {

constexpr Vec3 kEye = {0.5f, -1, 40};
constexpr Vec3 kForward = {0, 0.6f, -0.8f};

/// Particles in a ball of 20 m; `random` is their number since the first birth of all.
std::vector<ParticleInstance> cloud(std::uint32_t first, std::uint32_t count) {
    std::vector<ParticleInstance> instances(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        Random random(3, 1, 4, first + i);
        instances[i].position = 10.0f * random.uniform() * random.direction();
        instances[i].random = first + i;
    }
    return instances;
}

constexpr std::uint32_t kDead = 0xbc000000;  // an age of -1 s

bool is_alive(const ParticleInstance& one) {
    return one.velocity_z_age != kDead;
}

float depth_of(const ParticleInstance& one, const ParticleSortView& view = {kEye, kForward}) {
    return glm::dot(one.position - view.eye, view.forward);
}

/// An emitter's particles, sorted frame after frame.
struct Sorter : RenderTest {
    ParticleSortPrograms programs = *ParticleSortPrograms::create(device());
    FrameGraph graph{device()};
    GpuParticleSort sort;

    /// What is drawn; the first is particle `first`.
    std::vector<ParticleInstance> frame(
        const std::vector<ParticleInstance>& instances, std::uint32_t first, std::uint32_t passes,
        const ParticleSortView& view = {kEye, kForward}) {
        const ParticleWindow now = {first, static_cast<std::uint32_t>(instances.size())};
        const gpu::Buffer buffer =
            gpu::Buffer::of("instances", std::span<const ParticleInstance>(instances));
        plan_particle_sort(now, passes, sort);
        graph.begin_frame();
        const Use writes[] = {graph.import("order", sort.instances)};
        graph.add_pass("sort", {}, writes, [&](PassContext& context) {
            run_particle_sort(context, programs, now, buffer, view, sort);
        });
        graph.execute();
        std::vector<ParticleInstance> drawn(sort.count);
        sort.instances.read(0, std::as_writable_bytes(std::span(drawn)));
        return drawn;
    }
};

std::vector<std::uint32_t> numbers_of(const std::vector<ParticleInstance>& drawn) {
    std::vector<std::uint32_t> numbers;
    for (const ParticleInstance& one : drawn) {
        if (is_alive(one)) {
            numbers.push_back(one.random);
        }
    }
    return numbers;
}

std::vector<std::uint32_t> stable_order(std::vector<ParticleInstance> instances) {
    std::stable_sort(instances.begin(), instances.end(), [](const auto& a, const auto& b) {
        return depth_key(depth_of(a)) < depth_key(depth_of(b));
    });
    return numbers_of(instances);
}

/// Pairs that are drawn in the wrong order, as a fraction of all.
double inverted_fraction(const std::vector<ParticleInstance>& drawn, const ParticleSortView& view) {
    double inverted = 0;
    for (std::size_t a = 0; a < drawn.size(); ++a) {
        for (std::size_t b = a + 1; b < drawn.size(); ++b) {
            inverted += depth_of(drawn[a], view) < depth_of(drawn[b], view) ? 1 : 0;
        }
    }
    return inverted / (0.5 * static_cast<double>(drawn.size() * (drawn.size() - 1)));
}

}  // namespace

TEST_CASE_FIXTURE(
    Sorter, "gpu particle sort: back to front, equal ones in the order of births"
                * technique("particle.bitonic-sort")) {
    for (const std::uint32_t count : {1u, 2u, 777u, 1024u, 1025u, 4096u, 70000u}) {
        CAPTURE(count);
        std::vector<ParticleInstance> instances = cloud(0, count);
        for (std::uint32_t i = 0; i < count; ++i) {
            // In steps, so that many are equally far; a tenth of them dead.
            instances[i].position = glm::floor(instances[i].position);
            instances[i].velocity_z_age = i % 10 == 3 ? kDead : 0;
        }
        const std::vector<ParticleInstance> drawn = frame(instances, 0, 0);
        REQUIRE(drawn.size() == count);
        CHECK(numbers_of(drawn) == stable_order(instances));
        // The dead are last.
        CHECK(std::is_sorted(drawn.begin(), drawn.end(), [](const auto& a, const auto& b) {
            return a.velocity_z_age < b.velocity_z_age;
        }));
    }
}

TEST_CASE_FIXTURE(
    Sorter, "gpu particle sort: positions that are NaN count as farthest"
                * technique("particle.bitonic-sort")) {
    std::vector<ParticleInstance> instances = cloud(0, 100);
    instances[60].position.x = std::numeric_limits<float>::quiet_NaN();
    instances[70].position = kEye + 1e30f * kForward;
    CHECK(numbers_of(frame(instances, 0, 0))[0] == 60);
    CHECK(numbers_of(frame(instances, 0, 0))[1] == 70);
    CHECK(numbers_of(frame(instances, 0, 0)) == stable_order(instances));
}

TEST_CASE_FIXTURE(
    Sorter, "gpu particle sort: by four passes a frame, a million take 53 frames"
                * technique("particle.sort-amortised")) {
    plan_particle_sort({0, 1 << 20}, 4, sort);
    CHECK(sort.plan.last_pass == 210);  // the first one is whole
    int frames = 0;
    for (bool ended = false; !ended; ++frames) {
        plan_particle_sort({0, 1 << 20}, 4, sort);
        ended = sort.next_pass == 0;
        CHECK(sort.plan.last_pass - sort.plan.first_pass == (ended ? 2 : 4));
    }
    CHECK(frames == 53);

    // 2,000 particles are 66 passes: 17 frames. Keys are those of the first one.
    sort = {};
    const auto other_cloud = [](std::uint32_t seed) {
        std::vector<ParticleInstance> moved = cloud(seed, 2000);
        for (std::uint32_t i = 0; i < 2000; ++i) {
            moved[i].random = i;
        }
        return moved;
    };
    const std::vector<ParticleInstance> first = cloud(0, 2000);
    CHECK(numbers_of(frame(first, 0, 4)) == stable_order(first));
    const std::vector<ParticleInstance> second = other_cloud(5000);
    CHECK(numbers_of(frame(second, 0, 4)) == stable_order(first));
    const std::vector<ParticleInstance> third = other_cloud(9000);
    for (int i = 2; i < 17; ++i) {
        const std::vector<ParticleInstance> drawn = frame(third, 0, 4);
        CHECK(numbers_of(drawn) == stable_order(first));
        CHECK(drawn[5].position == third[drawn[5].random].position);  // where they are by now
    }
    CHECK(numbers_of(frame(third, 0, 4)) == stable_order(second));
}

TEST_CASE_FIXTURE(
    Sorter, "gpu particle sort: while it goes on, each that lives is drawn once"
                * technique("particle.sort-amortised")) {
    std::uint32_t first = 0xfffffc00u;  // wraps
    std::uint32_t end = first + 900;
    for (int i = 0; i < 120; ++i) {
        first += 29;
        end += 31;
        const std::vector<ParticleInstance> alive = cloud(first, end - first);
        const std::vector<std::uint32_t> drawn = numbers_of(frame(alive, first, 4));
        // In order: those that were there when the keys were read, whose positions have not
        // changed.
        std::vector<ParticleInstance> expected = alive;
        const std::uint32_t known = sort.shown->first + sort.shown->count - first;
        std::stable_sort(
            expected.begin(), expected.begin() + known, [](const auto& a, const auto& b) {
                return depth_key(depth_of(a)) < depth_key(depth_of(b));
            });
        CHECK(drawn == numbers_of(expected));
    }
}

TEST_CASE_FIXTURE(
    Sorter, "gpu particle sort: behind a slow camera few pairs are out of order"
                * technique("particle.sort-amortised")) {
    // It moves 0.1 units a frame around a ball of 100, whose center is 150 away. At four passes a
    // frame a sort takes 14 frames; at one 55, as a million particles do at four: the order shown
    // is then up to 109 frames old, 4 degrees. Keys of the view halfway through that
    // time leave a third of the 1.8 % that those of the view that was would leave.
    std::vector<ParticleInstance> ball = cloud(0, 1000);
    for (ParticleInstance& one : ball) {
        one.position *= 5.0f;
    }
    const auto view_at = [](int i) {
        const float angle = 0.1f / 150 * static_cast<float>(i);
        const Vec3 from = {std::sin(angle), 0, std::cos(angle)};
        return ParticleSortView{150.0f * from, -from};
    };
    for (const auto& [passes, limit] : {std::pair(4u, 0.0025), std::pair(1u, 0.006)}) {
        sort = {};
        double first = 0;  // until the second sort ends: the order knew no motion
        double worst = 0;
        for (int i = 0; i < 220; ++i) {
            const std::vector<ParticleInstance> drawn = frame(ball, 0, passes, view_at(i));
            if (i % 10 == 8) {
                double& fraction = i > 58 ? worst : first;
                fraction = std::max(fraction, inverted_fraction(drawn, view_at(i)));
            }
        }
        CHECK(first < 0.02);
        CHECK(worst > 0);
        CHECK(worst < limit);
    }
}

TEST_CASE(
    "gpu particle sort: the view of a steady camera is predicted, one after a jump is not"
    * technique("particle.sort-amortised")) {
    const ParticleSortView previous = {{0, 1, 0}, {0, 0, -1}};
    const ParticleSortView now = {{0.5f, 1, 0.25f}, glm::normalize(Vec3(0.1f, 0, -1))};
    const ParticleSortView then = predict_sort_view(previous, now, 4);
    CHECK(glm::distance(then.eye, Vec3(2.5f, 1, 1.25f)) < 1e-5f);
    CHECK(then.forward.x == near(0.245).epsilon(0.03));  // 0.15 rad further, no more
    CHECK(glm::length(then.forward) == near(1));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const ParticleSortView& jumped :
         {ParticleSortView{{20, 1, 0}, {0, 0, -1}}, ParticleSortView{{0, 1, 0}, {0, 0, 1}},
          ParticleSortView{{nan, 1, 0}, {0, 0, -1}}}) {
        const ParticleSortView same = predict_sort_view(previous, jumped, 4);
        CHECK((same.eye == jumped.eye || std::isnan(same.eye.x)));
        CHECK(same.forward == jumped.forward);
    }
}

}  // namespace limn::test::gpu_particle_sort_test
