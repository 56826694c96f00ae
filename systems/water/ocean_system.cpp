#include "systems/water/ocean_system.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/base/log.h"
#include "systems/water/fft_kernels.h"
#include "systems/water/ocean_cascades.h"
#include "systems/water/ocean_kernels.h"

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
    std::size_t points = 0;
    for (const OceanCascade& cascade : state.cascades) {
        points += cascade.height.size();
    }
    if (foam.coverage.size() != points) {
        foam.coverage.assign(points, 0.0f);
    }
    const Ocean limited = clamp_ocean(ocean);
    const float gain = limited.foam_rate * step;
    const float fade = std::exp(-step / limited.foam_decay);
    std::size_t first = 0;
    for (const OceanCascade& cascade : state.cascades) {
        const std::size_t count = cascade.height.size();
        const std::span<float> coverage = std::span(foam.coverage).subspan(first, count);
        const bool breaks = cascade.band_low * kMinBreakerLength < 2 * kPi;
        const float added = breaks ? gain : 0.0f;
        parallel_for(count, kFoamGrain, [&](std::size_t begin, std::size_t end) {
            step_foam(cascade, limited.foam_threshold, added, fade, coverage, begin, end);
        });
        first += count;
    }
}

}  // namespace limn
