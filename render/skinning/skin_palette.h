#pragma once

#include "ecs/components/animation.h"
#include "render/render_view.h"

#include <cstddef>
#include <vector>

namespace limn {

// Skinning matrices K = joint * joint_from_mesh, one per joint of the skin (char.skin-bone-offset),
// interpolated between two steps.

/// All joints of a skin.
inline constexpr std::size_t kSkinJoints = ~std::size_t{0};

/// Fills `palette` with the first `joints` of `skin` at `time`, interpolated componentwise from the
/// previous pose to the current one (mix_affine); without scale and shear for dual quaternions.
/// Empty without a skin or a pose. These joints must exist in the pose.
void make_palette(
    const SkinData* skin, const Pose* pose, Skinning skinning, const StepTime& time,
    std::vector<Affine>& palette, std::size_t joints = kSkinJoints);

/// Fills `palette` with the same joints of `skin` as they are: character_from_joint, at `time`,
/// without joint_from_mesh (char.skin-vertex-offset). Otherwise likewise.
void make_joint_palette(
    const SkinData* skin, const Pose* pose, const StepTime& time, std::vector<Affine>& palette,
    std::size_t joints = kSkinJoints);

/// Fills `weights` with `count` weights starting at `first`, at `time`; 0 for missing and
/// non-finite ones.
void make_morph_weights(
    const MorphWeights* morphs, std::size_t first, std::size_t count, const StepTime& time,
    std::vector<float>& weights);

/// Appends the layout of deform.comp: per joint three matrix rows, or a unit dual quaternion in two
/// texels.
void append_texels(
    const std::vector<Affine>& palette, Skinning skinning, std::vector<Vec4>& texels);

}  // namespace limn
