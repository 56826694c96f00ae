#include "bench/oracles/walker_motion.h"
#include "bench/quality/characters_quality.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/motion_match.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/walk.h"
#include "ecs/world.h"
#include "systems/animation/matching/match_root.h"
#include "systems/animation/walk/walk_body.h"
#include "systems/animation/walk/walk_system.h"
#include "systems/update_world.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

// Techniques: char.blend, char.motion-select

namespace limn::motion_match_quality {
namespace {

constexpr float kFrame = 1.0f / 60;
constexpr float kShortFrame = 1.0f / 1920;  ///< so short that accelerations do not count [s]
constexpr float kCourseTime = 40;           ///< [s]
constexpr int kFrames = 60 * 40;
const Vec3 kFlat(1, 0, 1);

/// A course of runs, turns and stops.
WalkRoute make_course() {
    WalkRoute route;
    route.reach = 0.7f;
    route.points = {{{0, 0, 4}, 0, 1.3f},  {{0, 0, 12}, 0, 3.6f},   {{3, 0, 14}, 0, 2.5f},
                    {{9, 0, 14}, 0, 2.5f}, {{9, 0, 9}, 1, 1.3f},    {{9, 0, 2}, 0, 3.6f},
                    {{5, 0, 0}, 0, 2.0f},  {{3, 0, 1.5f}, 0, 1.3f}, {{0, 0, 0}, 1, 1.3f}};
    return route;
}

/// Distance of a point from the course, on the ground [m].
float distance_from(const WalkRoute& route, const Vec3& point) {
    float nearest = INFINITY;
    for (std::size_t i = 0; i < route.points.size(); ++i) {
        const Vec3& a = route.points[i].position;
        const Vec3 way = route.points[(i + 1) % route.points.size()].position - a;
        const Vec3 off = (point - a) * kFlat;
        const float at = std::clamp(glm::dot(off, way) / glm::dot(way, way), 0.0f, 1.0f);
        nearest = std::min(nearest, glm::distance(off, at * way));
    }
    return nearest;
}

struct CourseErrors {
    double slide = 0;  ///< way of the still point of a planted foot, at most [mm]
    double jump = 0;   ///< of a joint off its way, in the step of a change of clips [mm]
    double usual = 0;  ///< the same in other steps [mm]
    double path = 0;   ///< mean distance from the course [m]
    int changes = 0;
};

/// One person on the course.
class CourseTrial {
  public:
    CourseTrial(float blend, float frame, const Vec3& start = Vec3(0))
        : frame_(frame), body_(find_walk_body(oracle::make_walker())) {
        Assets& assets = world_.insert_resource(Assets{});
        assets.skeletons.push_back(oracle::make_walker());
        world_.insert_resource(FrameTime{.step = frame});
        MotionMatch match;
        match.blend = blend;
        person_ =
            world_.create(Transform{.position = start}, Skeleton{{0}}, match, MoveIntent{}, route_);
        start_world(world_);
    }

    CourseErrors run() {
        CourseErrors errors;
        std::array<std::vector<Vec3>, 3> last;
        std::array<std::array<Vec3, 2>, 2> feet{};
        std::array<bool, 2> was{};
        std::array<float, 2> way{};
        std::uint32_t before = 0;
        float slide = 0;
        float off_course = 0;
        const auto frames = static_cast<int>(std::lround(kCourseTime / frame_));
        for (int frame = 0; frame < frames; ++frame) {
            step_world(world_, schedule_);
            const auto& state = world_.get<const MotionMatchState>(person_);
            std::rotate(last.begin(), last.begin() + 2, last.end());
            last[0] = joints();
            const bool changed = state.transitions != before;
            before = state.transitions;
            for (std::size_t j = 0; j < last[0].size() && frame > 3; ++j) {
                const auto off =
                    static_cast<double>(glm::distance(last[0][j], 2.0f * last[1][j] - last[2][j]));
                double& largest = changed ? errors.jump : errors.usual;
                largest = std::max(largest, 1000 * off);
            }
            for (std::size_t side = 0; side < 2; ++side) {
                const bool planted = state.feet[side].planted == 1;
                const std::array<Vec3, 2> now = points(side);
                way[side] += std::min(
                    glm::distance(now[0] * kFlat, feet[side][0] * kFlat),
                    glm::distance(now[1] * kFlat, feet[side][1] * kFlat));
                way[side] = planted && was[side] ? way[side] : 0.0f;
                slide = std::max(slide, way[side]);
                feet[side] = now;
                was[side] = planted;
            }
            off_course += distance_from(route_, at().position) / static_cast<float>(frames);
        }
        errors.slide = 1000 * static_cast<double>(slide);
        errors.path = static_cast<double>(off_course);
        errors.changes = static_cast<int>(before);
        return errors;
    }

  private:
    [[nodiscard]] const Transform& at() const { return world_.get<const Transform>(person_); }
    [[nodiscard]] Vec3 place(const Vec3& point) const {
        return at().position + at().rotation * point;
    }
    [[nodiscard]] std::vector<Vec3> joints() const {
        std::vector<Vec3> places;
        for (const Affine& joint : world_.get<const Pose>(person_).joints) {
            places.push_back(place(transform_point(joint, Vec3(0))));
        }
        return places;
    }
    /// Heel and ball of a foot. At rest, joints of this skeleton are not turned.
    [[nodiscard]] std::array<Vec3, 2> points(std::size_t side) const {
        const WalkLeg& leg = body_.legs[side];
        const Affine& ankle = world_.get<const Pose>(person_).joints[leg.foot];
        return {
            place(transform_point(ankle, leg.heel - leg.ankle)),
            place(transform_point(ankle, leg.ball - leg.ankle))};
    }

    float frame_;
    WalkBody body_;
    WalkRoute route_ = make_course();
    World world_;
    Schedule schedule_ = make_world_schedule();
    Entity person_{};
};

/// Mean distance from the course of a root that moves just as the person wants to [m].
double wanted_distance() {
    const WalkRoute route = make_course();
    const MotionMatch match;
    MatchWish wish;
    wish.response = match.response;
    wish.acceleration = match.acceleration;
    wish.turn_speed = match.turn_speed;
    World world;
    world.insert_resource(FrameTime{.step = kFrame});
    const Entity root = world.create(Transform{}, MoveIntent{}, route, WalkRouteState{});
    MatchRoot at;
    float sum = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
        world.run(update_walk_routes);
        const Vec3 velocity = world.get<const MoveIntent>(root).velocity;
        wish.velocity = {velocity.x, velocity.z};
        step_match_root(wish, kFrame, at);
        const Vec3 place(at.place.x, 0, at.place.y);
        world.get<Transform>(root).position = place;
        sum += distance_from(route, place) / kFrames;
    }
    return static_cast<double>(sum);
}

/// Of people who begin a little aside: each course is another one after a few steps [m].
std::vector<double> course_distances() {
    std::vector<double> distances;
    for (const float aside : {-0.07f, 0.0f, 0.07f}) {
        for (const float back : {0.0f, 0.11f, 0.22f, 0.33f}) {
            CourseTrial trial(MotionMatch{}.blend, kFrame, {aside, 0, -back});
            distances.push_back(trial.run().path);
        }
    }
    return distances;
}

Status measure_motion_matching(HeadlessRenderer& /*headless*/, QualityReport& report) {
    const float blend = MotionMatch{}.blend;
    const CourseErrors played = CourseTrial(blend, kFrame).run();
    report.inform("changes of clips on a course of 40 s", played.changes);
    report.at_most("slide of planted feet on it", played.slide, 2, "mm");
    const CourseErrors cut = CourseTrial(0, kShortFrame).run();
    const CourseErrors blended = CourseTrial(blend, kShortFrame).run();
    report.inform("cuts: jump of a joint", cut.jump, "mm");
    report.at_most("inertialized: jump of a joint", blended.jump, 10, "mm");
    report.inform("jump of a joint without a change", blended.usual, "mm");
    const double wanted = wanted_distance();
    report.inform("mean distance from the course, as wanted", wanted, "m");
    const std::vector<double> distances = course_distances();
    const double sum = std::accumulate(distances.begin(), distances.end(), 0.0);
    const double mean = sum / static_cast<double>(distances.size());
    const double most = *std::max_element(distances.begin(), distances.end());
    report.at_most("mean distance from it over that as wanted, of 12 people", mean / wanted, 1.5);
    report.inform("of the one who is the farthest off", most / wanted);
    return Done{};
}

const RegisterCharacterPart kMotionMatchPart("motion matching", measure_motion_matching);

}  // namespace
}  // namespace limn::motion_match_quality
