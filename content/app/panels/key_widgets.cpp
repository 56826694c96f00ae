#include "content/app/panels/key_widgets.h"

#include "content/app/panels/hud_style.h"
#include "content/app/panels/key_list.h"
#include "ecs/base/srgb.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <initializer_list>
#include <vector>

namespace limn {
namespace {

constexpr float kPlotHeight = 76.0f;  // [layout units]
constexpr float kBarHeight = 22.0f;
constexpr float kStopHeight = 11.0f;  // of the stops below the bar
constexpr int kBarColumns = 48;       // of a gradient, which is not linear in sRGB

bool has_fields(const FieldInfo& field, std::initializer_list<const char*> names) {
    return field.fields.size() == names.size()
           && std::equal(
               names.begin(), names.end(), field.fields.begin(),
               [](const char* name, const FieldInfo& one) {
                   return std::strcmp(name, one.name) == 0;
               });
}

ImVec2 im(const Vec2& v) {
    return {v.x, v.y};
}

ImU32 shown_color(const Vec3& linear, float opacity) {
    return ImGui::ColorConvertFloat4ToU32(
        {std::clamp(srgb_from_linear(linear.x), 0.0f, 1.0f),
         std::clamp(srgb_from_linear(linear.y), 0.0f, 1.0f),
         std::clamp(srgb_from_linear(linear.z), 0.0f, 1.0f), opacity});
}

/// An area that takes clicks, and its input.
struct KeyArea {
    KeyPlot plot;
    KeyInput input;
    bool active = false;
};

KeyArea key_area(const HudStyle& style, float height) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float margin = 6 * style.scale;
    const Vec2 size = {
        std::max(ImGui::GetContentRegionAvail().x - 2 * margin, 20.0f), height * style.scale};
    ImGui::InvisibleButton(
        "##keys", {size.x + 2 * margin, size.y + 2 * margin},
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered();
    KeyArea area;
    area.plot.corner = {corner.x + margin, corner.y + margin};
    area.plot.size = size;
    area.plot.pick_radius = 8 * style.scale;
    area.active = ImGui::IsItemActive();
    area.input.pointer = {io.MousePos.x, io.MousePos.y};
    area.input.pressed = hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    area.input.held = area.active && ImGui::IsMouseDown(ImGuiMouseButton_Left);
    area.input.double_clicked = hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    area.input.right_clicked = hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Right);
    area.input.removes = hovered && ImGui::IsKeyPressed(ImGuiKey_Delete, false);
    return area;
}

/// Widgets of the selected key's numbers.
bool edit_at(float& at) {
    ImGui::SetNextItemWidth(0.34f * ImGui::GetContentRegionAvail().x);
    return ImGui::SliderFloat("##at", &at, 0, 1, "at %.3f", ImGuiSliderFlags_AlwaysClamp);
}

bool edit_curve(const HudStyle& style, std::vector<CurveKey>& keys, int& selected, float& top) {
    KeyArea area = key_area(style, kPlotHeight);
    // The scale is kept while a key is dragged; otherwise it would run away from the pointer.
    top = area.active && top > 0 ? top : 1.25f * plot_top(keys);
    area.plot.top = top;
    bool changed = edit_keys(area.plot, area.input, keys, selected);

    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const Vec2 a = area.plot.corner;
    const Vec2 b = a + area.plot.size;
    draw.AddRectFilled(im(a), im(b), IM_COL32(255, 255, 255, 10), 3);
    const float one = key_position(area.plot, CurveKey{0, 1}).y;
    draw.AddLine({a.x, one}, {b.x, one}, IM_COL32(255, 255, 255, 36));
    std::vector<CurveKey> sorted = keys;
    sort_keys(sorted);
    const ImU32 accent = ImGui::ColorConvertFloat4ToU32(kHudAccent);
    Vec2 last = key_position(area.plot, CurveKey{0, sample_curve(keys, 0)});
    sorted.push_back({1, sample_curve(keys, 1)});
    for (const CurveKey& key : sorted) {
        const Vec2 next = key_position(area.plot, key);
        draw.AddLine(im(last), im(next), accent, 1.6f * style.scale);
        last = next;
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const bool chosen = static_cast<int>(i) == selected;
        draw.AddCircleFilled(
            im(key_position(area.plot, keys[i])), (chosen ? 5.0f : 3.5f) * style.scale,
            chosen ? IM_COL32_WHITE : accent);
    }
    if (selected >= 0) {
        CurveKey& key = keys[static_cast<std::size_t>(selected)];
        bool moved = edit_at(key.at);
        ImGui::SameLine();
        ImGui::SetNextItemWidth(-1);
        moved |= ImGui::DragFloat(
            "##value", &key.value, 0.01f, 0, 1000, "value %.3f", ImGuiSliderFlags_AlwaysClamp);
        selected = moved ? sort_keys(keys, selected) : selected;
        changed |= moved;
    }
    return changed;
}

void draw_gradient(const KeyPlot& plot, const std::vector<ColorKey>& keys) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const Vec2 a = plot.corner;
    const Vec2 b = a + plot.size;
    // A checkerboard, to show transparency.
    const float side = 0.5f * plot.size.y;
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; static_cast<float>(x) * side < plot.size.x; ++x) {
            const Vec2 corner = a + side * Vec2(x, y);
            draw.AddRectFilled(
                im(corner), {std::min(corner.x + side, b.x), corner.y + side},
                (x + y) % 2 == 0 ? IM_COL32(90, 90, 90, 255) : IM_COL32(54, 54, 54, 255));
        }
    }
    const auto color = [&](int i) {
        const Vec4 at = sample_colors(keys, static_cast<float>(i) / kBarColumns);
        return shown_color({at.x, at.y, at.z}, std::clamp(at.w, 0.0f, 1.0f));
    };
    for (int i = 0; i < kBarColumns; ++i) {
        const float width = plot.size.x / kBarColumns;
        const ImU32 left = color(i);
        const ImU32 right = color(i + 1);
        draw.AddRectFilledMultiColor(
            {a.x + static_cast<float>(i) * width, a.y},
            {a.x + static_cast<float>(i + 1) * width, b.y}, left, right, right, left);
    }
}

bool edit_gradient(const HudStyle& style, std::vector<ColorKey>& keys, int& selected) {
    KeyArea area = key_area(style, kBarHeight + kStopHeight);
    bool changed = edit_keys(area.plot, area.input, keys, selected);
    KeyPlot bar = area.plot;
    bar.size.y = kBarHeight * style.scale;
    draw_gradient(bar, keys);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float half = 5 * style.scale;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const bool chosen = static_cast<int>(i) == selected;
        const float x = key_position(bar, keys[i]).x;
        const float y = bar.corner.y + bar.size.y + 2 * style.scale;
        const std::array<ImVec2, 5> stop = {
            ImVec2{x, y - half},
            {x + half, y},
            {x + half, y + half},
            {x - half, y + half},
            {x - half, y}};
        draw.AddConvexPolyFilled(stop.data(), 5, shown_color(keys[i].color, 1));
        draw.AddPolyline(
            stop.data(), 5, chosen ? IM_COL32_WHITE : IM_COL32(150, 150, 150, 255),
            ImDrawFlags_Closed, chosen ? 2 * style.scale : 1.0f);
    }
    if (selected < 0) {
        return changed;
    }
    ColorKey& key = keys[static_cast<std::size_t>(selected)];
    bool moved = edit_at(key.at);
    ImGui::SameLine();
    std::array<float, 3> shown = {
        srgb_from_linear(key.color.x), srgb_from_linear(key.color.y),
        srgb_from_linear(key.color.z)};
    if (ImGui::ColorEdit3(
            "##color", shown.data(),
            ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR)) {
        for (int i = 0; i < 3; ++i) {
            key.color[i] =
                std::clamp(linear_from_srgb(shown[static_cast<std::size_t>(i)]), 0.0f, 1000.0f);
        }
        moved = true;
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    moved |= ImGui::SliderFloat(
        "##opacity", &key.opacity, 0, 1, "opacity %.2f", ImGuiSliderFlags_AlwaysClamp);
    selected = moved ? sort_keys(keys, selected) : selected;
    return changed || moved;
}

}  // namespace

bool is_key_list(const FieldInfo& field) {
    return field.shape == FieldShape::List && field.type == FieldType::Struct
           && (has_fields(field, {"at", "value"}) || has_fields(field, {"at", "color", "opacity"}));
}

bool edit_key_list(const HudStyle& style, const FieldInfo& field, void* data) {
    ImGui::PushID(field.name);
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID selected_id = ImGui::GetID("##selected");
    const ImGuiID top_id = ImGui::GetID("##top");
    int selected = storage.GetInt(selected_id, -1);
    float top = storage.GetFloat(top_id);
    const bool changed =
        field.fields.size() == 2
            ? edit_curve(style, *static_cast<std::vector<CurveKey>*>(data), selected, top)
            : edit_gradient(style, *static_cast<std::vector<ColorKey>*>(data), selected);
    storage.SetInt(selected_id, selected);
    storage.SetFloat(top_id, top);
    ImGui::PopID();
    return changed;
}

}  // namespace limn
