#include "content/app/panels/shows_panel.h"

#include "content/app/panels/hud_style.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <utility>

namespace limn {
namespace {

constexpr std::array kSides = {ShowSide::On, ShowSide::Off, ShowSide::Both};

}  // namespace

const char* show_side_name(ShowSide side) {
    switch (side) {
    case ShowSide::On:
        return "with";
    case ShowSide::Off:
        return "without";
    case ShowSide::Both:
        break;
    }
    return "side by side";
}

void ShowsPanel::read_list() {
    if (is_read_) {
        return;
    }
    is_read_ = true;
    Result<std::vector<FoundShow>> shows = list_shows();
    if (shows) {
        shows_ = *std::move(shows);
    } else {
        error_ = shows.error().message;
    }
}

void ShowsPanel::cycle_side() {
    side = kSides[(static_cast<std::size_t>(side) + 1) % kSides.size()];
}

void ShowsPanel::select_neighbor(const std::string& shown, int offset) {
    read_list();
    const int count = static_cast<int>(shows_.size());
    if (count == 0) {
        return;
    }
    const auto now = std::find_if(shows_.begin(), shows_.end(), [&](const FoundShow& found) {
        return found.show.technique == shown;
    });
    const int none = offset > 0 ? -1 : 0;
    const int index = now != shows_.end() ? static_cast<int>(now - shows_.begin()) : none;
    selected_ = shows_[static_cast<std::size_t>((index + offset + count) % count)];
}

std::optional<FoundShow> ShowsPanel::take_selected() {
    return std::exchange(selected_, std::nullopt);
}

void ShowsPanel::draw(const HudStyle& style, const std::string& shown) {
    if (!open) {
        return;
    }
    read_list();
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float margin = 14.0f * style.scale;
    const ImVec2 size = {
        std::min(620.0f * style.scale, 0.48f * display.x), display.y - 2.0f * margin};
    ImGui::SetNextWindowPos(
        {display.x - margin, margin}, ImGuiCond_FirstUseEver, ImVec2(1.0f, 0.0f));
    ImGui::SetNextWindowSize(size, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Shows", &open, ImGuiWindowFlags_NoCollapse)) {
        draw_shown(style, shown);
        ImGui::BeginChild("##list");
        draw_list(style, shown);
        ImGui::EndChild();
    }
    ImGui::End();
}

void ShowsPanel::draw_shown(const HudStyle& style, const std::string& shown) {
    if (!error_.empty()) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextColored(kHudBad, "%s", error_.c_str());
        ImGui::PopTextWrapPos();
    }
    if (ImGui::Button("Previous")) {
        select_neighbor(shown, -1);
    }
    ImGui::SameLine();
    if (ImGui::Button("Next")) {
        select_neighbor(shown, 1);
    }
    if (shown.empty()) {
        ImGui::TextColored(kHudDim, "Select a technique to compare the image with and without it.");
        ImGui::Separator();
        return;
    }
    for (const ShowSide choice : kSides) {
        ImGui::SameLine(0, choice == ShowSide::On ? 16 * style.scale : -1);
        if (ImGui::RadioButton(show_side_name(choice), side == choice)) {
            side = choice;
        }
    }
    if (side == ShowSide::Both) {
        ImGui::SetNextItemWidth(-1);
        ImGui::SliderFloat("##divider", &divider, 0.0f, 1.0f, "");
    }
    ImGui::PushFont(style.title);
    ImGui::TextUnformatted(shown.c_str());
    ImGui::PopFont();
    for (const FoundShow& found : shows_) {
        if (found.show.technique == shown) {
            ImGui::PushTextWrapPos(0.0f);
            ImGui::TextUnformatted(found.show.text.c_str());
            ImGui::PopTextWrapPos();
            break;
        }
    }
    ImGui::Separator();
}

void ShowsPanel::draw_list(const HudStyle& style, const std::string& shown) {
    const std::string* level = nullptr;
    float column = 0;  // where the texts begin
    ImGui::PushFont(style.numbers);
    for (const FoundShow& found : shows_) {
        column = std::max(column, ImGui::CalcTextSize(found.show.technique.c_str()).x);
    }
    ImGui::PopFont();
    for (const FoundShow& found : shows_) {
        if (level == nullptr || *level != found.level.name) {
            level = &found.level.name;
            ImGui::Spacing();
            ImGui::TextColored(kHudAccent, "%s", level->c_str());
        }
        ImGui::PushFont(style.numbers);
        const bool is_shown = found.show.technique == shown;
        if (ImGui::Selectable(found.show.technique.c_str(), is_shown) && !is_shown) {
            selected_ = found;
        }
        ImGui::PopFont();
        const bool hovered = ImGui::IsItemHovered();
        ImGui::SameLine(column + 16 * style.scale);
        ImGui::TextColored(kHudDim, "%s", found.show.text.c_str());
        if (hovered) {
            ImGui::SetTooltip("%s", found.show.text.c_str());
        }
    }
}

void ShowsPanel::draw_divider(const HudStyle& style) const {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImDrawList* const list = ImGui::GetBackgroundDrawList();
    const float x = divider * display.x;
    list->AddLine({x, 0}, {x, display.y}, ImGui::GetColorU32(kHudAccent), 2.0f * style.scale);
    const float y = 18.0f * style.scale;
    const float gap = 12.0f * style.scale;
    const auto label = [&](const char* text, float left) {
        const ImVec2 size = ImGui::CalcTextSize(text);
        const float pad = 5.0f * style.scale;
        list->AddRectFilled(
            {left - pad, y - pad}, {left + size.x + pad, y + size.y + pad},
            ImGui::GetColorU32({0.05f, 0.05f, 0.06f, 0.8f}), 4.0f);
        list->AddText({left, y}, ImGui::GetColorU32(kHudText), text);
    };
    const char* const off = show_side_name(ShowSide::Off);
    label(off, x - gap - ImGui::CalcTextSize(off).x);
    label(show_side_name(ShowSide::On), x + gap);
}

}  // namespace limn
