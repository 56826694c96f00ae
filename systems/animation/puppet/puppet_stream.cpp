#include "systems/animation/puppet/puppet_stream.h"

#include "ecs/base/check.h"
#include "ecs/base/rotation.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.puppetry

namespace limn {
namespace {

constexpr float kSpeedCutoff = 1.0f;  // of the speed that raises the cutoff [Hz]

std::span<const Quat> turns_of(const PuppetStream& stream, const PuppetPacket& packet) {
    const auto index = static_cast<std::size_t>(&packet - stream.packets.data());
    return std::span(stream.turns).subspan(index * stream.joints, stream.joints);
}

}  // namespace

void reset_stream(std::size_t packets, std::size_t joints, PuppetStream& stream) {
    LIMN_CHECK(packets >= 2);
    stream.packets.assign(packets, PuppetPacket{});
    stream.turns.assign(packets * joints, Quat(1, 0, 0, 0));
    stream.joints = static_cast<std::uint32_t>(joints);
}

void push_packet(const PuppetPacket& packet, std::span<const Quat> turns, PuppetStream& stream) {
    LIMN_CHECK(turns.size() == stream.joints);
    auto slot = std::ranges::find(stream.packets, packet.time, &PuppetPacket::time);
    if (slot == stream.packets.end()) {
        slot = std::ranges::min_element(stream.packets, {}, &PuppetPacket::time);
    }
    if (slot->time > packet.time) {
        ++stream.late;
        return;
    }
    *slot = packet;
    const auto first = static_cast<std::size_t>(slot - stream.packets.begin()) * stream.joints;
    std::ranges::copy(turns, stream.turns.begin() + static_cast<std::ptrdiff_t>(first));
}

PlayedPose play_stream(const PuppetStream& stream, double time, double now, std::span<Quat> turns) {
    const PuppetPacket* before = nullptr;
    const PuppetPacket* after = nullptr;
    for (const PuppetPacket& packet : stream.packets) {
        if (packet.time < 0 || packet.arrival > now) {
            continue;
        }
        if (packet.time <= time) {
            before = before == nullptr || packet.time > before->time ? &packet : before;
        } else {
            after = after == nullptr || packet.time < after->time ? &packet : after;
        }
    }
    PlayedPose played;
    if (before == nullptr) {
        return played;
    }
    played.packet = *before;
    played.is_valid = true;
    played.is_held = after == nullptr && before->time < time;
    const std::span<const Quat> from = turns_of(stream, *before);
    if (after == nullptr || before->time == time) {
        std::ranges::copy(from, turns.begin());
        return played;
    }
    const auto u = static_cast<float>((time - before->time) / (after->time - before->time));
    const std::span<const Quat> to = turns_of(stream, *after);
    for (std::size_t j = 0; j < turns.size(); ++j) {
        turns[j] = slerp(from[j], to[j], u);
    }
    PuppetPacket& mixed = played.packet;
    mixed.time = time;
    mixed.place = glm::mix(before->place, after->place, u);
    mixed.facing = slerp(before->facing, after->facing, u);
    for (std::size_t i = 0; i < mixed.points.size(); ++i) {
        mixed.points[i] = glm::mix(before->points[i], after->points[i], u);
    }
    return played;
}

float filter_share(float cutoff, float dt) {
    if (!(cutoff > 0)) {
        return 1;
    }
    const float r = 2 * kPi * cutoff * dt;
    return r / (r + 1);
}

void filter_turn(const Quat& input, float cutoff, float eagerness, float dt, FilteredTurn& turn) {
    const Quat way = glm::conjugate(turn.value) * to_same_hemisphere(turn.value, input);
    const float speed = dt > 0 ? 2 * glm::length(log_rotation(normalize_or_identity(way))) / dt : 0;
    turn.speed += filter_share(kSpeedCutoff, dt) * (speed - turn.speed);
    const float share = cutoff > 0 ? filter_share(cutoff + eagerness * turn.speed, dt) : 1.0f;
    turn.value = share < 1 ? slerp(turn.value, input, share) : input;
}

}  // namespace limn
