#include "content/app/outline.h"

#include "content/app/hud_style.h"
#include "render/render_view.h"

#include <imgui.h>

#include <array>

namespace limn {
namespace {

/// Clips the edge a b, in clip space, to the part in front of the near plane; false if there is
/// none.
bool clip_to_near_plane(Vec4& a, Vec4& b, float near) {
    if (a.w < near && b.w < near) {
        return false;
    }
    if (a.w < near) {
        a = glm::mix(a, b, (near - a.w) / (b.w - a.w));
    } else if (b.w < near) {
        b = glm::mix(b, a, (near - b.w) / (a.w - b.w));
    }
    return true;
}

}  // namespace

void draw_box_outline(const RenderView& view, const Affine& transform, const Bounds& box) {
    if (is_empty(box)) {
        return;
    }
    std::array<Vec4, 8> corners;  // bit 0, 1, 2 of the index: x, y, z of min or max
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 corner = {
            (i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
            (i & 4) != 0 ? box.max.z : box.min.z};
        corners[i] = view.unjittered_from_world * Vec4(transform_point(transform, corner), 1.0f);
    }
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const auto to_screen = [&](const Vec4& clip) {
        return ImVec2(
            (0.5f + 0.5f * clip.x / clip.w) * display.x,
            (0.5f - 0.5f * clip.y / clip.w) * display.y);
    };
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const ImU32 color = ImGui::GetColorU32({kHudAccent.x, kHudAccent.y, kHudAccent.z, 0.9f});
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (const std::size_t bit : {1u, 2u, 4u}) {
            Vec4 a = corners[i];
            Vec4 b = corners[i | bit];
            if ((i & bit) == 0 && clip_to_near_plane(a, b, view.near)) {
                list->AddLine(to_screen(a), to_screen(b), color, 1.5f);
            }
        }
    }
}

}  // namespace limn
