#pragma once

#include "render/gpu/buffer_texture.h"
#include "render/light/light_list.h"
#include "render/render_view.h"
#include "render/shaders/cluster_gpu.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Clustered light culling: the view frustum is cut into screen tiles and depth slices, and every
// cell gets the list of the lights whose sphere (and cone) touches it. A pixel then reads only its
// cell's list. Conservative: a light that reaches a point is in the list of the point's cell,
// whatever the rounding; lists may hold lights that do not reach. Lists keep the order of the
// lights, so sums do not depend on how the lists were made.
//
// The CPU does the work that is linear in the lights: it transforms each to view space and finds
// the box of cells that its sphere may touch. The boxes' volumes bound the total length of all
// lists, so the GPU, which only ever removes cells from a box (cluster_pass.h), never runs
// out of memory. 4,096 lights take 0.3 ms.
//
// After Olsson et al., "Clustered Deferred and Forward Shading", 2012.

/// How the frustum is cut into cells.
struct ClusterShape {
    int tile = 32;    ///< side of a tile [px]
    int columns = 1;  ///< tile columns, at most 256
    int rows = 1;     ///< tile rows, at most 256
    int slices = 32;  ///< in depth; slice = depth_scale log2(distance) + depth_bias, clamped
    float depth_scale = 1;
    float depth_bias = 0;

    [[nodiscard]] int cells() const { return columns * rows * slices; }
};

/// A box of cells, both ends included.
struct ClusterBox {
    int column[2] = {0, 0};
    int row[2] = {0, 0};
    int slice[2] = {0, 0};

    [[nodiscard]] std::size_t volume() const {
        return static_cast<std::size_t>(column[1] - column[0] + 1) * (row[1] - row[0] + 1)
               * (slice[1] - slice[0] + 1);
    }
};

/// Maximum total length of all lists: 64 MiB of indices. Lights that would exceed it are left out.
inline constexpr std::size_t kMaxListEntries = std::size_t{1} << 24;

/// The point and spot lights of a LightList that may reach into the view, in its order.
struct ClusterLights {
    ClusterShape shape;
    std::vector<layout::ClusterLight> lights;
    std::vector<layout::uvec2> boxes;  ///< of each light, packed as layout::cell_box_* expect
    std::size_t max_entries = kMaxListEntries;  ///< less if buffer textures cannot hold as many
    std::size_t capacity = 0;                   ///< upper bound of the total length of all lists
    int dropped = 0;                            ///< lights left out by max_entries
    BufferTexture light_records = BufferTexture("cluster lights", GL_RGBA32F);
    BufferTexture box_records = BufferTexture("cluster boxes", GL_RG32UI);
};

/// Shape whose slices span the distances from the near plane to the end of the farthest light.
[[nodiscard]] ClusterShape
make_cluster_shape(const RenderView& view, std::span<const LightRange> reach);

/// Fills `clusters` with the `lights` that reach into the view.
void place_lights(const RenderView& view, const LightList& lights, ClusterLights& clusters);

/// The cells that a light may touch; false if it is wholly behind the camera or off screen.
[[nodiscard]] bool find_cells(
    const RenderView& view, const ClusterShape& shape, const LightRange& light, ClusterBox& box);

/// The cell of a pixel at `distance` along the view axis [m]; the same as in lib/lighting.glsl.
[[nodiscard]] int cell_of(const ClusterShape& shape, float pixel_x, float pixel_y, float distance);

}  // namespace limn
