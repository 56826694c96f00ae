#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "content/load/motion/bvh_file.h"
#include "ecs/base/result.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <string>

namespace limn {

// BVH files as skeletons with a clip, in meters with +y up.
//
// The rotation of a joint is the product of its channels in the file's order, the first outermost:
// R = Rz Rx Ry for the channels Z, X, Y. Each frame becomes a key with a quaternion, in the
// hemisphere of the previous one. Joints have no rotation at rest. End sites become joints without
// keys, "LeftFoot_end".

enum class BvhUp : std::uint8_t {
    Auto,  ///< from the feet to the hips; without them, the longer extent of the rest pose
    Y,
    Z,
};

/// What position channels of a joint with an offset mean; files differ.
enum class BvhPositions : std::uint8_t {
    Auto,     ///< Replace if the first frame is near the offset, else Add
    Add,      ///< to the offset
    Replace,  ///< the offset
};

struct BvhImport {
    float scale = 0.0f;
    BvhUp up = BvhUp::Auto;
    float rate = 0.0f;
    BvhPositions positions = BvhPositions::Auto;
};
LIMN_FIELDS(BvhImport) {
    LIMN_FIELD(
        scale, "meters per unit of the file, which names none; 0: by the height of a person", "m",
        0, 1000);
    LIMN_FIELD(up, .doc = "axis that points upwards", .values = "auto y z");
    LIMN_FIELD(rate, "keys per second; 0: one per frame of the file", "1/s", 0, 1000);
    LIMN_FIELD(
        positions, .doc = "positions of joints are added to their offsets, or replace them",
        .values = "auto add replace");
}

/// The unit that makes a person's skeleton of `height` [file's unit] closest to 1.65 m: meters,
/// decimeters, centimeters, millimeters or inches. 1 for no height.
[[nodiscard]] float guess_unit(float height);

/// Fails with one line where times would not increase or coordinates exceed what floats hold.
/// `name` is the clip's.
[[nodiscard]] Result<SkeletonMotion>
make_bvh_motion(const BvhFile& bvh, const std::string& name, const BvhImport& options = {});

[[nodiscard]] Result<SkeletonMotion>
load_bvh_motion(const std::string& path, const BvhImport& options = {});

}  // namespace limn
