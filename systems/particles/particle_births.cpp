#include "systems/particles/particle_births.h"

#include "systems/particles/emitter_place.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr float kAspect = 16.0f / 9.0f;
constexpr double kMostBirths = 1e12;  // of a cause in a step or a second, so that sums stay finite
constexpr double kSlack =
    1e-5;  // of a birth: 600 per second are 10 in each step of 1/60 s, as far as floats know
constexpr double kMinDuration = 1e-3;  // [s] of an emitter that starts again

float spread(float mean, float width, Random& random) {
    return mean + width * random.uniform(-1.0f, 1.0f);
}

/// Once for all particles that it may hold: what is not used yet costs address space alone.
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

constexpr float kLeastKept = 0.37f;  // for which drag is taken back [1/e]

/// Takes a newborn back by the share `at` of a step, on the way along which gravity and drag will
/// bring it here. Otherwise all births of a step would fall as far, and jets break into clumps.
void rewind(const ParticleStep& step, float at, Vec3& position, Vec3& velocity) {
    const Vec3 now = velocity;
    const float undo_drag = step.keep == 1 ? 1 : std::pow(std::max(step.keep, kLeastKept), -at);
    velocity = step.air + (now - step.air) * undo_drag - step.gravity * (at * step.dt);
    position -= (velocity * step.old_share + now * (1 - step.old_share)) * (at * step.dt);
}

/// `ahead`: how much of the next step's time is before its birth [s].
void add_particle(
    ParticlePool& pool, const Vec3& position, const Vec3& velocity, float ahead, float life,
    std::uint32_t look) {
    if (!std::isfinite(position.x + position.y + position.z + life)) {
        return;
    }
    pool.x.push_back(position.x);
    pool.y.push_back(position.y);
    pool.z.push_back(position.z);
    pool.vx.push_back(velocity.x);
    pool.vy.push_back(velocity.y);
    pool.vz.push_back(velocity.z);
    pool.age.push_back(-ahead);
    pool.life.push_back(life);
    pool.look.push_back(look);
}

/// Each component between -1 and 1.
Vec3 random_vector(Random& random) {
    const float x = random.uniform(-1.0f, 1.0f);
    const float y = random.uniform(-1.0f, 1.0f);
    return {x, y, random.uniform(-1.0f, 1.0f)};
}

/// What is drawn for a birth.
struct Attributes {
    Vec3 local;     ///< place in the emitter's space
    Vec3 velocity;  ///< in world space
    float life;
    std::uint32_t look;
};

Attributes draw_attributes(const ParticleEmitter& emitter, const Affine& world, Random& random) {
    Attributes its{};
    its.local = sample_shape(emitter.shape, emitter.size, random);
    const bool is_radial = emitter.direction == EmitterDirection::Radial;
    const Vec3 direction = is_radial && its.local != Vec3(0)
                               ? glm::normalize(its.local)
                               : sample_cone(is_radial ? kPi : emitter.cone, random);
    const Vec3 aim = normalize_or(transform_vector(world, direction), Vec3(0, 1, 0));
    its.velocity = aim * spread(emitter.speed, emitter.speed_spread, random);
    its.life = spread(emitter.life, emitter.life_spread, random);
    its.look = random.word();
    // Last, so that whoever has none gets the same numbers as ever.
    if (emitter.size_spread != Vec3(0)) {
        its.local += emitter.size_spread * random_vector(random);
    }
    if (emitter.velocity_spread != Vec3(0)) {
        its.velocity += transform_vector(world, emitter.velocity_spread * random_vector(random));
    }
    return its;
}

/// The same scale, at another place and turned otherwise.
Affine turned_to(const Affine& world, const Vec3& position, const Quat& turn) {
    const Vec3 size = {
        glm::length(transform_vector(world, {1, 0, 0})),
        glm::length(transform_vector(world, {0, 1, 0})),
        glm::length(transform_vector(world, {0, 0, 1}))};
    return affine_from(position, turn, size);
}

double interval_of(const ParticleBurst& burst) {
    return std::max(static_cast<double>(burst.interval), 1e-3);
}
/// Number of the first repeat of a burst that is not before `begin` [s].
double first_repeat(const ParticleBurst& burst, double begin) {
    return std::max(std::ceil((begin - static_cast<double>(burst.time)) / interval_of(burst)), 0.0);
}
/// When that is, after `begin` [s].
double time_of_repeat(const ParticleBurst& burst, double repeat, double begin) {
    return static_cast<double>(burst.time) + repeat * interval_of(burst) - begin;
}

/// One piece of a step, without a restart of the emitter within it.
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
        rate = std::min(rate, kMostBirths);
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
            add(piece.offset + at, 0, std::min(std::round(asked), kMostBirths));
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
            // Of its middle: exact for straight lines.
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

float screen_share(float radius, float distance, float fov_y) {
    if (!(distance > radius)) {
        return 1;
    }
    // A disc of this radius in an image plane of height 2 tan(fov / 2).
    const float seen = radius / std::sqrt(distance * distance - radius * radius);
    const float half_height = std::tan(0.5f * fov_y);
    return std::min(kPi * seen * seen / (4.0f * half_height * half_height * kAspect), 1.0f);
}

Vec3 sample_shape(EmitterShape shape, const Vec3& size, Random& random) {
    switch (shape) {
    case EmitterShape::Point:
        break;
    case EmitterShape::Ball: {
        const float radius = std::cbrt(random.uniform());
        return size * (random.direction() * radius);
    }
    case EmitterShape::Sphere: {
        const Vec3 direction = random.direction();
        const Vec3 used = {
            size.x != 0 ? direction.x : 0, size.y != 0 ? direction.y : 0,
            size.z != 0 ? direction.z : 0};
        return size * (used == direction ? direction : normalize_or(used, Vec3(0)));
    }
    case EmitterShape::Disc: {
        const Vec2 p = random.in_disc();
        return size * Vec3(p.x, 0, p.y);
    }
    case EmitterShape::Circle: {
        const float angle = 2.0f * kPi * random.uniform();
        return size * Vec3(std::cos(angle), 0, std::sin(angle));
    }
    case EmitterShape::Box: {
        const float x = random.uniform(-1.0f, 1.0f);
        const float y = random.uniform(-1.0f, 1.0f);
        return size * Vec3(x, y, random.uniform(-1.0f, 1.0f));
    }
    case EmitterShape::Torus: {
        const Vec2 tube = size.y * random.in_disc();
        const float angle = 2.0f * kPi * random.uniform();
        const float cosine = std::cos(angle);
        const float sine = std::sin(angle);
        return {(size.x + tube.x) * cosine, tube.y, (size.z + tube.x) * sine};
    }
    }
    return Vec3(0);
}

Vec3 sample_cone(float cone, Random& random) {
    const float lowest = std::cos(std::clamp(finite_or(cone, 0), 0.0f, kPi));
    const float y = 1.0f - random.uniform() * (1.0f - lowest);
    const float angle = 2.0f * kPi * random.uniform();
    const float radius = std::sqrt(std::max(1.0f - y * y, 0.0f));
    return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

Vec3 inherited_velocity(const ParticleEmitter& emitter, const EmitterPlace& place, float dt) {
    const auto origin = [](const Affine& world) { return transform_point(world, Vec3(0)); };
    const Vec3 moved = (origin(place.now) - origin(place.before)) / dt;
    return moved * finite_or(emitter.inherit, 0);
}

void add_particles(
    const ParticleEmitter& emitter, const EmitterPlace& place, const ParticleStep& step,
    const SurfaceSource* surface, std::uint64_t seed, std::uint64_t subject,
    const std::vector<BirthRun>& births, ParticlePool& pool) {
    std::size_t count = 0;
    for (const BirthRun& run : births) {
        count += run.count;
    }
    if (count == 0) {
        return;
    }
    const Vec3 inherited = inherited_velocity(emitter, place, step.dt);
    thread_local SurfaceTable table;  // its memory is reused
    if (surface != nullptr && !fill_surface_table(*surface, table)) {
        pool.clock.dropped += count;
        return;
    }
    make_room(emitter, count, pool);
    const auto add = [&](float at) {
        Random random = attributes_random(seed, subject, pool.clock.born++);
        Affine world = mix_places(place, at);
        Vec3 added = inherited;
        SurfacePoint point;
        if (surface != nullptr) {
            Random places = surface_random(seed, subject, pool.clock.born - 1);
            point = surface_point(*surface, table, pool.clock.born - 1, at, step.dt, places);
            world = turned_to(world, point.position, point.turn);
            added = point.velocity * finite_or(surface->surface->inherit, 0);
        }
        Attributes its = draw_attributes(emitter, world, random);
        if (surface != nullptr && surface->surface->on == BirthSurface::Pieces) {
            its.look = (its.look & ~kPieceMask) | point.piece;
        }
        Vec3 velocity = its.velocity + added;
        Vec3 position = transform_point(world, its.local);
        rewind(step, at, position, velocity);
        add_particle(pool, position, velocity, at * step.dt, its.life, its.look);
    };
    for (const BirthRun& run : births) {
        for (std::uint32_t i = 0; i < run.count; ++i) {
            add(run.at(i));
        }
    }
}

void add_spawns(
    const ParticleEmitter& emitter, const Affine& world, const std::vector<ParticleSpawn>& spawns,
    std::uint64_t seed, std::uint64_t subject, ParticlePool& pool) {
    make_room(emitter, spawns.size(), pool);
    for (const ParticleSpawn& spawn : spawns) {
        Random random = attributes_random(seed, subject, pool.clock.born++);
        const Affine place = spawn.axis == Vec3(0)
                                 ? world
                                 : turned_to(world, Vec3(0), Quat(Vec3(0, 1, 0), spawn.axis));
        const Attributes its = draw_attributes(emitter, place, random);
        const Vec3 velocity = its.velocity + spawn.velocity;
        const Vec3 position =
            spawn.position + transform_vector(place, its.local) + velocity * spawn.age;
        add_particle(pool, position, velocity, -spawn.age, its.life, its.look);
    }
}

void add_drops(
    const ParticleEmitter& emitter, const std::vector<SprayDrop>& drops, const ParticleStep& step,
    std::uint64_t seed, std::uint64_t subject, ParticlePool& pool) {
    const std::size_t room = birth_room(emitter, pool.size(), pool.clock);
    const std::size_t count = std::min(drops.size(), room);
    pool.clock.dropped += drops.size() - count;
    make_room(emitter, count, pool);
    for (std::size_t i = 0; i < count; ++i) {
        Random random = attributes_random(seed, subject, pool.clock.born++);
        const float at = random.uniform();
        const float life = spread(emitter.life, emitter.life_spread, random);
        Vec3 velocity = drops[i].velocity * finite_or(emitter.drop_speed, 1);
        Vec3 position = drops[i].position;
        rewind(step, at, position, velocity);
        add_particle(pool, position, velocity, at * step.dt, life, random.word());
    }
}

}  // namespace limn
