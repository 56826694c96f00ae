#include "systems/env_probe_system.h"

#include <glm/geometric.hpp>

// Techniques: env.update-policy

namespace limn {

namespace {

constexpr std::uint64_t kFaces = 6;

bool is_capture_due(const EnvProbe& probe, const Vec3& position, const EnvProbeState& state) {
    const bool is_period_over =
        state.frames_since_capture >= static_cast<std::uint32_t>(probe.period);
    // Tolerates rounding: a distance equal to the threshold must not count as more.
    const bool moved = glm::distance(position, state.capture_position) > probe.threshold * 1.00001f;
    switch (probe.update) {
    case ProbeUpdate::Once:
        return false;
    case ProbeUpdate::Period:
        return is_period_over;
    case ProbeUpdate::Movement:
        return moved;
    case ProbeUpdate::Either:
        break;
    }
    return is_period_over || moved;
}

}  // namespace

void step_env_probe(const EnvProbe& probe, const Vec3& position, EnvProbeState& state) {
    if (state.faces % kFaces != 0) {
        ++state.faces;  // the next face of a capture in progress
        ++state.frames_since_capture;
        return;
    }
    ++state.frames_since_capture;
    const bool first = state.faces == 0;
    if (first || is_capture_due(probe, position, state)) {
        state.faces += probe.face_by_face && !first ? 1 : kFaces;
        state.capture_position = position;
        state.frames_since_capture = 0;
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
