#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Colors of the vertices of an OBJ file, from what stands behind their three coordinates:
//
//     v x y z r g b      v x y z w r g b      v x y z r g b a
//
// Seven numbers have a weight first if that is 1 in all of them, else opacity last, which is not
// drawn. The values are sRGB: MeshLab and ZBrush write what they display, and Blender decodes them.
// They are 0 .. 255 where one is above 1 and all are whole numbers; others are clamped to 0 .. 1.

class ObjColors {
  public:
    /// What follows the coordinates of vertex `vertex`: 3, 4 or 5 numbers; others have no color.
    /// Vertices in ascending order.
    void add(std::size_t vertex, std::span<const float> numbers);

    /// Linear RGB of `count` vertices, white for those without a color; empty if none has one.
    [[nodiscard]] std::vector<Vec3> decode(std::size_t count) const;

  private:
    struct Entry {
        std::uint32_t vertex = 0;
        Vec3 first;        ///< the first three numbers after the coordinates
        float fourth = 0;  ///< 0 without
        bool has_fourth = false;
    };
    /// All entries as r g b.
    [[nodiscard]] std::vector<Vec3> find_rgb() const;

    std::vector<Entry> entries_;
};

}  // namespace limn
