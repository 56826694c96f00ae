#pragma once

#include "ecs/components/speed_lines.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "render/effect.h"
#include "render/gpu/buffer_texture.h"

#include <vector>

namespace limn {

// Streaks behind fast-moving objects (post.speed-lines), as camera-facing quads that fade toward
// their tails. They start at mesh vertices, evenly spread over the vertex list, whose surface faces
// away from the motion, and trail back along it. Deformed meshes use their rest pose.
//
// Reads    depth; SpeedLines of entities with a mesh that moves
// Writes   radiance
// Order    after blended surfaces, before the lens
// Shaders  speed_line.vert, speed_line.frag

/// Layout of speed_line.vert: three texels.
struct SpeedLine {
    Vec3 head = {0, 0, 0};  ///< on the mesh, world space
    float width = 0;        ///< fraction of the image height
    Vec3 tail = {0, 0, 0};
    float unused = 0;
    Vec4 color = {1, 1, 1, 1};  ///< at the head
};

static_assert(sizeof(SpeedLine) == 48);

/// Appends the lines of one mesh that moved from `before` to `now` in `seconds`.
void append_speed_lines(
    const MeshData& mesh, const Affine& now, const Affine& before, float seconds,
    const SpeedLines& settings, std::vector<SpeedLine>& lines);

struct SpeedLineEffect {
    const gpu::Program* program = nullptr;
    std::vector<SpeedLine> lines = {};  ///< of the frame, in world order
    BufferTexture records = BufferTexture("speed lines", GL_RGBA32F);

    static Result<SpeedLineEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData&, ViewData& view);
};

}  // namespace limn
