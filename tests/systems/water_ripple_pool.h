#pragma once

#include "ecs/base/math.h"
#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"
#include "systems/water/water_ripple_field.h"

#include <cmath>

namespace limn::test {

// Pools and what moves in them, for tests of ripples.

inline constexpr float kStep = 1.0f / 60;

inline Water pool(float width, float length) {
    return {.size = {width, length}, .depth = 2};
}

/// Largest height, up or down; not a number if one is none.
inline float max_height(const RippleState& state) {
    float most = 0;
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const float height = std::abs(state.height[state.at(x, z)]);
            most = height <= most ? most : height;
            if (std::isnan(most)) {
                return most;
            }
        }
    }
    return most;
}

inline void run(RippleState& state, const WaterRipples& ripples, int steps) {
    for (int i = 0; i < steps; ++i) {
        step_ripples(state, ripples, kStep);
    }
}

/// Height of the standing wave cos(pi (i + 1/2) / n) of walls, along x.
inline void fill_standing_wave(RippleState& state, float amplitude) {
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const float share = (static_cast<float>(x) + 0.5f) / static_cast<float>(state.cells.x);
            const float h = amplitude * std::cos(kPi * share);
            state.height[state.at(x, z)] = h;
            state.previous[state.at(x, z)] = h;
        }
    }
}

}  // namespace limn::test
