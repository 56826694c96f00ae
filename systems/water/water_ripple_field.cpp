#include "systems/water/water_ripple_field.h"

#include "ecs/base/jobs.h"
#include "ecs/base/log.h"
#include "systems/water/water_ripple_grid.h"
#include "systems/water/water_ripple_kernels.h"
#include "systems/water/water_ripple_walls.h"

#include <algorithm>
#include <cmath>
#include <mutex>

// Techniques: water.ripple-grid
// Source of water.ripple-grid: the wave equation by differences (Courant et al. 1928)

namespace limn {

namespace {

constexpr std::size_t kRowGrain = 32;
constexpr float kCourant = 0.7f;           ///< largest wave motion per substep, in cells
constexpr std::uint32_t kLevelEvery = 16;  ///< steps between corrections of rounding
constexpr float kMinStep = 1e-5f;          ///< below, changes of heights are lost to rounding [s]
constexpr float kMaxSubstep = 0.1f;        ///< even for the slowest waves [s]
constexpr int kSpongeCells =
    40;  ///< width of the absorbing layer; narrower ones reflect long waves
constexpr float kSponge = 0.15f;   ///< fraction absorbed by the outermost cell
constexpr float kMaxPush = 10.0f;  ///< [m]

Vec2 extent_of(const Water& water, const WaterRipples& ripples) {
    return {
        water.size.x > 0 ? water.size.x : ripples.window.x,
        water.size.y > 0 ? water.size.y : ripples.window.y};
}

struct Grid {
    IVec2 cells = {0, 0};
    float cell = 0;
};

Grid grid_of(const Water& water, const WaterRipples& ripples) {
    const Vec2 extent = extent_of(water, ripples);
    if (!(extent.x > 0 && extent.y > 0 && ripples.cell > 0)
        || !std::isfinite(extent.x * extent.y)) {
        return {};
    }
    Grid grid;
    const float coarsest = std::max(extent.x, extent.y);
    grid.cell = std::clamp(ripples.cell, coarsest / 16384, coarsest);
    const auto count = [&](float length) {
        return std::max(4, static_cast<int>(std::ceil(length / grid.cell - 1e-3f)));
    };
    while (static_cast<std::int64_t>(count(extent.x)) * count(extent.y) > kMaxRippleCells) {
        grid.cell *= 1.25f;
    }
    grid.cells = {count(extent.x), count(extent.y)};
    return grid;
}

/// The border copies the outermost cells: no flow through a wall.
void close_border(RippleState& state, std::vector<float>& field) {
    const IVec2 n = state.cells;
    for (int z = 0; z < n.y; ++z) {
        field[state.at(-1, z)] = field[state.at(0, z)];
        field[state.at(n.x, z)] = field[state.at(n.x - 1, z)];
    }
    const auto row = [&](int z) {
        return field.begin() + static_cast<std::ptrdiff_t>(state.at(-1, z));
    };
    std::copy_n(row(0), n.x + 2, row(-1));
    std::copy_n(row(n.y - 1), n.x + 2, row(n.y));
}

/// Absorbing border (Mur 1981, first order): `next` is one substep after `now`; the inner cells of
/// both are known.
void open_border(
    const RippleState& state, const std::vector<float>& now, std::vector<float>& next,
    float courant) {
    const float coefficient = (courant - 1) / (courant + 1);
    const auto carry = [&](std::size_t ghost, std::size_t inner) {
        next[ghost] = now[inner] + coefficient * (next[inner] - now[ghost]);
    };
    const IVec2 n = state.cells;
    for (int z = 0; z < n.y; ++z) {
        carry(state.at(-1, z), state.at(0, z));
        carry(state.at(n.x, z), state.at(n.x - 1, z));
    }
    for (int x = -1; x <= n.x; ++x) {
        carry(state.at(x, -1), state.at(x, 0));
        carry(state.at(x, n.y), state.at(x, n.y - 1));
    }
}

/// Fraction of their motion that cells of a row or column keep in a substep.
void fill_keep(std::vector<float>& keep, int cells, float base, bool absorbing) {
    keep.assign(static_cast<std::size_t>(cells), base);
    const int width = std::min(kSpongeCells, cells / 4);
    const float strength =
        kSponge * square(static_cast<float>(width) / static_cast<float>(kSpongeCells));
    for (int i = 0; absorbing && i < width; ++i) {
        const float depth = 1.0f - static_cast<float>(i) / static_cast<float>(width);
        const float damping = 1.0f - strength * depth * depth;
        keep[static_cast<std::size_t>(i)] *= damping;
        keep[static_cast<std::size_t>(cells - 1 - i)] *= damping;
    }
}

double sum_of(const RippleState& state, const std::vector<float>& field) {
    double sum = 0;
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const std::size_t at = state.at(x, z);
            sum += is_dry(state, at) ? 0.0 : static_cast<double>(field[at]);
        }
    }
    return sum;
}

/// Removes volume added by rounding.
void keep_level(const RippleState& state, std::vector<float>& field) {
    if (state.wet == 0) {
        return;
    }
    const auto drift = static_cast<float>(sum_of(state, field) / state.wet - state.level);
    for (std::size_t i = 0; i < field.size(); ++i) {
        field[i] -= is_dry(state, i) ? 0.0f : drift;
    }
}

/// Slope of the field at a cell, by central differences, mirrored at walls.
Vec2 slope_at(const RippleState& state, int x, int z) {
    const auto height = [&](int column, int row) {
        return state.height[state.at(
            std::clamp(column, 0, state.cells.x - 1), std::clamp(row, 0, state.cells.y - 1))];
    };
    return Vec2(height(x + 1, z) - height(x - 1, z), height(x, z + 1) - height(x, z - 1))
           / (2 * state.cell);
}

}  // namespace

RippleState make_ripples(const Water& water, const WaterRipples& ripples, float step) {
    RippleState state;
    const Grid grid = grid_of(water, ripples);
    if (grid.cells.x == 0) {
        return state;
    }
    state.cells = grid.cells;
    state.cell = grid.cell;
    state.wet = grid.cells.x * grid.cells.y;
    state.stride = (grid.cells.x + 2 + 15) / 16 * 16;
    const auto floats =
        static_cast<std::size_t>(state.stride) * static_cast<std::size_t>(grid.cells.y + 2);
    state.height.resize(floats);
    state.previous.resize(floats);
    state.substep = step;
    state.substeps = 1;
    return state;
}

bool fits(const RippleState& state, const Water& water, const WaterRipples& ripples) {
    const Grid grid = grid_of(water, ripples);
    const std::size_t floats = state.height.size();
    return state.cells == grid.cells && state.cell == grid.cell
           && state.stride >= state.cells.x + (state.cells.x > 0 ? 2 : 0)
           && (state.cells.x == 0
               || floats
                      == static_cast<std::size_t>(state.stride)
                             * static_cast<std::size_t>(state.cells.y + 2))
           && state.previous.size() == floats && (state.body.empty() || state.body.size() == floats)
           && (state.dry.empty() || state.dry.size() == floats);
}

std::int64_t push_ripples(RippleState& state, const RippleImpulse& impulse) {
    const float check = impulse.center.x + impulse.center.y + impulse.radius + impulse.height;
    if (state.cells.x == 0 || !std::isfinite(check) || !is_over(state, impulse.center)
        || is_dry(state, cell_at(state, impulse.center))) {
        return 0;
    }
    const Vec2 extent = state.size();
    const Vec2 radius(std::clamp(
        impulse.radius, 1.5f * state.cell, std::max(extent.x + extent.y, 1.5f * state.cell)));
    const float height = std::clamp(impulse.height, -kMaxPush, kMaxPush);
    // A crater with rim, (1 - u^2)^2 (1 - 4 u^2), has no volume; discretization and walls are
    // compensated by a multiple of (1 - u^2)^2.
    const auto crater = [&](float weight, int x, int z) {
        const Vec2 from = (cell_center(state, x, z) - impulse.center) / radius;
        return weight * (1 - 4 * (from.x * from.x + from.y * from.y));
    };
    double weights = 0;
    double sum = 0;
    each_bump_cell(state, impulse.center, radius, [&](std::size_t, float weight, int x, int z) {
        weights += static_cast<double>(weight);
        sum += static_cast<double>(crater(weight, x, z));
    });
    const CellBox box = box_around(state, impulse.center, radius);
    const std::int64_t cells =
        static_cast<std::int64_t>(box.last.x - box.first.x) * (box.last.y - box.first.y);
    if (!(weights > 0)) {
        return cells;
    }
    const auto excess = static_cast<float>(sum / weights);
    each_bump_cell(state, impulse.center, radius, [&](std::size_t at, float weight, int x, int z) {
        const float push = height * (crater(weight, x, z) - excess * weight);
        state.height[at] += push;
        state.previous[at] += push;
    });
    return cells;
}

void displace_ripples(RippleState& state, std::span<const WaterBulge> bulges) {
    const bool any = std::any_of(bulges.begin(), bulges.end(), [&](const WaterBulge& bulge) {
        return bulge.volume > 0 && is_over(state, bulge.center);
    });
    if (state.cells.x == 0 || (!any && state.body.empty())) {
        return;
    }
    thread_local std::vector<float> now;  // reused between steps
    now.assign(state.height.size(), 0.0f);
    const float area = state.cell * state.cell;
    double volume = 0;
    for (const WaterBulge& bulge : bulges) {
        const float check =
            bulge.volume + bulge.radius.x + bulge.radius.y + bulge.center.x + bulge.center.y;
        if (!std::isfinite(check) || !(bulge.volume > 0) || !is_over(state, bulge.center)) {
            continue;
        }
        const Vec2 radius = glm::max(bulge.radius, Vec2(1.5f * state.cell));
        double weights = 0;
        each_bump_cell(state, bulge.center, radius, [&](std::size_t, float weight, int, int) {
            weights += static_cast<double>(weight);
        });
        if (!(weights > 0)) {
            continue;
        }
        volume += static_cast<double>(bulge.volume);
        const auto height = static_cast<float>(
            static_cast<double>(bulge.volume) / (weights * static_cast<double>(area)));
        each_bump_cell(state, bulge.center, radius, [&](std::size_t at, float weight, int, int) {
            now[at] += height * weight;
        });
    }
    state.body.resize(state.height.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
        const float risen = now[i] - state.body[i];
        state.height[i] += risen;
        state.previous[i] += risen;
    }
    state.body.assign(now.begin(), now.end());
    if (!any) {
        state.body.clear();
    }
    const double covered = static_cast<double>(area) * state.wet;
    state.level = state.wet > 0 ? (volume + state.wall_volume) / covered : 0;
}

namespace {

void push_all(RippleState& state) {
    std::int64_t cells = 0;
    for (std::size_t i = 0; i < state.impulses.size(); ++i) {
        if (cells > kMaxPushedCells) {
            state.dropped += static_cast<std::uint32_t>(state.impulses.size() - i);
            static std::once_flag said;
            std::call_once(said, [&] {
                log_warn(
                    "ripples: {} impulses of one step dropped, all others push {} cells "
                    "(kMaxPushedCells)",
                    state.dropped, cells);
            });
            break;
        }
        cells += push_ripples(state, state.impulses[i]);
    }
    state.impulses.clear();
}

}  // namespace

void step_ripples(RippleState& state, const WaterRipples& ripples, float step) {
    if (state.cells.x == 0 || !(step >= kMinStep) || !std::isfinite(step)) {
        return;
    }
    push_all(state);

    const bool absorbing = ripples.border == RippleBorder::Absorbing;
    const float speed = std::isfinite(ripples.speed) ? std::max(ripples.speed, 0.0f) : 0.0f;
    const float wanted = std::ceil(speed * step / (kCourant * state.cell));
    const int substeps =
        static_cast<int>(std::clamp(wanted, 1.0f, static_cast<float>(kMaxRippleSubsteps)));
    const float dt = std::min(step / static_cast<float>(substeps), kMaxSubstep);
    if (dt != state.substep) {  // rescale the previous heights to the new substep
        // In wave time, since waves that are too fast are slowed down.
        const float longest = kCourant * state.cell / std::max(speed, 1e-6f);
        const float last = std::min(state.substep, longest);
        const float ratio = last > 0 ? std::min(dt, longest) / last : 0.0f;
        for (std::size_t i = 0; i < state.height.size(); ++i) {
            state.previous[i] = state.height[i] - (state.height[i] - state.previous[i]) * ratio;
        }
    }
    state.substeps = substeps;
    state.substep = dt;

    const float courant = std::min(speed * dt / state.cell, kCourant);
    // Damping acts on the mean of the velocities before and after: stable for any strength.
    const float fade = std::max(ripples.damping * dt, 0.0f);
    const float base = (1 - fade) / (1 + fade);
    const float courant2 = courant * courant / (1 + fade);
    thread_local std::vector<float> keep_x;
    thread_local std::vector<float> keep_z;
    fill_keep(keep_x, state.cells.x, base, absorbing);
    fill_keep(keep_z, state.cells.y, 1.0f, absorbing);
    const float* const columns = keep_x.data();
    const float* const row_keeps = keep_z.data();
    const auto width = static_cast<std::size_t>(state.cells.x);
    for (int i = 0; i < substeps; ++i) {
        if (!absorbing) {
            close_border(state, state.height);
        }
        parallel_for(
            static_cast<std::size_t>(state.cells.y), kRowGrain,
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t z = begin; z < end; ++z) {
                    const int row = static_cast<int>(z);
                    const float* const heights = state.height.data();
                    step_ripple_row(
                        {heights + state.at(0, row - 1), heights + state.at(0, row),
                         heights + state.at(0, row + 1)},
                        {state.previous.data() + state.at(0, row), width}, columns, row_keeps[z],
                        courant2);
                }
                apply_wall_faces(state, begin, end, courant2 / 6.0f);
            });
        fill_wall_cells(state, state.previous);
        if (absorbing) {
            open_border(state, state.height, state.previous, courant);
        }
        std::swap(state.height, state.previous);
    }
    ++state.steps;
    if (!absorbing && state.steps % kLevelEvery == 0) {
        keep_level(state, state.height);
        keep_level(state, state.previous);
    }
}

RipplePoint sample_ripples(const RippleState& state, const Vec2& at) {
    if (state.cells.x == 0 || !is_over(state, at)) {
        return {};
    }
    const Vec2 cell_position = glm::clamp(
        at / state.cell + 0.5f * Vec2(state.cells) - 0.5f, Vec2(0), Vec2(state.cells - 1));
    const IVec2 corner = glm::min(IVec2(cell_position), state.cells - 2);
    const Vec2 u = cell_position - Vec2(corner);
    const std::size_t first = state.at(corner.x, corner.y);
    const std::size_t below = first + static_cast<std::size_t>(state.stride);
    const auto blend = [&](const std::vector<float>& field) {
        return glm::mix(
            glm::mix(field[first], field[first + 1], u.x),
            glm::mix(field[below], field[below + 1], u.x), u.y);
    };
    const std::vector<float>& h = state.height;
    RipplePoint point;
    point.height = blend(h);
    point.velocity = (point.height - blend(state.previous)) / state.substep;
    point.slope = glm::mix(
        glm::mix(slope_at(state, corner.x, corner.y), slope_at(state, corner.x + 1, corner.y), u.x),
        glm::mix(
            slope_at(state, corner.x, corner.y + 1), slope_at(state, corner.x + 1, corner.y + 1),
            u.x),
        u.y);
    return point;
}

double ripple_volume(const RippleState& state) {
    const double area = static_cast<double>(state.cell) * static_cast<double>(state.cell);
    return sum_of(state, state.height) * area;
}

}  // namespace limn
