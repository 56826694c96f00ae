#include "content/make/patterns/sprite_fluid.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr int kPressureSweeps = 40;
constexpr float kRelaxation = 1.7f;  // of the sweeps

/// Clamps to the edge outside the grid.
float sample_fluid(const FluidGrid& fluid, const std::vector<float>& field, float x, float y) {
    const float top = static_cast<float>(fluid.side - 1);
    x = std::clamp(x, 0.0f, top);
    y = std::clamp(y, 0.0f, top);
    const int x0 = std::min(static_cast<int>(x), fluid.side - 2);
    const int y0 = std::min(static_cast<int>(y), fluid.side - 2);
    const float fx = x - static_cast<float>(x0);
    const float fy = y - static_cast<float>(y0);
    const std::size_t i = fluid.at(x0, y0);
    const auto row = static_cast<std::size_t>(fluid.side);
    const float low = field[i] + (field[i + 1] - field[i]) * fx;
    const float high = field[i + row] + (field[i + row + 1] - field[i + row]) * fx;
    return low + (high - low) * fy;
}

/// Calls `cell(x, y)` for all interior cells.
template <typename Cell>
void each_inner(const FluidGrid& fluid, Cell&& cell) {
    for (int y = 1; y + 1 < fluid.side; ++y) {
        for (int x = 1; x + 1 < fluid.side; ++x) {
            cell(x, y);
        }
    }
}

void advect(FluidGrid& fluid, float dt) {
    const FluidGrid before = fluid;
    const float cells_per_speed = dt * static_cast<float>(fluid.side);
    each_inner(fluid, [&](int x, int y) {
        const std::size_t i = fluid.at(x, y);
        // Midpoint method: the velocity halfway back.
        const float half_x = static_cast<float>(x) - 0.5f * cells_per_speed * before.u[i];
        const float half_y = static_cast<float>(y) - 0.5f * cells_per_speed * before.v[i];
        const float from_x = static_cast<float>(x)
                             - cells_per_speed * sample_fluid(before, before.u, half_x, half_y);
        const float from_y = static_cast<float>(y)
                             - cells_per_speed * sample_fluid(before, before.v, half_x, half_y);
        fluid.u[i] = sample_fluid(before, before.u, from_x, from_y);
        fluid.v[i] = sample_fluid(before, before.v, from_x, from_y);
        fluid.heat[i] = sample_fluid(before, before.heat, from_x, from_y);
        fluid.soot[i] = sample_fluid(before, before.soot, from_x, from_y);
    });
}

/// Vorticity confinement: restores vortices that the grid has blurred.
void confine(FluidGrid& fluid, float strength, float dt) {
    const auto row = static_cast<std::size_t>(fluid.side);
    std::vector<float> curl(fluid.u.size(), 0.0f);
    each_inner(fluid, [&](int x, int y) {
        const std::size_t i = fluid.at(x, y);
        curl[i] = 0.5f * (fluid.v[i + 1] - fluid.v[i - 1] - fluid.u[i + row] + fluid.u[i - row]);
    });
    const float scale = strength * dt * static_cast<float>(fluid.side);
    each_inner(fluid, [&](int x, int y) {
        const std::size_t i = fluid.at(x, y);
        const float dx = std::abs(curl[i + 1]) - std::abs(curl[i - 1]);
        const float dy = std::abs(curl[i + row]) - std::abs(curl[i - row]);
        const float length = std::sqrt(dx * dx + dy * dy) + 1e-6f;
        fluid.u[i] += scale * curl[i] * dy / length;
        fluid.v[i] -= scale * curl[i] * dx / length;
    });
}

float divergence(const FluidGrid& fluid, std::size_t i) {
    const auto row = static_cast<std::size_t>(fluid.side);
    return 0.5f * static_cast<float>(fluid.side)
           * (fluid.u[i + 1] - fluid.u[i - 1] + fluid.v[i + row] - fluid.v[i - row]);
}

/// Projects the divergence to that of the expansion; the pressure is 0 at open edges.
void project_velocity(FluidGrid& fluid, const FluidStep& step) {
    const int side = fluid.side;
    const auto row = static_cast<std::size_t>(side);
    const float cell = 1.0f / static_cast<float>(side);
    std::vector<float> pressure(fluid.u.size(), 0.0f);
    std::vector<float> asked(fluid.u.size(), 0.0f);
    each_inner(fluid, [&](int x, int y) {
        const std::size_t i = fluid.at(x, y);
        asked[i] = cell * cell * (divergence(fluid, i) - step.expansion * fluid.heat[i]);
    });
    for (int sweep = 0; sweep < kPressureSweeps; ++sweep) {
        for (int parity = 0; parity < 2; ++parity) {  // of x + y: red-black ordering
            for (int y = 1; y + 1 < side; ++y) {
                for (int x = 1 + (y + parity) % 2; x + 1 < side; x += 2) {
                    const std::size_t i = fluid.at(x, y);
                    const float sum =
                        pressure[i - 1] + pressure[i + 1] + pressure[i - row] + pressure[i + row];
                    pressure[i] += kRelaxation * (0.25f * (sum - asked[i]) - pressure[i]);
                }
            }
        }
        for (int x = 0; step.has_floor && x < side; ++x) {
            pressure[fluid.at(x, 0)] = pressure[fluid.at(x, 1)];
        }
    }
    const float slope = 0.5f * static_cast<float>(side);
    each_inner(fluid, [&](int x, int y) {
        const std::size_t i = fluid.at(x, y);
        fluid.u[i] -= slope * (pressure[i + 1] - pressure[i - 1]);
        fluid.v[i] -= slope * (pressure[i + row] - pressure[i - row]);
    });
}

void set_edges(FluidGrid& fluid, bool has_floor) {
    const int last = fluid.side - 1;
    for (int i = 0; i <= last; ++i) {
        for (std::vector<float>* field : {&fluid.u, &fluid.v}) {
            (*field)[fluid.at(0, i)] = (*field)[fluid.at(1, i)];
            (*field)[fluid.at(last, i)] = (*field)[fluid.at(last - 1, i)];
            (*field)[fluid.at(i, 0)] = (*field)[fluid.at(i, 1)];
            (*field)[fluid.at(i, last)] = (*field)[fluid.at(i, last - 1)];
        }
        if (has_floor) {
            fluid.v[fluid.at(i, 0)] = 0;
        }
        for (std::vector<float>* field : {&fluid.heat, &fluid.soot}) {
            for (const std::size_t edge :
                 {fluid.at(0, i), fluid.at(last, i), fluid.at(i, 0), fluid.at(i, last)}) {
                (*field)[edge] = 0;
            }
        }
    }
}

}  // namespace

FluidGrid make_fluid(int side) {
    FluidGrid fluid;
    fluid.side = std::max(side, 4);
    const std::size_t count = fluid.at(0, fluid.side);
    for (std::vector<float>* field : {&fluid.u, &fluid.v, &fluid.heat, &fluid.soot}) {
        field->assign(count, 0.0f);
    }
    return fluid;
}

void step_fluid(FluidGrid& fluid, const FluidStep& step) {
    const float keep = 1.0f / (1.0f + step.drag * step.dt);
    const float keep_soot = 1.0f / (1.0f + step.soot_decay * step.dt);
    for (std::size_t i = 0; i < fluid.u.size(); ++i) {
        float& heat = fluid.heat[i];
        fluid.v[i] += step.rise * heat * step.dt;
        fluid.u[i] *= keep;
        fluid.v[i] *= keep;
        // dT/dt = -cooling (0.25 T + 0.75 T^3): radiation, and mixing with the air
        heat = heat / (1.0f + step.cooling * step.dt * (0.25f + 0.75f * heat * heat));
        fluid.soot[i] *= keep_soot;
    }
    if (step.whirls > 0) {
        confine(fluid, step.whirls, step.dt);
    }
    advect(fluid, step.dt);
    set_edges(fluid, step.has_floor);
    project_velocity(fluid, step);
    set_edges(fluid, step.has_floor);
}

float largest_divergence(const FluidGrid& fluid) {
    float largest = 0;
    each_inner(fluid, [&](int x, int y) {
        if (x > 1 && y > 1 && x + 2 < fluid.side && y + 2 < fluid.side) {
            largest = std::max(largest, std::abs(divergence(fluid, fluid.at(x, y))));
        }
    });
    return largest;
}

}  // namespace limn
