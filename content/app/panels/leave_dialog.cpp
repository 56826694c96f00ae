#include "content/app/panels/leave_dialog.h"

#include "content/app/panels/hud_style.h"
#include "content/app/panels/inspector.h"

#include <imgui.h>

#include <utility>

namespace limn {

void LeaveDialog::ask(std::string question, std::string accept, std::function<void()> action) {
    question_ = std::move(question);
    accept_ = std::move(accept);
    action_ = std::move(action);
    copied_ = false;
}

void LeaveDialog::accept() {
    accepted_ = std::exchange(action_, nullptr);
}

void LeaveDialog::stay() {
    action_ = nullptr;
}

std::function<void()> LeaveDialog::take_accepted() {
    return std::exchange(accepted_, nullptr);
}

void LeaveDialog::draw(const HudStyle& style, const Inspector& inspector, World& world) {
    if (!is_open()) {
        return;
    }
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, display, IM_COL32(0, 0, 0, 120));
    ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowFocus();
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove
                                        | ImGuiWindowFlags_AlwaysAutoResize
                                        | ImGuiWindowFlags_NoSavedSettings;
    if (ImGui::Begin("##leave", nullptr, kFlags)) {
        ImGui::PushFont(style.title);
        ImGui::TextUnformatted(question_.c_str());
        ImGui::PopFont();
        const std::size_t edits = inspector.edit_count();
        if (edits > 0) {
            ImGui::Text("%zu edit%s of this level will be lost.", edits, edits == 1 ? "" : "s");
            saves_ = ImGui::Button("Save  (S)") || saves_;
            ImGui::SameLine();
            if (ImGui::Button("Copy the edits as JSON")) {
                ImGui::SetClipboardText(inspector.edits_as_json(world).c_str());
                copied_ = true;
            }
            if (copied_) {
                ImGui::SameLine();
                ImGui::TextColored(kHudDim, "copied");
            }
        }
        ImGui::Dummy({0, 4 * style.scale});
        if (ImGui::Button((accept_ + "  (Enter)").c_str())) {
            accept();
        }
        ImGui::SameLine();
        if (ImGui::Button("Stay  (Esc)")) {
            stay();
        }
    }
    ImGui::End();
}

}  // namespace limn
