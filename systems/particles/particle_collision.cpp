#include "systems/particles/particle_collision.h"

#include "ecs/base/check.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

// Techniques: particle.collision-loop, particle.penetration-guard, particle.plane-response

namespace limn {

namespace {

constexpr std::size_t kCollisionBlock = 512;  // particles per broad phase

/// What a particle may hit; `bounds` is empty if they are not known.
struct Obstacles {
    std::span<const Collider> colliders;
    std::span<const ColliderBounds> bounds;
};

struct Step {
    Vec3 from;
    Vec3 to;
    Vec3 velocity;
    float dt;
    float radius;
};

struct NumberedContact {
    Contact contact;
    std::uint32_t collider;
};

bool is_far_from_obstacle(
    const Obstacles& obstacles, std::size_t i, const Vec3& from, const Vec3& to, float radius,
    float skin) {
    return !obstacles.bounds.empty() && !may_touch(obstacles.bounds[i], from, to, radius, skin);
}

/// The first contact with any collider.
std::optional<NumberedContact>
nearest_contact(const Obstacles& obstacles, const Vec3& from, const Vec3& to, float radius) {
    std::optional<NumberedContact> nearest;
    for (std::size_t i = 0; i < obstacles.colliders.size(); ++i) {
        if (is_far_from_obstacle(obstacles, i, from, to, radius, 0)) {
            continue;
        }
        const std::optional<Contact> contact =
            first_contact(obstacles.colliders[i], from, to, radius);
        if (contact && (!nearest || contact->fraction < nearest->contact.fraction)) {
            nearest = {*contact, static_cast<std::uint32_t>(i)};
        }
    }
    return nearest;
}

/// Moves to `to` if no collider is in between.
void move_if_clear(Vec3& position, const Vec3& to, const Obstacles& obstacles, float radius) {
    if (!nearest_contact(obstacles, position, to, radius)) {
        position = to;
    }
}

/// Calls hit(collider, point, normal, velocity) at each hit, before it changes the velocity.
template <typename Hit>
CollisionResult follow(
    const Step& step, const Obstacles& obstacles, const SurfaceResponse& response,
    const CollisionOptions& options, Hit hit) {
    CollisionResult now = {.position = step.from, .velocity = step.velocity};
    if (!is_finite(step.from) || !is_finite(step.to)) {
        now.velocity = Vec3(0);
        return now;
    }
    const bool stops = options.action != ContactAction::Bounce;
    const float skin = skin_of(step.from, step.to, options.skin);
    Vec3 to = step.to;

    // If it starts inside, or so near that rounding decides, it is pushed out without a bounce.
    for (std::size_t i = 0; i < obstacles.colliders.size(); ++i) {
        if (is_far_from_obstacle(obstacles, i, now.position, now.position, step.radius, skin)) {
            continue;
        }
        const auto out =
            find_escape(obstacles.colliders[i], now.position, step.radius + 0.5f * skin);
        if (!out) {
            continue;
        }
        const bool inside = out->depth > 0.5f * skin;
        Vec3 path = to - now.position;
        move_if_clear(now.position, out->point + 0.5f * skin * out->normal, obstacles, step.radius);
        if (inside && stops) {
            hit(static_cast<std::uint32_t>(i), now.position, out->normal, now.velocity);
            ++now.contacts;
            now.velocity = Vec3(0);
            return now;
        }
        if (inside) {
            now.velocity -= std::min(glm::dot(now.velocity, out->normal), 0.0f) * out->normal;
            path -= std::min(glm::dot(path, out->normal), 0.0f) * out->normal;
        }
        to = now.position + path;
    }

    float time = step.dt;
    while (true) {
        const auto found = nearest_contact(obstacles, now.position, to, step.radius);
        if (!found) {
            now.position = to;
            break;
        }
        const Contact& contact = found->contact;
        const float length = glm::distance(now.position, to);
        move_if_clear(now.position, contact.point + skin * contact.normal, obstacles, step.radius);
        ++now.contacts;
        const float toward = -glm::dot(now.velocity, contact.normal);
        const bool rests = !(toward >= options.rest_speed);
        if (stops || !rests) {
            hit(found->collider, contact.point, contact.normal, now.velocity);
        }
        if (stops || now.contacts >= options.max_bounces || !is_finite(now.velocity)) {
            now.velocity = Vec3(0);
            break;
        }
        now.velocity = respond(
            now.velocity, contact.normal, {rests ? 0.0f : response.bounce, response.friction});
        const float left = 1 - contact.fraction;
        time *= left;
        to = now.position
             + (options.mode == CollisionOptions::Mode::Time
                    ? time * now.velocity
                    : length * left * normalize_or(now.velocity, Vec3(0)));
    }
    return now;
}

void check_sizes(const CollidingParticles& p) {
    const std::size_t count = p.x.size();
    LIMN_CHECK(p.x0.size() == count && p.y0.size() == count && p.z0.size() == count);
    LIMN_CHECK(p.y.size() == count && p.z.size() == count && p.marks.size() == count);
    LIMN_CHECK(p.vx.size() == count && p.vy.size() == count && p.vz.size() == count);
    LIMN_CHECK(p.radius.empty() || p.radius.size() == count);
}

void write(const CollidingParticles& p, std::size_t i, const Vec3& position, const Vec3& velocity) {
    p.x[i] = position.x;
    p.y[i] = position.y;
    p.z[i] = position.z;
    p.vx[i] = velocity.x;
    p.vy[i] = velocity.y;
    p.vz[i] = velocity.z;
}

Vec3 start_of(const CollidingParticles& p, std::size_t i) {
    return {p.x0[i], p.y0[i], p.z0[i]};
}

/// Particles that stopped in earlier steps stay; all other marks are cleared.
void begin_marks(const CollidingParticles& p, std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) {
        p.marks[i] &= kParticleStuck | kParticleKilled;
        if (p.marks[i] != 0) {
            write(p, i, start_of(p, i), Vec3(0));
        }
    }
}

}  // namespace

Vec3 respond(const Vec3& velocity, const Vec3& normal, const SurfaceResponse& response) {
    const Vec3 unit = normalize_or(normal, Vec3(0));
    const float speed = glm::dot(velocity, unit);
    if (!(speed < 0)) {
        return velocity;
    }
    const Vec3 across = speed * unit;
    return std::clamp(response.friction, 0.0f, 1.0f) * (velocity - across)
           - std::clamp(response.bounce, 0.0f, 1.0f) * across;
}

CollisionResult move_with_collisions(
    const Vec3& position, const Vec3& velocity, float dt, std::span<const Collider> colliders,
    const SurfaceResponse& response, const CollisionOptions& options) {
    if (!is_finite(velocity * dt) || !(dt >= 0)) {
        return {.position = position};
    }
    return follow(
        {position, position + velocity * dt, velocity, dt, options.radius}, {colliders, {}},
        response, options, [](auto&&...) {});
}

void set_colliders(ColliderSet& set, std::span<const Collider> colliders) {
    set.colliders.assign(colliders.begin(), colliders.end());
    set.bounds.clear();
    for (const Collider& collider : colliders) {
        set.bounds.push_back(find_collider_bounds(collider));
    }
}

void collide_particles(
    const CollidingParticles& particles, float dt, const ColliderSet& set,
    const SurfaceResponse& response, const CollisionOptions& options,
    std::vector<ParticleHit>& hits) {
    check_sizes(particles);
    LIMN_CHECK(set.bounds.size() == set.colliders.size());
    const CollidingParticles& p = particles;
    const ParticlePaths paths = {
        .x0 = p.x0,
        .y0 = p.y0,
        .z0 = p.z0,
        .x1 = p.x,
        .y1 = p.y,
        .z1 = p.z,
        .radius = p.radius,
        .one_radius = options.radius,
        .skin = options.skin};
    const Obstacles obstacles = {set.colliders, set.bounds};
    std::array<std::uint32_t, kCollisionBlock + kCandidatePadding> near;
    for (std::size_t first = 0; first < p.x.size(); first += kCollisionBlock) {
        const std::size_t count = std::min(kCollisionBlock, p.x.size() - first);
        begin_marks(p, first, count);
        const std::size_t near_count = find_near(paths, first, count, set.bounds, near.data());
        for (const std::uint32_t i : std::span(near).first(near_count)) {
            if (p.marks[i] != 0) {
                continue;
            }
            const Step step = {
                .from = start_of(p, i),
                .to = {p.x[i], p.y[i], p.z[i]},
                .velocity = {p.vx[i], p.vy[i], p.vz[i]},
                .dt = dt,
                .radius = p.radius.empty() ? options.radius : p.radius[i]};
            const auto add_hit = [&](std::uint32_t collider, const Vec3& point, const Vec3& normal,
                                     const Vec3& velocity) {
                p.marks[i] |= kParticleHit;
                hits.push_back({p.first + i, collider, point, normal, velocity});
            };
            const CollisionResult result = follow(step, obstacles, response, options, add_hit);
            if (p.marks[i] != 0 && options.action == ContactAction::Stick) {
                p.marks[i] |= kParticleStuck;
            }
            if (p.marks[i] != 0 && options.action == ContactAction::Kill) {
                p.marks[i] |= kParticleKilled;
            }
            write(p, i, result.position, result.velocity);
        }
    }
}

}  // namespace limn
