// One drawn copy of a mesh, read as instance-rate vertex attributes: the draw's base instance picks the first.
// The previous frame's transform is a second stream of three rows, filled only when velocity is rendered.
// Techniques: shade.vector-ops

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct InstanceRecord {
    vec4 row[3];   // world_from_mesh, current
    uint material;
    uint flags;    // bit 0: mirrored, the determinant is negative; then the number of its fur (fur_gpu.h); from bit 8:
                   // kModel* of lib/gbuffer.glsl
    uint index;    // of this record in the frame
    float inflate; // distance by which vertices move along their normals, in mesh space [m]
};

#ifdef __cplusplus
static_assert(sizeof(InstanceRecord) == 64);
}  // namespace limn::layout
#endif
