#include "content/bake/motion/loop_finding.h"

#include "content/bake/motion/body_frame.h"
#include "content/bake/motion/foot_pins.h"
#include "ecs/base/check.h"
#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

// Techniques: char.mocap-cleanup

namespace limn {
namespace {

constexpr float kVelocityWeight = 0.1f;           ///< of a difference of velocities [s]
constexpr float kNoDifference = 1e-8f;            ///< not worth a later or longer interval [m^2]
constexpr std::size_t kMaxCompared = 60'000'000;  ///< joints in pairs of frames; more: fewer begin

/// The parts of the body, or all joints where too few are known.
std::vector<std::uint16_t> find_compared_joints(const SkeletonData& skeleton) {
    std::vector<std::uint16_t> joints;
    for (const std::uint16_t joint : find_body_joints(skeleton).joints) {
        if (joint != BodyJoints::kNoJoint) {
            joints.push_back(joint);
        }
    }
    if (joints.size() < 5) {
        joints.resize(skeleton.joints.size());
        std::iota(joints.begin(), joints.end(), std::uint16_t{0});
    }
    return joints;
}

/// Positions of joints as seen from the body root, which faces +z.
std::vector<std::vector<Vec3>>
find_features(const SkeletonData& skeleton, const MotionFrames& frames, std::uint16_t root) {
    const std::vector<std::uint16_t> compared = find_compared_joints(skeleton);
    const std::vector<Quat> rest = find_frame_rotations(skeleton, skeleton.rest.rotations);
    std::vector<std::vector<Vec3>> features;
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        const std::vector<Affine> joints = find_frame_joints(skeleton, frames, f);
        const std::vector<Quat> rotations = find_frame_rotations(
            skeleton, std::span(frames.rotations).subspan(f * frames.joints, frames.joints));
        const Vec3 forward = rotations[root] * glm::conjugate(rest[root]) * Vec3(0, 0, 1);
        const Quat back = rotation_about({0, 1, 0}, -std::atan2(forward.x, forward.z));
        Vec3 origin = transform_point(joints[root], Vec3(0));
        origin.y = 0;
        std::vector<Vec3>& row = features.emplace_back();
        for (const std::uint16_t joint : compared) {
            row.push_back(back * (transform_point(joints[joint], Vec3(0)) - origin));
        }
    }
    return features;
}

/// Mean squared distance between two frames, with velocities.
float difference_of(
    const std::vector<std::vector<Vec3>>& features, std::size_t a, std::size_t b, float weight) {
    float sum = 0;
    const std::size_t joints = features[a].size();
    const auto velocity = [&](std::size_t f, std::size_t j) {
        const std::size_t next = std::min(f + 1, features.size() - 1);
        const std::size_t previous = f > 0 ? f - 1 : 0;
        return (features[next][j] - features[previous][j])
               / static_cast<float>(std::max<std::size_t>(next - previous, 1));
    };
    for (std::size_t j = 0; j < joints; ++j) {
        const Vec3 apart = features[a][j] - features[b][j];
        const Vec3 faster = weight * (velocity(a, j) - velocity(b, j));
        sum += glm::dot(apart, apart) + glm::dot(faster, faster);
    }
    return sum / static_cast<float>(joints);
}

}  // namespace

std::optional<LoopInterval> find_loop(
    const SkeletonData& skeleton, const MotionFrames& frames, float min_seconds,
    float max_seconds) {
    const std::uint16_t root = find_body_root(skeleton, find_body_joints(skeleton));
    const auto features = find_features(skeleton, frames, root);
    const auto shortest =
        std::max<std::size_t>(static_cast<std::size_t>(std::lround(min_seconds * frames.rate)), 1);
    const std::size_t longest =
        max_seconds > 0 ? static_cast<std::size_t>(std::lround(max_seconds * frames.rate))
                        : features.size();
    const std::size_t pairs = features.size() * std::min(longest, features.size());
    const std::size_t stride = 1 + pairs * features[0].size() / kMaxCompared;
    std::optional<LoopInterval> best;
    float least = std::numeric_limits<float>::infinity();
    const auto compare = [&](std::size_t first) {
        for (std::size_t last = first + shortest; last < features.size() && last - first <= longest;
             ++last) {
            const float difference =
                difference_of(features, first, last, kVelocityWeight * frames.rate);
            if (difference + kNoDifference < least) {
                least = difference;
                best = {first, last, 0};
            }
        }
    };
    for (std::size_t first = 0; first < features.size(); first += stride) {
        compare(first);
    }
    const std::size_t around = best ? best->first : 0;
    for (std::size_t first = around > stride ? around - stride : 0;
         stride > 1 && first < around + stride; ++first) {
        compare(first);
    }
    if (best) {
        best->error = std::sqrt(difference_of(features, best->first, best->last, 0));
    }
    return best;
}

MotionFrames
cut_loop(const SkeletonData& skeleton, const MotionFrames& frames, const LoopInterval& loop) {
    LIMN_CHECK(loop.first < loop.last && loop.last < frames.frames());
    const std::uint16_t root = find_body_root(skeleton, find_body_joints(skeleton));
    // Of the root, only the height is closed, in its parent's space.
    const std::int32_t parent = skeleton.parents[root];
    const std::vector<Quat> rest = find_frame_rotations(skeleton, skeleton.rest.rotations);
    const Vec3 up = parent < 0
                        ? Vec3(0, 1, 0)
                        : glm::conjugate(rest[static_cast<std::size_t>(parent)]) * Vec3(0, 1, 0);
    MotionFrames cut;
    cut.rate = frames.rate;
    cut.joints = frames.joints;
    const std::size_t begin = loop.first * frames.joints;
    const std::size_t end = loop.last * frames.joints;
    for (std::size_t f = loop.first; f <= loop.last; ++f) {
        const float u =
            static_cast<float>(f - loop.first) / static_cast<float>(loop.last - loop.first);
        for (std::size_t j = 0; j < frames.joints; ++j) {
            const std::size_t i = f * frames.joints + j;
            const Quat gap =
                glm::conjugate(frames.rotations[end + j]) * frames.rotations[begin + j];
            Quat rotation = glm::normalize(frames.rotations[i] * slerp(Quat(1, 0, 0, 0), gap, u));
            if (f > loop.first) {
                rotation = to_same_hemisphere(
                    cut.rotations[cut.rotations.size() - frames.joints], rotation);
            }
            cut.rotations.push_back(rotation);
            Vec3 shift = frames.translations[begin + j] - frames.translations[end + j];
            shift = j == root ? glm::dot(shift, up) * up : shift;
            cut.translations.push_back(frames.translations[i] + u * shift);
            cut.scales.push_back(glm::mix(
                frames.scales[i],
                frames.scales[i] + frames.scales[begin + j] - frames.scales[end + j], u));
        }
    }
    return cut;
}

}  // namespace limn
