#include "content/app/player/outline.h"

#include "content/app/panels/hud_style.h"
#include "content/app/player/world_lines.h"

#include <array>
#include <cstddef>

namespace limn {

void draw_box_outline(const RenderView& view, const Affine& transform, const Bounds& box) {
    if (is_empty(box)) {
        return;
    }
    std::array<Vec3, 8> corners;  // bit 0, 1, 2 of the index: x, y, z of min or max
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 corner = {
            (i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
            (i & 4) != 0 ? box.max.z : box.min.z};
        corners[i] = transform_point(transform, corner);
    }
    WorldLines lines(view, Vec3(kHudAccent.x, kHudAccent.y, kHudAccent.z));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (const std::size_t bit : {1u, 2u, 4u}) {
            if ((i & bit) == 0) {
                lines.draw_line(corners[i], corners[i | bit]);
            }
        }
    }
}

}  // namespace limn
