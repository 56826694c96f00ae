#include "bench/oracles/crowd_oracle.h"
#include "bench/oracles/crowd_scenes.h"
#include "bench/quality/characters_quality.h"
#include "ecs/base/rng.h"
#include "systems/crowd/flow_field.h"
#include "systems/crowd/orca.h"
#include "systems/crowd/step_crowd.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Techniques: char.flock

namespace limn::crowd_quality {
namespace {

using oracle::CrowdScene;
using oracle::CrowdVec;

void measure_overlaps(
    QualityReport& report, const std::string& name, CrowdScene scene, int seconds) {
    std::size_t most = 0;
    double deepest = 0;
    for (int i = 0; i < 60 * seconds; ++i) {
        scene.step();
        if (i % 15 == 14) {
            const auto found = scene.overlaps();
            most = std::max(most, found.first);
            deepest = std::max(deepest, found.second);
        }
    }
    report.at_most(name + ", pairs that overlap by more than 1 mm", double(most), 0);
    report.at_most(name + ", deepest overlap", 1e3 * deepest, 1, "mm");
}

void measure_rings(QualityReport& report, std::size_t count, double limit) {
    constexpr std::uint64_t kSeeds = 3;
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        sum += oracle::ring_ratio(count, seed) / double(kSeeds);
    }
    report.at_most(
        "ring of " + std::to_string(count) + ", last arrival over the straight time, mean of 3",
        sum, limit);
}

/// How much farther from the preferred velocity than the best corner of all.
void measure_optima(QualityReport& report) {
    Random random(1, 0, name_hash("quality of optima"), 0);
    double worst = 0;
    int feasible = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<VelocityPlane> planes(1 + random.below(10));
        std::vector<oracle::CrowdHalfPlane> exact;
        for (VelocityPlane& plane : planes) {
            const float angle = random.uniform(0.0f, 2 * kPi);
            plane.normal = {std::cos(angle), std::sin(angle)};
            plane.offset = random.uniform(-1.5f, 0.7f);
            CrowdVec normal = {double(plane.normal.x), double(plane.normal.y)};
            normal = (1 / oracle::length_of(normal)) * normal;
            exact.push_back({double(plane.offset) * normal, normal});
        }
        Vec2 preferred;
        preferred.x = random.uniform(-2.0f, 2.0f);
        preferred.y = random.uniform(-2.0f, 2.0f);
        const CrowdVec wanted = {double(preferred.x), double(preferred.y)};
        const double best = oracle::best_distance(exact, wanted, 1.5, 1e-9);
        if (std::isfinite(best)) {
            ++feasible;
            const Vec2 v = solve_velocity(planes, 0, preferred, 1.5f);
            worst = std::max(worst, std::abs(double(glm::distance(v, preferred)) - best));
        }
    }
    report.at_least("velocities, programs with a solution", feasible, 500);
    report.at_most("velocities, distance from the optimum by brute force", worst, 1e-3, "m/s");
}

/// Lengths of ways on open ground over the straight distances.
void measure_ways(QualityReport& report) {
    const FlowGrid grid = make_flow_grid({0, 0}, {40, 40}, 0.5f, 0.4f, {});
    const FlowField field = solve_flow_field(grid, {0.25f, 0.25f}, 0.5f);
    double longest = 0;
    for (std::size_t cell = 0; cell < field.length.size(); ++cell) {
        const double x = -19.75 + 0.5 * double(cell % grid.columns) - 0.25;
        const double y = -19.75 + 0.5 * double(cell / grid.columns) - 0.25;
        if (const double straight = std::hypot(x, y); straight > 2) {
            longest = std::max(longest, double(field.length[cell]) / straight - 1);
        }
    }
    report.at_most("ways on open ground, longer than straight", 100 * longest, 10, "%");
}

Status measure_crowd(HeadlessRenderer&, QualityReport& report) {
    measure_overlaps(report, "500 walkers, 1/m2, 5 s", oracle::make_random_crowd(500, 1), 5);
    measure_overlaps(report, "400 in rings, 30 s", oracle::make_crowd_rings(400, 12.9f, 1), 30);
    measure_rings(report, 100, 1.6);
    measure_rings(report, 250, 2);
    measure_optima(report);
    measure_ways(report);
    return Done{};
}

const RegisterCharacterPart kCrowdPart("crowd", measure_crowd);

}  // namespace
}  // namespace limn::crowd_quality
