#pragma once

#include "ecs/base/rotation.h"
#include "ecs/components/skeleton.h"

#include <cstdint>
#include <string>

namespace limn::test {

/// A chain of `count` joints, each one unit above its parent.
inline SkeletonData make_chain(std::size_t count) {
    SkeletonData skeleton;
    skeleton.name = "chain";
    for (std::size_t i = 0; i < count; ++i) {
        skeleton.joints.push_back("joint " + std::to_string(i));
        skeleton.parents.push_back(static_cast<std::int32_t>(i) - 1);
        skeleton.rest.translations.push_back(i == 0 ? Vec3(0) : Vec3(0, 1, 0));
        skeleton.rest.rotations.push_back(Quat(1, 0, 0, 0));
        skeleton.rest.scales.push_back(Vec3(1));
    }
    return skeleton;
}

/// One joint that turns about z by these angles [deg] at these times [s].
inline ClipData
make_turn(const std::vector<float>& times, const std::vector<float>& angles, std::uint16_t joint) {
    ClipData clip;
    clip.name = "turn";
    clip.duration = times.back();
    ClipSheet sheet;
    sheet.times = times;
    sheet.rotating = {joint};
    for (const float angle : angles) {
        sheet.rotations.push_back(rotation_about({0, 0, 1}, radians(angle)));
    }
    clip.sheets.push_back(sheet);
    return clip;
}

}  // namespace limn::test
