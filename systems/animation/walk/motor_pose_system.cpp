#include "systems/animation/walk/motor_pose_system.h"

#include "systems/animation/walk/apply_motor_pose.h"
#include "systems/animation/walk/walk_plan.h"
#include "systems/animation/walk/walk_step.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace limn {
namespace {

constexpr float kPushReach = 0.16f;   // between body and character, while it pushes [m]
constexpr float kPushHeight = 0.5f;   // least of the top of what it pushes, of its own height
constexpr float kHandHeight = 0.72f;  // most of hands, of its own height
constexpr float kPushCosine = 0.6f;   // of the direction to it

/// Looks for what a character carries or pushes.
class LooseBodySearch {
  public:
    LooseBodySearch(
        Entity entity, const CharacterMotor& motor, const MoveIntent* intent,
        const Transform& transform, const WalkBody& body, MotorPoseInput& input)
        : entity_(entity), motor_(motor), intent_(intent), transform_(transform), input_(input),
          ahead_(transform.rotation * heading_direction(body.heading)) {}

    void visit(const LooseBody& body, const LooseState& state, const Vec3& center) {
        if (state.carrier == entity_) {
            input_.carried = local(center);
            input_.width = body.radius / uniform_scale(transform_);
        } else if (state.carrier.is_null() && !input_.carried) {
            consider_push(body, center);
        }
    }

  private:
    [[nodiscard]] Vec3 local(const Vec3& point) const {
        return glm::conjugate(transform_.rotation) * (point - transform_.position)
               / uniform_scale(transform_);
    }
    void consider_push(const LooseBody& body, const Vec3& center) {
        const Vec3 to = center - transform_.position;
        const float distance = glm::length(Vec3(to.x, 0, to.z));
        const float gap = distance - motor_.radius - body.radius;
        const bool is_high = to.y + body.radius > kPushHeight * motor_.height
                             && to.y - body.radius < kHandHeight * motor_.height;
        const Vec3 way = distance > 0 ? Vec3(to.x, 0, to.z) / distance : ahead_;
        const bool goes = intent_ != nullptr && glm::dot(intent_->velocity, way) > 0.3f
                          && glm::dot(ahead_, way) > kPushCosine;
        if (!is_high || !goes || gap > kPushReach || gap > nearest_) {
            return;
        }
        nearest_ = gap;
        Vec3 point = center - body.radius * way;
        point.y = transform_.position.y
                  + std::min(to.y + 0.7f * body.radius, kHandHeight * motor_.height);
        input_.pushed = local(point);
        input_.width = body.radius / uniform_scale(transform_);
    }

    Entity entity_;
    const CharacterMotor& motor_;
    const MoveIntent* intent_;
    const Transform& transform_;
    MotorPoseInput& input_;
    Vec3 ahead_;
    float nearest_ = std::numeric_limits<float>::infinity();
};

}  // namespace

void add_motor_poses(
    Query<const MotorPose, const Transform, Without<MotorPoseState>> bare, Commands commands) {
    bare.each([&](Entity entity, const MotorPose&, const Transform& transform) {
        MotorPoseState state;
        state.root = transform.position;
        commands.add(entity, state);
    });
}

void update_motor_poses(
    Query<
        const MotorPose, const CharacterMotor, const MotorState, Optional<const MoveIntent>,
        const Transform, MotorPoseState, WalkState, WalkBody>
        characters,
    Query<const LooseBody, const LooseState, const Transform> bodies,
    OptionalRes<const FrameTime> time) {
    const float step = time ? time->step : 0.0f;
    characters.each([&](Entity entity, const MotorPose& style, const CharacterMotor& motor,
                        const MotorState& motion, const MoveIntent* intent,
                        const Transform& transform, MotorPoseState& state, WalkState& walk,
                        WalkBody& body) {
        MotorPoseInput input = {
            .motor = motion, .velocity = motion.velocity, .height = motor.height};
        LooseBodySearch search(entity, motor, intent, transform, body, input);
        bodies.each([&](const LooseBody& loose, const LooseState& loose_state,
                        const Transform& at) { search.visit(loose, loose_state, at.position); });
        step_motor_pose(style, input, body, transform, step, state, walk);
        body.targets = find_walk_targets(body, walk, transform);
        add_motor_targets(style, state, body);
    });
}

}  // namespace limn
