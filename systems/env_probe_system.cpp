#include "systems/env_probe_system.h"

#include <glm/geometric.hpp>

namespace limn {

namespace {

constexpr std::uint64_t kFaces = 6;

bool looks_again(const EnvProbe& probe, const Vec3& position, const EnvProbeState& state) {
    const bool in_time = state.waited >= static_cast<std::uint32_t>(probe.period);
    // Exactly the threshold is not more than it, whatever rounding makes of the difference.
    const bool moved = glm::distance(position, state.seen_from) > probe.threshold * 1.00001f;
    switch (probe.update) {
    case ProbeUpdate::Once:
        return false;
    case ProbeUpdate::Period:
        return in_time;
    case ProbeUpdate::Movement:
        return moved;
    case ProbeUpdate::Either:
        break;
    }
    return in_time || moved;
}

}  // namespace

void step_env_probe(const EnvProbe& probe, const Vec3& position, EnvProbeState& state) {
    if (state.faces % kFaces != 0) {
        ++state.faces;  // the next of a round that goes face by face
        ++state.waited;
        return;
    }
    ++state.waited;
    const bool first = state.faces == 0;
    if (first || looks_again(probe, position, state)) {
        state.faces += probe.face_by_face && !first ? 1 : kFaces;
        state.seen_from = position;
        state.waited = 0;
    }
}

void add_env_probe_states(Query<const EnvProbe, Without<EnvProbeState>> probes, Commands commands) {
    probes.each([&](Entity entity, const EnvProbe&) { commands.add(entity, EnvProbeState{}); });
}

void update_env_probes(Query<const EnvProbe, const WorldTransform, EnvProbeState> probes) {
    probes.each([](const EnvProbe& probe, const WorldTransform& at, EnvProbeState& state) {
        const auto& row = at.world.row;
        step_env_probe(probe, {row[0].w, row[1].w, row[2].w}, state);
    });
}

}  // namespace limn
