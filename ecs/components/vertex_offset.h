#pragma once

#include "ecs/components/animation.h"
#include "ecs/reflect.h"

namespace limn {

/// Tag, with a Deformed of linear skinning: its vertices are stored once per influence, in the
/// space of the joint, and moved by the joints' own matrices, without inverse bind matrices
/// (char.skin-vertex-offset). The same vertices for three times the memory, to compare with. Meshes
/// with morph targets, deformers or a surface are skinned as without it: their offsets from the
/// rest pose would be needed in the space of each joint.
/// Techniques: char.skin-vertex-offset
struct VertexOffsetSkinning {};

template <>
struct ComponentTraits<VertexOffsetSkinning> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

}  // namespace limn
