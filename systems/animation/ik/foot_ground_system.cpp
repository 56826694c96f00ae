#include "systems/animation/ik/foot_ground_system.h"

#include "ecs/components/humanoid.h"
#include "systems/animation/ik/placements.h"
#include "systems/animation/ik/plant_feet.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {
namespace {

constexpr std::uint16_t kNoFoot = 0xffff;

/// What apply_foot_plant has made of a foot.
struct PlantedFoot {
    Vec3 ankle = {0, 0, 0};
    float low = 0.0f;  ///< highest ankle that turns with the slope [m]
};

/// The point of the ground about which it has turned.
Vec3 find_turned_about(
    const FootPlant& plant, const PlantedFoot& foot, float lift, const Vec3& normal) {
    const Vec3 up = foot_slope(plant, normal) * Vec3(0, 1, 0);
    return foot.ankle - std::min((foot.ankle.y - lift) / up.y, foot.low) * up;
}

void update_foot(
    std::span<const PlacedGround> grounds, const Affine& world, const Affine& local,
    const FootPlant& plant, const PlantedFoot& planted, bool stands, float step, std::size_t i,
    FootContacts& contacts) {
    const Vec3 foot = find_turned_about(
        plant, planted, std::clamp(plant.weight, 0.0f, 1.0f) * contacts.lifts[i],
        contacts.normals[i]);
    const auto on_floor = [&](float height) {
        return transform_point(world, Vec3(foot.x, height, foot.z));
    };
    const Segment segment = {on_floor(plant.step), on_floor(-plant.step)};
    const Landing landing = stands ? find_landing(grounds, segment) : Landing{};
    const PlacedGround* const last = find_placed(grounds, contacts.grounds[i]);
    // Height and slope of the contact as its ground has carried it.
    const float carried =
        last != nullptr ? transform_point(local, transform_point(last->world, contacts.points[i])).y
                        : contacts.lifts[i];
    const Vec3 slope =
        last != nullptr ? normalize_or(
            transform_vector(local, transform_vector(last->world, contacts.slopes[i])),
            Vec3(0, 1, 0))
                        : contacts.normals[i];
    const float wanted = landing.ground != nullptr ? transform_point(local, landing.point).y : 0.0f;
    const float share = plant.speed > 0 ? 1 - std::exp(-plant.speed * step) : 1.0f;
    const bool is_first = contacts.feet[i] == kNoFoot;
    const float lift = std::clamp(
        carried + (is_first ? 1.0f : share) * (wanted - carried), -plant.step, plant.step);
    const Vec3 normal = landing.ground != nullptr
                            ? normalize_or(transform_vector(local, landing.normal), {0, 1, 0})
                            : Vec3(0, 1, 0);
    contacts.lifts[i] = lift;
    contacts.normals[i] =
        normalize_or(glm::mix(slope, normal, is_first ? 1.0f : share), Vec3(0, 1, 0));
    contacts.grounds[i] = landing.ground != nullptr ? landing.ground->entity : Entity{};
    if (landing.ground != nullptr) {
        contacts.points[i] = transform_point(landing.ground->local, on_floor(lift));
        contacts.slopes[i] = normalize_or(
            transform_vector(landing.ground->local, transform_vector(world, contacts.normals[i])),
            Vec3(0, 1, 0));
    }
}

}  // namespace

void add_foot_contacts(
    Query<const FootPlant, With<Skeleton>, Without<FootContacts>> bare, Commands commands) {
    bare.each([&](Entity entity, const FootPlant&) { commands.add(entity, FootContacts{}); });
}

void update_foot_contacts(
    Query<const Skeleton, const FootPlant, const Pose, Optional<const MotorState>, FootContacts>
        characters,
    GroundQueries grounds, OptionalRes<const FrameTime> time) {
    if (characters.empty() || !grounds.assets) {
        return;
    }
    const Placements placements(grounds.transforms, grounds.parents);
    const std::vector<PlacedGround> placed = place_grounds(grounds);
    const Assets& assets = *grounds.assets;
    const float step = time ? time->step : 0.0f;
    characters.each([&](Entity entity, const Skeleton& skeleton, const FootPlant& plant,
                        const Pose& pose, const MotorState* motor, FootContacts& contacts) {
        const std::uint32_t index = skeleton.skeleton.index;
        const Affine world = placements.world(entity);
        Affine local;
        if (index >= assets.skeletons.size() || pose.joints.empty()
            || !find_inverse(world, local)) {
            return;
        }
        std::array<std::uint16_t, 2> feet = contacts.feet;
        if (feet[0] == kNoFoot) {
            const BodyJoints body = find_body_joints(assets.skeletons[index]);
            feet = {body[BodyPart::LeftFoot], body[BodyPart::RightFoot]};
        }
        const bool stands = motor == nullptr || motor->mode == MotorMode::Stand;
        for (std::size_t i = 0; i < 2; ++i) {
            if (feet[i] < pose.joints.size()) {
                const PlantedFoot foot = {
                    transform_point(pose.joints[feet[i]], Vec3(0)),
                    sloping_height(assets.skeletons[index], feet[i])};
                update_foot(placed, world, local, plant, foot, stands, step, i, contacts);
            }
        }
        contacts.feet = feet;
    });
}

}  // namespace limn
