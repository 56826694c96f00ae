#pragma once

#include "bench/characters/scalar_pose.h"
#include "ecs/components/skeleton.h"
#include "systems/animation/pose_chain.h"

#include <cstddef>
#include <vector>

namespace limn::bench {

/// A skeleton like a person's: a spine, limbs and fingers, about as deep as a real one, 1.8 m tall.
[[nodiscard]] SkeletonData make_bench_skeleton(std::size_t joints);

/// Two seconds at 30 frames a second in which every joint turns by a sum of sines and the root
/// moves.
[[nodiscard]] ClipData make_bench_clip(const SkeletonData& skeleton, std::uint64_t seed);

inline constexpr std::size_t kBenchClips = 8;

/// Characters that play eight clips at random times, blending into another one; for the engine and
/// for scalar loops.
struct BenchCrowd {
    SkeletonData skeleton;
    CrowdRig rig;
    std::vector<Affine> bind;  ///< joint_from_mesh
    std::vector<CrowdClip> clips;
    std::vector<ScalarClip> scalar_clips;

    struct Member {
        std::size_t clip = 0;
        std::size_t next = 0;
        float time = 0;
        float next_time = 0;
        float weight = 0;
    };
    std::vector<Member> members;
    std::vector<Affine> matrices;  ///< of all members

    BenchCrowd(std::size_t joints, std::size_t count);
    [[nodiscard]] std::size_t joints() const { return rig.joints(); }
    /// Destination of member i.
    [[nodiscard]] Affine* matrices_of(std::size_t i) { return matrices.data() + i * joints(); }
    [[nodiscard]] std::vector<CrowdCharacter> characters();
};

/// The matrices of all members by the scalar loops: two samples, blended, ready to skin. `buffer`:
/// scratch memory.
void pose_by_hand(BenchCrowd& crowd, std::vector<float>& buffer);

}  // namespace limn::bench
