#include "content/load/motion/bvh_motion.h"

#include "ecs/base/rotation.h"
#include "ecs/base/text.h"
#include "ecs/components/humanoid.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

// Techniques: char.bvh-format, char.mocap-rate, char.skeleton-hierarchy

namespace limn {
namespace {

using BvhDQuat = glm::dquat;
using BvhDVec3 = glm::dvec3;

constexpr float kUnits[] = {1.0f, 0.1f, 0.01f, 0.001f, 0.0254f};  ///< [m]
constexpr float kPersonHeight = 1.65f;  ///< of a skeleton, which ends in the head [m]
constexpr double kDegree = 3.14159265358979323846 / 180.0;

/// Axes of the file to ours: +z up becomes +y up, and what faces -y faces +z.
Vec3 turn_upright(const Vec3& v, bool z_is_up) {
    return z_is_up ? Vec3(v.x, v.z, -v.y) : v;
}
BvhDQuat turn_upright(const BvhDQuat& q, bool z_is_up) {
    return z_is_up ? BvhDQuat(q.w, q.x, q.z, -q.y) : q;
}

std::vector<Vec3> find_rest_positions(const BvhFile& bvh) {
    std::vector<Vec3> positions;
    for (const BvhJoint& joint : bvh.joints) {
        positions.push_back(
            joint.parent < 0 ? joint.offset
                             : positions[static_cast<std::size_t>(joint.parent)] + joint.offset);
    }
    return positions;
}

/// The tree alone, as names and parents.
SkeletonData make_tree(const BvhFile& bvh) {
    SkeletonData tree;
    for (const BvhJoint& joint : bvh.joints) {
        const bool has_name = !joint.name.empty() || joint.parent < 0;
        tree.joints.push_back(
            has_name ? joint.name : tree.joints[static_cast<std::size_t>(joint.parent)] + "_end");
        tree.parents.push_back(joint.parent);
    }
    return tree;
}

bool is_z_up(const SkeletonData& tree, std::span<const Vec3> rest) {
    const BodyJoints body = find_body_joints(tree);
    Vec3 up(0);
    for (const BodyPart foot : {BodyPart::LeftFoot, BodyPart::RightFoot}) {
        if (body.has(foot) && body.has(BodyPart::Hips)) {
            up += rest[body[BodyPart::Hips]] - rest[body[foot]];
        }
    }
    if (up == Vec3(0)) {
        Bounds box;
        for (const Vec3& p : rest) {
            grow(box, p);
        }
        up = half_extent(box);
    }
    return std::abs(up.z) > std::abs(up.y);
}

float height_of(std::span<const Vec3> rest, bool z_is_up) {
    Bounds box;
    for (const Vec3& p : rest) {
        grow(box, p);
    }
    return z_is_up ? box.max.z - box.min.z : box.max.y - box.min.y;
}

/// Whether the positions of a joint replace its offset: the first frame is near the offset, along
/// its longest component, not near 0.
bool replaces_offset(const BvhFile& bvh, const BvhJoint& joint, BvhPositions positions) {
    if (positions != BvhPositions::Auto || bvh.frames == 0) {
        return positions == BvhPositions::Replace;
    }
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) {
        longest = std::abs(joint.offset[axis]) > std::abs(joint.offset[longest]) ? axis : longest;
    }
    const float offset = joint.offset[longest];
    for (std::size_t c = 0; c < joint.channels.size(); ++c) {
        if (is_position(joint.channels[c]) && axis_of(joint.channels[c]) == longest) {
            const float first = bvh.values[joint.first_value + c];
            return std::abs(first - offset) < 0.5f * std::abs(offset);
        }
    }
    return false;
}

/// The product of the rotation channels in their order.
BvhDQuat rotation_of(const BvhJoint& joint, const float* row) {
    BvhDQuat rotation(1, 0, 0, 0);
    for (std::size_t c = 0; c < joint.channels.size(); ++c) {
        if (!is_position(joint.channels[c])) {
            const double half = 0.5 * kDegree * static_cast<double>(row[joint.first_value + c]);
            BvhDVec3 axis(0);
            axis[axis_of(joint.channels[c])] = std::sin(half);
            rotation = rotation * BvhDQuat(std::cos(half), axis.x, axis.y, axis.z);
        }
    }
    return glm::normalize(rotation);
}

Vec3 position_of(const BvhJoint& joint, const float* row, bool replaces) {
    Vec3 position = joint.offset;
    for (std::size_t c = 0; c < joint.channels.size(); ++c) {
        if (is_position(joint.channels[c])) {
            float& component = position[axis_of(joint.channels[c])];
            component = row[joint.first_value + c] + (replaces ? 0.0f : component);
        }
    }
    return position;
}

bool has_channel(const BvhJoint& joint, bool position) {
    return std::any_of(joint.channels.begin(), joint.channels.end(), [&](BvhChannel channel) {
        return is_position(channel) == position;
    });
}

/// One key per frame.
ClipSheet make_frame_keys(const BvhFile& bvh, const BvhImport& options, float scale, bool z_is_up) {
    ClipSheet sheet;
    std::vector<bool> replaces(bvh.joints.size(), false);
    for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
        const auto joint = static_cast<std::uint16_t>(j);
        if (has_channel(bvh.joints[j], false)) {
            sheet.rotating.push_back(joint);
        }
        if (has_channel(bvh.joints[j], true)) {
            sheet.translating.push_back(joint);
            replaces[j] = replaces_offset(bvh, bvh.joints[j], options.positions);
        }
    }
    const std::size_t width = bvh.channels();
    for (std::size_t f = 0; f < bvh.frames && width > 0; ++f) {
        sheet.times.push_back(
            static_cast<float>(static_cast<double>(f) * static_cast<double>(bvh.frame_time)));
        const float* const row = bvh.values.data() + f * width;
        for (const std::uint16_t j : sheet.rotating) {
            const Quat q(turn_upright(rotation_of(bvh.joints[j], row), z_is_up));
            const std::size_t i = sheet.rotations.size();
            const std::size_t count = sheet.rotating.size();
            sheet.rotations.push_back(
                i < count ? q : to_same_hemisphere(sheet.rotations[i - count], q));
        }
        for (const std::uint16_t j : sheet.translating) {
            sheet.translations.push_back(
                scale * turn_upright(position_of(bvh.joints[j], row, replaces[j]), z_is_up));
        }
    }
    return sheet;
}

}  // namespace

float guess_unit(float height) {
    if (!(height > 0)) {
        return 1;
    }
    return *std::min_element(std::begin(kUnits), std::end(kUnits), [&](float a, float b) {
        const float from_a = std::abs(std::log(a * height / kPersonHeight));
        const float from_b = std::abs(std::log(b * height / kPersonHeight));
        return from_a < from_b;
    });
}

Result<SkeletonMotion>
make_bvh_motion(const BvhFile& bvh, const std::string& name, const BvhImport& options) {
    const std::vector<Vec3> rest = find_rest_positions(bvh);
    SkeletonMotion motion;
    motion.skeleton = make_tree(bvh);
    motion.skeleton.name = name;
    const bool z_is_up =
        options.up == BvhUp::Z || (options.up == BvhUp::Auto && is_z_up(motion.skeleton, rest));
    const float scale = options.scale > 0 ? options.scale : guess_unit(height_of(rest, z_is_up));
    for (const BvhJoint& joint : bvh.joints) {
        motion.skeleton.rest.translations.push_back(scale * turn_upright(joint.offset, z_is_up));
    }
    motion.skeleton.rest.rotations.assign(bvh.joints.size(), Quat(1, 0, 0, 0));
    motion.skeleton.rest.scales.assign(bvh.joints.size(), Vec3(1));
    motion.clip.name = name;
    ClipSheet sheet = make_frame_keys(bvh, options, scale, z_is_up);
    if (!sheet.times.empty()) {
        motion.clip.duration = sheet.times.back();
        motion.clip.sheets.push_back(std::move(sheet));
    }
    LIMN_TRY(check_skeleton(motion.skeleton));
    LIMN_TRY(check_clip(motion.clip, bvh.joints.size(), 0));
    if (options.rate > 0) {
        LIMN_TRY(check_pose_count(motion, options.rate));
        motion = resample_motion(motion, options.rate);
    }
    return motion;
}

Result<SkeletonMotion> load_bvh_motion(const std::string& path, const BvhImport& options) {
    const BvhFile bvh = LIMN_TRY(load_bvh(path));
    Result<SkeletonMotion> motion =
        make_bvh_motion(bvh, std::filesystem::path(path).stem().string(), options);
    return motion ? std::move(motion) : fail("{}: {}", path, motion.error().message);
}

}  // namespace limn
