#include "systems/particles/trail_system.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: engine.trail

namespace limn {
namespace {

constexpr float kMaxStepPoints = 2000;  // of one step; more are a jump
constexpr float kSharpTurn = 0.5f;      // cosine of the turn beyond which a path is straightened

bool is_finite_point(const TrailPoint& point) {
    const Vec3 sum = point.position + point.span;
    return std::isfinite(sum.x + sum.y + sum.z);
}

/// Points of a strand: 1.5 times as many as its length needs, to leave room for those of a step.
std::uint32_t capacity_of(const Trail& trail) {
    const float points = 1.5f * trail.length / trail_spacing(trail);
    return points > 0 ? static_cast<std::uint32_t>(std::min(points, 1500.0f)) + 8 : 8;
}

void push_point(TrailState& state, TrailStrand& strand, const TrailPoint& point) {
    Ring<TrailPoint> points = trail_points(state, strand);
    if (points.is_full()) {
        points.pop_front();
    }
    points.push_back(point);
    ++strand.number;
}

TrailPoint mix_points(const TrailPoint& a, const TrailPoint& b, float t) {
    return {a.position + (b.position - a.position) * t, 0, a.span + (b.span - a.span) * t};
}

/// Adds points along the segment from `a` to `b`, each `spacing` away from the one before it: where
/// the segment leaves the sphere of that radius around the last point.
void walk(
    TrailState& state, TrailStrand& strand, float spacing, const TrailPoint& a, const TrailPoint& b,
    float age, float duration) {
    const Vec3 segment = b.position - a.position;
    const float length2 = glm::dot(segment, segment);
    for (float from = 0; length2 > 0;) {
        const Vec3 last = trail_point(state, strand, strand.count - 1).position;
        const Vec3 offset = a.position - last;
        // |offset + t segment| = spacing, the larger root.
        const float along = glm::dot(offset, segment);
        const float inside = spacing * spacing - glm::dot(offset, offset);
        const float discriminant = along * along + length2 * inside;
        const float t = discriminant >= 0 ? (std::sqrt(discriminant) - along) / length2 : 2.0f;
        if (!(t >= from && t <= 1)) {
            return;
        }
        TrailPoint point = mix_points(a, b, t);
        point.age = age + (1 - t) * duration;
        push_point(state, strand, point);
        from = std::max(t, std::nextafter(from, 2.0f));
    }
}

TrailPoint trail_position(const Affine& world, const Trail& trail) {
    return {transform_point(world, Vec3(0)), 0, transform_vector(world, trail.span)};
}

void follow_entity(
    TrailState& state, const Trail& trail, const Affine& now, const Affine& previous, float dt) {
    const TrailPoint to = trail_position(now, trail);
    TrailPoint from = trail_position(previous, trail);
    from.age = dt;
    TrailStrand* strand = state.strands.empty() ? nullptr : &state.strands.back();
    if (strand != nullptr && strand->live && trail.active
        && (strand->head.position == from.position)) {
        if (extend_strand(state, *strand, trail, to, dt)) {
            return;
        }
    } else if (strand != nullptr) {
        strand->live = false;  // a Teleport, or no longer active
    }
    if (trail.active && is_finite_point(to)) {
        TrailStrand& fresh = add_strand(state, is_finite_point(from) ? from : to);
        if (!extend_strand(state, fresh, trail, to, dt)) {
            add_strand(state, to);
        }
    }
}

/// Finds the particles of the strands by their random bits: both are in the order of their births.
void follow_particles(TrailState& state, const Trail& trail, const ParticlePool& pool, float dt) {
    const std::size_t known = state.strands.size();
    std::size_t live = 0;
    for (const TrailStrand& strand : state.strands) {
        live += strand.live ? 1 : 0;
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const TrailPoint to = {{pool.x[i], pool.y[i], pool.z[i]}, 0, Vec3(0)};
        const Vec3 velocity = {pool.vx[i], pool.vy[i], pool.vz[i]};
        std::size_t found = next;
        while (found < known
               && !(state.strands[found].live && state.strands[found].key == pool.look[i])) {
            ++found;
        }
        if (found < known) {
            for (; next < found; ++next) {
                state.strands[next].live = false;  // its particle has died
            }
            ++next;
            extend_strand(state, state.strands[found], trail, to, dt);
        } else if (trail.active && live < trail.count && pool.age[i] <= dt) {
            const float age = std::min(pool.age[i], dt);
            TrailStrand& fresh = add_strand(state, {to.position - velocity * age, age, Vec3(0)});
            fresh.key = pool.look[i];
            extend_strand(state, fresh, trail, to, age);
            ++live;
        }
    }
    for (; next < known; ++next) {
        state.strands[next].live = false;
    }
}

}  // namespace

void add_trail_states(Query<const Trail, Without<TrailState>> trails, Commands commands) {
    trails.each([&](Entity entity, const Trail&) { commands.add(entity, TrailState{}); });
}

TrailStrand& add_strand(TrailState& state, const TrailPoint& start) {
    if (state.free_slots.empty()) {
        state.free_slots.push_back(
            static_cast<std::uint32_t>(state.points.size() / state.capacity));
        state.points.resize(state.points.size() + state.capacity);
    }
    TrailStrand strand;
    strand.slot = state.free_slots.back();
    state.free_slots.pop_back();
    strand.head = strand.previous = start;
    strand.before = start.position;
    strand.head.age = 0;
    push_point(state, strand, start);
    state.strands.push_back(strand);
    return state.strands.back();
}

bool extend_strand(
    TrailState& state, TrailStrand& strand, const Trail& trail, const TrailPoint& to, float dt) {
    const TrailPoint from = strand.head;
    const float spacing = trail_spacing(trail);
    const Vec3 path = to.position - from.position;
    const float length = glm::length(path);
    if (!is_finite_point(to) || !(length <= std::min(trail.jump, kMaxStepPoints * spacing))) {
        strand.live = false;
        return false;
    }
    const Vec3 came = from.position - strand.before;
    const bool smooth = glm::dot(came, path) > kSharpTurn * glm::length(came) * length;
    const Vec3 bend = smooth ? 0.5f * (path - came) : Vec3(0);
    const int parts = std::clamp(static_cast<int>(2 * length / spacing), 1, 64);
    TrailPoint a = from;
    for (int i = 1; i <= parts; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(parts);
        TrailPoint b = mix_points(from, to, t);
        b.position -= bend * (t * (1 - t));
        walk(state, strand, spacing, a, b, (1 - t) * dt, dt / static_cast<float>(parts));
        a = b;
    }
    strand.before = from.position;
    strand.previous = from;
    strand.head = {to.position, 0, to.span};
    return true;
}

void age_trail(TrailState& state, const Trail& trail, float dt) {
    const float spacing = trail_spacing(trail);
    for (TrailStrand& strand : state.strands) {
        strand.previous = strand.head;
        strand.head.age += strand.live ? 0 : dt;
        Ring<TrailPoint> points = trail_points(state, strand);
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            points[i].age += dt;
        }
        const auto beyond = [&](std::uint32_t i) {
            const float behind = static_cast<float>(points.size() - 1 - i) * spacing;
            return points[i].age > trail.life + dt || behind > trail.length;
        };
        while (points.size() >= 2 && beyond(1)) {
            points.pop_front();
        }
    }
    std::erase_if(state.strands, [&](const TrailStrand& strand) {
        const bool gone = !strand.live && strand.head.age > trail.life + dt;
        if (gone) {
            state.free_slots.push_back(strand.slot);
        }
        return gone;
    });
}

void update_trails(
    Query<const Trail, TrailState> trails, Query<const ParticlePool> pools,
    Query<const WorldTransform, const PreviousWorldTransform> transforms,
    Res<const FrameTime> time) {
    trails.each([&](Entity entity, const Trail& trail, TrailState& state) {
        if (trail.path == TrailPath::Births) {
            return;
        }
        if (state.capacity != capacity_of(trail)) {
            state = {};
            state.capacity = capacity_of(trail);
        }
        age_trail(state, trail, time->step);
        const Entity followed = trail.emitter == Entity{} ? entity : trail.emitter;
        if (trail.path == TrailPath::Particles) {
            if (const auto* const pool = pools.find<const ParticlePool>(followed)) {
                follow_particles(state, trail, *pool, time->step);
            }
        } else if (const auto* const now = transforms.find<const WorldTransform>(followed)) {
            const Affine& previous = transforms.find<const PreviousWorldTransform>(followed)->world;
            follow_entity(state, trail, now->world, previous, time->step);
        }
    });
}

}  // namespace limn
