#include "content/make/head/head_correctives.h"

#include <glm/common.hpp>

namespace limn {
namespace {

constexpr HeadCorrective kCorrectives[] = {
    {"AU42", {}},     {"AU43", {}},     {"AU45", {}},    {"AU64", {}},    {"AU26", {}},
    {"AU27", {}},     {"AU43", "AU45"}, {"AU43", "AU6"}, {"AU43", "AU7"}, {"AU43", "AU42"},
    {"AU43", "AU44"}, {"AU43", "AU64"}, {"AU45", "AU6"}, {"AU45", "AU7"}, {"AU45", "AU42"},
    {"AU45", "AU44"}, {"AU45", "AU64"},
};

/// The unit at `weight`, with every motion scaled.
ActionUnit scaled(ActionUnit unit, float weight) {
    for (MusclePull& pull : unit.pulls) {
        pull.motion *= weight;
    }
    unit.jaw *= weight;
    unit.jaw_shift *= weight;
    unit.upper_lid *= weight;
    unit.lower_lid *= weight;
    unit.upper_roll *= weight;
    unit.lower_roll *= weight;
    unit.tongue *= weight;
    return unit;
}

/// Only the lid motion of the unit.
ActionUnit lids_of(const ActionUnit& unit) {
    ActionUnit lids;
    lids.upper_lid = unit.upper_lid;
    lids.lower_lid = unit.lower_lid;
    return lids;
}

/// Weight of the edges of closed lids, which muscles around the eye must not pull apart.
float lid_weight(const HeadPoint& point) {
    constexpr float kLid = kLidLoop;
    return point.loops == HeadLoops::Eye
               ? glm::smoothstep(kLid - 4, kLid, static_cast<float>(point.loop))
               : 0.0f;
}

}  // namespace

std::span<const HeadCorrective> head_correctives() {
    return kCorrectives;
}

Vec3 corrective_offset(
    const HeadCorrective& corrective, const HeadPoint& point, const HeadShape& shape) {
    const ActionUnit& unit = action_unit(corrective.unit);
    if (corrective.other.empty()) {
        return action_offset(scaled(unit, 0.5f), point, shape)
               - 0.5f * action_offset(unit, point, shape);
    }
    const ActionUnit& other = action_unit(corrective.other);
    const auto pulls = [&](const ActionUnit& both) {
        return action_offset(both, point, shape) - action_offset(lids_of(both), point, shape);
    };
    return -action_offset(lids_of(other), point, shape)
           - lid_weight(point) * (pulls(unit) + pulls(other));
}

}  // namespace limn
