#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"
#include "bench/characters/scalar_ik.h"
#include "ecs/base/rng.h"
#include "systems/animation/ik/ik_kernels.h"
#include "systems/animation/ik/iterate_ik.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace limn::bench {

void add_ik_rows(CharacterBench& bench);

namespace {

constexpr std::size_t kLimbs = 10000;
constexpr std::size_t kChains = 2048;
constexpr std::size_t kLinks = 7;
constexpr double kLimbNs = 1e9 / kLimbs;
constexpr double kChainNs = 1e9 / kChains;

void append(std::vector<float>& list, const Vec3& v) {
    list.insert(list.end(), {v.x, v.y, v.z});
}

void add_limb_rows(CharacterBench& bench) {
    Random random(1, 0, name_hash("bench limbs"), 0);
    TwoLinkBatch batch;
    batch.resize(kLimbs);
    AimBatch aims;
    aims.resize(kLimbs);
    std::vector<float> points;
    std::vector<float> forward;
    std::vector<float> wanted;
    for (std::size_t i = 0; i < kLimbs; ++i) {
        const Vec3 root = random.direction();
        const Vec3 middle = root + 0.45f * random.direction();
        const Vec3 tip = middle + 0.42f * random.direction();
        const Vec3 target = root + random.uniform(0.1f, 0.9f) * random.direction();
        const Vec3 pole = random.direction();
        Vec3Lanes* const lanes[] = {
            &batch.root, &batch.middle, &batch.tip, &batch.target, &batch.pole};
        const Vec3 values[] = {root, middle, tip, target, pole};
        for (std::size_t k = 0; k < 5; ++k) {
            lanes[k]->set(i, values[k]);
            append(points, values[k]);
        }
        aims.forward.set(i, middle - root);
        aims.wanted.set(i, pole);
        append(forward, middle - root);
        append(wanted, pole);
    }
    std::vector<float> rotations(8 * kLimbs);
    const auto [ours, scalar, by_hand] = race(
        thread_seconds, bench.repeats, [&] { solve_two_links(batch); },
        [&] { solve_two_links_scalar(batch); },
        [&] {
            two_links_by_hand(points.data(), kLimbs, rotations.data());
            keep(rotations.data());
        });
    bench.add(
        {.gate = "10",
         .name = fmt::format("{} limbs of two links", kLimbs),
         .ours = ours * kLimbNs,
         .reference = by_hand * kLimbNs,
         .against = "scalar, floats",
         .limit = 0.12,
         .stretch = 0.08,
         .peer = "3.3 (ozz)",
         .vectors = true});
    bench.add(
        {.gate = "",
         .name = "the same, one after the other",
         .ours = scalar * kLimbNs,
         .reference = by_hand * kLimbNs,
         .against = "scalar, floats"});
    const auto [aim_ours, aim_by] = race(
        thread_seconds, bench.repeats, [&] { aim(aims); },
        [&] {
            aim_by_hand(forward.data(), wanted.data(), kLimbs, rotations.data());
            keep(rotations.data());
        });
    bench.add(
        {.gate = "11",
         .name = "aim, one shortest arc",
         .ours = aim_ours * kLimbNs,
         .reference = aim_by * kLimbNs,
         .against = "scalar, floats",
         .limit = 0.2,
         .stretch = 0.1,
         .peer = "10 (ozz)",
         .vectors = true});
}

/// Random chains of 7 links, for the engine and for loops by hand.
struct BenchChains {
    ChainBatch batch;
    std::vector<float> points;
    std::vector<float> goals;

    BenchChains() {
        Random random(2, 0, name_hash("bench chains"), 0);
        batch.resize(kLinks, kChains);
        for (std::size_t i = 0; i < kChains; ++i) {
            Vec3 point(0);
            for (std::size_t k = 0; k <= kLinks; ++k) {
                batch.points.set(k * kChains + i, point);
                append(points, point);
                point += 0.2f * normalize_or(Vec3(0, 1, 0) + 0.8f * random.direction(), {});
            }
            const Vec3 goal = random.uniform(0.3f, 1.2f) * random.direction();
            batch.goals.set(i, goal);
            append(goals, goal);
        }
    }
};

using SolveBatch = void (*)(ChainBatch&, const ChainOptions&);
using SolveByHand = void (*)(float*, const float*);

void add_chain_row(CharacterBench& bench, const char* name, SolveBatch solve, SolveByHand by_hand) {
    BenchChains start;
    // Solving goes on from the last result: the same work, whatever the chains' shapes.
    const auto [ours, scalar] = race(
        thread_seconds, bench.repeats, [&] { solve(start.batch, {}); },
        [&] { by_hand(start.points.data(), start.goals.data()); });
    bench.add(
        {.gate = "12",
         .name = fmt::format("{}, 7 links, 10 iterations", name),
         .ours = ours * kChainNs,
         .reference = scalar * kChainNs,
         .against = "scalar, floats",
         .limit = 0.12,
         .stretch = 0.06,
         .vectors = true});
}

/// One chain of seven hinges by the general solver, ten iterations.
void add_single_row(CharacterBench& bench) {
    JointTree arm;
    for (int i = 0; i < 7; ++i) {
        add_joint(arm, i - 1, {0, i == 0 ? 0.0f : 0.2f, 0});
        add_hinge(arm, i % 2 == 0 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), -2, 2);
    }
    const Effector tip = {6, {0, 0.2f, 0}};
    const JointState rest = zero_state(arm);
    JointState state;
    const IkOptions options = {.iterations = 10, .step = 0.2f, .tracking = 0, .tolerance = 0};
    constexpr int kSolves = 100;
    const auto [time] = race(thread_seconds, bench.repeats, [&] {
        for (int i = 0; i < kSolves; ++i) {
            state = rest;
            state.values[1] = 0.4f;
            state.values[3] = 0.6f;
            iterate_ik(arm, tip, {{0.5f, 0.6f, 0.3f}, {}}, options, state);
        }
    });
    bench.add(
        {.gate = "",
         .name = "one arm of 7 hinges with limits, 10 iterations",
         .ours = time * 1e9 / kSolves});
}

}  // namespace

void add_ik_rows(CharacterBench& bench) {
    add_limb_rows(bench);
    add_chain_row(
        bench, "damped least squares", solve_chains_dls, [](float* points, const float* goals) {
            dls_by_hand(points, goals, kChains, kLinks, 10, 0.1f);
        });
    add_chain_row(bench, "FABRIK", solve_chains_fabrik, [](float* points, const float* goals) {
        fabrik_by_hand(points, goals, kChains, kLinks, 10);
    });
    add_chain_row(bench, "CCD", solve_chains_ccd, [](float* points, const float* goals) {
        ccd_by_hand(points, goals, kChains, kLinks, 10);
    });
    add_single_row(bench);
}

}  // namespace limn::bench
