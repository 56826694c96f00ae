#include "systems/particles/particle_contacts.h"

#include "systems/particles/particle_kernels.h"
#include "systems/particles/particle_motion.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace limn {
namespace {

constexpr float kWaterSkin = 1e-3f;  // distance above water of what bounces off or sticks [m]

/// A particle of a block that enters water, unless it hits something solid before.
struct Entry {
    std::uint32_t particle = 0;  ///< within the block
    WaterContact contact;
};

/// A block of particles in this step: where they began, and where they are.
struct Paths {
    std::array<float, kParticleBlock> start[3];
    std::array<std::uint8_t, kParticleBlock> marks{};
    CollidingParticles particles;

    [[nodiscard]] Vec3 from(std::size_t i) const { return {start[0][i], start[1][i], start[2][i]}; }
    [[nodiscard]] Vec3 to(std::size_t i) const {
        return {particles.x[i], particles.y[i], particles.z[i]};
    }
    [[nodiscard]] Vec3 velocity(std::size_t i) const {
        return {particles.vx[i], particles.vy[i], particles.vz[i]};
    }
    void move(std::size_t i, const Vec3& to, const Vec3& velocity) const {
        particles.x[i] = to.x;
        particles.y[i] = to.y;
        particles.z[i] = to.z;
        particles.vx[i] = velocity.x;
        particles.vy[i] = velocity.y;
        particles.vz[i] = velocity.z;
    }
};

void begin_paths(ParticlePool& pool, std::uint32_t first, std::uint32_t count, Paths& paths) {
    const auto part = [&](std::vector<float>& column) {
        return std::span(column).subspan(first, count);
    };
    const auto began = [&](int axis) {
        return std::span<const float>(paths.start[axis]).first(count);
    };
    paths.particles = {
        .x0 = began(0),
        .y0 = began(1),
        .z0 = began(2),
        .x = part(pool.x),
        .y = part(pool.y),
        .z = part(pool.z),
        .vx = part(pool.vx),
        .vy = part(pool.vy),
        .vz = part(pool.vz),
        .marks = std::span(paths.marks).first(count),
        .first = first};
    int axis = 0;
    for (const std::span<float> axis_values :
         {paths.particles.x, paths.particles.y, paths.particles.z}) {
        std::copy(axis_values.begin(), axis_values.end(), paths.start[axis++].begin());
    }
    for (std::size_t i = 0; i < count && first + i < pool.stuck.size(); ++i) {
        paths.marks[i] = pool.stuck[first + i] != 0 ? kParticleStuck : 0;
    }
}

/// Ends the paths of those that would enter water at the surface.
void stop_at_water(
    const Paths& paths, std::span<const ParticleWater> waters, std::vector<Entry>& entries) {
    for (std::uint32_t i = 0; i < paths.particles.x.size(); ++i) {
        if (paths.marks[i] != 0) {
            continue;
        }
        if (const auto contact = enter_water(waters, paths.from(i), paths.to(i))) {
            entries.push_back({i, *contact});
            paths.move(i, contact->point, paths.velocity(i));
        }
    }
}

/// The response of those that hit nothing solid before the water.
void hit_water(
    Paths& paths, const ParticleCollision& collision, const ParticleSurroundings& around, float dt,
    std::span<const Entry> entries, std::vector<ParticleHit>& hits) {
    for (const auto& [i, contact] : entries) {
        if (paths.marks[i] != 0) {
            continue;
        }
        const Vec3 velocity = paths.velocity(i);
        const auto collider =
            static_cast<std::uint32_t>(around.solid->colliders.size()) + contact.water;
        hits.push_back(
            {paths.particles.first + i, collider, contact.point, contact.normal, velocity});
        Vec3 after(0);
        if (collision.action == CollisionAction::Bounce) {
            after = respond(velocity, contact.normal, {collision.bounce, collision.friction});
        }
        const float rest = (1 - contact.fraction) * dt;
        paths.move(i, contact.point + kWaterSkin * contact.normal + rest * after, after);
        paths.marks[i] = collision.action == CollisionAction::Kill    ? kParticleKilled
                         : collision.action == CollisionAction::Stick ? kParticleStuck
                                                                      : kParticleHit;
    }
}

CollisionOptions options_of(const ParticleCollision& collision) {
    CollisionOptions options;
    options.radius = finite_or(collision.radius, 0);
    options.action = collision.action == CollisionAction::Kill    ? ContactAction::Kill
                     : collision.action == CollisionAction::Stick ? ContactAction::Stick
                                                                  : ContactAction::Bounce;
    return options;
}

}  // namespace

std::uint32_t move_colliding_particles(
    const MotionStep& motion, const ParticleCollision& collision,
    const ParticleSurroundings& around, ParticlePool& pool, std::uint32_t first,
    std::uint32_t count, std::vector<ParticleHit>& hits) {
    Paths paths;
    begin_paths(pool, first, count, paths);
    auto dead = static_cast<std::uint32_t>(move_block(motion, particle_block(pool, first, count)));
    std::vector<Entry> entries;
    stop_at_water(paths, around.waters, entries);
    collide_particles(
        paths.particles, motion.step.dt, *around.solid, {collision.bounce, collision.friction},
        options_of(collision), hits);
    hit_water(paths, collision, around, motion.step.dt, entries, hits);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t at = first + i;
        if (at < pool.stuck.size()) {
            pool.stuck[at] = (paths.marks[i] & kParticleStuck) != 0 ? 1 : 0;
        }
        if ((paths.marks[i] & kParticleKilled) != 0 && pool.age[at] < pool.life[at]) {
            pool.life[at] = pool.age[at];
            ++dead;
        }
    }
    return dead;
}

std::vector<ParticleWater>
find_particle_waters(WaterQuery& waters, const Query<const ParticleCollider>& colliders) {
    std::vector<ParticleWater> found;
    for (const WaterSurface& surface : collect_water_surfaces(waters)) {
        const auto* collider = colliders.find<const ParticleCollider>(surface.entity);
        if (collider != nullptr && collider->shape == ColliderShape::Water) {
            found.push_back(
                {surface, surface.frame.origin.y + highest_wave(surface), collider->ripple,
                 collider->ripple_radius});
        }
    }
    return found;
}

void add_ripples(
    std::span<const ParticleHit> hits, const ParticleSurroundings& around,
    Query<RippleState>& ripples) {
    const std::size_t solids = around.solid->colliders.size();
    for (const ParticleHit& hit : hits) {
        if (hit.collider < solids) {
            continue;
        }
        const ParticleWater& water = around.waters[hit.collider - solids];
        RippleState* const state = ripples.find<RippleState>(water.surface.entity);
        if (state != nullptr && water.ripple > 0) {
            state->impulses.push_back(make_ripple_impulse(water, hit.point, hit.velocity));
        }
    }
}

}  // namespace limn
