#include "systems/particles/particle_births.h"

#include "systems/particles/birth_attributes.h"
#include "systems/particles/birth_kernels.h"
#include "systems/particles/emitter_pose.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

// Techniques: engine.particle-cpu, particle.emission-rate, particle.linear-window, particle.system,
//     water.crest-spray, water.impact-spray

namespace limn {
namespace {

constexpr float kAspect = 16.0f / 9.0f;
constexpr double kMaxBirths = 1e12;  // of a burst or per second, so that sums stay finite
// Of a birth: 600 per second are 10 in each step of 1/60 s, in spite of rounding.
constexpr double kSlack = 1e-5;
constexpr double kMinDuration = 1e-3;  // [s] of an emitter that loops

/// Reserves the whole capacity at once: unused memory only costs address space.
void reserve(ParticlePool& pool, std::size_t count) {
    for (auto* column :
         {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz, &pool.age, &pool.life}) {
        column->reserve(count);
    }
    pool.look.reserve(count);
}

void make_room(const ParticleEmitter& emitter, std::size_t more, ParticlePool& pool) {
    const std::size_t size = pool.size() + more;
    if (pool.x.capacity() < size) {
        reserve(pool, std::max<std::size_t>(emitter.capacity, size));
    }
}

/// Adds particles at the end of a pool, which is resized once for all of them.
class NewParticles {
  public:
    /// At most `count` more.
    NewParticles(ParticlePool& pool, std::size_t count) : pool_(pool), size_(pool.size()) {
        resize(size_ + count);
    }
    NewParticles(const NewParticles&) = delete;
    NewParticles& operator=(const NewParticles&) = delete;
    ~NewParticles() { resize(size_); }

    /// Unless its position or life is not finite.
    void add(const Newborn& born) {
        if (!born.is_finite()) {
            return;
        }
        const BirthColumns columns = next();
        *columns.x = born.position.x;
        *columns.y = born.position.y;
        *columns.z = born.position.z;
        *columns.vx = born.velocity.x;
        *columns.vy = born.velocity.y;
        *columns.vz = born.velocity.z;
        *columns.age = born.age;
        *columns.life = born.life;
        *columns.look = born.look;
        ++size_;
    }

    /// All births of a run.
    void add(const BirthDraw& draw, const BirthRun& run) {
        std::uint64_t& number = pool_.clock.born;
        std::uint32_t i = 0;
        while (i < run.count) {
            const std::size_t drawn = draw_births(draw, run, i, run.count - i, number, next());
            i += static_cast<std::uint32_t>(drawn);
            number += drawn;
            size_ += drawn;
            if (i < run.count) {
                add(draw_birth(draw, run.at(i++), number++));
            }
        }
    }

  private:
    [[nodiscard]] BirthColumns next() const {
        return {pool_.x.data() + size_,   pool_.y.data() + size_,    pool_.z.data() + size_,
                pool_.vx.data() + size_,  pool_.vy.data() + size_,   pool_.vz.data() + size_,
                pool_.age.data() + size_, pool_.life.data() + size_, pool_.look.data() + size_};
    }
    void resize(std::size_t size) {
        for (auto* column :
             {&pool_.x, &pool_.y, &pool_.z, &pool_.vx, &pool_.vy, &pool_.vz, &pool_.age,
              &pool_.life}) {
            column->resize(size);
        }
        pool_.look.resize(size);
    }

    ParticlePool& pool_;
    std::size_t size_;
};

/// The same scale, with another position and rotation.
Affine turned_to(const Affine& world, const Vec3& position, const Quat& turn) {
    const Vec3 size = {
        glm::length(transform_vector(world, {1, 0, 0})),
        glm::length(transform_vector(world, {0, 1, 0})),
        glm::length(transform_vector(world, {0, 0, 1}))};
    return affine_from(position, turn, size);
}

bool is_moving(const EmitterPose& pose) {
    return !std::equal(std::begin(pose.now.row), std::end(pose.now.row), pose.before.row);
}

/// A birth on a surface. The surface's own velocity is added instead of `draw.added`.
std::optional<Newborn> draw_birth_on(
    const SurfaceSource& surface, const SurfaceTable& table, const BirthDraw& draw, float at,
    std::uint64_t number) {
    Random random = attributes_random(draw.seed, draw.subject, number);
    Random surface_numbers = surface_random(draw.seed, draw.subject, number);
    const float dt = draw.rewind.step.dt;
    const std::optional<SurfacePoint> point =
        surface_point(surface, table, number, at, dt, surface_numbers);
    if (!point) {
        return std::nullopt;
    }
    const Affine world = turned_to(interpolate_pose(draw.pose, at), point->position, point->turn);
    const BirthAttributes attributes = draw_attributes(*draw.emitter, world, random);
    const Vec3 added = point->velocity * finite_or(surface.surface->inherit, 0);
    Newborn born = {
        transform_point(world, attributes.local), attributes.velocity + added, -(at * dt),
        attributes.life, attributes.look};
    if (surface.surface->on == BirthSurface::Pieces) {
        born.look = (born.look & ~kPieceMask) | point->piece;
    }
    draw.rewind.apply(at, born.position, born.velocity);
    return born;
}

double interval_of(const ParticleBurst& burst) {
    return std::max(static_cast<double>(burst.interval), 1e-3);
}
/// Number of the first repeat of a burst that is not before `begin` [s].
double first_repeat(const ParticleBurst& burst, double begin) {
    return std::max(std::ceil((begin - static_cast<double>(burst.time)) / interval_of(burst)), 0.0);
}
/// When it is due, after `begin` [s].
double time_of_repeat(const ParticleBurst& burst, double repeat, double begin) {
    return static_cast<double>(burst.time) + repeat * interval_of(burst) - begin;
}

/// A part of a step within which the emitter does not restart.
struct Piece {
    double begin;  ///< of the emitter's time [s]
    double length;
    double offset;  ///< from the beginning of the step [s]
};

class Births {
  public:
    Births(float dt, std::size_t room, EmitterClock& clock, std::vector<BirthRun>& runs)
        : dt_(static_cast<double>(dt)), room_(static_cast<double>(room)), clock_(clock),
          runs_(runs) {}

    void add_rate(const Piece& piece, double rate) {
        if (!(rate > 0)) {
            return;
        }
        rate = std::min(rate, kMaxBirths);
        const double due = clock_.carry + rate * piece.length;
        const double whole = std::floor(due + kSlack);
        add(piece.offset + (1 - clock_.carry) / rate, 1 / rate, whole);
        clock_.carry = std::max(due - whole, 0.0);
    }

    void add_burst(const Piece& piece, const ParticleBurst& burst, Random& random) {
        for (double k = first_repeat(burst, piece.begin); k <= burst.repeats; ++k) {
            const double at = time_of_repeat(burst, k, piece.begin);
            if (at >= piece.length) {
                break;
            }
            const auto asked = static_cast<double>(spread(burst.count, burst.spread, random));
            add(piece.offset + at, 0, std::min(std::round(asked), kMaxBirths));
        }
    }

  private:
    void add(double first, double spacing, double wanted) {
        const double count = std::min(wanted, room_);
        if (count > 0) {
            runs_.push_back(
                {static_cast<float>(first / dt_), static_cast<float>(spacing / dt_),
                 static_cast<std::uint32_t>(count)});
            room_ -= count;
        }
        clock_.dropped += wanted > count ? static_cast<std::uint64_t>(wanted - count) : 0;
    }

    double dt_;
    double room_;
    EmitterClock& clock_;
    std::vector<BirthRun>& runs_;
};

}  // namespace

std::size_t
birth_room(const ParticleEmitter& emitter, std::uint64_t window, const EmitterClock& clock) {
    const std::uint64_t used =
        emitter.population == ParticlePopulation::Linear ? clock.born : window;
    return emitter.capacity > used ? static_cast<std::size_t>(emitter.capacity - used) : 0;
}

bool has_no_births(const ParticleEmitter& emitter, float dt, const EmitterClock& clock) {
    if (emitter.duration > 0) {
        return false;
    }
    if (!emitter.active) {
        return true;
    }
    const auto is_due = [&](const ParticleBurst& burst) {
        const double k = first_repeat(burst, clock.time);
        return !(k > burst.repeats)
               && !(time_of_repeat(burst, k, clock.time) >= static_cast<double>(dt));
    };
    return emitter.rate == 0 && emitter.rate_spread == 0
           && std::none_of(emitter.bursts.begin(), emitter.bursts.end(), is_due);
}

void find_births(
    const ParticleEmitter& emitter, float scale, float dt, std::size_t room, Random& random,
    EmitterClock& clock, std::vector<BirthRun>& births) {
    const float rate =
        scale * spread(finite_or(emitter.rate, 0), finite_or(emitter.rate_spread, 0), random);
    const double asked = static_cast<double>(finite_or(emitter.duration, 0));
    const double duration = asked > 0 ? std::max(asked, kMinDuration) : 0;
    Births found(dt, room, clock, births);
    double left = static_cast<double>(dt);
    while (left > 0) {
        const double rest = duration > 0 ? duration - clock.time : left;
        if (rest <= 0 && !emitter.loop) {
            clock.carry = 0;
            break;
        }
        const Piece piece = {
            clock.time, std::min(left, std::max(rest, 0.0)), static_cast<double>(dt) - left};
        if (emitter.active) {
            // At its midpoint: exact for straight lines.
            const double period = duration > 0 ? duration : 1.0;
            const double at = std::fmod((piece.begin + 0.5 * piece.length) / period, 1.0);
            const float factor = sample_curve(emitter.rate_curve, static_cast<float>(at));
            found.add_rate(piece, static_cast<double>(rate * finite_or(factor, 0)));
            for (const ParticleBurst& burst : emitter.bursts) {
                found.add_burst(piece, burst, random);
            }
        }
        left -= piece.length;
        clock.time =
            duration > 0 && rest <= piece.length && emitter.loop ? 0.0 : clock.time + piece.length;
    }
}

float screen_coverage(float radius, float distance, float fov_y) {
    if (!(distance > radius)) {
        return 1;
    }
    // A disc of this radius in an image plane of height 2 tan(fov / 2).
    const float projected = radius / std::sqrt(distance * distance - radius * radius);
    const float half_height = std::tan(0.5f * fov_y);
    return std::min(
        kPi * projected * projected / (4.0f * half_height * half_height * kAspect), 1.0f);
}

Vec3 inherited_velocity(const ParticleEmitter& emitter, const EmitterPose& pose, float dt) {
    const auto origin = [](const Affine& world) { return transform_point(world, Vec3(0)); };
    const Vec3 moved = (origin(pose.now) - origin(pose.before)) / dt;
    return moved * finite_or(emitter.inherit, 0);
}

void add_particles(
    const ParticleEmitter& emitter, const EmitterPose& pose, const ParticleStep& step,
    const SurfaceSource* surface, std::uint64_t seed, std::uint64_t subject,
    const std::vector<BirthRun>& births, ParticlePool& pool) {
    std::size_t count = 0;
    for (const BirthRun& run : births) {
        count += run.count;
    }
    if (count == 0) {
        return;
    }
    const Vec3 inherited = inherited_velocity(emitter, pose, step.dt);
    thread_local SurfaceTable table;  // its memory is reused
    if (surface != nullptr && !fill_surface_table(*surface, table)) {
        pool.clock.dropped += count;
        return;
    }
    make_room(emitter, count, pool);
    NewParticles particles(pool, count);
    const BirthDraw draw = {&emitter,  pose, is_moving(pose), Rewind(step),
                            inherited, seed, subject};
    for (const BirthRun& run : births) {
        if (surface == nullptr) {
            particles.add(draw, run);
            continue;
        }
        for (std::uint32_t i = 0; i < run.count; ++i) {
            const std::uint64_t number = pool.clock.born++;
            if (const auto born = draw_birth_on(*surface, table, draw, run.at(i), number)) {
                particles.add(*born);
            } else {
                ++pool.clock.dropped;
            }
        }
    }
}

void add_spawns(
    const ParticleEmitter& emitter, const Affine& world, const std::vector<ParticleSpawn>& spawns,
    std::uint64_t seed, std::uint64_t subject, ParticlePool& pool) {
    make_room(emitter, spawns.size(), pool);
    NewParticles particles(pool, spawns.size());
    for (const ParticleSpawn& spawn : spawns) {
        Random random = attributes_random(seed, subject, pool.clock.born++);
        const Affine shape = spawn.axis == Vec3(0)
                                 ? world
                                 : turned_to(world, Vec3(0), Quat(Vec3(0, 1, 0), spawn.axis));
        const BirthAttributes attributes = draw_attributes(emitter, shape, random);
        const Vec3 velocity = attributes.velocity + spawn.velocity;
        const Vec3 position =
            spawn.position + transform_vector(shape, attributes.local) + velocity * spawn.age;
        particles.add({position, velocity, spawn.age, attributes.life, attributes.look});
    }
}

void add_drops(
    const ParticleEmitter& emitter, const std::vector<SprayDrop>& drops, const ParticleStep& step,
    std::uint64_t seed, std::uint64_t subject, ParticlePool& pool) {
    const std::size_t room = birth_room(emitter, pool.size(), pool.clock);
    const std::size_t count = std::min(drops.size(), room);
    pool.clock.dropped += drops.size() - count;
    make_room(emitter, count, pool);
    NewParticles particles(pool, count);
    const Rewind rewind(step);
    for (std::size_t i = 0; i < count; ++i) {
        Random random = attributes_random(seed, subject, pool.clock.born++);
        const float at = random.uniform();
        const float life = spread(emitter.life, emitter.life_spread, random);
        const Vec3 velocity = drops[i].velocity * finite_or(emitter.drop_speed, 1);
        Newborn drop = {drops[i].position, velocity, -(at * step.dt), life, random.word()};
        rewind.apply(at, drop.position, drop.velocity);
        particles.add(drop);
    }
}

std::vector<GpuBirthPlace> place_on_surface(
    const SurfaceSource& surface, float dt, std::uint64_t seed, std::uint64_t subject,
    std::uint64_t first, const std::vector<BirthRun>& births) {
    thread_local SurfaceTable table;  // its memory is reused
    std::vector<GpuBirthPlace> places;
    if (!fill_surface_table(surface, table)) {
        return places;
    }
    const float inherit = finite_or(surface.surface->inherit, 0);
    for (const BirthRun& run : births) {
        for (std::uint32_t i = 0; i < run.count; ++i) {
            const std::uint64_t number = first + places.size();
            Random random = surface_random(seed, subject, number);
            const auto point = surface_point(surface, table, number, run.at(i), dt, random);
            places.push_back(
                point ? GpuBirthPlace{
                            .kind = GpuBirthKind::Surface,
                            .position = point->position,
                            .velocity = point->velocity * inherit,
                            .turn = point->turn}
                      : GpuBirthPlace{});
        }
    }
    return places;
}

void place_drops(
    const ParticleEmitter& emitter, const std::vector<SprayDrop>& drops, std::size_t room,
    EmitterClock& clock, std::vector<GpuBirthPlace>& places) {
    const std::size_t count = std::min(drops.size(), room);
    clock.dropped += drops.size() - count;
    for (std::size_t i = 0; i < count; ++i) {
        places.push_back(
            {.kind = GpuBirthKind::Drop,
             .position = drops[i].position,
             .velocity = drops[i].velocity * finite_or(emitter.drop_speed, 1)});
    }
}

GpuBirthPlace place_spawn(const ParticleSpawn& spawn) {
    const bool is_turned = spawn.axis != Vec3(0);
    return {
        .kind = is_turned ? GpuBirthKind::Turned : GpuBirthKind::Spawn,
        .position = spawn.position,
        .velocity = spawn.velocity,
        .turn = is_turned ? Quat(Vec3(0, 1, 0), spawn.axis) : Quat(1, 0, 0, 0),
        .age = spawn.age};
}

}  // namespace limn
