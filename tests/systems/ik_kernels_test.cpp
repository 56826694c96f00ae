#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/animation/ik/ik_kernels.h"
#include "tests/near.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstring>
#include <vector>

namespace limn::ik_kernels_test {

using namespace limn::test;

namespace {

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size()
           && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}
bool same_bits(const Vec3Lanes& a, const Vec3Lanes& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}
bool same_bits(const QuatLanes& a, const QuatLanes& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z) && same_bits(a.w, b.w);
}

/// Random limbs; some straight, folded, of length 0, or with targets that are far, near or at the
/// root.
TwoLinkBatch make_limbs(std::size_t count) {
    Random random(1, 0, 0, 0);
    TwoLinkBatch batch;
    batch.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 root = any_direction(random);
        const Vec3 upper = i % 13 == 3 ? Vec3(0) : any_offset(random, 0.2f, 0.6f);
        const Vec3 lower = i % 11 == 4   ? upper
                           : i % 11 == 5 ? -upper
                                         : any_offset(random, 0.2f, 0.6f);
        batch.root.set(i, root);
        batch.middle.set(i, root + upper);
        batch.tip.set(i, root + upper + lower);
        const float far = i % 7 == 6 ? 5.0f : random.uniform(0.0f, 1.2f);
        batch.target.set(i, i % 17 == 2 ? root : root + far * any_direction(random));
        batch.pole.set(i, i % 19 == 1 ? Vec3(0) : any_direction(random));
    }
    return batch;
}

ChainBatch make_chains(std::size_t links, std::size_t count, float reach) {
    Random random(2, 0, 0, 0);
    ChainBatch batch;
    batch.resize(links, count);
    for (std::size_t i = 0; i < count; ++i) {
        Vec3 point = any_direction(random);
        batch.points.set(i, point);
        float length = 0;
        Vec3 way = any_direction(random);
        for (std::size_t k = 1; k <= links; ++k) {
            const float bone = random.uniform(0.1f, 0.3f);
            way = normalize_or(way + 0.7f * any_direction(random), {0, 1, 0});
            point += bone * way;
            length += bone;
            batch.points.set(k * count + i, point);
        }
        batch.goals.set(i, batch.points.get(i) + reach * length * any_offset(random, 0.5f, 1.0f));
    }
    return batch;
}

std::vector<float> bone_lengths(const ChainBatch& batch) {
    std::vector<float> lengths;
    for (std::size_t i = 0; i < batch.links * batch.count; ++i) {
        lengths.push_back(glm::distance(batch.points.get(i), batch.points.get(i + batch.count)));
    }
    return lengths;
}

float tip_distance(const ChainBatch& batch, std::size_t i) {
    return glm::distance(batch.points.get(batch.links * batch.count + i), batch.goals.get(i));
}

using Solve = void (*)(ChainBatch&, const ChainOptions&);
struct ChainSolver {
    Solve vector;
    Solve scalar;
};
constexpr ChainSolver kChainSolvers[] = {
    {solve_chains_dls, solve_chains_dls_scalar},
    {solve_chains_fabrik, solve_chains_fabrik_scalar},
    {solve_chains_ccd, solve_chains_ccd_scalar}};

}  // namespace

TEST_CASE(
    "IK batch: vectors and scalars have the same bits, for every number of chains"
    * technique("char.ik-two-link, char.ik-ccd, char.ik-pinv")) {
    for (const std::size_t count : {0u, 1u, 3u, 16u, 37u, 200u}) {
        TwoLinkBatch limbs = make_limbs(count);
        TwoLinkBatch scalar = limbs;
        solve_two_links(limbs);
        solve_two_links_scalar(scalar);
        CHECK(same_bits(limbs.upper, scalar.upper));
        CHECK(same_bits(limbs.lower, scalar.lower));
        for (const ChainSolver& solver : kChainSolvers) {
            for (const std::size_t links : {1u, 2u, 7u, 16u}) {
                ChainBatch chains = make_chains(links, count, 0.9f);
                ChainBatch other = chains;
                solver.vector(chains, {});
                solver.scalar(other, {});
                CHECK(same_bits(chains.points, other.points));
            }
        }
    }
}

TEST_CASE(
    "IK batch: two links reach what they can, with unit rotations and the elbow toward its pole"
    * technique("char.ik-two-link")) {
    TwoLinkBatch limbs = make_limbs(500);
    solve_two_links(limbs);
    for (std::size_t i = 0; i < 500; ++i) {
        const Vec3 root = limbs.root.get(i);
        const Vec3 upper = limbs.middle.get(i) - root;
        const Vec3 lower = limbs.tip.get(i) - limbs.middle.get(i);
        const Quat first = limbs.upper.get(i);
        const Quat second = limbs.lower.get(i);
        CHECK(glm::length(first) == near(1));
        CHECK(glm::length(second) == near(1));
        const Vec3 elbow = first * upper;
        const Vec3 tip = root + elbow + second * (first * lower);
        const float far = glm::distance(limbs.target.get(i), root);
        const float reach = glm::length(upper) + glm::length(lower);
        const float least = std::abs(glm::length(upper) - glm::length(lower));
        const double expected = double(std::max({far - reach, least - far, 0.0f}));
        CHECK(std::abs(double(glm::distance(tip, limbs.target.get(i))) - expected) < 2e-3);
        if (far > least + 0.05f && far < reach - 0.05f) {
            CHECK(glm::distance(tip, limbs.target.get(i)) < 1e-5f);
            const Vec3 line = (limbs.target.get(i) - root) / far;
            const Vec3 pole = limbs.pole.get(i) - glm::dot(limbs.pole.get(i), line) * line;
            const Vec3 beside = elbow - glm::dot(elbow, line) * line;
            if (glm::length(pole) > 0.1f) {
                CHECK(glm::dot(pole, beside) > 0.99f * glm::length(pole) * glm::length(beside));
            }
        }
    }
}

TEST_CASE("IK batch: aim turns by the shortest arc, also to the opposite and from nothing") {
    AimBatch batch;
    batch.resize(100);
    Random random(3, 0, 0, 0);
    for (std::size_t i = 0; i < 100; ++i) {
        const Vec3 forward = any_offset(random, 0.1f, 9.0f);
        batch.forward.set(i, i % 10 == 3 ? Vec3(0) : forward);
        batch.wanted.set(i, i % 10 == 5 ? -forward : any_direction(random));
    }
    AimBatch scalar = batch;
    aim(batch);
    aim_scalar(scalar);
    CHECK(same_bits(batch.rotation, scalar.rotation));
    for (std::size_t i = 0; i < 100; ++i) {
        const Quat q = batch.rotation.get(i);
        CHECK(glm::length(q) == near(1));
        if (i % 10 == 3) {
            CHECK(q == Quat(1, 0, 0, 0));
            continue;
        }
        const Vec3 from = normalize_or(batch.forward.get(i), {});
        const Vec3 to = normalize_or(batch.wanted.get(i), {});
        CHECK(glm::distance(q * from, to) < 1e-5f);
        CHECK(std::cos(axis_angle(q).angle) == near(double(glm::dot(from, to))).scale(1));
    }
}

TEST_CASE(
    "IK batch: chains keep root and bones, and reach their goals in a few iterations"
    * technique("char.ik-ccd, char.ik-pinv")) {
    const float tolerance[] = {0.02f, 0.01f, 0.04f};  // after 10 iterations, of chains of 1.4 m
    std::size_t solver_index = 0;
    for (const ChainSolver& solver : kChainSolvers) {
        CAPTURE(solver_index);
        ChainBatch chains = make_chains(7, 200, 0.7f);
        const std::vector<float> before = bone_lengths(chains);
        const Vec3 root = chains.points.get(11);
        std::vector<float> start;
        for (std::size_t i = 0; i < chains.count; ++i) {
            start.push_back(tip_distance(chains, i));
        }
        solver.vector(chains, {});
        CHECK(chains.points.get(11) == root);
        const std::vector<float> after = bone_lengths(chains);
        for (std::size_t i = 0; i < before.size(); ++i) {
            CHECK(after[i] == near(double(before[i])).epsilon(2e-5));
        }
        int reached = 0;
        for (std::size_t i = 0; i < chains.count; ++i) {
            CHECK(tip_distance(chains, i) < start[i]);
            reached += tip_distance(chains, i) < tolerance[solver_index] ? 1 : 0;
        }
        CHECK(reached >= 190);
        ++solver_index;
    }
}

TEST_CASE(
    "IK batch: degenerate chains are finite: straight ones, goals at the root, length 0"
    * technique("char.ik-ccd, char.ik-pinv")) {
    for (const ChainSolver& solver : kChainSolvers) {
        ChainBatch chains;
        chains.resize(3, 20);
        for (std::size_t i = 0; i < 20; ++i) {
            for (std::size_t k = 0; k <= 3; ++k) {
                const float length = i % 4 == 0 ? 0.0f : static_cast<float>(k);
                chains.points.set(k * 20 + i, {0, length, 0});
            }
            const Vec3 goals[] = {{0, 0, 0}, {0, 2, 0}, {0, -2, 0}, {0, 3, 0}, {1e6f, 0, 0}};
            chains.goals.set(i, goals[i % 5]);
        }
        ChainBatch scalar = chains;
        solver.vector(chains, {});
        solver.scalar(scalar, {});
        CHECK(same_bits(chains.points, scalar.points));
        for (std::size_t i = 0; i < chains.points.size(); ++i) {
            CHECK(is_finite(chains.points.get(i)));
        }
    }
}

}  // namespace limn::ik_kernels_test
