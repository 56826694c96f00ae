#include "render/particles/gpu_particle_sort.h"

#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/shaders/particle_gpu.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

// Techniques: particle.bitonic-sort, particle.distance-sort, particle.sort-amortised

namespace limn {
namespace {

constexpr std::uint32_t kSortGroup = 512;  // invocations of a work group
constexpr std::uint32_t kLocal = 1024;     // entries that a work group sorts by itself

void make_sort_buffers(std::uint32_t size, GpuParticleSort& sort) {
    for (gpu::Buffer& entries : sort.entries) {
        entries =
            gpu::Buffer("particle order", size * sizeof(std::uint64_t), gpu::BufferUse::GpuOnly);
    }
    // Particles that have died during a sort keep their slots in the order until the next sort.
    sort.instances = gpu::Buffer(
        "sorted particles", std::size_t{2} * size * layout::kParticleWords * sizeof(std::uint32_t),
        gpu::BufferUse::GpuOnly);
    sort.texels.set(sort.instances);
    sort.capacity = size;
    sort.next_pass = 0;
    sort.shown.reset();
}

void sort_some(
    gpu::Device& device, const ParticleSortPrograms& programs, const ParticleSortPlan& plan) {
    device.use(*programs.pass);
    for (std::uint32_t number = plan.first_pass; number < plan.last_pass; ++number) {
        const BitonicPass pass = bitonic_pass_at(number);
        programs.pass->set("run", pass.run);
        programs.pass->set("partner", pass.partner);
        device.dispatch(plan.size / 2 / kSortGroup);
        device.storage_barrier();
    }
}

}  // namespace

ParticleSortView
predict_sort_view(const ParticleSortView& previous, const ParticleSortView& now, float frames) {
    constexpr float kMaxMove = 10;      // in a frame [m]; more is a cut, as in is_cut()
    constexpr float kMinCosine = 0.5f;  // of the turn in a frame
    constexpr float kMaxTurn = 0.15f;   // to extrapolate [rad]: turns soon stop, by eye
    const Vec3 move = now.eye - previous.eye;
    if (!(glm::length(move) <= kMaxMove && glm::dot(previous.forward, now.forward) >= kMinCosine)) {
        return now;
    }
    const Vec3 turn = now.forward - previous.forward;
    const float turned = frames * glm::length(turn);
    const float turn_frames = turned > kMaxTurn ? frames * kMaxTurn / turned : frames;
    return {now.eye + frames * move, glm::normalize(now.forward + turn_frames * turn)};
}

std::uint32_t sort_size(std::uint32_t count) {
    return std::max(std::bit_ceil(count), kLocal);
}

void plan_particle_sort(const ParticleWindow& now, std::uint32_t passes, GpuParticleSort& sort) {
    if (sort.capacity < sort_size(now.count)) {
        make_sort_buffers(sort_size(now.count), sort);
    }
    const bool whole = passes == 0 || !sort.shown;
    if (whole) {
        sort.next_pass = 0;
    }
    ParticleSortPlan& plan = sort.plan;
    plan.read_keys = sort.next_pass == 0;
    if (plan.read_keys) {
        sort.sorting = now;
    }
    plan.size = sort_size(sort.sorting.count);
    const std::uint32_t all = bitonic_pass_count(plan.size);
    plan.ahead =
        whole ? 0.0f : 1.5f * static_cast<float>((all + passes - 1) / passes);  // 1 to 2 sorts
    plan.first_pass = sort.next_pass;
    plan.last_pass = whole ? all : std::min(all, sort.next_pass + passes);
    sort.next_pass = plan.last_pass;
    if (plan.last_pass == all) {
        sort.next_pass = 0;
        sort.shown = sort.sorting;
        sort.current = 1 - sort.current;
    }
    sort.count = now.first + now.count - sort.shown->first;
}

Result<ParticleSortPrograms> ParticleSortPrograms::create(gpu::Device& device) {
    const auto load = [&](std::vector<gpu::ShaderDefine> defines) {
        return device.shaders().load(
            {.compute = "particle_sort.comp", .defines = std::move(defines)});
    };
    ParticleSortPrograms programs;
    programs.keys = LIMN_TRY(load({{"KEYS"}}));
    programs.pass = LIMN_TRY(load({{"PASS"}}));
    programs.local = LIMN_TRY(load({{"LOCAL"}}));
    programs.gather = LIMN_TRY(load({}));
    return programs;
}

// Consecutive passes within the entries of a work group are one dispatch.
void sort_entries(gpu::Device& device, const ParticleSortPrograms& programs, std::uint32_t size) {
    const auto sort_local = [&](std::uint32_t run, std::uint32_t last_run) {
        device.use(*programs.local);
        programs.local->set("run", run);
        programs.local->set("last_run", last_run);
        device.dispatch(size / kLocal);
        device.storage_barrier();
    };
    sort_local(2, kLocal);
    for (std::uint32_t run = 2 * kLocal; run <= size; run *= 2) {
        device.use(*programs.pass);
        programs.pass->set("run", run);
        for (std::uint32_t partner = run / 2; partner >= kLocal; partner /= 2) {
            programs.pass->set("partner", partner);
            device.dispatch(size / 2 / kSortGroup);
            device.storage_barrier();
        }
        sort_local(run, run);
    }
}

void run_particle_sort(
    PassContext& context, const ParticleSortPrograms& programs, const ParticleWindow& now,
    const gpu::Buffer& instances, const ParticleSortView& view, GpuParticleSort& sort) {
    gpu::Device& device = context.device();
    const ParticleSortPlan& plan = sort.plan;
    const ParticleSortView previous = std::exchange(sort.view, view).value_or(view);
    const bool ended = sort.next_pass == 0;
    const int sorted = ended ? 1 - sort.current : sort.current;
    device.storage_barrier();  // after the particles have moved
    device.bind_storage(layout::kSortEntriesBinding, sort.entries[sorted]);
    device.bind_storage(layout::kSortInstancesBinding, instances);
    if (plan.read_keys) {
        device.use(*programs.keys);
        programs.keys->set("count", now.count);
        programs.keys->set("size", plan.size);
        const ParticleSortView predicted = predict_sort_view(previous, view, plan.ahead);
        programs.keys->set("eye", predicted.eye);
        programs.keys->set("forward", predicted.forward);
        device.dispatch(plan.size / kSortGroup);
        device.storage_barrier();
    }
    if (plan.first_pass == 0 && ended) {
        sort_entries(device, programs, plan.size);
    } else {
        sort_some(device, programs, plan);
    }
    device.bind_storage(layout::kSortEntriesBinding, sort.entries[1 - sort.current]);
    device.bind_storage(layout::kSortedInstancesBinding, sort.instances);
    device.use(*programs.gather);
    programs.gather->set("count", now.count);
    programs.gather->set("sorted_count", sort.shown->count);
    programs.gather->set("died", now.first - sort.shown->first);
    programs.gather->set("total", sort.count);
    device.dispatch((sort.count + kSortGroup - 1) / kSortGroup);
}

}  // namespace limn
