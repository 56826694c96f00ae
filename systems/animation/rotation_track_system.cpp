#include "systems/animation/rotation_track_system.h"

#include "ecs/base/rotation.h"
#include "systems/animation/constant_angular_velocity.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

// Techniques: anim.constant-angular-velocity, anim.euler, anim.quat-lerp, anim.shortest-arc,
//     anim.slerp, anim.squad

namespace limn {
namespace {

/// The inner control point of each key; of the first and the last the key itself.
std::vector<Quat> squad_points(const std::vector<Quat>& keys) {
    std::vector<Quat> inner = keys;
    for (std::size_t i = 1; i + 1 < keys.size(); ++i) {
        inner[i] = squad_point(keys[i - 1], keys[i], keys[i + 1]);
    }
    return inner;
}

/// Yaw about y, pitch about x, roll about z, as in level files [rad].
Vec3 euler_angles(const Quat& q) {
    const Mat3 m = glm::mat3_cast(q);
    const float pitch = std::asin(std::clamp(-m[2].y, -1.0f, 1.0f));
    if (std::abs(m[2].y) > 0.999999f) {  // straight up or down: all of the turn is yaw
        return {std::atan2(-m[0].z, m[0].x), pitch, 0.0f};
    }
    return {std::atan2(m[2].x, m[2].z), pitch, std::atan2(m[0].y, m[1].y)};
}

Quat mix_angles(const Quat& from, const Quat& to, float u) {
    const Vec3 angles = glm::mix(euler_angles(from), euler_angles(to), u);
    return glm::angleAxis(angles.x, Vec3(0, 1, 0)) * glm::angleAxis(angles.y, Vec3(1, 0, 0))
           * glm::angleAxis(angles.z, Vec3(0, 0, 1));
}

/// Time since a loop last restarted at a rotation that differs from its last key [s]; infinite if
/// it has not.
double
seconds_since_restart(const RotationTrack& track, const RotationTrackState& state, double time) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    if (!track.loop || state.times.size() < 2) {
        return kNever;
    }
    const double duration = static_cast<double>(state.times.back() - state.times.front());
    const double played = time - static_cast<double>(state.times.front());
    const bool closes =
        std::abs(glm::dot(state.rotations.front(), state.rotations.back())) > 1.0f - 1e-6f;
    return closes || duration <= 0.0 || played < duration ? kNever : std::fmod(played, duration);
}

}  // namespace

RotationTrackState make_rotation_track(const RotationTrack& track) {
    RotationTrackState state;
    for (const RotationKey& key : track.keys) {
        state.times.push_back(key.time);
        state.rotations.push_back(normalize_or_identity(key.rotation));
    }
    align_rotations(state.rotations);
    if (track.timing == RotationTiming::EvenSpeed && state.times.size() > 1) {
        const float begin = state.times.front();
        const float duration = state.times.back() - begin;
        if (duration > 0.0f) {
            TimedRotations even = make_constant_speed(state.rotations, duration);
            state.rotations = std::move(even.rotations);
            state.times = std::move(even.times);
            for (float& time : state.times) {
                time += begin;
            }
        }
    }
    state.inner = squad_points(state.rotations);
    return state;
}

Quat rotation_at(const RotationTrack& track, const RotationTrackState& state, double time) {
    const std::vector<float>& times = state.times;
    if (times.size() < 2) {
        return times.empty() ? Quat(1, 0, 0, 0) : state.rotations.front();
    }
    const double begin = times.front();
    const double duration = static_cast<double>(times.back()) - begin;
    double t = time - begin;
    if (track.loop && duration > 0.0) {
        t -= std::floor(t / duration) * duration;
    }
    const float now = static_cast<float>(begin + std::clamp(t, 0.0, std::max(duration, 0.0)));
    const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, now);
    const auto to = static_cast<std::size_t>(after - times.begin());
    const std::size_t from = to - 1;
    const float step = times[to] - times[from];
    const float u = step > 0.0f ? std::clamp((now - times[from]) / step, 0.0f, 1.0f) : 1.0f;
    const Quat& a = state.rotations[from];
    const Quat& b = state.rotations[to];
    switch (track.method) {
    case RotationMethod::Nlerp:
        return nlerp(a, b, u);
    case RotationMethod::Squad:
        return squad(a, state.inner[from], state.inner[to], b, u);
    case RotationMethod::Euler:
        return mix_angles(a, b, u);
    case RotationMethod::Slerp:
        break;
    }
    return slerp(a, b, u);
}

void add_rotation_track_states(
    Query<const RotationTrack, Without<RotationTrackState>> tracks, Commands commands) {
    tracks.each([&](Entity entity, const RotationTrack& track) {
        commands.add(entity, make_rotation_track(track));
    });
}

void prepare_rotation_tracks(
    Query<const RotationTrack, RotationTrackState, Changed<RotationTrack>> tracks) {
    tracks.each([](const RotationTrack& track, RotationTrackState& state) {
        state = make_rotation_track(track);
    });
}

void update_rotation_tracks(
    Query<const RotationTrack, const RotationTrackState, Transform> tracks,
    Res<const FrameTime> time, OptionalRes<StepJumps> jumps) {
    tracks.par_each(
        [now = time->time](
            const RotationTrack& track, const RotationTrackState& state, Transform& transform) {
            if (!track.keys.empty()) {
                transform.rotation = rotation_at(track, state, now);
            }
        });
    const auto step = static_cast<double>(time->step);
    tracks.each([&](Entity entity, const RotationTrack& track, const RotationTrackState& state,
                    const Transform&) {
        const double since = seconds_since_restart(track, state, time->time);
        if (since < step && jumps) {
            jumps->requests.push_back({entity, static_cast<float>(1.0 - since / step)});
        }
    });
}

}  // namespace limn
