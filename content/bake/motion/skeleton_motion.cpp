#include "content/bake/motion/skeleton_motion.h"

#include "ecs/base/check.h"
#include "ecs/base/rotation.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

// Techniques: char.mocap-rate

namespace limn {
namespace {

constexpr float kDefaultMotionRate = 30.0f;
constexpr double kMaxPoseJoints = 1e8;  ///< joints of all poses: 4 GB

/// Two rows of a sheet, and how far between them.
struct RowPair {
    std::size_t first = 0;
    std::size_t second = 0;
    float u = 0;
    float seconds = 0;  ///< between them
};

RowPair find_row_pair(const ClipSheet& sheet, float time) {
    const std::vector<float>& times = sheet.times;
    const std::size_t last = times.size() - 1;
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    if (after == times.begin()) {
        return {};
    }
    const auto first = static_cast<std::size_t>(after - times.begin()) - 1;
    if (first == last || sheet.interpolation == Interpolation::Step) {
        return {first, first, 0, 0};
    }
    const float seconds = times[first + 1] - times[first];
    return {first, first + 1, std::min((time - times[first]) / seconds, 1.0f), seconds};
}

/// The value of column `column` of `width` at the rows of `at`.
template <typename T>
T sample_column(
    const ClipSheet& sheet, const std::vector<T>& rows, std::size_t width, std::size_t column,
    const RowPair& at) {
    if (sheet.interpolation != Interpolation::Cubic) {
        const T& a = rows[at.first * width + column];
        const T& b = rows[at.second * width + column];
        if constexpr (std::is_same_v<T, Quat>) {
            return slerp(a, b, at.u);
        } else {
            return a * (1.0f - at.u) + b * at.u;
        }
    }
    const auto value = [&](std::size_t key, std::size_t part) {
        return rows[(3 * key + part) * width + column];
    };
    const float u = at.u;
    const float u2 = u * u;
    const float u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * value(at.first, 1)
           + (at.seconds * (u3 - 2 * u2 + u)) * value(at.first, 2)
           + (3 * u2 - 2 * u3) * value(at.second, 1)
           + (at.seconds * (u3 - u2)) * value(at.second, 0);
}

/// The joints whose values differ from `rest` in some frame.
template <typename T>
std::vector<std::uint16_t>
find_moving(const std::vector<T>& values, const std::vector<T>& rest, std::size_t joints) {
    std::vector<bool> moves(joints, false);
    for (std::size_t i = 0; i < values.size(); ++i) {
        moves[i % joints] = moves[i % joints] || values[i] != rest[i % joints];
    }
    std::vector<std::uint16_t> found;
    for (std::size_t j = 0; j < joints; ++j) {
        if (moves[j]) {
            found.push_back(static_cast<std::uint16_t>(j));
        }
    }
    return found;
}

template <typename T>
std::vector<T> choose_columns(
    const std::vector<T>& values, const std::vector<std::uint16_t>& columns, std::size_t joints) {
    std::vector<T> chosen;
    chosen.reserve(values.size() / joints * columns.size());
    for (std::size_t row = 0; row < values.size(); row += joints) {
        for (const std::uint16_t column : columns) {
            chosen.push_back(values[row + column]);
        }
    }
    return chosen;
}

}  // namespace

LocalPose sample_motion(const SkeletonData& skeleton, const ClipData& clip, float time) {
    LocalPose pose = skeleton.rest;
    for (const ClipSheet& sheet : clip.sheets) {
        const RowPair at = find_row_pair(sheet, time);
        for (std::size_t i = 0; i < sheet.rotating.size(); ++i) {
            pose.rotations[sheet.rotating[i]] = normalize_or_identity(
                sample_column(sheet, sheet.rotations, sheet.rotating.size(), i, at));
        }
        for (std::size_t i = 0; i < sheet.translating.size(); ++i) {
            pose.translations[sheet.translating[i]] =
                sample_column(sheet, sheet.translations, sheet.translating.size(), i, at);
        }
        for (std::size_t i = 0; i < sheet.scaling.size(); ++i) {
            pose.scales[sheet.scaling[i]] =
                sample_column(sheet, sheet.scales, sheet.scaling.size(), i, at);
        }
    }
    return pose;
}

float find_motion_rate(const ClipData& clip) {
    for (const ClipSheet& sheet : clip.sheets) {
        const std::vector<float>& times = sheet.times;
        if (times.size() < 2) {
            continue;
        }
        const float step = (times.back() - times.front()) / static_cast<float>(times.size() - 1);
        bool is_even = true;
        for (std::size_t i = 1; i < times.size(); ++i) {
            is_even = is_even && std::abs(times[i] - times[i - 1] - step) <= 0.01f * step;
        }
        if (is_even) {
            return 1 / step;
        }
    }
    return kDefaultMotionRate;
}

Status check_pose_count(const SkeletonMotion& motion, float rate) {
    const double poses = std::floor(static_cast<double>(motion.clip.duration) * rate) + 1;
    const auto joints = static_cast<double>(motion.skeleton.joints.size());
    if (!(poses * joints <= kMaxPoseJoints)) {
        return fail(
            "found {} s at {} poses per second of {} joints, expected at most {} joints in all "
            "poses",
            motion.clip.duration, rate, motion.skeleton.joints.size(), kMaxPoseJoints);
    }
    return Done{};
}

MotionFrames sample_frames(const SkeletonMotion& motion, float rate) {
    LIMN_CHECK(rate > 0);
    MotionFrames frames;
    frames.rate = rate;
    frames.joints = motion.skeleton.joints.size();
    const double last = std::floor(static_cast<double>(motion.clip.duration) * rate + 1e-3);
    const auto count = static_cast<std::size_t>(std::max(last, 0.0)) + 1;
    for (std::size_t f = 0; f < count; ++f) {
        const auto time = static_cast<float>(static_cast<double>(f) / rate);
        LocalPose pose = sample_motion(motion.skeleton, motion.clip, time);
        if (f > 0) {
            const Quat* const previous = &frames.rotations[(f - 1) * frames.joints];
            for (std::size_t j = 0; j < frames.joints; ++j) {
                pose.rotations[j] = to_same_hemisphere(previous[j], pose.rotations[j]);
            }
        }
        frames.translations.insert(
            frames.translations.end(), pose.translations.begin(), pose.translations.end());
        frames.rotations.insert(
            frames.rotations.end(), pose.rotations.begin(), pose.rotations.end());
        frames.scales.insert(frames.scales.end(), pose.scales.begin(), pose.scales.end());
    }
    return frames;
}

ClipData
make_frames_clip(const SkeletonData& skeleton, const MotionFrames& frames, const ClipData& like) {
    LIMN_CHECK(frames.joints == skeleton.joints.size());
    ClipData clip;
    clip.name = like.name;
    ClipSheet sheet;
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        sheet.times.push_back(static_cast<float>(static_cast<double>(f) / frames.rate));
    }
    clip.duration = sheet.times.empty() ? 0.0f : sheet.times.back();
    sheet.rotating = find_moving(frames.rotations, skeleton.rest.rotations, frames.joints);
    sheet.rotations = choose_columns(frames.rotations, sheet.rotating, frames.joints);
    sheet.translating = find_moving(frames.translations, skeleton.rest.translations, frames.joints);
    sheet.translations = choose_columns(frames.translations, sheet.translating, frames.joints);
    sheet.scaling = find_moving(frames.scales, skeleton.rest.scales, frames.joints);
    sheet.scales = choose_columns(frames.scales, sheet.scaling, frames.joints);
    clip.sheets.push_back(std::move(sheet));
    for (ClipContact contact : like.contacts) {
        contact.end = std::min(contact.end, clip.duration);
        if (contact.begin <= contact.end) {
            clip.contacts.push_back(contact);
        }
    }
    for (const ClipEvent& event : like.events) {
        if (event.time <= clip.duration) {
            clip.events.push_back(event);
        }
    }
    return clip;
}

std::vector<Affine>
find_frame_joints(const SkeletonData& skeleton, const MotionFrames& frames, std::size_t frame) {
    std::vector<Affine> joints;
    joints.reserve(frames.joints);
    for (std::size_t j = 0; j < frames.joints; ++j) {
        const std::size_t i = frame * frames.joints + j;
        const Affine local =
            affine_from(frames.translations[i], frames.rotations[i], frames.scales[i]);
        const std::int32_t parent = skeleton.parents[j];
        joints.push_back(parent < 0 ? local : joints[static_cast<std::size_t>(parent)] * local);
    }
    return joints;
}

std::vector<Vec3>
joint_path(const SkeletonData& skeleton, const MotionFrames& frames, std::size_t joint) {
    std::vector<Vec3> path;
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        path.push_back(transform_point(find_frame_joints(skeleton, frames, f)[joint], Vec3(0)));
    }
    return path;
}

SkeletonMotion resample_motion(const SkeletonMotion& motion, float rate) {
    return {
        motion.skeleton,
        make_frames_clip(motion.skeleton, sample_frames(motion, rate), motion.clip)};
}

}  // namespace limn
