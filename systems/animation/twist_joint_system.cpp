#include "systems/animation/twist_joint_system.h"

#include "systems/animation/twist_pose.h"

#include <cstdint>
#include <vector>

namespace limn {

void add_twist_links(
    Query<const TwistJoints, With<Skeleton>, Without<TwistLinks>> bare, Commands commands) {
    bare.each([&](Entity entity, const TwistJoints&) { commands.add(entity, TwistLinks{}); });
}

void update_twist_links(
    Query<const Skeleton, const TwistJoints, TwistLinks> characters, Res<const Assets> assets) {
    characters.each([&](const Skeleton& skeleton, const TwistJoints& twist, TwistLinks& found) {
        if (found.skeleton == skeleton.skeleton && found.asked == twist.joints) {
            return;
        }
        const std::uint32_t index = skeleton.skeleton.index;
        found.links = index < assets->skeletons.size()
                          ? find_twist_links(assets->skeletons[index], twist.joints)
                          : std::vector<TwistLink>();
        found.asked = twist.joints;
        found.skeleton = skeleton.skeleton;
    });
}

}  // namespace limn
