// Scalar version of pose_chain.h: the bit-exact reference of the SIMD version, and what runs where
// there are no vectors.

#include "ecs/base/check.h"
#include "systems/animation/crowd_frames.h"
#include "systems/animation/pose_chain.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace limn {
namespace crowd {
namespace {

float mix(float a, float b, float u) {
    return a + (b - a) * u;
}

Quat mix(const Quat& a, const Quat& b, float u) {
    return {mix(a.w, b.w, u), mix(a.x, b.x, u), mix(a.y, b.y, u), mix(a.z, b.z, u)};
}

float dot(const Quat& a, const Quat& b) {
    return (a.x * b.x + a.y * b.y) + (a.z * b.z + a.w * b.w);
}

Quat scale(const Quat& q, float factor) {
    return {q.w * factor, q.x * factor, q.y * factor, q.z * factor};
}

float inverse_length(float length2) {
    const float left = 1.0f - length2 * (1.0f / kPackedLength2);
    float sum = kInverseRoot[3];
    for (std::size_t i = 3; i-- > 0;) {
        sum = sum * left + kInverseRoot[i];
    }
    return sum;
}

void put(PoseRows& rows, std::size_t joint, const Quat& q) {
    float* const v = rows.values.data() + joint;
    v[0] = q.x;
    v[rows.stride] = q.y;
    v[2 * rows.stride] = q.z;
    v[3 * rows.stride] = q.w;
}

Affine multiply(const Affine& a, const Affine& b) {
    Affine product;
    for (int i = 0; i < 3; ++i) {
        const Vec4& row = a.row[i];
        product.row[i] = row.x * b.row[0] + row.y * b.row[1] + row.z * b.row[2];
        product.row[i].w += row.w;
    }
    return product;
}

}  // namespace
}  // namespace crowd

void sample_crowd_clip_scalar(
    const CrowdClip& clip, float time, PoseRows& rows, std::size_t max_joints) {
    const std::size_t joints = std::min(clip.joints, max_joints);
    rows.resize(joints);
    const crowd::FramePair at = crowd::find_frames(clip, time);
    const CrowdTracks& turns = clip.rotations;
    const auto packed = [&](std::size_t frame, std::size_t column) {
        const std::uint16_t* const words =
            turns.frames.data() + 3 * turns.animated * frame + column;
        return unpack_rotation({words[0], words[turns.animated], words[2 * turns.animated]});
    };
    crowd::copy_all_constants(clip, rows);
    for (const TrackRun& run : turns.runs) {
        for (std::size_t i = 0; i < run.count && run.first + i < joints; ++i) {
            const std::size_t column = run.track + i;
            const Quat mixed =
                crowd::mix(packed(at.first, column), packed(at.first + at.step, column), at.u);
            crowd::put(
                rows, run.first + i,
                crowd::scale(mixed, crowd::inverse_length(crowd::dot(mixed, mixed))));
        }
    }
    const CrowdTracks& moves = clip.translations;
    const std::size_t width = moves.animated;
    const std::uint16_t* const frame = moves.frames.data() + 3 * width * at.first;
    for (const TrackRun& run : moves.runs) {
        for (std::size_t i = 0; i < run.count && run.first + i < joints; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t column = axis * width + run.track + i;
                const float steps =
                    crowd::mix(frame[column], frame[column + 3 * width * at.step], at.u);
                rows.values[(4 + axis) * rows.stride + run.first + i] =
                    steps * moves.ranges[column + 3 * width] + moves.ranges[column];
            }
        }
    }
}

void blend_poses_scalar(const PoseRows& a, const PoseRows& b, float weight, PoseRows& out) {
    LIMN_CHECK(a.joints == b.joints);
    out.resize(a.joints);
    for (std::size_t j = 0; j < a.joints; ++j) {
        const Quat p = a.rotation(j);
        const Quat q = b.rotation(j);
        const bool flips = std::signbit(crowd::dot(p, q));
        const Quat sum = crowd::mix(p, flips ? crowd::scale(q, -1.0f) : q, weight);
        const Vec3 from = a.translation(j);
        const Vec3 to = b.translation(j);
        crowd::put(out, j, crowd::scale(sum, 1.0f / std::sqrt(crowd::dot(sum, sum))));
        for (int axis = 0; axis < 3; ++axis) {
            out.values[(4 + static_cast<std::size_t>(axis)) * out.stride + j] =
                crowd::mix(from[axis], to[axis], weight);
        }
    }
}

void compute_crowd_joints(
    const CrowdRig& rig, const PoseRows& rows, std::span<Affine> joints,
    std::span<const Affine> joint_from_mesh) {
    LIMN_CHECK(rows.joints == rig.joints() && joints.size() == rig.joints());
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const Affine local = affine_from(rows.translation(j), rows.rotation(j), rig.scales[j]);
        const std::int32_t parent = rig.parents[j];
        joints[j] =
            parent < 0 ? local : crowd::multiply(joints[static_cast<std::size_t>(parent)], local);
    }
    for (std::size_t j = 0; j < joint_from_mesh.size(); ++j) {
        joints[j] = crowd::multiply(joints[j], joint_from_mesh[j]);
    }
}

void pose_crowd_scalar(
    const CrowdRig& rig, std::span<const CrowdCharacter> characters,
    std::span<const Affine> joint_from_mesh) {
    PoseRows rows;
    PoseRows next;
    for (const CrowdCharacter& character : characters) {
        sample_crowd_clip_scalar(*character.clip, character.time, rows, rig.joints());
        if (character.next != nullptr) {
            sample_crowd_clip_scalar(*character.next, character.next_time, next, rig.joints());
            blend_poses_scalar(rows, next, character.weight, rows);
        }
        compute_crowd_joints(rig, rows, {character.joints, rig.joints()}, joint_from_mesh);
    }
}

}  // namespace limn
