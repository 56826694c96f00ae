#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <vector>

namespace limn {

// A small 2D fluid simulation for flipbooks of fire: heat that rises, cools and
// carries soot (J. Stam, "Stable Fluids", 1999; R. Fedkiw et al., "Visual Simulation of Smoke",
// 2001, for vorticity confinement). Rows run upwards. Lengths are in sides of the square, so that a
// flow looks alike at every resolution. No libm beyond sqrt and floor: identical on every machine.

struct FluidGrid {
    int side = 0;             ///< cells
    std::vector<float> u, v;  ///< velocity [sides/s], at the cells' centers
    std::vector<float> heat;  ///< 1: the temperature of the source
    std::vector<float> soot;

    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(side)
               + static_cast<std::size_t>(x);
    }
};

struct FluidStep {
    float dt = 1.0f / 60;
    float rise = 8;         ///< acceleration by heat 1 [sides/s^2]
    float whirls = 0.3f;    ///< vorticity confinement, 0 .. 1
    float cooling = 1.5f;   ///< of heat 1 [1/s]; hot cools fast, as radiation does
    float soot_decay = 0;   ///< [1/s]
    float drag = 0.2f;      ///< [1/s]
    float expansion = 0;    ///< divergence by heat 1 [1/s]: explosions
    bool has_floor = true;  ///< nothing flows through the lower edge; the others are open
};

[[nodiscard]] FluidGrid make_fluid(int side);
void step_fluid(FluidGrid& fluid, const FluidStep& step);

/// Largest absolute divergence of the velocity between the cells of the interior [1/s].
[[nodiscard]] float largest_divergence(const FluidGrid& fluid);

}  // namespace limn
