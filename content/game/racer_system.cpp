#include "content/game/racer_system.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {
namespace {

constexpr float kSteerRate = 1.6f;     // turn rate at full lock [rad/s]
constexpr float kStraighten = 2.5f;    // rate of alignment with the track without steering [1/s]
constexpr float kDrift = 0.25f;        // fraction of a bend that an unsteered racer does not follow
constexpr float kMaxHeading = 0.6f;    // [rad]
constexpr float kBrake = 2.5f;         // relative to the acceleration
constexpr float kBoost = 2.0f;         // relative to the acceleration
constexpr float kBoostSeconds = 4.0f;  // duration of a full store of energy
constexpr float kRefillSeconds = 12.0f;  // from empty to full
constexpr float kWallLoss = 0.6f;        // relative loss of speed while scraping a wall [1/s]
constexpr float kLean = 0.012f;          // per lateral acceleration [rad/(m/s^2)]
constexpr float kMaxLean = 0.7f;         // [rad]
constexpr float kLeanRate = 6.0f;        // [1/s]
constexpr float kLookAhead = 0.9f;       // preview time of the autopilot [s]
constexpr float kOvertakeGap = 35.0f;    // distance behind another racer to start overtaking [m]
constexpr float kRacerWidth = 3.2f;      // lateral distance between two side by side [m]

/// Fraction of an exponential approach at `rate` [1/s] that is completed in `dt` [s].
float approach_fraction(float rate, float dt) {
    return 1.0f - std::exp(-rate * dt);
}

const PathData* find_track(const Assets& assets, PathId id) {
    return id.index < assets.paths.size() ? &assets.paths[id.index] : nullptr;
}

/// A racer at the start of the step, so that results do not depend on the order of updates.
struct RacerSnapshot {
    PathId track;
    double distance;
    float lateral;
    float speed;
};

/// Signed distance from `from` to `to` along the track, in the shorter direction on a closed one.
double gap(const PathData& track, double from, double to) {
    const double length = track.length();
    return track.closed ? std::remainder(to - from, length) : to - from;
}

Driving run_autopilot(
    const Racer& settings, const RacerState& racer, const PathData& track,
    const std::vector<RacerSnapshot>& snapshots, std::size_t self) {
    // The sharpest bend within a second limits the speed.
    float bend = 0.0f;
    for (const float seconds : {0.25f, 0.6f, 1.0f}) {
        const double there =
            racer.distance + static_cast<double>(seconds * std::max(racer.speed, 5.0f));
        bend = std::max(bend, std::abs(path_curvature(track, there)));
    }
    const float wanted = std::min(
        settings.top_speed, bend > 0.0f ? std::sqrt(settings.grip / bend) : settings.top_speed);
    float lane = settings.lane;
    for (std::size_t i = 0; i < snapshots.size(); ++i) {
        const RacerSnapshot& other = snapshots[i];
        const double ahead = gap(track, racer.distance, other.distance);
        if (i == self || !(other.track == settings.track) || ahead <= 0.0
            || ahead > static_cast<double>(kOvertakeGap) || other.speed > racer.speed + 1.0f
            || std::abs(other.lateral - lane) > kRacerWidth) {
            continue;
        }
        // Pass on the side with more room.
        lane = other.lateral + (other.lateral > 0.0f ? -kRacerWidth : kRacerWidth);
    }
    const float room = std::max(settings.half_width - 1.5f, 0.0f);
    lane = std::clamp(lane, -room, room);
    const float ahead = std::max(racer.speed * kLookAhead, 4.0f);
    const float aim = std::atan2(lane - racer.lateral, ahead);
    // Steering that compensates the drift in the current bend.
    const float hold = -kDrift * path_curvature(track, racer.distance) * racer.speed / kSteerRate;
    return {
        std::clamp((wanted - racer.speed) * 0.25f, -1.0f, 1.0f),
        std::clamp((aim - racer.heading) * 4.0f + hold, -1.0f, 1.0f), false};
}

void write_transform(
    const Racer& settings, const RacerState& racer, const PathData& track, Transform& transform) {
    const PathFrame frame = path_frame_at(track, racer.distance);
    transform =
        transform_on_path(frame, {racer.lateral, settings.height, 0}, false, transform.scale);
    // +x is to the left: turning right is negative about +y, leaning right positive about +z.
    transform.rotation = transform.rotation * glm::angleAxis(-racer.heading, Vec3(0, 1, 0))
                         * glm::angleAxis(racer.lean, Vec3(0, 0, 1));
}

}  // namespace

void step_racer(
    const Racer& settings, const PathData& track, const Driving& driving, float dt,
    RacerState& racer) {
    // Boosts last while there is energy, which recharges when they end.
    racer.boosting = driving.boost && racer.energy > 0.0f;
    racer.energy = std::clamp(
        racer.energy + dt * (racer.boosting ? -1.0f / kBoostSeconds : 1.0f / kRefillSeconds), 0.0f,
        1.0f);
    const float limit = std::max(racer.boosting ? settings.boost_speed : settings.top_speed, 1e-3f);
    const float push = settings.acceleration * (racer.boosting ? kBoost : 1.0f);
    const float throttle = racer.boosting ? 1.0f : driving.throttle;
    const float drag = settings.acceleration * (racer.speed / limit) * (racer.speed / limit)
                       * (racer.boosting ? kBoost : 1.0f);
    const float brakes = throttle < 0.0f ? kBrake * throttle * settings.acceleration : 0.0f;
    racer.speed =
        std::max(racer.speed + dt * (std::max(throttle, 0.0f) * push + brakes - drag), 0.0f);

    const float curvature = path_curvature(track, racer.distance);
    // The inside of a bend is shorter; curvature is positive to the left, lateral to the right.
    const float stretch = std::max(1.0f + curvature * racer.lateral, 0.1f);
    const float along = racer.speed * std::cos(racer.heading) / stretch;
    const float turn = driving.steer * kSteerRate;
    racer.heading += dt * (turn + kDrift * curvature * along);
    racer.heading -=
        racer.heading * approach_fraction(kStraighten * (1.0f - std::abs(driving.steer)), dt);
    racer.heading = std::clamp(racer.heading, -kMaxHeading, kMaxHeading);

    racer.distance += static_cast<double>(along * dt);
    racer.lateral += racer.speed * std::sin(racer.heading) * dt;
    if (std::abs(racer.lateral) > settings.half_width) {
        racer.lateral = std::clamp(racer.lateral, -settings.half_width, settings.half_width);
        racer.heading = 0.0f;
        racer.speed -= racer.speed * approach_fraction(kWallLoss, dt);
    }
    if (track.closed) {
        const double length = track.length();
        racer.distance -= std::floor(racer.distance / length) * length;
    } else {
        racer.distance = std::clamp(racer.distance, 0.0, static_cast<double>(track.length()));
    }
    const float sideways = racer.speed * (turn - curvature * along);
    const float lean = std::clamp(kLean * sideways, -kMaxLean, kMaxLean);
    racer.lean += (lean - racer.lean) * approach_fraction(kLeanRate, dt);
}

void add_racer_states(Query<const Racer, Without<RacerState>> racers, Commands commands) {
    racers.each([&](Entity entity, const Racer& racer) {
        commands.add(entity, RacerState{.distance = racer.distance, .speed = racer.speed});
    });
}

void update_racers(
    Query<const Racer, RacerState, Transform> racers, Res<const Assets> assets,
    Res<const Input> input, Res<const FrameTime> time) {
    const Driving keys = {
        action_axis(*input, "accelerate", "brake"),
        action_axis(*input, "steer_right", "steer_left"), action_value(*input, "boost") > 0};
    const bool any = keys.throttle != 0 || keys.steer != 0 || keys.boost;
    std::vector<RacerSnapshot> snapshots;
    racers.each([&](const Racer& settings, const RacerState& racer, const Transform&) {
        snapshots.push_back({settings.track, racer.distance, racer.lateral, racer.speed});
    });
    std::size_t self = 0;
    racers.each([&](const Racer& settings, RacerState& racer, Transform& transform) {
        if (const PathData* track = find_track(*assets, settings.track)) {
            racer.player_active = racer.player_active || (settings.player && any);
            const Driving driving = racer.player_active
                                        ? keys
                                        : run_autopilot(settings, racer, *track, snapshots, self);
            step_racer(settings, *track, driving, time->step, racer);
            write_transform(settings, racer, *track, transform);
        }
        ++self;
    });
}

void place_racers(
    Query<const Racer, const RacerState, Transform> racers, Res<const Assets> assets) {
    racers.each([&](const Racer& settings, const RacerState& racer, Transform& transform) {
        if (const PathData* track = find_track(*assets, settings.track)) {
            write_transform(settings, racer, *track, transform);
        }
    });
}

void update_speed_views(
    Query<const SpeedView, Camera> views, Query<const Racer, const RacerState> racers,
    OptionalRes<MotionBlur> blur) {
    views.each([&](const SpeedView& view, Camera& camera) {
        const auto* const settings = racers.find<const Racer>(view.racer);
        const auto* const racer = racers.find<const RacerState>(view.racer);
        if (settings == nullptr || racer == nullptr) {
            return;
        }
        const float speed_fraction =
            std::clamp(racer->speed / std::max(settings->boost_speed, 1e-3f), 0.0f, 1.0f);
        camera.fov_y = glm::mix(view.slow_fov, view.fast_fov, speed_fraction);
        if (camera.active && blur) {
            blur->shutter = glm::mix(view.slow_shutter, view.fast_shutter, speed_fraction);
        }
    });
}

}  // namespace limn
