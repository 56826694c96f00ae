#include "content/app/comparison_overlay.h"

#include "ecs/components/shading_comparison.h"
#include "ecs/field_access.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace limn {
namespace {

// As in shading_marks.frag.
const ImVec4 kLeftColor = {0.98f, 0.66f, 0.26f, 1};
const ImVec4 kRightColor = {0.36f, 0.70f, 1, 1};
constexpr float kPlotPadding = 0.12f;

constexpr ImGuiWindowFlags kBare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground
                                   | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings
                                   | ImGuiWindowFlags_NoBringToFrontOnFocus
                                   | ImGuiWindowFlags_NoFocusOnAppearing;

std::string rate_name(ShadingRate rate) {
    const FieldInfo* field = find_field(component_info<ShadingComparison>().fields, "right");
    return std::string(get_enum(*field, &rate));
}

/// A name with its color, from `x` to the right (align 0), to the left (1) or about it (0.5).
void draw_name(
    const HudStyle& style, const std::string& text, const ImVec4& color, float x, float y,
    float align) {
    ImDrawList* const list = ImGui::GetBackgroundDrawList();
    ImGui::PushFont(style.title);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float pad = 7 * style.scale;
    const float left = x - align * (size.x + 2 * pad);
    list->AddRectFilled(
        {left, y}, {left + size.x + 2 * pad, y + size.y + pad},
        ImGui::GetColorU32({0.05f, 0.06f, 0.08f, 0.85f}), 5 * style.scale);
    list->AddText({left + pad, y + 0.5f * pad}, ImGui::GetColorU32(color), text.c_str());
    ImGui::PopFont();
}

/// Lets the pointer drag the divider.
void drag_divider(const HudStyle& style, ShadingComparison& comparison, float bottom) {
    const float width = ImGui::GetIO().DisplaySize.x;
    const float reach = 14 * style.scale;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::SetNextWindowPos({comparison.divider * width - reach, 0});
    ImGui::SetNextWindowSize({2 * reach, bottom});
    if (ImGui::Begin("##divider", nullptr, kBare)) {
        ImGui::InvisibleButton("##drag", {2 * reach, bottom});
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
    const auto* rendering = std::as_const(world).find_resource<Rendering>();
    const std::string left = rate_name(rendering != nullptr ? rendering->shading : ShadingRate{});
    const std::string right = rate_name(comparison->right);
    const float bottom = size.y * (1 - (plot != nullptr ? plot->height : 0));
    const float y = bottom - 34 * style.scale;
    if (comparison->image == ComparisonImage::Difference) {
        const std::string power = comparison->exponent == 1
                                      ? ""
                                      : fmt::format(", to the power {:g}", comparison->exponent);
        draw_name(
            style, fmt::format("{} - {}{}", left, right, power), kHudText, 0.5f * size.x, y, 0.5f);
        return;
    }
    const float x = comparison->divider * size.x;
    const float gap = 10 * style.scale;
    draw_name(style, left, kLeftColor, x - gap, y, 1);
    draw_name(style, right, kRightColor, x + gap, y, 0);
    drag_divider(style, *comparison, bottom);
}

}  // namespace limn
