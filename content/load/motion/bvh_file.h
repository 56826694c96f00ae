#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Motion capture files of Biovision, BVH: a tree of joints, each with an offset from its parent and
// up to six channels, and a row of numbers per frame, in degrees and the file's unit of length.
//
//     HIERARCHY
//     ROOT Hips
//     {
//         OFFSET 0 0 0
//         CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
//         JOINT LeftHip
//         { ... End Site { OFFSET 0 -3.1 0 } ... }
//     }
//     MOTION
//     Frames: 2
//     Frame Time: 0.033333
//     0 36 0 1.5 -2 ...      one row per frame
//
// Read as it stands: bvh_motion.h makes a skeleton and a clip of it. HIERARCHY may be missing; the
// case of keywords does not matter; names may contain spaces and any UTF-8.

enum class BvhChannel : std::uint8_t {
    Xposition,
    Yposition,
    Zposition,
    Xrotation,
    Yrotation,
    Zrotation,
};
inline constexpr int kBvhChannels = 6;

/// Axis 0 to 2 of the channel.
[[nodiscard]] constexpr int axis_of(BvhChannel channel) {
    return static_cast<int>(channel) % 3;
}
[[nodiscard]] constexpr bool is_position(BvhChannel channel) {
    return static_cast<int>(channel) < 3;
}

struct BvhJoint {
    std::string name;             ///< "" for an end site
    std::int32_t parent = -1;     ///< an earlier joint; -1 for the first, the root
    Vec3 offset = {0, 0, 0};      ///< from the parent [file's unit]
    bool is_end = false;          ///< an end site: the tip of its parent, without channels
    std::size_t first_value = 0;  ///< of its channels in a row
    std::vector<BvhChannel> channels = {};  ///< in the file's order, the first is the outermost
};

struct BvhFile {
    std::vector<BvhJoint> joints;  ///< parents first, in the file's order
    float frame_time = 1.0f / 30;  ///< [s], > 0
    std::size_t frames = 0;
    std::vector<float> values;  ///< frames rows of channels() numbers: degrees, or file's unit
    std::vector<std::string> warnings = {};

    /// Numbers per row.
    [[nodiscard]] std::size_t channels() const;
};

/// Limits on untrusted files.
struct BvhLimits {
    std::uint64_t max_bytes = std::uint64_t{1} << 30;
    std::size_t max_joints = 65'000;
    std::size_t max_frames = 10'000'000;
    std::size_t max_values = std::size_t{1} << 28;  ///< in all rows
};

/// Fails with one line, "walk.bvh:7: found X, expected Y": a block that is not closed, a second
/// root, an unknown or repeated channel, a row with other than a number per channel, fewer rows
/// than the file says, a frame time that is not above 0, numbers that are not finite. Rows beyond
/// the stated number are ignored with a warning.
[[nodiscard]] Result<BvhFile>
parse_bvh(std::string_view text, const std::string& file, const BvhLimits& limits = {});

[[nodiscard]] Result<BvhFile> load_bvh(const std::string& path, const BvhLimits& limits = {});

/// The text of a file, from which parse_bvh reads an equal one, numbers to the bit.
[[nodiscard]] std::string write_bvh(const BvhFile& bvh);

}  // namespace limn
