#pragma once

#include "ecs/components/animation.h"

#include <vector>

namespace limn {

// Where joints take a mesh: K = joint * joint_from_mesh, one matrix a joint of the skin
// (char.skin-bone-offset), at a moment between two steps.

/// `palette` gets the joints of `skin` at the moment `alpha`: the way from the pose before to the
/// one now, componentwise (mix_affine). For dual quaternions without scale and shear. Empty without
/// a skin or a pose. Joints must be there.
void make_palette(
    const SkinData* skin, const Pose* pose, Skinning skinning, float alpha,
    std::vector<Affine>& palette);

/// `weights` gets `count` weights from place `first` on, at the moment `alpha`; 0 where there is
/// none, or none that is finite.
void make_morph_weights(
    const MorphWeights* morphs, std::size_t first, std::size_t count, float alpha,
    std::vector<float>& weights);

/// As deform.comp reads them: three rows a joint, or a unit dual quaternion in two.
void append_texels(
    const std::vector<Affine>& palette, Skinning skinning, std::vector<Vec4>& texels);

}  // namespace limn
