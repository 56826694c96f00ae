#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "ecs/components/body_measures.h"
#include "ecs/components/humanoid.h"
#include "ecs/components/skeleton.h"

#include <cstddef>
#include <span>

namespace limn {

// Keeps planted feet where they are (char.retarget-body). In a contact of an ankle or of toes the
// joint stays where it is when the contact begins; with both the foot also keeps its direction.
// Afterwards the correction fades. Legs are solved in closed form and bend in the plane in which
// they bend anyway; hips are lowered where a target is out of reach.

struct FootPins {
    std::size_t contacts = 0;  ///< that were pinned
    float lowered = 0;         ///< most that the hips were lowered [m]
};

/// `contacts` are of joints of this skeleton; those of other joints than ankles and toes are
/// ignored. `fade` [s].
FootPins pin_feet(
    const SkeletonData& skeleton, const BodyJoints& body, MotionFrames& frames,
    std::span<const ClipContact> contacts, float fade);

/// A limb of two bones: thigh, shin, foot or upper arm, forearm, hand.
struct PinnedLimb {
    std::uint16_t root = 0;
    std::uint16_t middle = 0;
    std::uint16_t tip = 0;
};

/// Brings the tip to `target`, in the space of the skeleton, in one frame. `hinge`: unit axis about
/// which a straight limb bends. The tip keeps its orientation, turned by `turn`.
void reach_with_limb(
    const SkeletonData& skeleton, MotionFrames& frames, std::size_t frame, const PinnedLimb& limb,
    const Vec3& target, const Vec3& hinge, const Quat& turn = {1, 0, 0, 0});

}  // namespace limn
