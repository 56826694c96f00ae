#include "systems/racer_system.h"

#include "ecs/components/camera.h"
#include "ecs/components/motion_blur.h"
#include "ecs/world.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {
namespace {

constexpr float kSteerRate = 1.6f;       // [rad/s] of a nose at full lock
constexpr float kStraighten = 2.5f;      // [1/s] back toward the track's direction, hands off
constexpr float kDrift = 0.25f;          // of a bend that the keel does not follow by itself
constexpr float kMostHeading = 0.6f;     // [rad]
constexpr float kBrake = 2.5f;           // of the acceleration
constexpr float kBoost = 2.0f;           // of the acceleration
constexpr float kBoostSeconds = 4.0f;    // that a full store lasts
constexpr float kRefillSeconds = 12.0f;  // from empty to full
constexpr float kWallLoss = 0.6f;        // [1/s] of the speed, scraping along
constexpr float kLean = 0.012f;          // [rad] for each [m/s^2] sideways
constexpr float kMostLean = 0.7f;        // [rad]
constexpr float kLeanRate = 6.0f;        // [1/s]
constexpr float kLookAhead = 0.9f;       // [s] at which a driver looks
constexpr float kPassWithin = 35.0f;     // [m] behind another a driver gives way
constexpr float kRacerWidth = 3.2f;      // [m] between two side by side

/// Share of the way gone in `dt` at `rate` [1/s]: the same after the same time, whatever the step.
float share_of(float rate, float dt) {
    return 1.0f - std::exp(-rate * dt);
}

const PathData* find_track(const Assets& assets, PathId id) {
    return id.index < assets.paths.size() ? &assets.paths[id.index] : nullptr;
}

/// Where each racer was when the step began: none sees another half moved.
struct Place {
    PathId track;
    double distance;
    float lateral;
    float speed;
};

/// How far `to` is ahead of `from`, the short way round.
double gap(const PathData& track, double from, double to) {
    const double length = track.length();
    return track.closed ? std::remainder(to - from, length) : to - from;
}

Driving drive_itself(
    const Racer& racer, const PathData& track, const std::vector<Place>& places, std::size_t self) {
    // The sharpest bend that is near decides.
    float bend = 0.0f;
    for (const float seconds : {0.25f, 0.6f, 1.0f}) {
        const double there =
            racer.distance + static_cast<double>(seconds * std::max(racer.speed, 5.0f));
        bend = std::max(bend, std::abs(path_curvature(track, there)));
    }
    const float wanted =
        std::min(racer.top_speed, bend > 0.0f ? std::sqrt(racer.grip / bend) : racer.top_speed);
    float lane = racer.lane;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Place& other = places[i];
        const double ahead = gap(track, racer.distance, other.distance);
        if (i == self || !(other.track == racer.track) || ahead <= 0.0
            || ahead > static_cast<double>(kPassWithin) || other.speed > racer.speed + 1.0f
            || std::abs(other.lateral - lane) > kRacerWidth) {
            continue;
        }
        // On the side with more room.
        lane = other.lateral + (other.lateral > 0.0f ? -kRacerWidth : kRacerWidth);
    }
    const float room = std::max(racer.half_width - 1.5f, 0.0f);
    lane = std::clamp(lane, -room, room);
    const float ahead = std::max(racer.speed * kLookAhead, 4.0f);
    const float aim = std::atan2(lane - racer.lateral, ahead);
    // What holds the nose against the drift of the bend that it is in.
    const float hold = -kDrift * path_curvature(track, racer.distance) * racer.speed / kSteerRate;
    return {
        std::clamp((wanted - racer.speed) * 0.25f, -1.0f, 1.0f),
        std::clamp((aim - racer.heading) * 4.0f + hold, -1.0f, 1.0f), false};
}

void place(const Racer& racer, const PathData& track, Transform& transform) {
    const PathFrame frame = find_path_frame(track, racer.distance);
    transform = stand_on_path(frame, {racer.lateral, racer.height, 0}, false, transform.scale);
    // To the right is -y about +y, and leaning right +z ahead... +x is to the left.
    transform.rotation = transform.rotation * glm::angleAxis(-racer.heading, Vec3(0, 1, 0))
                         * glm::angleAxis(racer.lean, Vec3(0, 0, 1));
}

}  // namespace

void step_racer(Racer& racer, const PathData& track, const Driving& driving, float dt) {
    // Boosts last while there is energy, which comes back when they end.
    racer.boosting = driving.boost && racer.energy > 0.0f;
    racer.energy = std::clamp(
        racer.energy + dt * (racer.boosting ? -1.0f / kBoostSeconds : 1.0f / kRefillSeconds), 0.0f,
        1.0f);
    const float most = std::max(racer.boosting ? racer.boost_speed : racer.top_speed, 1e-3f);
    const float push = racer.acceleration * (racer.boosting ? kBoost : 1.0f);
    const float throttle = racer.boosting ? 1.0f : driving.throttle;
    const float drag = racer.acceleration * (racer.speed / most) * (racer.speed / most)
                       * (racer.boosting ? kBoost : 1.0f);
    const float brakes = throttle < 0.0f ? kBrake * throttle * racer.acceleration : 0.0f;
    racer.speed =
        std::max(racer.speed + dt * (std::max(throttle, 0.0f) * push + brakes - drag), 0.0f);

    const float curvature = path_curvature(track, racer.distance);
    // The inside of a bend is shorter; curvature is to the left, lateral to the right.
    const float stretch = std::max(1.0f + curvature * racer.lateral, 0.1f);
    const float along = racer.speed * std::cos(racer.heading) / stretch;
    const float turn = driving.steer * kSteerRate;
    racer.heading += dt * (turn + kDrift * curvature * along);
    racer.heading -= racer.heading * share_of(kStraighten * (1.0f - std::abs(driving.steer)), dt);
    racer.heading = std::clamp(racer.heading, -kMostHeading, kMostHeading);

    racer.distance += static_cast<double>(along * dt);
    racer.lateral += racer.speed * std::sin(racer.heading) * dt;
    if (std::abs(racer.lateral) > racer.half_width) {
        racer.lateral = std::clamp(racer.lateral, -racer.half_width, racer.half_width);
        racer.heading = 0.0f;
        racer.speed -= racer.speed * share_of(kWallLoss, dt);
    }
    if (track.closed) {
        const double length = track.length();
        racer.distance -= std::floor(racer.distance / length) * length;
    } else {
        racer.distance = std::clamp(racer.distance, 0.0, static_cast<double>(track.length()));
    }
    const float sideways = racer.speed * (turn - curvature * along);
    const float lean = std::clamp(kLean * sideways, -kMostLean, kMostLean);
    racer.lean += (lean - racer.lean) * share_of(kLeanRate, dt);
}

void update_racers(
    Query<Racer, Transform> racers, Res<const Assets> assets, Res<const Input> input,
    Res<const FrameTime> time) {
    std::vector<Place> places;
    racers.each([&](const Racer& racer, const Transform&) {
        places.push_back({racer.track, racer.distance, racer.lateral, racer.speed});
    });
    std::size_t self = 0;
    racers.each([&](Racer& racer, Transform& transform) {
        const PathData* track = find_track(*assets, racer.track);
        if (track != nullptr) {
            const bool any = input->move != Vec3(0) || input->fast;
            racer.taken = racer.taken || (racer.player && any);
            const Driving driving = racer.taken ? Driving{input->move.z, input->move.x, input->fast}
                                                : drive_itself(racer, *track, places, self);
            step_racer(racer, *track, driving, time->step);
            place(racer, *track, transform);
        }
        ++self;
    });
}

void place_racers(Query<Racer, Transform> racers, Res<const Assets> assets) {
    racers.each([&](const Racer& racer, Transform& transform) {
        if (const PathData* track = find_track(*assets, racer.track)) {
            place(racer, *track, transform);
        }
    });
}

void update_speed_views(World& world) {
    auto* const blur = world.find_resource<MotionBlur>();
    world.query<const SpeedView, Camera>().each([&](const SpeedView& view, Camera& camera) {
        const auto* const racer = world.find<Racer>(view.racer);
        if (racer == nullptr) {
            return;
        }
        const float share =
            std::clamp(racer->speed / std::max(racer->boost_speed, 1e-3f), 0.0f, 1.0f);
        camera.fov_y = glm::mix(view.slow_fov, view.fast_fov, share);
        if (camera.active && blur != nullptr) {
            blur->shutter = glm::mix(view.slow_shutter, view.fast_shutter, share);
        }
    });
}

}  // namespace limn
