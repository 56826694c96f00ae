#include "render/particles/gpu_particle_pools.h"

#include "ecs/base/log.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_balls.h"
#include "ecs/components/particle_collider.h"
#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/shaders/particle_gpu.h"
#include "render/shaders/view_gpu.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

// Techniques: particle.circular-list, particle.depth-collision, particle.gpu-init,
//     particle.gpu-shadow, particle.gpu-state, particle.gpu-update, particle.gpu-update-mrt,
//     particle.million

namespace limn {
namespace {

float word(std::uint64_t bits) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
}

/// Bounce, friction, radius, action.
Vec4 response_texel(const ParticleCollision* collision) {
    if (collision == nullptr) {
        return Vec4(0);
    }
    const auto clamped = [](float value) { return std::clamp(finite_or(value, 0), 0.0f, 1.0f); };
    const auto action = static_cast<std::uint32_t>(collision->action) + 1;
    return {
        clamped(collision->bounce), clamped(collision->friction),
        std::max(finite_or(collision->radius, 0), 0.0f), word(action)};
}

void pack_emitter(
    const ParticleEmitter& emitter, const ParticleCollision* collision,
    const GpuParticles& particles, std::vector<Vec4>& texels) {
    const PhiloxKey& key = particles.key;
    const PhiloxCounter& counter = particles.counter;
    const float cone = std::clamp(finite_or(emitter.cone, 0), 0.0f, kPi);
    texels.emplace_back(word(key[0]), word(key[1]), word(counter[2]), word(counter[3]));
    texels.emplace_back(
        0.0f, word(static_cast<std::uint32_t>(emitter.shape)),
        word(static_cast<std::uint32_t>(emitter.direction)), std::cos(cone));
    texels.emplace_back(emitter.size, emitter.speed);
    texels.emplace_back(emitter.speed_spread, emitter.life, emitter.life_spread, 0.0f);
    texels.emplace_back(emitter.size_spread, 0.0f);
    texels.emplace_back(emitter.velocity_spread, 0.0f);
    texels.push_back(response_texel(collision));
}

/// The first texels of what belongs to a step, each relative to the first of its kind.
struct StepParts {
    std::uint32_t run = 0;
    std::uint32_t force = 0;
    std::uint32_t collider = 0;
    std::uint32_t place = 0;
};

void pack_step(const GpuParticleStep& step, const StepParts& first, std::vector<Vec4>& texels) {
    const MotionStep& motion = step.motion;
    const float dt = motion.step.dt;
    texels.emplace_back(
        word(step.first), word(step.count), word(first.run), word(step.births.size()));
    texels.emplace_back(motion.step.gravity * dt, dt);
    texels.emplace_back(motion.step.air, motion.step.keep);
    for (const Affine* const world : {&step.pose.before, &step.pose.now}) {
        texels.insert(texels.end(), std::begin(world->row), std::end(world->row));
    }
    texels.emplace_back(step.inherited, motion.step.old_weight);
    texels.emplace_back(motion.turbulence.drift_a, motion.turbulence.strength * dt);
    texels.emplace_back(motion.turbulence.drift_b, 1 / motion.turbulence.size);
    texels.emplace_back(motion.vortex.origin, motion.vortex.around * dt);
    texels.emplace_back(motion.vortex.axis, motion.vortex.toward * dt);
    texels.emplace_back(
        motion.steering.orbit, motion.steering.loss, word(motion.turbulence.seed), 0.0f);
    texels.emplace_back(motion.wrap_center, word(first.force));
    texels.emplace_back(motion.wrap_size, word(motion.forces.size()));
    texels.emplace_back(
        word(first.collider), word(step.colliders.size()), word(first.place),
        word(step.count - step.places.size()));
}

Result<const gpu::Program*>
load_update(gpu::Device& device, std::vector<gpu::ShaderDefine> defines) {
    return device.shaders().load(
        {.compute = "particle_update.comp", .defines = std::move(defines)});
}

bool is_steered(const MotionStep& motion) {
    return motion.steering.orbit > 0 || motion.steering.loss > 0;
}

/// Whether a step has only gravity, drag and steering.
bool is_plain(const GpuParticleStep& step) {
    const MotionStep& motion = step.motion;
    const bool whirls = motion.vortex.around != 0 || motion.vortex.toward != 0;
    const bool steers_late = is_steered(motion) && motion.step.old_weight == 1;
    return !motion.step.closed_form && motion.turbulence.strength == 0 && !steers_late && !whirls
           && motion.forces.empty() && motion.wrap_size == Vec3(0) && step.colliders.empty();
}

void make_buffers(std::uint32_t capacity, GpuParticlePool& pool) {
    const std::size_t slots = std::max(capacity, 1u);
    pool.state = gpu::Buffer("particle state", slots * 2 * sizeof(Vec4), gpu::BufferUse::GpuOnly);
    pool.bits =
        gpu::Buffer("particle bits", slots * sizeof(std::uint32_t), gpu::BufferUse::GpuOnly);
    pool.instances = gpu::Buffer(
        "particle instances", slots * layout::kParticleWords * sizeof(std::uint32_t),
        gpu::BufferUse::GpuOnly);
    pool.texels.set(pool.instances);
    pool.capacity = static_cast<std::uint32_t>(slots);
    pool.done = 0;
    pool.seen = 0;
}

/// Offset from the oldest particle to the oldest simulated one, whose number is a multiple of the
/// stride.
std::uint32_t offset_of(const GpuParticlePool& pool) {
    return (0u - pool.first) & (pool.stride - 1);
}

/// How many of the `count` oldest particles are simulated.
std::uint32_t moved_of(std::uint64_t count, const GpuParticlePool& pool) {
    const std::uint64_t offset = offset_of(pool);
    return count > offset
               ? static_cast<std::uint32_t>((count - offset + pool.stride - 1) / pool.stride)
               : 0;
}

/// The simulated particles, numbered without gaps.
ParticleWindow sort_window(const GpuParticlePool& pool) {
    return {(pool.first + offset_of(pool)) / pool.stride, pool.count};
}

/// Balls that are skipped could not be bumped into, so a stride other than 1 has none.
bool has_balls(const ParticleBalls* settings, const GpuParticlePool& pool) {
    return settings != nullptr && pool.stride == 1;
}

constexpr std::size_t kAllSteps = std::numeric_limits<std::size_t>::max();

/// Of a paced frame: more than it adds, so that a pool that is behind catches up.
std::size_t max_ball_steps(const GpuParticles& particles, const GpuParticlePool& pool) {
    constexpr std::size_t kFew = 16;  // by eye
    const bool starts_over = pool.seen == 0 || pool.seen > particles.step;
    return kFew + (starts_over ? 0 : 2 * static_cast<std::size_t>(particles.step - pool.seen));
}

void set_balls(
    const ParticleBalls* settings, const ParticleCollision* collision,
    std::span<const GpuParticleStep> pending, std::uint64_t oldest, GpuParticlePool& pool) {
    GpuBalls& balls = pool.balls;
    balls.radius = has_balls(settings, pool) && !pool.closed_form
                       ? std::max(finite_or(settings->radius, 0), 0.0f)
                       : 0.0f;
    balls.steps.clear();
    if (!(balls.radius > 0)) {
        return;
    }
    balls.bounce = std::clamp(finite_or(settings->bounce, 0), 0.0f, 1.0f);
    balls.wall_radius =
        collision != nullptr ? std::max(finite_or(collision->radius, 0), 0.0f) : -1.0f;
    for (const GpuParticleStep& step : pending) {
        const std::uint64_t end = step.first + step.count;
        balls.steps.emplace_back(
            static_cast<std::uint32_t>(end > oldest ? end - oldest : 0), step.motion.step.dt);
    }
    const std::uint32_t size = sort_size(pool.capacity);
    if (balls.size != size || balls.slots != pool.capacity) {
        const std::size_t slots = pool.capacity;
        const auto make = [](const char* label, std::size_t bytes) {
            return gpu::Buffer(label, bytes, gpu::BufferUse::GpuOnly);
        };
        balls.entries = make("ball cells", size * sizeof(std::uint64_t));
        balls.near = make("ball neighbors", slots * layout::kBallNearWords * sizeof(std::uint32_t));
        for (gpu::Buffer& buffer : balls.motion) {
            buffer = make("ball motion", slots * 2 * sizeof(Vec4));
        }
        balls.size = size;
        balls.slots = pool.capacity;
    }
}

}  // namespace

std::uint32_t particle_stride(float fraction) {
    std::uint32_t stride = 1;
    while (stride < 1024 && static_cast<float>(stride) * fraction < 1) {
        stride *= 2;
    }
    return stride;
}

std::vector<Vec4> pack_particle_steps(
    const ParticleEmitter& emitter, const ParticleCollision* collision,
    const GpuParticles& particles, std::uint64_t from, std::size_t max_steps, GpuShapeList& shapes,
    ParticleStepTexels& layout) {
    const std::span<const GpuParticleStep> kept = particles.kept();
    const std::uint64_t first_kept = particles.step - kept.size();
    const std::size_t skipped = std::min<std::size_t>(
        from > first_kept ? static_cast<std::size_t>(from - first_kept) : 0, kept.size());
    const std::span<const GpuParticleStep> packed =
        kept.subspan(skipped, std::min(kept.size() - skipped, max_steps));
    std::vector<Vec4> texels;
    pack_emitter(emitter, collision, particles, texels);
    StepParts next;
    for (const GpuParticleStep& step : packed) {
        pack_step(step, next, texels);
        next.run += static_cast<std::uint32_t>(step.births.size());
        next.force += static_cast<std::uint32_t>(step.motion.forces.size()) * layout::kForceTexels;
        next.collider +=
            static_cast<std::uint32_t>(step.colliders.size()) * layout::kColliderTexels;
        next.place += static_cast<std::uint32_t>(step.places.size()) * layout::kPlaceTexels;
    }
    layout.steps = static_cast<int>(packed.size());
    layout.runs = static_cast<int>(texels.size());
    for (const GpuParticleStep& step : packed) {
        for (const BirthRun& births : step.births) {
            texels.emplace_back(births.first, births.spacing, word(births.count), 0.0f);
        }
    }
    layout.forces = static_cast<int>(texels.size());
    for (const GpuParticleStep& step : packed) {
        const float scale = step.motion.force_scale * step.motion.step.dt;
        for (const Force& one : step.motion.forces) {
            texels.emplace_back(one.origin, word(static_cast<std::uint32_t>(one.kind)));
            texels.emplace_back(one.axis, one.strength * scale);
            texels.emplace_back(one.speed, one.radius, 0.0f, 0.0f);
        }
    }
    layout.colliders = static_cast<int>(texels.size());
    layout.has_shapes = false;
    for (const GpuParticleStep& step : packed) {
        for (const GpuCollider& one : step.colliders) {
            texels.insert(texels.end(), std::begin(one.rows), std::end(one.rows));
            texels.emplace_back(one.half, word(static_cast<std::uint32_t>(one.kind)));
            texels.emplace_back(word(shapes.find_or_add(one.shape)), 0.0f, 0.0f, 0.0f);
            layout.has_shapes = layout.has_shapes || one.shape != nullptr;
        }
    }
    layout.places = static_cast<int>(texels.size());
    for (const GpuParticleStep& step : packed) {
        for (const GpuBirthPlace& one : step.places) {
            texels.emplace_back(one.position, one.age);
            texels.emplace_back(one.velocity, word(static_cast<std::uint32_t>(one.kind)));
            texels.emplace_back(one.turn.x, one.turn.y, one.turn.z, one.turn.w);
        }
    }
    return texels;
}

void GpuShapeList::begin_frame() {
    if (std::exchange(has_grown_, false)) {
        std::erase_if(entries_, [](const Entry& entry) { return !entry.used; });
    }
    for (Entry& entry : entries_) {
        entry.used = false;
    }
}

std::uint32_t GpuShapeList::find_or_add(const GpuShape& shape) {
    if (shape == nullptr) {
        return 0;
    }
    const auto found = std::find_if(
        entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.shape == shape; });
    if (found != entries_.end()) {
        found->used = true;
        return found->first;
    }
    // In the first gap that holds it.
    std::uint32_t first = 0;
    auto next = entries_.begin();
    while (next != entries_.end() && next->first - first < shape->size()) {
        first = next->first + static_cast<std::uint32_t>(next->shape->size());
        ++next;
    }
    entries_.insert(next, {.shape = shape, .first = first, .used = true});
    has_grown_ = true;
    return first;
}

void GpuShapeList::upload() {
    if (entries_.empty()) {
        return;
    }
    const std::uint32_t end =
        entries_.back().first + static_cast<std::uint32_t>(entries_.back().shape->size());
    const bool grows = end > capacity_;
    if (grows) {
        capacity_ = std::bit_ceil(end);
        buffer_ = gpu::Buffer("particle shapes", capacity_ * sizeof(Vec4), gpu::BufferUse::Dynamic);
        texels_.set(buffer_);
    }
    for (Entry& entry : entries_) {
        if (grows || entry.is_new) {
            buffer_.write(entry.first * sizeof(Vec4), std::span<const Vec4>(*entry.shape));
            uploaded_ += entry.shape->size();
            entry.is_new = false;
        }
    }
}

void GpuShapeList::bind(gpu::Device& device) const {
    texels_.bind(device, layout::kParticleShapesUnit);
}

Result<GpuParticlePools> GpuParticlePools::create(gpu::Device& device) {
    GpuParticlePools pools;
    pools.programs_[0][0].births = LIMN_TRY(load_update(device, {}));
    pools.programs_[0][0].old = LIMN_TRY(load_update(device, {{"OLD"}}));
    pools.plain_ = LIMN_TRY(load_update(device, {{"OLD"}, {"PLAIN"}}));
    pools.steered_ = LIMN_TRY(load_update(device, {{"OLD"}, {"PLAIN"}, {"STEERED"}}));
    return pools;
}

void GpuParticlePools::begin_frame(const World& world) {
    if (std::exchange(epoch_, world.core().epoch) != world.core().epoch) {
        pools_.clear();
    }
    updated_ = false;
    shapes_.begin_frame();
    for (auto& [entity, pool] : pools_) {
        pool->used = false;
    }
}

void GpuParticlePools::drop_unused() {
    std::erase_if(pools_, [](const auto& pool) { return !pool.second->used; });
}

bool GpuParticlePools::can_sort(gpu::Device& device) {
    if (!sort_programs_) {
        Result<ParticleSortPrograms> made = ParticleSortPrograms::create(device);
        if (!made) {
            log_error("{}", made.error().message);
            return false;
        }
        sort_programs_ = *made;
    }
    return true;
}

const GpuParticlePools::Programs*
GpuParticlePools::find_programs(gpu::Device& device, bool has_shapes, bool has_depth) {
    Programs& found = programs_[has_shapes ? 1 : 0][has_depth ? 1 : 0];
    if (found.old == nullptr) {
        std::vector<gpu::ShaderDefine> defines;
        if (has_shapes) {
            defines.push_back({"SHAPES"});
        }
        if (has_depth) {
            defines.push_back({"DEPTH_COLLISION"});
        }
        const Result<const gpu::Program*> births = load_update(device, defines);
        defines.push_back({"OLD"});
        const Result<const gpu::Program*> old = load_update(device, defines);
        if (!births || !old) {
            log_error("{}", (births ? old : births).error().message);
            return nullptr;
        }
        found = {*births, *old};
    }
    return &found;
}

bool GpuParticlePools::collides_with_depth() const {
    return std::any_of(pools_.begin(), pools_.end(), [](const auto& pool) {
        return pool.second->collide_depth > 0;
    });
}

void GpuParticlePools::add(
    FrameData& frame, Entity entity, const ParticleEmitter& emitter, const GpuParticles& particles,
    std::uint32_t look, std::optional<std::uint32_t> sort_passes,
    const ParticleCollision* collision, std::uint32_t stride, const ParticleBalls* balls,
    bool paced) {
    std::unique_ptr<GpuParticlePool>& found = pools_[entity.bits()];
    if (found == nullptr) {
        found = std::make_unique<GpuParticlePool>();
    }
    GpuParticlePool& pool = *found;
    const std::uint64_t window = particles.clock.born - particles.oldest();
    // A capacity below the number of particles takes effect once, when enough of them have died.
    const std::uint64_t wanted = std::max(emitter.capacity, 1u);
    const auto slots = static_cast<std::uint32_t>(
        window <= wanted ? wanted : std::max<std::uint64_t>(pool.capacity, window));
    const std::uint64_t first_kept = particles.step - particles.kept().size();
    if (pool.capacity != slots || pool.done > particles.step || pool.done < first_kept
        || stride < pool.stride) {
        const std::uint64_t seen = pool.seen;
        make_buffers(slots, pool);  // all recorded steps are simulated again
        pool.seen = seen;
    }
    pool.stride = stride;
    const std::size_t max_steps =
        (paced || frame.warm_up) && has_balls(balls, pool) && balls->radius > 0 && !pool.closed_form
            ? max_ball_steps(particles, pool)
            : kAllSteps;
    pool.steps.upload(
        *frame.ring,
        pack_particle_steps(
            emitter, collision, particles, pool.done, max_steps, shapes_, pool.layout));
    const std::uint64_t from = std::max(pool.done, first_kept);
    const std::span<const GpuParticleStep> pending = particles.kept().subspan(
        static_cast<std::size_t>(from - first_kept), static_cast<std::size_t>(pool.layout.steps));
    pool.done = from + pending.size();
    pool.seen = particles.step;
    pool.used = true;
    pool.look = look;
    pool.first = static_cast<std::uint32_t>(particles.oldest());
    const auto born_at = [&](std::uint64_t step) {  // its beginning
        return step < particles.step ? particles.kept()[step - first_kept].first
                                     : particles.clock.born;
    };
    const std::uint64_t born = std::max(born_at(pool.done), particles.oldest());
    pool.count = moved_of(born - particles.oldest(), pool);
    const std::uint64_t born_before = born_at(from);
    pool.old = moved_of(std::max(born_before, particles.oldest()) - particles.oldest(), pool);
    pool.plain.reset();
    pool.steering.reset();
    if (pending.size() == 1 && is_plain(pending.front())) {
        const MotionStep& motion = pending.front().motion;
        pool.plain = motion.step;
        if (is_steered(motion)) {
            pool.steering = motion.steering;
        }
    }
    if (!particles.kept().empty()) {
        const ParticleStep& step = particles.kept().back().motion.step;
        pool.closed_form = step.closed_form;
        pool.gravity = step.gravity;
    }
    set_balls(balls, collision, pending, particles.oldest(), pool);
    const bool closed_form = pool.closed_form;
    const float depth = collision != nullptr ? finite_or(collision->collide_depth, 0) : 0.0f;
    pool.collide_depth = depth > 0 && !closed_form ? depth : 0.0f;
    if (frame.warm_up) {  // before there are steps to simulate
        for (const bool has_shapes : {false, collision != nullptr}) {
            for (const bool has_depth : {false, depth > 0}) {
                (void)find_programs(*frame.device, has_shapes, has_depth);
            }
        }
        if (balls != nullptr) {
            (void)can_collide_balls(*frame.device);
        }
    }
    pool.sorted = sort_passes.has_value() && pool.count > 0 && can_sort(*frame.device);
    if (pool.sorted) {
        plan_particle_sort(sort_window(pool), *sort_passes, pool.sort);
    }
}

/// Dispatches the update of the particles born before the steps to simulate, and of those born
/// during them.
void GpuParticlePools::move(
    gpu::Device& device, const GpuParticlePool& pool, float back, bool has_depth, int only_step) {
    const bool collides = has_depth && pool.collide_depth > 0;
    const bool is_plain_step = pool.plain.has_value() && !collides && only_step < 0;
    const Programs* const programs = find_programs(device, pool.layout.has_shapes, collides);
    if (programs == nullptr) {
        return;
    }
    if (pool.layout.has_shapes) {
        shapes_.bind(device);
    }
    pool.steps.bind(device, layout::kParticleStepsUnit);
    device.bind_storage(layout::kParticleStateBinding, pool.state);
    device.bind_storage(layout::kParticleBitsBinding, pool.bits);
    device.bind_storage(layout::kParticleInstancesBinding, pool.instances);
    const auto dispatch = [&](const gpu::Program& program, std::uint32_t begin, std::uint32_t end,
                              std::uint32_t first_slot) {
        if (begin >= end) {
            return;
        }
        device.use(program);
        program.set("first", pool.first);
        program.set("begin", begin);
        program.set("end", end);
        program.set("stride", pool.stride);
        program.set("offset", offset_of(pool));
        program.set("first_slot", first_slot);
        program.set("first_step", std::max(only_step, 0));
        program.set("step_count", only_step >= 0 ? 1 : pool.layout.steps);
        program.set("runs", pool.layout.runs);
        program.set("forces", pool.layout.forces);
        program.set("colliders", pool.layout.colliders);
        program.set("places", pool.layout.places);
        program.set("look", pool.look);
        program.set("back", back);
        program.set("closed_form", pool.closed_form ? 1 : 0);
        program.set("gravity", pool.gravity);
        program.set("thickness", pool.collide_depth);
        if (pool.plain) {
            const ParticleStep& step = *pool.plain;
            const float old_dt = step.dt * step.old_weight;
            const Vec3 added = step.air + (step.gravity * step.dt - step.air) * step.keep;
            program.set("added_dt", Vec4(added, step.dt));
            program.set("kept", step.keep);
            program.set("velocity_dt", Vec2(old_dt, step.dt - old_dt));
        }
        if (pool.steering) {
            program.set("steering_origin", Vec4(pool.steering->origin, pool.steering->orbit));
            program.set("steering_axis", Vec4(pool.steering->axis, pool.steering->loss));
        }
        device.dispatch((end - begin + layout::kParticleGroup - 1) / layout::kParticleGroup);
    };
    const gpu::Program* const old = !is_plain_step  ? programs->old
                                    : pool.steering ? steered_
                                                    : plain_;
    // The slots are a ring: indices beyond its end wrap to its beginning.
    const std::uint32_t first_slot = pool.first % pool.capacity + offset_of(pool);
    const std::uint32_t room = pool.capacity - std::min(first_slot, pool.capacity);
    const std::uint32_t wrap = room / pool.stride + (room % pool.stride > 0 ? 1 : 0);
    const auto dispatch_parts = [&](const gpu::Program& program, std::uint32_t begin,
                                    std::uint32_t end) {
        const std::uint32_t ring_end = std::clamp(wrap, begin, end);
        dispatch(program, begin, ring_end, first_slot);
        dispatch(program, ring_end, end, first_slot - pool.capacity);
    };
    dispatch_parts(*old, 0, pool.old);
    dispatch_parts(*programs->births, pool.old, pool.count);
}

bool GpuParticlePools::can_collide_balls(gpu::Device& device) {
    if (ball_programs_.apply != nullptr) {
        return true;
    }
    const auto load = [&](std::vector<gpu::ShaderDefine> defines) -> const gpu::Program* {
        const Result<const gpu::Program*> program = device.shaders().load(
            {.compute = "particle_balls.comp", .defines = std::move(defines)});
        if (!program) {
            log_error("{}", program.error().message);
            return nullptr;
        }
        return *program;
    };
    BallPrograms made = {
        .keys = load({{"KEYS"}}),
        .near = load({{"NEAR"}}),
        .mutual = load({{"MUTUAL"}}),
        .push = {load({{"PUSH"}}), load({{"PUSH"}, {"SHAPES"}})},
        .speed = load({{"SPEED"}}),
        .apply = load({})};
    const bool complete = made.keys != nullptr && made.near != nullptr && made.mutual != nullptr
                          && made.push[0] != nullptr && made.push[1] != nullptr
                          && made.speed != nullptr && made.apply != nullptr && can_sort(device);
    if (complete) {
        ball_programs_ = made;
    }
    return complete;
}

void GpuParticlePools::move_balls(
    gpu::Device& device, GpuParticlePool& pool, float back, bool has_depth) {
    constexpr int kBallPasses = 32;   // over all pairs: how many balls far a push spreads
    constexpr int kSpeedPasses = 12;  // likewise, of speeds
    GpuBalls& balls = pool.balls;
    int read = 1;  // the first pass writes motion[0]
    const auto dispatch = [&](const gpu::Program& program, std::size_t step, std::uint32_t count,
                              int is_first = 0) {
        device.storage_barrier();
        device.use(program);
        pool.steps.bind(device, layout::kParticleStepsUnit);
        if (pool.layout.has_shapes) {
            shapes_.bind(device);
        }
        device.bind_storage(layout::kParticleStateBinding, pool.state);
        device.bind_storage(layout::kBallNearBinding, balls.near);
        device.bind_storage(layout::kParticleInstancesBinding, pool.instances);
        device.bind_storage(layout::kBallEntriesBinding, balls.entries);
        device.bind_storage(layout::kBallReadBinding, balls.motion[read]);
        device.bind_storage(layout::kBallWriteBinding, balls.motion[1 - read]);
        program.set("count", pool.count);
        program.set("born", balls.steps[step].first);
        program.set("first_slot", pool.first % pool.capacity);
        program.set("capacity", pool.capacity);
        program.set("size", sort_size(pool.count));
        program.set("radius", balls.radius);
        program.set("bounce", balls.bounce);
        program.set("dt", balls.steps[step].second);
        program.set("back", back);
        program.set(
            "step_texel",
            static_cast<int>(layout::kEmitterTexels + step * std::size_t{layout::kStepTexels}));
        program.set("colliders", pool.layout.colliders);
        program.set("wall_radius", balls.wall_radius);
        program.set("is_first", is_first);
        device.dispatch((count + layout::kParticleGroup - 1) / layout::kParticleGroup);
        read = 1 - read;
    };
    for (std::size_t step = 0; step < balls.steps.size(); ++step) {
        device.storage_barrier();
        move(device, pool, back, has_depth, static_cast<int>(step));
        if (!(balls.steps[step].second > 0) || pool.count == 0) {
            continue;
        }
        const std::uint32_t size = sort_size(pool.count);
        dispatch(*ball_programs_.keys, step, size);
        device.storage_barrier();
        device.bind_storage(layout::kSortEntriesBinding, balls.entries);
        sort_entries(device, *sort_programs_, size);
        dispatch(*ball_programs_.near, step, pool.count);
        dispatch(*ball_programs_.mutual, step, pool.count);
        for (int pass = 0; pass < kBallPasses; ++pass) {
            dispatch(*ball_programs_.push[pool.layout.has_shapes ? 1 : 0], step, pool.count);
        }
        for (int pass = 0; pass <= kSpeedPasses; ++pass) {
            dispatch(*ball_programs_.speed, step, pool.count, pass == 0 ? 1 : 0);
        }
        dispatch(*ball_programs_.apply, step, pool.count);
    }
    device.storage_barrier();
}

void GpuParticlePools::update(FrameGraph& graph, const GpuParticleView& view) {
    if (std::exchange(updated_, true)) {
        return;
    }
    if (pools_.empty()) {
        return;
    }
    shapes_.upload();
    std::vector<Use> writes;
    for (const auto& [entity, pool] : pools_) {
        for (const gpu::Buffer* const buffer : {&pool->state, &pool->bits, &pool->instances}) {
            writes.emplace_back(graph.import("particles", *buffer));
        }
    }
    const PreviousDepth depth = view.depth;
    std::vector<Use> reads;
    if (depth.depth != nullptr) {
        reads.push_back(
            sampled(graph.import("previous depth", *depth.depth), layout::kPreviousDepthUnit));
    }
    graph.add_pass(
        "move particles", reads, writes, [this, back = view.back, depth](PassContext& context) {
            gpu::Device& device = context.device();
            if (depth.depth != nullptr) {
                device.bind_uniforms(
                    layout::kViewBinding, depth.camera.buffer, depth.camera.offset,
                    depth.camera.size);
            }
            const bool has_depth = depth.depth != nullptr;
            for (const auto& [entity, pool] : pools_) {
                if (!pool->balls.steps.empty() && can_collide_balls(device)) {
                    move_balls(device, *pool, back, has_depth);
                } else {
                    move(device, *pool, back, has_depth);
                }
            }
        });
    for (const auto& [entity, found] : pools_) {
        GpuParticlePool& pool = *found;
        if (!pool.sorted) {
            continue;
        }
        const Use unsorted[] = {graph.import("particles", pool.instances)};
        const Use order[] = {
            graph.import("particle order", pool.sort.entries[0]),
            graph.import("particle order", pool.sort.entries[1]),
            graph.import("sorted particles", pool.sort.instances)};
        graph.add_pass("sort particles", unsorted, order, [=, this, &pool](PassContext& context) {
            run_particle_sort(
                context, *sort_programs_, sort_window(pool), pool.instances,
                {view.eye, view.forward}, pool.sort);
        });
    }
}

}  // namespace limn
