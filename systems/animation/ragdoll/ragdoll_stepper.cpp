#include "systems/animation/ragdoll/ragdoll_stepper.h"

#include "ecs/base/gravity.h"
#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/ik/elbow_circle.h"
#include "systems/animation/ik/placements.h"
#include "systems/animation/ragdoll/ragdoll_scene.h"
#include "systems/animation/ragdoll/ragdoll_solver.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

// Techniques: char.dynamics

namespace limn {
namespace {

constexpr float kSleepSpeed = 0.06f;    // below which a body hardly moves [m/s]
constexpr float kSleepArm = 0.1f;       // at which its spin counts [m]
constexpr float kSleepTime = 0.5f;      // [s]
constexpr double kTouchMargin = 0.005;  // within which a capsule touches [m]
constexpr double kMaxStartSpeed = 50;   // taken over from the animation [m/s], [rad/s]
constexpr double kMuscleRate = 25;      // natural frequency at half stiffness [rad/s]
constexpr double kBraceRate = 7;        // likewise, of a body that braces itself, by eye
constexpr float kBraceTime = 6;         // for which it does [collapse times]
constexpr float kBraceBend = 0.35f;     // of hinges, of their range

RigidQuat to_rigid(const Quat& q) {
    return glm::normalize(RigidQuat(q));
}

bool is_finite_quat(const Quat& q) {
    return std::isfinite(q.w + q.x + q.y + q.z);
}

RagdollSize find_size(const RagdollCharacter& c) {
    RagdollSize size;
    size.mass = static_cast<double>(std::max(finite_or(c.ragdoll->mass, 75), 1e-3f));
    size.scale = matrix_scale(c.world);
    size.thickness = find_thickness(*c.ragdoll);
    return size;
}

std::vector<RigidCapsule> load_bodies(const RagdollCharacter& c, const RagdollSize& size) {
    const RagdollState& state = *c.state;
    std::vector<RigidCapsule> bodies;
    for (std::size_t i = 0; i < state.joints.size(); ++i) {
        RigidCapsule body =
            make_ragdoll_body(c.rig->bones[i], size, RigidVec(0), to_rigid(state.rotations[i]));
        body.position = RigidVec(state.positions[i]);
        body.velocity = RigidVec(state.velocities[i]);
        body.spin = RigidVec(state.spins[i]);
        bodies.push_back(body);
    }
    return bodies;
}

/// One character in this step.
class RagdollStepper {
  public:
    RagdollStepper(
        const RagdollStage& stage, const RagdollCharacter& character,
        std::vector<PartingPlane> planes)
        : stage_(stage), c_(character), ragdoll_(*character.ragdoll), state_(*character.state),
          planes_(std::move(planes)) {
        size_ = find_size(c_);
    }

    RagdollOutcome step() {
        if (!ragdoll_.active) {
            ragdoll_.active = is_pushed() || is_tripped();
        }
        if (!ragdoll_.active) {
            return {.gets_up = rest()};
        }
        const bool starts = state_.is_active == 0 || state_.joints.size() != c_.rig->bones.size();
        if (starts) {
            start();
        } else {
            follow_jump();
        }
        simulate();
        if (!is_state_finite()) {
            start();
            if (!is_state_finite()) {  // neither is the pose
                ragdoll_.active = false;
                state_ = {};
            }
            return {};
        }
        return outcome_;
    }

  private:
    [[nodiscard]] bool is_pushed() const {
        return is_finite(ragdoll_.push) && ragdoll_.push != Vec3(0);
    }

    bool rest() {
        if (state_.is_active != 0) {
            state_.is_active = 0;
            state_.weight = 1;
            return true;
        }
        if (state_.weight > 0) {
            const float time = finite_or(ragdoll_.get_up, 0);
            const float share = time > 0 ? static_cast<float>(stage_.dt) / time : 1.0f;
            state_.weight = std::max(state_.weight - share, 0.0f);
        }
        return false;
    }

    [[nodiscard]] Vec3 field_acceleration(const Vec3& at, const Vec3& velocity) const {
        Vec3 sum(0);
        for (const Force& force : stage_.forces) {
            sum += finite_or(ragdoll_.fields, 0) * acceleration(force, at, velocity);
        }
        return is_finite(sum) ? sum : Vec3(0);
    }

    [[nodiscard]] bool is_tripped() const {
        const Vec3 root =
            transform_point(c_.world * c_.pose->joints[c_.rig->bones[0].joint], Vec3(0));
        if (ragdoll_.trip_field > 0
            && glm::length(field_acceleration(root, Vec3(0))) >= ragdoll_.trip_field) {
            return true;
        }
        if (!(ragdoll_.trip_speed > 0) || !stage_.any_moves) {
            return false;
        }
        const double least = static_cast<double>(ragdoll_.trip_speed);
        const RagdollScene scene = scene_at(c_.world, c_.pose->joints);
        std::vector<RagdollObstacle> fast;
        for (std::size_t i = 0; i < stage_.obstacles.size(); ++i) {
            const RagdollObstacle& obstacle = stage_.obstacles[i];
            const bool is_fast =
                obstacle.moves && stage_.owners[i] != c_.entity
                && glm::length(obstacle.velocity(RigidVec(root), stage_.dt)) >= least;
            if (is_fast) {
                fast.push_back(obstacle);
            }
        }
        std::vector<RagdollContact> contacts;
        RagdollContacts(fast, {}, scene.bodies, stage_.dt)
            .find(scene.bodies, 0, contacts, kTouchMargin);
        return std::ranges::any_of(contacts, [least](const RagdollContact& contact) {
            return glm::length(contact.moves) >= least;
        });
    }

    [[nodiscard]] RagdollScene scene_at(const Affine& world, std::span<const Affine> joints) const {
        return make_ragdoll_scene(*c_.rig, size_, world, joints);
    }

    /// Takes places and velocities from the pose.
    void start() {
        RagdollScene now = scene_at(c_.world, c_.pose->joints);
        RagdollScene last;
        const bool has_last = c_.pose->previous.size() == c_.pose->joints.size()
                              && c_.previous.row[0] != Vec4(0) && stage_.dt > 0;
        if (has_last) {
            last = scene_at(c_.previous, c_.pose->previous);
        }
        state_ = {.character_from_world = state_.character_from_world, .weight = 1, .is_active = 1};
        for (std::size_t i = 0; i < now.bodies.size(); ++i) {
            RigidCapsule& body = now.bodies[i];
            const RagdollBone& bone = c_.rig->bones[i];
            if (has_last) {
                body.velocity = limited((body.position - last.bodies[i].position) / stage_.dt);
                const RigidQuat turn = body.rotation * glm::conjugate(last.bodies[i].rotation);
                body.spin = limited(
                    RigidVec(log_rotation(Quat(turn.w < 0 ? -turn : turn))) * (2 / stage_.dt));
            }
            state_.joints.push_back(bone.joint);
            state_.centers.push_back(0.5f * (bone.from + bone.to) * size_.scale);
            state_.slack.push_back(0);
        }
        for (const RagdollJoint& joint : now.joints) {
            state_.slack[joint.child] = static_cast<float>(limit_excess(now, joint));
        }
        store(now);
    }
    static RigidVec limited(const RigidVec& v) {
        const double size = glm::length(v);
        return size > kMaxStartSpeed ? v * (kMaxStartSpeed / size) : v;
    }

    /// A teleport takes the body along.
    void follow_jump() {
        const TransformJump* const jump = find_jump(stage_.jumps, c_.entity);
        Affine back;
        if (jump == nullptr || !find_inverse(jump->before, back)) {
            return;
        }
        const Affine move = c_.world * back;
        const Quat turn = matrix_rotation(move);
        for (std::size_t i = 0; i < state_.joints.size(); ++i) {
            state_.positions[i] = transform_point(move, state_.positions[i]);
            state_.rotations[i] = turn * state_.rotations[i];
            state_.velocities[i] = turn * state_.velocities[i];
            state_.spins[i] = turn * state_.spins[i];
        }
        state_.still = 0;
    }

    void load(RagdollScene& scene) const {
        scene.bodies = load_bodies(c_, size_);
        scene.joints = make_ragdoll_joints(*c_.rig, size_);
        for (RagdollJoint& joint : scene.joints) {
            joint.slack = static_cast<double>(state_.slack[joint.child]);
        }
    }
    void store(const RagdollScene& scene) {
        const std::size_t count = scene.bodies.size();
        state_.positions.resize(count);
        state_.rotations.resize(count);
        state_.velocities.resize(count);
        state_.spins.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            const RigidCapsule& body = scene.bodies[i];
            state_.positions[i] = Vec3(body.position);
            state_.rotations[i] = Quat(body.rotation);
            state_.velocities[i] = Vec3(body.velocity);
            state_.spins[i] = Vec3(body.spin);
        }
        for (const RagdollJoint& joint : scene.joints) {
            state_.slack[joint.child] =
                std::min(state_.slack[joint.child], static_cast<float>(joint.slack));
        }
    }

    [[nodiscard]] bool is_state_finite() const {
        for (std::size_t i = 0; i < state_.positions.size(); ++i) {
            if (!is_finite(state_.positions[i]) || !is_finite_quat(state_.rotations[i])
                || !is_finite(state_.velocities[i]) || !is_finite(state_.spins[i])) {
                return false;
            }
        }
        return true;
    }

    /// Natural frequencies of the muscles [rad/s].
    struct Muscles {
        double hold = 0;   ///< toward the animation: stiff at the switch, then as `stiffness` says
        double brace = 0;  ///< toward bent joints, as long as a fall takes people by surprise
    };
    [[nodiscard]] Muscles muscles() const {
        const float collapse = finite_or(ragdoll_.collapse, 0);
        const float since = collapse > 0 ? state_.time / collapse : kBraceTime;
        const float own = std::clamp(finite_or(ragdoll_.stiffness, 0), 0.0f, 1.0f);
        const double stiffness = static_cast<double>(own + (1 - own) * std::max(1 - since, 0.0f));
        const double left = static_cast<double>(std::clamp(2 - 2 * since / kBraceTime, 0.0f, 1.0f));
        return {kMuscleRate * stiffness / (1.001 - stiffness), kBraceRate * (1 - stiffness) * left};
    }

    /// Relative to rest: hinges bend a little, cones turn to their middles. So knees and hips give
    /// way, and arms go out and ahead.
    static Quat braced(const RagdollLimit& limit) {
        if (limit.kind == RagdollJointKind::Hinge) {
            return rotation_about(limit.axis, limit.min + kBraceBend * (limit.max - limit.min));
        }
        return rotation_between(limit.bone, limit.center);
    }

    void aim_muscles(const Muscles& muscles, RagdollScene& scene) const {
        thread_local LocalPose pose;  // reused between characters
        thread_local std::vector<float> weights;
        thread_local std::vector<Quat> turns;
        weights.assign(c_.morph != nullptr ? c_.morph->weights.size() : 0, 0.0f);
        const ClipData* clip = nullptr;
        if (c_.player != nullptr && c_.player->clip.index < stage_.assets->clips.size()) {
            clip = &stage_.assets->clips[c_.player->clip.index];
        }
        sample_pose(
            *c_.skeleton, clip, c_.player != nullptr ? c_.player->time : 0.0f, pose, weights);
        turns.resize(pose.size());
        for (std::size_t j = 0; j < pose.size(); ++j) {
            const std::int32_t parent = c_.skeleton->parents[j];
            turns[j] = parent < 0 ? pose.rotations[j]
                                  : turns[static_cast<std::size_t>(parent)] * pose.rotations[j];
        }
        const double hold = muscles.hold * muscles.hold;
        const auto share =
            static_cast<float>(hold / std::max(hold + muscles.brace * muscles.brace, 1e-12));
        for (RagdollJoint& joint : scene.joints) {
            const Quat& parent = turns[state_.joints[joint.parent]];
            const Quat held = glm::conjugate(parent) * turns[state_.joints[joint.child]];
            const Quat bent = Quat(joint.rest) * braced(joint.limit);
            joint.target = to_rigid(slerp(bent, held, share));
        }
    }

    void apply_push(RagdollScene& scene) {
        if (!is_pushed()) {
            return;
        }
        const RigidVec push(ragdoll_.push);
        ragdoll_.push = Vec3(0);
        state_.still = 0;
        const std::size_t body = find_pushed_body();
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            if (body == scene.bodies.size() || body == i) {
                scene.bodies[i].velocity += push;
            }
        }
    }
    /// The body of push_joint, or of its nearest ancestor; the number of bodies: all of them.
    [[nodiscard]] std::size_t find_pushed_body() const {
        const std::vector<std::string>& names = c_.skeleton->joints;
        const auto found = std::ranges::find(names, ragdoll_.push_joint);
        if (ragdoll_.push_joint.empty() || found == names.end()) {
            return state_.joints.size();
        }
        auto joint = static_cast<std::int32_t>(found - names.begin());
        for (; joint >= 0; joint = c_.skeleton->parents[static_cast<std::size_t>(joint)]) {
            const auto bone = std::ranges::find(state_.joints, joint);
            if (bone != state_.joints.end()) {
                return static_cast<std::size_t>(bone - state_.joints.begin());
            }
        }
        return state_.joints.size();
    }

    /// Acceleration by the part of a capsule that is under water: buoyancy, and drag toward the
    /// water's velocity, which slows its spin, too.
    [[nodiscard]] Vec3 float_in_water(RigidCapsule& body) const {
        const float density = finite_or(ragdoll_.buoyancy, 0);
        if (stage_.waters.empty() || !(density > 0)) {
            return Vec3(0);
        }
        const LineSegment segment = body.placed();
        const double half = 0.5 * std::abs(segment.to.y - segment.from.y) + body.radius;
        const auto lowest = Vec3(body.position - RigidVec(0, half, 0));
        const auto around = find_water(stage_.waters, lowest);
        if (!around) {
            return Vec3(0);
        }
        const float sunk = std::min(around->depth / static_cast<float>(2 * half), 1.0f);
        const float drag = sunk * std::max(finite_or(ragdoll_.water_drag, 0), 0.0f);
        body.spin /= 1 + static_cast<double>(drag) * stage_.dt;
        const float gravity = static_cast<float>(kGravity) * finite_or(ragdoll_.gravity, 1);
        return Vec3(0, sunk * density * gravity, 0)
               - drag / (1 + drag * static_cast<float>(stage_.dt))
                     * (Vec3(body.velocity) - around->surface.velocity);
    }

    static bool is_support(const RagdollContact& contact) {
        return contact.other == RagdollContact::kNoBody && !contact.parts;
    }
    static RigidVec momentum_of(const RagdollScene& scene) {
        RigidVec sum(0);
        for (const RigidCapsule& body : scene.bodies) {
            sum += body.velocity / body.inverse_mass;
        }
        return sum;
    }
    static RigidVec pull_on(const RagdollScene& scene, const RigidVec& gravity) {
        RigidVec sum(0);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            sum += (gravity + scene.forces[i]) / scene.bodies[i].inverse_mass;
        }
        return sum;
    }

    void simulate() {
        RagdollScene scene;
        load(scene);
        outcome_ = {.meets = !planes_.empty(), .is_free = true, .mass = size_.mass};
        apply_push(scene);
        const Muscles muscle = muscles();
        const double rate = std::hypot(muscle.hold, muscle.brace);
        bool is_pulled = muscle.hold > 0;  // who only braces may lie still
        for (RigidCapsule& body : scene.bodies) {
            const Vec3 pull =
                field_acceleration(Vec3(body.position), Vec3(body.velocity)) + float_in_water(body);
            scene.forces.emplace_back(pull);
            is_pulled = is_pulled || glm::length(pull) > 0.1f;
        }
        // Its own skin does not stop it.
        std::vector<RagdollObstacle> others;
        std::span<const RagdollObstacle> obstacles = stage_.obstacles;
        if (std::ranges::find(stage_.owners, c_.entity) != stage_.owners.end()) {
            for (std::size_t i = 0; i < obstacles.size(); ++i) {
                if (stage_.owners[i] != c_.entity) {
                    others.push_back(obstacles[i]);
                }
            }
            obstacles = others;
        }
        const RagdollContacts near(
            obstacles, c_.rig->apart, scene.bodies, stage_.dt, std::move(planes_));
        if (sleeps(near, scene, is_pulled)) {
            outcome_.is_free = false;
            return;
        }
        if (rate > 0) {
            aim_muscles(muscle, scene);
        }
        RagdollOptions options;
        options.gravity =
            RigidVec(0, -kGravity * static_cast<double>(finite_or(ragdoll_.gravity, 1)), 0);
        options.friction = static_cast<double>(std::max(finite_or(ragdoll_.friction, 0), 0.0f));
        options.bounce = static_cast<double>(std::clamp(finite_or(ragdoll_.bounce, 0), 0.0f, 1.0f));
        options.damping = static_cast<double>(std::max(finite_or(ragdoll_.damping, 0), 0.0f));
        options.muscles = rate;
        const RigidVec before = momentum_of(scene) + stage_.dt * pull_on(scene, options.gravity);
        step_ragdoll(
            scene, stage_.dt, options,
            [&](const std::vector<RigidCapsule>& bodies, double left,
                std::vector<RagdollContact>& contacts) {
                near.find(bodies, left, contacts);
                outcome_.is_free = outcome_.is_free && std::ranges::none_of(contacts, is_support);
            });
        outcome_.received = momentum_of(scene) - before;
        store(scene);
        state_.time += static_cast<float>(stage_.dt);
        note_stillness(near, scene);
    }

    static std::size_t
    count_touches(const RagdollContacts& near, const RagdollScene& scene, bool& is_moved) {
        std::vector<RagdollContact> contacts;
        near.find(scene.bodies, 0, contacts, kTouchMargin);
        for (const RagdollContact& contact : contacts) {
            is_moved = is_moved || glm::length(contact.moves) > static_cast<double>(kSleepSpeed);
        }
        return contacts.size();
    }

    bool sleeps(const RagdollContacts& near, const RagdollScene& scene, bool is_pulled) {
        if (state_.still < kSleepTime) {
            return false;
        }
        bool is_moved = is_pulled;
        const std::size_t touches = count_touches(near, scene, is_moved);
        if (is_moved || touches < state_.contacts) {
            state_.still = 0;
            return false;
        }
        return true;
    }

    void note_stillness(const RagdollContacts& near, const RagdollScene& scene) {
        float speed = 0;
        for (std::size_t i = 0; i < state_.joints.size(); ++i) {
            speed = std::max(
                {speed, glm::length(state_.velocities[i]),
                 kSleepArm * glm::length(state_.spins[i])});
        }
        state_.still = speed < kSleepSpeed ? state_.still + static_cast<float>(stage_.dt) : 0.0f;
        if (state_.still < kSleepTime) {
            return;
        }
        bool is_moved = false;
        const std::size_t touches = count_touches(near, scene, is_moved);
        if (touches == 0 || is_moved) {  // at the top of a flight, or carried
            state_.still = 0;
            return;
        }
        state_.contacts = static_cast<std::uint32_t>(touches);
        std::ranges::fill(state_.velocities, Vec3(0));
        std::ranges::fill(state_.spins, Vec3(0));
    }

    const RagdollStage& stage_;
    const RagdollCharacter& c_;
    Ragdoll& ragdoll_;
    RagdollState& state_;
    RagdollSize size_;
    std::vector<PartingPlane> planes_;
    RagdollOutcome outcome_{};
};

}  // namespace

float matrix_scale(const Affine& a) {
    const float volume = std::abs(glm::determinant(Mat3(to_mat4(a))));
    return volume > 1e-18f && std::isfinite(volume) ? std::cbrt(volume) : 1.0f;
}

float find_thickness(const Ragdoll& ragdoll) {
    return std::clamp(finite_or(ragdoll.thickness, 1), 0.1f, 10.0f);
}

RagdollOutcome step_ragdoll_character(
    const RagdollStage& stage, const RagdollCharacter& character,
    std::vector<PartingPlane> planes) {
    return RagdollStepper(stage, character, std::move(planes)).step();
}

std::vector<RigidCapsule> find_meeting_bodies(const RagdollCharacter& character) {
    const bool meets = character.ragdoll->active && character.ragdoll->meets
                       && character.state->is_active != 0
                       && character.state->joints.size() == character.rig->bones.size();
    return meets ? load_bodies(character, find_size(character)) : std::vector<RigidCapsule>{};
}

}  // namespace limn
