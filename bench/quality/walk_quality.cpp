#include "bench/oracles/walker_motion.h"
#include "bench/quality/characters_quality.h"
#include "ecs/base/foot_flight.h"
#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/walk/walk_pose.h"
#include "systems/animation/walk/walk_step.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

// Techniques: char.foot-flight, char.walk-cycle

namespace limn::walk_quality {
namespace {

/// Joints in double precision, in the world.
struct ExactPose {
    std::vector<glm::dvec3> places;
    std::vector<glm::dquat> turns;
};

class MeasuredWalk {
  public:
    explicit MeasuredWalk(const Walk& walk)
        : walk_(walk), skeleton_(oracle::make_walker()), body_(find_walk_body(skeleton_)) {}

    /// `time` chooses where it wants to go: ahead, then around a curve, a stop, and back.
    void step(float time, float dt) {
        MoveIntent intent;
        const float heading = time < 3 ? 0.0f : 0.7f * (time - 3);
        intent.velocity = time > 6 && time < 8 ? Vec3(0) : walk_.speed * heading_direction(heading);
        step_walk(walk_, intent, body_, std::nullopt, dt, state, transform_);
        body_.targets = find_walk_targets(body_, state, transform_);
        pose = skeleton_.rest;
        apply_walk(skeleton_, walk_, state, body_, pose);
    }

    [[nodiscard]] ExactPose exact() const {
        ExactPose exact;
        const glm::dquat root = glm::normalize(glm::dquat(transform_.rotation));
        for (std::size_t j = 0; j < pose.size(); ++j) {
            const std::int32_t parent = skeleton_.parents[j];
            const auto p = static_cast<std::size_t>(std::max(parent, 0));
            const glm::dquat outer = parent < 0 ? root : exact.turns[p];
            const glm::dvec3 origin =
                parent < 0 ? glm::dvec3(transform_.position) : exact.places[p];
            exact.places.push_back(origin + outer * glm::dvec3(pose.translations[j]));
            exact.turns.push_back(outer * glm::normalize(glm::dquat(pose.rotations[j])));
        }
        return exact;
    }

    /// A point of a foot, by its offset at rest from the ground below the ankle.
    [[nodiscard]] glm::dvec3
    foot_point(const ExactPose& exact, std::size_t side, const Vec3& offset) const {
        const WalkLeg& leg = body_.legs[side];
        // At rest, joints of this skeleton are not turned.
        return exact.places[leg.foot] + exact.turns[leg.foot] * glm::dvec3(offset - leg.ankle);
    }
    [[nodiscard]] glm::dvec3 toe(const ExactPose& exact, std::size_t side) const {
        return foot_point(exact, side, body_.legs[side].ball);
    }
    /// Height of the lower one of heel and ball above where they are in a flat foot.
    [[nodiscard]] double clearance(const ExactPose& exact, std::size_t side) const {
        const WalkLeg& leg = body_.legs[side];
        return std::min(
            foot_point(exact, side, leg.heel).y,
            toe(exact, side).y - static_cast<double>(leg.ball.y));
    }
    /// What foot_flight.h says.
    [[nodiscard]] double flight(std::size_t side) const {
        const float s = state.step / kFlightShare;
        return state.flying == side && s < 1 ? static_cast<double>(
                   0.5f * state.feet[side].height * flight_height(s, walk_.plateau))
                                             : 0.0;
    }

    WalkState state;
    LocalPose pose;

  private:
    Walk walk_;
    SkeletonData skeleton_;
    WalkBody body_;
    Transform transform_;
};

struct WalkErrors {
    double slide = 0;   ///< [mm]
    double flight = 0;  ///< [mm]
};

WalkErrors measure_feet(const Walk& walk) {
    MeasuredWalk measured(walk);
    WalkErrors errors;
    std::array<glm::dvec3, 2> prints{};
    std::array<bool, 2> was{};
    constexpr float kStep = 1.0f / 60;
    for (int i = 0; i < 60 * 12; ++i) {
        measured.step(static_cast<float>(i) * kStep, kStep);
        const ExactPose exact = measured.exact();
        for (std::size_t side = 0; side < 2; ++side) {
            const bool is_planted = measured.state.flying != side;
            const glm::dvec3 toe = measured.toe(exact, side);
            prints[side] = is_planted && was[side] ? prints[side] : toe;
            was[side] = is_planted;
            errors.slide = std::max(errors.slide, 1000 * glm::distance(toe, prints[side]));
            errors.flight = std::max(
                errors.flight,
                1000 * std::abs(measured.clearance(exact, side) - measured.flight(side)));
        }
    }
    return errors;
}

/// Largest change of a joint's speed from one step to the next [rad/s].
double largest_change(const Walk& walk, float step) {
    MeasuredWalk measured(walk);
    std::vector<Quat> before;
    std::vector<Vec3> speeds;
    double largest = 0;
    for (float time = 0; time < 12; time += step) {
        measured.step(time, step);
        speeds.resize(measured.pose.size(), Vec3(0));
        for (std::size_t j = 0; j < before.size(); ++j) {
            const Quat& now = measured.pose.rotations[j];
            const Quat turn = glm::conjugate(before[j]) * to_same_hemisphere(before[j], now);
            const Vec3 speed = 2 / step * log_rotation(normalize_or_identity(turn));
            const auto change = static_cast<double>(glm::distance(speed, speeds[j]));
            largest = time > 3 * step ? std::max(largest, change) : largest;
            speeds[j] = speed;
        }
        before = measured.pose.rotations;
    }
    return largest;
}

Status measure_walk(HeadlessRenderer& /*headless*/, QualityReport& report) {
    Walk limping;
    limping.left = {.hip = 0.3f, .knee = 0.2f, .ankle = 0.3f};
    Walk tired;
    tired.tiredness = 1;
    const std::array<std::pair<const char*, Walk>, 3> styles = {
        {{"a stroll", {}}, {"a limp", limping}, {"tired legs", tired}}};
    for (const auto& [name, walk] : styles) {
        const WalkErrors errors = measure_feet(walk);
        const std::string suffix = std::string(", ") + name;
        report.at_most("slide of planted toes" + suffix, errors.slide, 0.1, "mm");
        report.at_most(
            "height of feet against the flight curve" + suffix, errors.flight, 0.1, "mm");
        const double coarse = largest_change(walk, 1.0f / 240);
        const double fine = largest_change(walk, 1.0f / 960);
        report.at_most(
            "change of joint speeds in steps of a quarter, relative" + suffix, fine / coarse, 0.6);
    }
    return Done{};
}

const RegisterCharacterPart kWalkPart("walk", measure_walk);

}  // namespace
}  // namespace limn::walk_quality
