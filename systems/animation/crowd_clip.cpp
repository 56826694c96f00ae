#include "systems/animation/crowd_clip.h"

#include "ecs/base/text.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_chain.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.clip-layout

namespace limn {
namespace {

constexpr double kMaxRate = 120.0;  ///< frames per second
constexpr std::size_t kMaxCrowdFrames = 65536;
constexpr float kSameRotation = 3e-5f;      ///< of a component; about half a step of a word
constexpr std::size_t kMinConstantRun = 4;  ///< fewer constant joints do not end a run
constexpr float kTranslationSteps = 65535.0f;
constexpr float kScaleTolerance = 1e-5f;

/// A clip sampled at uniform frames: frame f of joint j is at f * joints + j.
struct SampledClip {
    std::size_t joints = 0;
    std::size_t frames = 0;
    std::vector<Quat> rotations;  ///< aligned from frame to frame
    std::vector<Vec3> translations;
};

void sample_exactly(
    const SkeletonData& skeleton, const ClipData& clip, float time, LocalPose& pose) {

    pose.translations = skeleton.rest.translations;
    pose.rotations = skeleton.rest.rotations;
    pose.scales = skeleton.rest.scales;
    sample_clip(clip, time, pose, {});
}

SampledClip
sample_uniformly(const SkeletonData& skeleton, const ClipData& clip, std::size_t frames) {
    SampledClip sampled;
    sampled.joints = skeleton.parents.size();
    sampled.frames = frames;
    LocalPose pose;
    for (std::size_t f = 0; f < frames; ++f) {
        const double u = frames > 1 ? static_cast<double>(f) / static_cast<double>(frames - 1) : 0;
        sample_exactly(skeleton, clip, static_cast<float>(u * clip.duration), pose);
        for (std::size_t j = 0; j < sampled.joints; ++j) {
            const Quat& q = pose.rotations[j];
            const bool flips =
                f > 0 && glm::dot(sampled.rotations[(f - 1) * sampled.joints + j], q) < 0;
            sampled.rotations.push_back(flips ? -q : q);
            sampled.translations.push_back(pose.translations[j]);
        }
    }
    return sampled;
}

float largest_difference(const Quat& a, const Quat& b) {
    const Quat d = a - b;
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z), std::abs(d.w)});
}

float largest_difference(const Vec3& a, const Vec3& b) {
    const Vec3 d = glm::abs(a - b);
    return std::max({d.x, d.y, d.z});
}

/// Joints whose value changes by more than `tolerance`.
template <typename T>
std::vector<bool> find_animated(const std::vector<T>& values, std::size_t joints, float tolerance) {
    std::vector<bool> animated(joints);
    for (std::size_t i = joints; i < values.size(); ++i) {
        const std::size_t j = i % joints;
        animated[j] = animated[j] || largest_difference(values[j], values[i]) > tolerance;
    }
    return animated;
}

/// A few constant joints between animated ones count as animated.
void make_runs(const std::vector<bool>& animated, CrowdTracks& tracks) {
    for (std::size_t j = 0; j < animated.size(); ++j) {
        if (!animated[j]) {
            continue;
        }
        const std::size_t end =
            tracks.runs.empty() ? 0 : tracks.runs.back().first + tracks.runs.back().count;
        const std::size_t first = !tracks.runs.empty() && j - end < kMinConstantRun ? end : j;
        if (first == j && (tracks.runs.empty() || j != end)) {
            tracks.runs.push_back(
                {static_cast<std::uint16_t>(j), 0, static_cast<std::uint32_t>(tracks.animated)});
        }
        tracks.runs.back().count += static_cast<std::uint16_t>(j + 1 - first);
        tracks.animated += j + 1 - first;
    }
}

/// Calls put(joint, column) for each animated track.
template <typename Put>
void each_track(const CrowdTracks& tracks, Put&& put) {
    for (const TrackRun& run : tracks.runs) {
        for (std::size_t i = 0; i < run.count; ++i) {
            put(run.first + i, run.track + i);
        }
    }
}

/// The first frame of all joints, unless all are animated.
template <typename T>
void set_constants(
    const std::vector<T>& values, std::size_t joints, std::size_t components, CrowdTracks& tracks) {
    if (tracks.animated == joints) {
        return;
    }
    const std::size_t stride = pose_stride(joints);
    tracks.constants.assign(components * stride + kPosePadding, 0.0f);
    for (std::size_t row = 0; row < components; ++row) {
        for (std::size_t j = 0; j < joints; ++j) {
            tracks.constants[row * stride + j] = values[j][static_cast<glm::length_t>(row)];
        }
    }
}

CrowdTracks pack_rotations(const SampledClip& sampled) {
    CrowdTracks tracks;
    make_runs(find_animated(sampled.rotations, sampled.joints, kSameRotation), tracks);
    set_constants(sampled.rotations, sampled.joints, 4, tracks);
    tracks.frames.assign(3 * tracks.animated * sampled.frames + kPosePadding, 0);
    for (std::size_t f = 0; f < sampled.frames; ++f) {
        std::uint16_t* const rows = tracks.frames.data() + 3 * tracks.animated * f;
        each_track(tracks, [&](std::size_t joint, std::size_t column) {
            const PackedRotation words =
                pack_rotation(sampled.rotations[f * sampled.joints + joint]);
            for (std::size_t row = 0; row < 3; ++row) {
                rows[row * tracks.animated + column] = words[row];
            }
        });
    }
    return tracks;
}

CrowdTracks pack_translations(const SampledClip& sampled, float tolerance) {
    CrowdTracks tracks;
    make_runs(find_animated(sampled.translations, sampled.joints, tolerance), tracks);
    set_constants(sampled.translations, sampled.joints, 3, tracks);
    tracks.frames.assign(3 * tracks.animated * sampled.frames + kPosePadding, 0);
    tracks.ranges.assign(tracks.animated > 0 ? 6 * tracks.animated + kPosePadding : 0, 0.0f);
    each_track(tracks, [&](std::size_t joint, std::size_t column) {
        Bounds range;
        for (std::size_t f = 0; f < sampled.frames; ++f) {
            grow(range, sampled.translations[f * sampled.joints + joint]);
        }
        for (int axis = 0; axis < 3; ++axis) {
            const auto row = static_cast<std::size_t>(axis);
            const float low = range.min[axis];
            const float step = (range.max[axis] - low) / kTranslationSteps;
            tracks.ranges[row * tracks.animated + column] = low;
            tracks.ranges[(3 + row) * tracks.animated + column] = step;
            for (std::size_t f = 0; f < sampled.frames; ++f) {
                const float value = sampled.translations[f * sampled.joints + joint][axis];
                const float word = step > 0 ? std::round((value - low) / step) : 0.0f;
                tracks.frames[(3 * f + row) * tracks.animated + column] =
                    static_cast<std::uint16_t>(std::clamp(word, 0.0f, kTranslationSteps));
            }
        }
    });
    return tracks;
}

/// The smallest cosine between rotations of neighboring frames.
float smallest_cosine(const SampledClip& sampled) {
    float smallest = 1;
    for (std::size_t i = sampled.joints; i < sampled.rotations.size(); ++i) {
        smallest = std::min(
            smallest, glm::dot(sampled.rotations[i - sampled.joints], sampled.rotations[i]));
    }
    return smallest;
}

CrowdClip pack_clip(const ClipData& clip, const SampledClip& sampled, float tolerance) {
    const std::size_t frames = sampled.frames;
    CrowdClip packed;
    packed.joints = sampled.joints;
    packed.frames = frames;
    packed.duration = clip.duration;
    packed.rate = frames > 1 ? static_cast<float>(frames - 1) / clip.duration : 0.0f;
    packed.rotations = pack_rotations(sampled);
    packed.translations = pack_translations(sampled, 0.01f * tolerance);
    return packed;
}

/// Times of the keys, and halfway between the frames [s].
std::vector<float> times_to_check(const ClipData& clip, std::size_t frames) {
    std::vector<float> times;
    for (const ClipSheet& sheet : clip.sheets) {
        times.insert(times.end(), sheet.times.begin(), sheet.times.end());
    }
    for (std::size_t f = 0; f + 1 < frames; ++f) {
        times.push_back(
            clip.duration * (static_cast<float>(f) + 0.5f) / static_cast<float>(frames - 1));
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

/// Stops at the first error above the tolerance.
float measure_error(
    const SkeletonData& skeleton, const ClipData& clip, const CrowdClip& packed,
    const CrowdClipLimits& limits) {
    const CrowdRig rig = make_crowd_rig(skeleton);
    LocalPose pose;
    PoseRows rows;
    std::vector<Affine> exact(packed.joints);
    std::vector<Affine> ours(packed.joints);
    float worst = 0;
    for (const float time : times_to_check(clip, packed.frames)) {
        sample_exactly(skeleton, clip, time, pose);
        compute_joint_matrices(skeleton, pose, exact);
        sample_crowd_clip(packed, time, rows);
        compute_crowd_joints(rig, rows, ours);
        worst = std::max(worst, shell_error(exact, ours, limits.shell));
        if (!(worst <= limits.tolerance)) {
            break;
        }
    }
    return worst;
}

/// Numbers of frames to try, ascending: fractions and multiples of those at which each key has a
/// frame of its own, and common rates, for motion between few keys.
std::vector<std::size_t> candidate_frames(const ClipData& clip) {
    if (!(clip.duration > 0)) {
        return {1};
    }
    double closest = clip.duration;
    for (const ClipSheet& sheet : clip.sheets) {
        for (std::size_t i = 1; i < sheet.times.size(); ++i) {
            closest = std::min(closest, static_cast<double>(sheet.times[i] - sheet.times[i - 1]));
        }
    }
    const double duration = clip.duration;
    const double most = std::min(kMaxRate * duration + 2, static_cast<double>(kMaxCrowdFrames));
    const double own = std::round(duration / std::max(closest, 1 / kMaxRate));
    std::vector<std::size_t> candidates;
    for (const double fraction : {1.0 / 8, 1.0 / 6, 0.25, 1.0 / 3, 0.5, 2.0 / 3, 1.0, 2.0}) {
        candidates.push_back(
            static_cast<std::size_t>(std::min(std::ceil(fraction * own) + 1, most)));
    }
    for (const double rate : {15.0, 30.0, 60.0, kMaxRate}) {
        candidates.push_back(
            static_cast<std::size_t>(std::min(std::ceil(rate * duration) + 1, most)));
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    return candidates;
}

/// Crowds take morph weights from the clip itself.
ClipData without_weights(ClipData clip) {
    for (ClipSheet& sheet : clip.sheets) {
        sheet.morphing.clear();
        sheet.weights.clear();
    }
    std::erase_if(clip.sheets, [](const ClipSheet& sheet) {
        return sheet.rotating.empty() && sheet.translating.empty() && sheet.scaling.empty();
    });
    return clip;
}

Status check_convertible(const SkeletonData& skeleton, const ClipData& clip) {
    if (const Status valid = check_clip(clip, skeleton.joints.size(), 0); !valid) {
        return valid.error();
    }
    for (const ClipSheet& sheet : clip.sheets) {
        const std::size_t width = sheet.scaling.size();
        for (std::size_t i = 0; i < sheet.scales.size(); ++i) {
            const std::uint16_t joint = sheet.scaling[i % width];
            if (sheet.interpolation == Interpolation::Cubic
                || largest_difference(skeleton.rest.scales[joint], sheet.scales[i])
                       > kScaleTolerance) {
                return fail(
                    "clip {}: found scales of joint {}, expected none that move: crowds do not "
                    "have them",
                    clip.name, skeleton.joints[joint]);
            }
        }
    }
    return Done{};
}

/// The even or odd integer nearest to `value`.
std::int16_t nearest_integer(float value, bool odd) {
    const float shift = odd ? 1.0f : 0.0f;
    const float half = std::round((std::clamp(value, -kPackedMax, kPackedMax) - shift) / 2.0f);
    return static_cast<std::int16_t>(2.0f * half + shift);
}

}  // namespace

PackedRotation pack_rotation(const Quat& rotation) {
    const float q[] = {rotation.x, rotation.y, rotation.z, rotation.w};
    std::size_t largest = 0;
    for (std::size_t i = 1; i < 4; ++i) {
        largest = std::abs(q[i]) > std::abs(q[largest]) ? i : largest;
    }
    const bool is_odd[] = {(largest & 1) != 0, largest > 1, q[largest] < 0};
    PackedRotation words = {};
    std::size_t next = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        if (i == largest) {
            continue;
        }
        words[next] = static_cast<std::uint16_t>(
            nearest_integer(q[i] * (kPackedMax * 1.41421356f), is_odd[next]));
        ++next;
    }
    return words;
}

Quat unpack_rotation(const PackedRotation& words) {
    float others[3];
    for (std::size_t i = 0; i < 3; ++i) {
        others[i] = static_cast<std::int16_t>(words[i]);
    }
    const float sum = (others[0] * others[0] + others[1] * others[1]) + others[2] * others[2];
    const float size =
        std::sqrt(2.0f * kPackedMax * kPackedMax - sum);  // at least kPackedMax / 1.5
    const float largest = (words[2] & 1) != 0 ? -size : size;
    const std::size_t index = (words[0] & 1u) | (words[1] & 1u) << 1;
    float q[4];
    for (std::size_t i = 0, next = 0; i < 4; ++i) {
        q[i] = i == index ? largest : others[next++];
    }
    return {q[3], q[0], q[1], q[2]};
}

CrowdClipLimits scale_limits(const SkeletonData& skeleton) {
    constexpr float kTall = 2.0f;
    std::vector<Affine> joints(skeleton.joints.size());
    compute_joint_matrices(skeleton, skeleton.rest, joints);
    Bounds bounds;
    for (const Affine& joint : joints) {
        grow(bounds, {joint.row[0].w, joint.row[1].w, joint.row[2].w});
    }
    const Vec3 size = joints.empty() ? Vec3(0) : 2.0f * half_extent(bounds);
    const float scale = std::max({size.x, size.y, size.z}) / kTall;
    const CrowdClipLimits limits;
    return scale > 0 && std::isfinite(scale)
               ? CrowdClipLimits{scale * limits.tolerance, scale * limits.shell}
               : limits;
}

Result<CrowdClip> make_crowd_clip(
    const SkeletonData& skeleton, const ClipData& source, const CrowdClipLimits& limits) {
    const ClipData clip = without_weights(source);
    if (const Status convertible = check_convertible(skeleton, clip); !convertible) {
        return convertible.error();
    }
    float error = INFINITY;
    for (const std::size_t frames : candidate_frames(clip)) {
        const SampledClip sampled = sample_uniformly(skeleton, clip, frames);
        if (smallest_cosine(sampled) < kMinFrameCosine) {
            continue;
        }
        CrowdClip packed = pack_clip(clip, sampled, limits.tolerance);
        error = measure_error(skeleton, clip, packed, limits);
        if (error <= limits.tolerance) {
            packed.error = error;
            return packed;
        }
    }
    return fail(
        "clip {}: found motion that uniform frames do not follow within {} m, expected no jumps",
        clip.name, limits.tolerance);
}

float shell_error(std::span<const Affine> a, std::span<const Affine> b, float shell) {
    float worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        Vec3 center;
        float turned = 0;
        for (int row = 0; row < 3; ++row) {
            center[row] = a[i].row[row].w - b[i].row[row].w;
        }
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 offset;
            for (int row = 0; row < 3; ++row) {
                offset[row] = shell * (a[i].row[row][axis] - b[i].row[row][axis]);
            }
            turned = std::max({turned, glm::length(center + offset), glm::length(center - offset)});
        }
        worst = std::max(worst, turned);
        if (!std::isfinite(turned)) {
            return turned;
        }
    }
    return worst;
}

std::size_t crowd_clip_bytes(const CrowdClip& clip) {
    std::size_t bytes = 0;
    for (const CrowdTracks* tracks : {&clip.rotations, &clip.translations}) {
        bytes += tracks->frames.size() * sizeof(std::uint16_t)
                 + tracks->constants.size() * sizeof(float) + tracks->ranges.size() * sizeof(float)
                 + tracks->runs.size() * sizeof(TrackRun);
    }
    return bytes;
}

}  // namespace limn
