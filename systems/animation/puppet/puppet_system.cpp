#include "systems/animation/puppet/puppet_system.h"

#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/animation/puppet/puppet_stream.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

// Techniques: char.puppetry

namespace limn {
namespace {

constexpr std::size_t kMaxPackets = 256;

/// Enough packets for what is still to be played.
std::size_t stream_size(const Puppet& puppet, float step) {
    const float time = std::max(puppet.latency, 0.0f) + std::max(puppet.jitter, 0.0f);
    const float packets = std::ceil(time / std::max(step, 1e-4f)) + 4;
    return static_cast<std::size_t>(std::min(packets, static_cast<float>(kMaxPackets)));
}

/// What the link does to the packet of this step.
struct PacketFate {
    bool is_lost = false;
    float delay = 0.0f;
};

PacketFate pass_link(const Puppet& puppet, Random& random, std::span<Quat> turns) {
    PacketFate fate;
    fate.is_lost = random.uniform(0.0f, 1.0f) < puppet.loss;
    fate.delay = puppet.jitter * random.uniform(0.0f, 1.0f);
    for (Quat& turn : turns) {
        if (puppet.noise > 0) {
            const float x = random.normal();
            const float y = random.normal();
            turn = turn * exp_rotation(0.5f * puppet.noise * Vec3(x, y, random.normal()));
        }
    }
    return fate;
}

/// Moves `value` to the input by one step of the filter.
void filter_point(const Vec3& input, float cutoff, float eagerness, float dt, Vec3& value) {
    const float speed = dt > 0 ? glm::distance(input, value) / dt : 0.0f;
    const float share = cutoff > 0 ? filter_share(cutoff + eagerness * speed, dt) : 1.0f;
    value = glm::mix(value, input, share);
}

void begin_performance(
    const PuppetPacket& packet, std::span<const Quat> turns, const Transform& transform,
    PuppetState& state) {
    state.turns.resize(turns.size());
    for (std::size_t j = 0; j < turns.size(); ++j) {
        state.turns[j] = {turns[j], 0};
    }
    state.points = packet.points;
    state.place = state.first_place = packet.place;
    state.facing = state.first_facing = packet.facing;
    state.origin = transform.position;
    state.origin_facing = transform.rotation;
}

void filter_performance(
    const Puppet& puppet, const PuppetPacket& packet, std::span<const Quat> turns, float step,
    PuppetState& state) {
    for (std::size_t j = 0; j < turns.size(); ++j) {
        filter_turn(turns[j], puppet.cutoff, puppet.eagerness, step, state.turns[j]);
    }
    for (std::size_t i = 0; i < state.points.size(); ++i) {
        filter_point(packet.points[i], puppet.cutoff, puppet.eagerness, step, state.points[i]);
    }
    filter_point(packet.place, puppet.cutoff, puppet.eagerness, step, state.place);
    FilteredTurn facing = {state.facing, 0};
    filter_turn(packet.facing, puppet.cutoff, puppet.eagerness, step, facing);
    state.facing = facing.value;
}

/// As far from where it began as the performer, by the length of its legs.
void move_puppet(const PuppetState& state, float scale, Transform& transform) {
    const Quat turn = state.origin_facing * glm::conjugate(state.first_facing);
    transform.position =
        state.origin
        + turn * (scale * glm::abs(transform.scale) * (state.place - state.first_place));
    transform.rotation = normalize_or_identity(turn * state.facing);
}

/// Measures bodies that it does not know yet; false where a skeleton is missing.
bool prepare_body(
    const Assets& assets, const Skeleton& performer, const Skeleton& puppet, PuppetBody& body) {
    const std::size_t count = assets.skeletons.size();
    if (performer.skeleton.index >= count || puppet.skeleton.index >= count) {
        return false;
    }
    if (body.performer != performer.skeleton || body.puppet != puppet.skeleton) {
        measure_puppet(
            assets.skeletons[performer.skeleton.index], assets.skeletons[puppet.skeleton.index],
            body);
        body.performer = performer.skeleton;
        body.puppet = puppet.skeleton;
    }
    return true;
}

}  // namespace

void add_puppet_states(
    Query<const Puppet, const Skeleton, Without<PuppetState>> states,
    Query<const Puppet, const Skeleton, Without<PuppetBody>> bodies, Commands commands) {
    states.each([&](Entity entity, const Puppet&, const Skeleton&) {
        commands.add(entity, PuppetState{});
    });
    bodies.each(
        [&](Entity entity, const Puppet&, const Skeleton&) { commands.add(entity, PuppetBody{}); });
}

void step_puppet(
    const Puppet& puppet, const SkeletonData& skeleton, double now, float step, PuppetState& state,
    PuppetBody& body, Transform& transform) {
    body.turns.resize(state.stream.joints);
    const PlayedPose played =
        play_stream(state.stream, now - double(std::max(puppet.latency, 0.0f)), now, body.turns);
    if (!played.is_valid) {
        return;
    }
    state.stream.held += played.is_held ? 1 : 0;
    if (state.started && state.turns.size() == body.turns.size()) {
        filter_performance(puppet, played.packet, body.turns, step, state);
    } else {
        begin_performance(played.packet, body.turns, transform, state);
    }
    for (std::size_t j = 0; j < body.turns.size(); ++j) {
        body.turns[j] = state.turns[j].value;
    }
    if (puppet.moves_root) {
        move_puppet(state, body.map.scale, transform);
    }
    pose_puppet(skeleton, body.turns, state.points, std::clamp(puppet.hands, 0.0f, 1.0f), body);
    if (puppet.pin_feet && body.leg > 0) {
        const Transform performer = {.position = state.place, .rotation = state.facing};
        pin_puppet(skeleton, performer, transform, step, state, body);
    }
    state.started = true;
}

void send_performances(
    Query<const Puppet, const Skeleton, PuppetState, PuppetBody> puppets,
    Query<const Skeleton, const Pose, const Transform, Without<Puppet>> performers,
    Res<const Assets> assets, Res<const FrameTime> time, OptionalRes<const RandomSeed> seed) {
    const std::uint64_t key = seed ? seed->seed : 0;
    puppets.par_each([&, key](
                         Entity entity, const Puppet& puppet, const Skeleton& skeleton,
                         PuppetState& state, PuppetBody& body) {
        const auto* const performs = performers.find<const Skeleton>(puppet.performer);
        if (performs == nullptr || !prepare_body(*assets, *performs, skeleton, body)) {
            return;
        }
        const std::size_t joints = assets->skeletons[performs->skeleton.index].joints.size();
        if (state.stream.joints != joints || state.stream.packets.empty()) {
            reset_stream(stream_size(puppet, time->step), joints, state.stream);
        }
        const Pose& pose = *performers.find<const Pose>(puppet.performer);
        if (pose.joints.size() != joints) {
            return;
        }
        const Transform& at = *performers.find<const Transform>(puppet.performer);
        PuppetPacket packet = {.time = time->time, .place = at.position, .facing = at.rotation};
        body.turns.resize(joints);
        read_performer(body, pose.joints, body.turns, packet.points);
        Random random(key, entity.bits(), name_hash("send_performances"), time->frame);
        const PacketFate fate = pass_link(puppet, random, body.turns);
        packet.arrival = packet.time + double(fate.delay);
        if (!fate.is_lost) {
            push_packet(packet, body.turns, state.stream);
        }
    });
}

void update_puppets(
    Query<const Puppet, const Skeleton, PuppetState, PuppetBody, Transform> puppets,
    Query<const Skeleton, Without<Puppet>> performers, Res<const Assets> assets,
    Res<const FrameTime> time) {
    puppets.par_each([&](const Puppet& puppet, const Skeleton& skeleton, PuppetState& state,
                         PuppetBody& body, Transform& transform) {
        const auto* const performs = performers.find<const Skeleton>(puppet.performer);
        if (performs != nullptr && prepare_body(*assets, *performs, skeleton, body)) {
            step_puppet(
                puppet, assets->skeletons[skeleton.skeleton.index], time->time, time->step, state,
                body, transform);
        }
    });
}

}  // namespace limn
