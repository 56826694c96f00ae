#pragma once

#include "bench/oracles/crowd_oracle.h"
#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "systems/crowd/step_crowd.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::oracle {

// Crowds that benches and `limn quality` measure: walkers of 0.3 m that walk straight to their
// goals, at 1.1 .. 1.5 m/s to random ones or at 1.3 m/s across a ring.

struct CrowdScene {
    std::vector<CrowdWalker> walkers;
    std::vector<Vec2> goals;     ///< of the walker with key i + 1
    std::vector<float> speeds;   ///< likewise [m/s]
    std::vector<float> arrived;  ///< when it was first within 1 m of its goal [s]; < 0: not yet
    WalkerScratch scratch;
    float side = 0;  ///< of the square in which random goals are; 0: they stay [m]
    std::uint64_t seed = 1;
    std::uint64_t frame = 0;
    static constexpr float kStep = 1.0f / 60;

    void add(const Vec2& position, const Vec2& goal, float speed) {
        CrowdWalker walker;
        walker.position = position;
        walker.key = walkers.size() + 1;
        walkers.push_back(walker);
        goals.push_back(goal);
        speeds.push_back(speed);
        arrived.push_back(-1);
    }
    /// Before step_crowd(): what the walkers want.
    void want() {
        for (CrowdWalker& walker : walkers) {
            const std::size_t i = walker.key - 1;
            const Vec2 offset = goals[i] - walker.position;
            const float distance = glm::length(offset);
            if (distance < 1 && arrived[i] < 0) {
                arrived[i] = static_cast<float>(frame) * kStep;
            }
            if (distance < 1 && side > 0) {
                Random random(seed, walker.key, name_hash("next goal"), frame);
                goals[i].x = random.uniform(0.0f, side);
                goals[i].y = random.uniform(0.0f, side);
            }
            walker.distance = side > 0 ? INFINITY : distance;
            walker.wanted =
                distance < 0.3f && side == 0
                    ? Vec2(0)
                    : offset * (std::min(speeds[i], 2 * distance) / std::max(distance, 1e-3f));
            walker.wanted = jittered_velocity(walker, seed, frame);
        }
        ++frame;
    }
    void step() {
        want();
        step_crowd(walkers, {}, kStep, scratch);
    }
    [[nodiscard]] bool all_arrived() const {
        return std::ranges::all_of(arrived, [](float time) { return time >= 0; });
    }
    /// Pairs that overlap by more than a millimeter, and the deepest overlap [m].
    [[nodiscard]] std::pair<std::size_t, double> overlaps() const {
        std::vector<CrowdVec> centers;
        std::vector<double> radii;
        for (const CrowdWalker& walker : walkers) {
            centers.push_back({double(walker.position.x), double(walker.position.y)});
            radii.push_back(double(walker.radius));
        }
        return count_overlaps(centers, radii, 1e-3);
    }
};

inline CrowdScene make_random_crowd(std::size_t count, float density) {
    CrowdScene scene;
    scene.side = std::sqrt(static_cast<float>(count) / density);
    Random random(count, 0, name_hash("random crowd"), 0);
    const auto point = [&] {
        Vec2 p;
        p.x = random.uniform(0.0f, scene.side);
        p.y = random.uniform(0.0f, scene.side);
        return p;
    };
    // One to a square of a grid, so that they do not overlap.
    const float square_side = 1 / std::sqrt(density);
    const auto columns = static_cast<std::size_t>(std::ceil(scene.side / square_side));
    for (std::size_t i = 0; i < count; ++i) {
        const float free = std::max(square_side - 0.62f, 0.0f);
        Vec2 corner =
            square_side * Vec2(static_cast<float>(i % columns), static_cast<float>(i / columns));
        corner.x += random.uniform(0.0f, free);
        corner.y += random.uniform(0.0f, free);
        const Vec2 goal = point();
        scene.add(corner, goal, random.uniform(1.1f, 1.5f));
    }
    return scene;
}

/// Walkers on rings 1 m apart along them, who cross to the opposite points: `count` on the
/// innermost, or that many in all on rings 0.9 m apart from a radius on.
inline CrowdScene make_crowd_rings(std::size_t count, float radius, std::uint64_t seed) {
    CrowdScene scene;
    scene.seed = seed;
    for (float ring = radius; scene.walkers.size() < count; ring += 0.9f) {
        const auto around = static_cast<std::size_t>(std::round(2 * kPi * ring));
        for (std::size_t i = 0; i < around && scene.walkers.size() < count; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(around);
            const Vec2 start = ring * Vec2(std::cos(angle), std::sin(angle));
            scene.add(start, -start, 1.3f);
        }
    }
    return scene;
}
inline CrowdScene make_crowd_ring(std::size_t count, std::uint64_t seed) {
    return make_crowd_rings(count, static_cast<float>(count) / (2 * kPi), seed);
}

/// The last arrival on a ring of `count` over the time that the straight way takes; infinite where
/// somebody has not arrived after four times that.
inline double ring_ratio(std::size_t count, std::uint64_t seed) {
    CrowdScene ring = make_crowd_ring(count, seed);
    const float straight = 2 * (static_cast<float>(count) / (2 * kPi)) / 1.3f;
    for (float time = 0; time < 4 * straight; time += CrowdScene::kStep) {
        ring.step();
        if (ring.all_arrived()) {
            return double(*std::ranges::max_element(ring.arrived) / straight);
        }
    }
    return INFINITY;
}

}  // namespace limn::oracle
