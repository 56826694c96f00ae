#include "content/app/player/comparison_overlay.h"

#include "ecs/components/shading_comparison.h"
#include "ecs/world.h"

#include <algorithm>
#include <utility>

namespace limn {
namespace {

// As in shading_marks.frag.
constexpr float kPlotPadding = 0.12f;

constexpr ImGuiWindowFlags kBare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground
                                   | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings
                                   | ImGuiWindowFlags_NoBringToFrontOnFocus
                                   | ImGuiWindowFlags_NoFocusOnAppearing;

/// Lets the pointer drag the divider.
void drag_divider(const HudStyle& style, ShadingComparison& comparison, float bottom) {
    const float width = ImGui::GetIO().DisplaySize.x;
    const float half_width = 14 * style.scale;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::SetNextWindowPos({comparison.divider * width - half_width, 0});
    ImGui::SetNextWindowSize({2 * half_width, bottom});
    if (ImGui::Begin("##divider", nullptr, kBare)) {
        ImGui::InvisibleButton("##drag", {2 * half_width, bottom});
        if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
            ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
        }
        if (ImGui::IsItemActive() && width > 0) {
            comparison.divider = std::clamp(ImGui::GetIO().MousePos.x / width, 0.0f, 1.0f);
        }
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

void caption_plot(const HudStyle& style, const ScanlinePlot& plot, float height) {
    const float top = height * (1 - plot.height);
    const float scale = height - top;
    ImDrawList* const list = ImGui::GetBackgroundDrawList();
    const auto write = [&](const char* text, float value) {
        const float y = height - scale * (kPlotPadding + (1 - 2 * kPlotPadding) * value);
        list->AddText({8 * style.scale, y + 1}, ImGui::GetColorU32(kHudDim), text);
    };
    write("1   brightness along the dashed row", 1);
    write("1/2", 0.5f);
}

}  // namespace

void draw_comparison_overlay(const HudStyle& style, World& world) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const auto* plot = std::as_const(world).find_resource<ScanlinePlot>();
    if (plot != nullptr && plot->height > 0) {
        caption_plot(style, *plot, size.y);
    }
    auto* const comparison = world.find_resource<ShadingComparison>();
    if (comparison == nullptr) {
        return;
    }
    if (comparison->image == ComparisonImage::Split) {
        drag_divider(style, *comparison, size.y * (1 - (plot != nullptr ? plot->height : 0)));
    }
}

}  // namespace limn
