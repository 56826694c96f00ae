#include "content/load/motion/bvh_export.h"

#include "content/load/files/atomic_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

// Techniques: char.bvh-format

namespace limn {
namespace {

/// Angles [degrees] about z, x and y with R = Rz Rx Ry.
std::array<float, 3> zxy_angles(const Quat& rotation) {
    const glm::dmat3 r = glm::mat3_cast(glm::dquat(rotation));  // r[column][row]
    const double sine = std::clamp(r[1][2], -1.0, 1.0);
    std::array<double, 3> angles = {0, std::asin(sine), 0};
    if (std::abs(sine) < 1.0 - 1e-9) {
        angles[0] = std::atan2(-r[1][0], r[1][1]);
        angles[2] = std::atan2(-r[0][2], r[2][2]);
    } else {  // z and y turn about the same axis
        angles[0] = std::atan2(r[0][1], r[0][0]);
    }
    std::array<float, 3> in_degrees{};
    for (std::size_t i = 0; i < 3; ++i) {
        in_degrees[i] = static_cast<float>(glm::degrees(angles[i]));
    }
    return in_degrees;
}

class BvhExport {
  public:
    BvhExport(const SkeletonMotion& motion, float scale)
        : skeleton_(motion.skeleton), clip_(motion.clip), scale_(scale),
          number_(motion.skeleton.joints.size(), 0) {
        children_.resize(skeleton_.joints.size());
        for (std::size_t j = 1; j < skeleton_.joints.size(); ++j) {
            children_[parent_of(j)].push_back(j);
        }
        root_ = is_scene(0) ? 1 : 0;
        find_rest();
        find_order();
    }

    BvhFile make(float rate) {
        const MotionFrames frames = sample_frames({skeleton_, clip_}, rate);
        bvh_.frame_time = 1 / rate;
        bvh_.frames = frames.frames();
        add_joints();
        for (std::size_t f = 0; f < frames.frames(); ++f) {
            for (const std::size_t joint : order_) {
                add_values(joint, frames, f);
            }
        }
        return std::move(bvh_);
    }

  private:
    [[nodiscard]] std::size_t parent_of(std::size_t joint) const {
        return static_cast<std::size_t>(skeleton_.parents[joint]);
    }

    [[nodiscard]] bool is_animated(std::size_t joint, bool only_position) const {
        const auto j = static_cast<std::uint16_t>(joint);
        const auto has = [&](const std::vector<std::uint16_t>& list) {
            return std::find(list.begin(), list.end(), j) != list.end();
        };
        return std::any_of(clip_.sheets.begin(), clip_.sheets.end(), [&](const ClipSheet& sheet) {
            return has(sheet.translating)
                   || (!only_position && (has(sheet.rotating) || has(sheet.scaling)));
        });
    }

    /// Whether the joint does nothing but hold the root.
    [[nodiscard]] bool is_scene(std::size_t joint) const {
        const LocalPose& rest = skeleton_.rest;
        return children_[joint].size() == 1 && rest.translations[joint] == Vec3(0)
               && rest.rotations[joint] == Quat(1, 0, 0, 0) && rest.scales[joint] == Vec3(1)
               && !is_animated(joint, false);
    }

    /// Positions and rotations at rest in the skeleton's space.
    void find_rest() {
        std::vector<Affine> matrices;
        for (std::size_t j = 0; j < skeleton_.joints.size(); ++j) {
            const LocalPose& rest = skeleton_.rest;
            const Affine local =
                affine_from(rest.translations[j], rest.rotations[j], rest.scales[j]);
            matrices.push_back(j == 0 ? local : matrices[parent_of(j)] * local);
            rest_positions_.push_back(transform_point(matrices[j], Vec3(0)));
            rest_rotations_.push_back(
                j == 0 ? rest.rotations[j] : rest_rotations_[parent_of(j)] * rest.rotations[j]);
        }
    }

    /// Depth first, as the rows of a file are.
    void find_order() {
        std::vector<std::size_t> pending = {root_};
        while (!pending.empty()) {
            const std::size_t joint = pending.back();
            pending.pop_back();
            number_[joint] = order_.size();
            order_.push_back(joint);
            pending.insert(pending.end(), children_[joint].rbegin(), children_[joint].rend());
        }
    }

    void add_joints() {
        std::size_t values = 0;
        for (const std::size_t j : order_) {
            BvhJoint& joint = bvh_.joints.emplace_back();
            const bool is_root = j == root_;
            joint.parent = is_root ? -1 : static_cast<std::int32_t>(number_[parent_of(j)]);
            joint.offset =
                (rest_positions_[j] - (is_root ? Vec3(0) : rest_positions_[parent_of(j)])) / scale_;
            joint.first_value = values;
            joint.is_end =
                !is_root && children_[j].empty() && skeleton_.joints[j].ends_with("_end");
            if (joint.is_end) {
                continue;
            }
            joint.name = skeleton_.joints[j];
            if (is_root || is_animated(j, true)) {
                joint.channels = {
                    BvhChannel::Xposition, BvhChannel::Yposition, BvhChannel::Zposition};
            }
            joint.channels.insert(
                joint.channels.end(),
                {BvhChannel::Zrotation, BvhChannel::Xrotation, BvhChannel::Yrotation});
            values += joint.channels.size();
        }
    }

    /// The channels of a joint in frame `frame`.
    void add_values(std::size_t j, const MotionFrames& frames, std::size_t frame) {
        const BvhJoint& joint = bvh_.joints[number_[j]];
        const std::size_t i = frame * frames.joints + j;
        const Quat outer = j == 0 ? Quat(1, 0, 0, 0) : rest_rotations_[parent_of(j)];
        if (joint.channels.size() == kBvhChannels) {  // absolute, as most programs write them
            const Vec3 moved = outer * (frames.translations[i] - skeleton_.rest.translations[j]);
            for (int axis = 0; axis < 3; ++axis) {
                bvh_.values.push_back(joint.offset[axis] + moved[axis] / scale_);
            }
        }
        if (!joint.is_end) {
            const std::array<float, 3> angles =
                zxy_angles(outer * frames.rotations[i] * glm::conjugate(rest_rotations_[j]));
            bvh_.values.insert(bvh_.values.end(), angles.begin(), angles.end());
        }
    }

    const SkeletonData& skeleton_;
    const ClipData& clip_;
    float scale_;  ///< [m]
    std::size_t root_ = 0;
    std::vector<std::vector<std::size_t>> children_;
    std::vector<Vec3> rest_positions_;
    std::vector<Quat> rest_rotations_;
    std::vector<std::size_t> order_;   ///< of the joints in the file
    std::vector<std::size_t> number_;  ///< of each joint in the file
    BvhFile bvh_;
};

}  // namespace

BvhFile make_bvh_file(const SkeletonMotion& motion, float rate, float scale) {
    return BvhExport(motion, scale).make(rate);
}

Status save_bvh(const std::string& path, const SkeletonMotion& motion) {
    return write_file(path, write_bvh(make_bvh_file(motion, find_motion_rate(motion.clip))));
}

}  // namespace limn
