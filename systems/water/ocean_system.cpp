#include "systems/water/ocean_system.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/base/log.h"
#include "systems/water/fft_kernels.h"
#include "systems/water/ocean_cascades.h"
#include "systems/water/ocean_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>

// Techniques: water.fft-synthesis

namespace limn {

namespace {

constexpr std::size_t kFoamGrain = 16384;  ///< points per task
constexpr float kMinBreakerLength = 2.0f;  ///< shorter waves produce no foam [m]

/// Created once per size; concurrent callers wait for it.
const FftPlan& plan_of_size(std::size_t size) {
    static std::mutex mutex;
    static std::map<std::size_t, FftPlan> plans;
    const std::lock_guard lock(mutex);
    const auto found = plans.find(size);
    return found != plans.end() ? found->second
                                : plans.emplace(size, make_fft_plan(size)).first->second;
}

/// Whether two oceans have the same spectra.
bool has_waves_of(const Ocean& a, const Ocean& b) {
    Ocean alike = a;
    alike.choppiness = b.choppiness;
    alike.foam_threshold = b.foam_threshold;
    alike.foam_rate = b.foam_rate;
    alike.foam_decay = b.foam_decay;
    return alike == b;
}

/// The two fields of each transformed pair.
struct PairPlanes {
    std::vector<float>* re;
    std::vector<float>* im;
};

std::array<PairPlanes, kOceanPairs> planes_of(OceanCascade& cascade) {
    return {{
        {&cascade.height, &cascade.shift_x},
        {&cascade.shift_xx, &cascade.slope_x},
        {&cascade.shift_zz, &cascade.slope_z},
        {&cascade.shift_xz, &cascade.shift_z},
    }};
}

/// Sums the derivatives of all waves that break along a row of the largest patch, the copy about
/// the origin. Those of smaller patches, whose points are closer, are of the nearest point.
void sum_derivatives(
    const OceanState& state, std::size_t row, std::span<float> xx, std::span<float> zz,
    std::span<float> xz) {
    const OceanCascade& largest = state.cascades.front();
    const int size = largest.size;
    const std::size_t first = row * xx.size();
    std::copy_n(largest.shift_xx.begin() + static_cast<std::ptrdiff_t>(first), size, xx.begin());
    std::copy_n(largest.shift_zz.begin() + static_cast<std::ptrdiff_t>(first), size, zz.begin());
    std::copy_n(largest.shift_xz.begin() + static_cast<std::ptrdiff_t>(first), size, xz.begin());
    const auto centered = [half = size / 2, size](int i) { return i < half ? i : i - size; };
    for (std::size_t c = 1; c < state.cascades.size(); ++c) {
        const OceanCascade& cascade = state.cascades[c];
        if (cascade.band_low * kMinBreakerLength >= 2 * kPi) {
            break;
        }
        // The nearest point of a periodic patch; sizes are powers of two.
        const float points = largest.patch / static_cast<float>(size)
                             * static_cast<float>(cascade.size) / cascade.patch;
        const auto nearest = [&](int i) {
            const float at = static_cast<float>(centered(i)) * points;
            return static_cast<int>(std::floor(at + 0.5f)) & (cascade.size - 1);
        };
        const int line = nearest(static_cast<int>(row)) * cascade.size;
        for (int i = 0; i < size; ++i) {
            const auto at = static_cast<std::size_t>(line + nearest(i));
            xx[static_cast<std::size_t>(i)] += cascade.shift_xx[at];
            zz[static_cast<std::size_t>(i)] += cascade.shift_zz[at];
            xz[static_cast<std::size_t>(i)] += cascade.shift_xz[at];
        }
    }
}

}  // namespace

void add_ocean_states(
    Query<const Ocean, Without<OceanState>> stateless,
    Query<const Ocean, Without<OceanFoam>> foamless, Commands commands) {
    stateless.each([&](Entity entity, const Ocean&) { commands.add(entity, OceanState{}); });
    foamless.each([&](Entity entity, const Ocean&) { commands.add(entity, OceanFoam{}); });
}

void update_oceans(Query<const Ocean, OceanState> oceans, Res<const FrameTime> time) {
    oceans.each([&](const Ocean& ocean, OceanState& state) {
        step_ocean(ocean, time->time, time->step, state);
    });
}

void update_ocean_foam(
    Query<const Ocean, const OceanState, OceanFoam> oceans, Res<const FrameTime> time) {
    oceans.each([&](const Ocean& ocean, const OceanState& state, OceanFoam& foam) {
        step_ocean_foam(ocean, state, time->step, foam);
    });
}

void step_ocean(const Ocean& ocean, double time, float step, OceanState& state) {
    const Ocean limited = clamp_ocean(ocean);
    const bool is_new = state.cascades.empty() || !has_waves_of(limited, state.made_for);
    if (is_new) {
        if (!(limited == ocean)) {
            log_warn("ocean: some fields are out of range and were clamped");
        }
        state.cascades = make_ocean_cascades(limited);
    }
    // Time is wrapped to one loop, to keep its precision after many of them.
    const auto in_loop = [period = limited.loop_period](double t) {
        return period > 0 ? std::fmod(t, static_cast<double>(period)) : t;
    };
    const double last_time = time - static_cast<double>(step);
    const bool has_last = !is_new && std::abs(state.time - last_time) < 1e-6
                          && limited.choppiness == state.made_for.choppiness;
    for (OceanCascade& cascade : state.cascades) {
        if (!has_last) {
            synthesize_waves(cascade, limited.choppiness, in_loop(last_time));
        }
        cascade.height.swap(cascade.previous_height);
        cascade.shift_x.swap(cascade.previous_shift_x);
        cascade.shift_z.swap(cascade.previous_shift_z);
        synthesize_waves(cascade, limited.choppiness, in_loop(time));
    }
    state.made_for = limited;
    state.time = time;
    state.step = step;
}

void synthesize_waves(OceanCascade& cascade, float choppiness, double time) {
    const std::size_t size = static_cast<std::size_t>(cascade.size);
    const FftPlan& plan = plan_of_size(size);
    const std::size_t block = kFftColumns * size;
    const std::array<PairPlanes, kOceanPairs> planes = planes_of(cascade);
    // Each block of spectrum columns is transposed into rows of the planes. The second transform
    // then works in place on columns of the planes, without a copy.
    parallel_for(size / kFftColumns, 1, [&](std::size_t begin, std::size_t) {
        thread_local std::vector<float> memory;
        memory.resize(2 * kOceanPairs * block + fft_scratch_size(size));
        const std::span<float> pairs = std::span(memory).first(2 * kOceanPairs * block);
        const std::span<float> scratch = std::span(memory).subspan(pairs.size());
        const std::size_t first = begin * kFftColumns;
        evolve_waves(cascade, choppiness, time, first, pairs);
        for (std::size_t pair = 0; pair < kOceanPairs; ++pair) {
            float* const re = pairs.data() + pair * 2 * block;
            const FftColumns columns = {re, re + block, kFftColumns};
            inverse_fft_columns(plan, columns, columns, scratch);
            transpose_columns(columns.re, size, planes[pair].re->data() + first * size, size);
            transpose_columns(columns.im, size, planes[pair].im->data() + first * size, size);
        }
    });
    parallel_for(size / kFftColumns, 1, [&](std::size_t begin, std::size_t) {
        thread_local std::vector<float> memory;
        memory.resize(fft_scratch_size(size));
        const std::size_t first = begin * kFftColumns;
        for (const PairPlanes& pair : planes) {
            const FftColumns columns = {pair.re->data() + first, pair.im->data() + first, size};
            inverse_fft_columns(plan, columns, columns, memory);
        }
    });
}

void step_ocean_foam(const Ocean& ocean, const OceanState& state, float step, OceanFoam& foam) {
    if (state.cascades.empty()) {
        foam.coverage.clear();
        return;
    }
    const OceanCascade& largest = state.cascades.front();
    const std::size_t size = static_cast<std::size_t>(largest.size);
    if (foam.coverage.size() != size * size) {
        foam.coverage.assign(size * size, 0.0f);
    }
    const Ocean limited = clamp_ocean(ocean);
    const bool breaks = largest.band_low * kMinBreakerLength < 2 * kPi;
    const float gain = breaks ? limited.foam_rate * step : 0.0f;
    const float fade = std::exp(-step / limited.foam_decay);
    parallel_for(size, std::max(kFoamGrain / size, std::size_t{1}), [&](auto begin, auto end) {
        thread_local std::vector<float> memory;
        memory.resize(3 * size);
        const std::span<float> xx = std::span(memory).first(size);
        const std::span<float> zz = std::span(memory).subspan(size, size);
        const std::span<float> xz = std::span(memory).subspan(2 * size, size);
        for (std::size_t row = begin; row < end; ++row) {
            sum_derivatives(state, row, xx, zz, xz);
            const std::span<float> coverage = std::span(foam.coverage).subspan(row * size, size);
            step_foam({xx, zz, xz}, limited.foam_threshold, gain, fade, coverage, 0, size);
        }
    });
}

}  // namespace limn
