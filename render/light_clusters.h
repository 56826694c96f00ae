#pragma once

#include "render/light_list.h"
#include "render/render_view.h"
#include "render/shaders/cluster_gpu.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Which lights reach which part of the view: the pyramid is cut into tiles on the screen and slices
// in depth, and every cell gets the list of the lights whose sphere (and cone) touches it. A pixel
// then looks at its cell's list alone. Conservative: a light that reaches a point is in the list of
// the point's cell, whatever the rounding; lists may hold lights that do not reach. Lists are in
// the order of the lights, so that sums do not depend on how the lists were made.
//
// The CPU does what is linear in the lights: it takes each to view space and finds the box of
// cells that its sphere may touch. The boxes' volumes bound the length of all lists together, so
// that the GPU, which only ever takes cells out of a box (passes/cluster_pass.h), never runs out
// of memory. 4,096 lights take 0.3 ms.
//
// After Olsson et al., "Clustered Deferred and Forward Shading", 2012.

/// How the pyramid is cut.
struct ClusterShape {
    int tile = 32;    ///< side of a tile [px]
    int columns = 1;  ///< tiles across, at most 256
    int rows = 1;     ///< tiles up, at most 256
    int slices = 32;  ///< in depth; slice = depth_scale log2(distance) + depth_bias, clamped
    float depth_scale = 1;
    float depth_bias = 0;

    [[nodiscard]] int cells() const { return columns * rows * slices; }
};

/// A box of cells, both ends included.
struct CellBox {
    int column[2] = {0, 0};
    int row[2] = {0, 0};
    int slice[2] = {0, 0};

    [[nodiscard]] std::size_t volume() const {
        return static_cast<std::size_t>(column[1] - column[0] + 1) * (row[1] - row[0] + 1)
               * (slice[1] - slice[0] + 1);
    }
};

/// The point and spot lights of a LightList that the view may show, in its order.
struct ClusterLights {
    ClusterShape shape;
    std::vector<layout::ClusterLight> lights;
    std::vector<layout::uvec2> boxes;  ///< of each, as layout::cell_box_* have it
    std::size_t capacity = 0;          ///< bound of all lists' lengths together
    int dropped = 0;                   ///< lights that went over kMaxListEntries
};

/// Longest that all lists together may become: 64 MiB of indices. Lights that would go beyond are
/// left out of them.
inline constexpr std::size_t kMaxListEntries = std::size_t{1} << 24;

/// Slices that divide the distances from the near plane to the end of the farthest light.
[[nodiscard]] ClusterShape
make_cluster_shape(const RenderView& view, std::span<const LightReach> reach);

/// Fills `clusters` with those of `lights` that reach into the view.
void place_lights(const RenderView& view, const LightList& lights, ClusterLights& clusters);

/// The cells that a light may touch; none if it is wholly behind the camera or beside the picture.
[[nodiscard]] bool find_cells(
    const RenderView& view, const ClusterShape& shape, const LightReach& light, CellBox& box);

/// The cell of a pixel at `distance` along the view axis [m], as lib/lighting.glsl has it.
[[nodiscard]] int cell_of(const ClusterShape& shape, float pixel_x, float pixel_y, float distance);

}  // namespace limn
