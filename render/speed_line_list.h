#pragma once

#include "ecs/components/speed_lines.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "render/render_view.h"

#include <vector>

namespace limn {

class World;

// The lines of every SpeedLines at the moment that a view shows (post.speed-lines): from points of
// the mesh, evenly spread over its list of vertices, whose surface faces away from where they go,
// backward along their motion. Deformed meshes have those of their shape at rest.

/// As speed_line.vert reads it: three texels.
struct SpeedLine {
    Vec3 head = {0, 0, 0};  ///< on the mesh, world space
    float width = 0;        ///< share of the picture's height
    Vec3 tail = {0, 0, 0};
    float unused = 0;
    Vec4 color = {1, 1, 1, 1};  ///< at the head
};

static_assert(sizeof(SpeedLine) == 48);

/// Appends the lines of one mesh that went from `before` to `now` in `seconds`.
void append_speed_lines(
    const MeshData& mesh, const Affine& now, const Affine& before, float seconds,
    const SpeedLines& settings, std::vector<SpeedLine>& lines);

/// All of the world, in world order; replaces what is in `lines`.
void collect_speed_lines(const World& world, const RenderView& view, std::vector<SpeedLine>& lines);

}  // namespace limn
