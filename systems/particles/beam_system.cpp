#include "systems/particles/beam_system.h"

#include "systems/particles/collider_bounds.h"

#include <cmath>
#include <optional>

namespace limn {
namespace {

Vec3 first_hit(const ColliderSet& solid, const Vec3& from, const Vec3& to) {
    float fraction = 1;
    for (std::size_t i = 0; i < solid.colliders.size(); ++i) {
        if (may_touch(solid.bounds[i], from, to, 0, 0)) {
            const std::optional<Contact> contact = first_contact(solid.colliders[i], from, to);
            fraction = contact ? std::min(fraction, contact->fraction) : fraction;
        }
    }
    return from + (to - from) * fraction;
}

bool is_finite(const Vec3& v) {
    return std::isfinite(v.x + v.y + v.z);
}

}  // namespace

void add_beam_states(Query<const Beam, Without<BeamState>> beams, Commands commands) {
    beams.each([&](Entity entity, const Beam&) { commands.add(entity, BeamState{}); });
}

void update_beams(
    Query<const Beam, const WorldTransform, BeamState> beams,
    Query<const WorldTransform> transforms, Res<const ParticleObstacles> obstacles) {
    beams.each([&](const Beam& beam, const WorldTransform& transform, BeamState& state) {
        const bool was_shown = state.shown;
        const auto* const target = transforms.find<const WorldTransform>(beam.to);
        const Vec3 axis = normalize_or(transform_vector(transform.world, {0, 0, -1}), {0, 0, -1});
        state.previous_start = state.start;
        state.previous_end = state.end;
        state.start = transform_point(transform.world, Vec3(0));
        state.end = target != nullptr ? transform_point(target->world, Vec3(0))
                                      : state.start + beam.length * axis;
        state.shown = beam.active && (target != nullptr || beam.to.is_null())
                      && is_finite(state.start) && is_finite(state.end);
        if (state.shown && target == nullptr && beam.stops) {
            state.end = first_hit(obstacles->solid, state.start, state.end);
        }
        if (!was_shown) {
            state.previous_start = state.start;
            state.previous_end = state.end;
        }
    });
}

}  // namespace limn
