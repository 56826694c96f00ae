#include "content/app/player/world_lines.h"

#include "content/app/player/label_layout.h"
#include "render/render_view.h"

#include <imgui.h>

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

ImVec2 to_screen(const Vec4& clip) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    return {
        (0.5f + 0.5f * clip.x / clip.w) * display.x, (0.5f - 0.5f * clip.y / clip.w) * display.y};
}

}  // namespace

std::optional<Vec2> find_pixel(const RenderView& view, const Vec3& at) {
    const Vec4 clip = view.unjittered_from_world * Vec4(at, 1.0f);
    if (clip.w < view.near) {
        return std::nullopt;
    }
    const ImVec2 pixel = to_screen(clip);
    return Vec2(pixel.x, pixel.y);
}

WorldLines::WorldLines(const RenderView& view, const Vec3& color, float opacity)
    : view_(view), color_(ImGui::GetColorU32({color.x, color.y, color.z, opacity})) {}

void WorldLines::draw_line(const Vec3& from, const Vec3& to, float width) {
    Vec4 a = view_.unjittered_from_world * Vec4(from, 1.0f);
    Vec4 b = view_.unjittered_from_world * Vec4(to, 1.0f);
    if (clip_to_near_plane(a, b, view_.near)) {
        ImGui::GetBackgroundDrawList()->AddLine(to_screen(a), to_screen(b), color_, width);
    }
}

void WorldLines::draw_point(const Vec3& at, float radius, const std::string& label) {
    const std::optional<Vec2> position = find_pixel(view_, at);
    if (!position) {
        return;
    }
    ImDrawList* const list = ImGui::GetBackgroundDrawList();
    list->AddCircleFilled({position->x, position->y}, radius, color_);
    if (!label.empty()) {
        list->AddText({position->x + 2 * radius, position->y - 2 * radius}, color_, label.c_str());
    }
}

void WorldLines::draw_label(const Vec3& at, const std::string& label, LabelLayout& layout) {
    constexpr float kGap = 6.0f;  // to the point [pixels]
    const std::optional<Vec2> position = find_pixel(view_, at);
    if (!position) {
        return;
    }
    const ImVec2 size = ImGui::CalcTextSize(label.c_str());
    if (const auto corner = layout.place(*position, {size.x, size.y}, kGap)) {
        ImDrawList* const list = ImGui::GetBackgroundDrawList();
        // Dark behind bright, so that it can be read before anything.
        list->AddText({corner->x + 1, corner->y + 1}, IM_COL32(0, 0, 0, 200), label.c_str());
        list->AddText({corner->x, corner->y}, color_, label.c_str());
    }
}

}  // namespace limn
