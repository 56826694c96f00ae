#include "content/app/panels/hud_style.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>

namespace limn {
namespace {

constexpr const char* kFontFolder = "/usr/share/fonts/truetype/dejavu/";

ImFont* load_font(const char* file, float pixels) {
    ImFontAtlas* atlas = ImGui::GetIO().Fonts;
    const std::string path = std::string(kFontFolder) + file;
    // Latin and the symbols that the HUD uses: punctuation, arrows, mathematics, triangles.
    static constexpr std::array<ImWchar, 11> kGlyphs = {
        0x0020, 0x00ff, 0x2010, 0x2026, 0x2190, 0x2193, 0x2200, 0x226f, 0x25a0, 0x25cf, 0};
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) {
        ImFontConfig config;
        config.OversampleH = 2;
        return atlas->AddFontFromFileTTF(path.c_str(), pixels, &config, kGlyphs.data());
    }
    ImFontConfig config;
    config.SizePixels = pixels;
    return atlas->AddFontDefault(&config);
}

void set_colors(ImGuiStyle& style) {
    const auto gray = [](float value, float alpha) {
        return ImVec4(value, value * 1.06f, value * 1.22f, alpha);  // a little blue
    };
    const auto accent = [](float alpha) {
        return ImVec4(kHudAccent.x, kHudAccent.y, kHudAccent.z, alpha);
    };
    ImVec4* color = style.Colors;
    color[ImGuiCol_Text] = kHudText;
    color[ImGuiCol_TextDisabled] = kHudDim;
    color[ImGuiCol_WindowBg] = gray(0.055f, 0.90f);
    color[ImGuiCol_ChildBg] = gray(0.0f, 0.0f);
    color[ImGuiCol_PopupBg] = gray(0.08f, 0.97f);
    color[ImGuiCol_Border] = gray(1.0f, 0.09f);
    color[ImGuiCol_BorderShadow] = {0, 0, 0, 0};
    color[ImGuiCol_FrameBg] = gray(0.80f, 0.08f);
    color[ImGuiCol_FrameBgHovered] = gray(0.80f, 0.14f);
    color[ImGuiCol_FrameBgActive] = gray(0.80f, 0.20f);
    color[ImGuiCol_TitleBg] = gray(0.045f, 0.95f);
    color[ImGuiCol_TitleBgActive] = gray(0.075f, 0.97f);
    color[ImGuiCol_TitleBgCollapsed] = gray(0.045f, 0.80f);
    color[ImGuiCol_MenuBarBg] = gray(0.08f, 1.0f);
    color[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
    color[ImGuiCol_ScrollbarGrab] = gray(0.80f, 0.16f);
    color[ImGuiCol_ScrollbarGrabHovered] = gray(0.80f, 0.26f);
    color[ImGuiCol_ScrollbarGrabActive] = gray(0.80f, 0.36f);
    color[ImGuiCol_CheckMark] = kHudAccent;
    color[ImGuiCol_SliderGrab] = accent(0.85f);
    color[ImGuiCol_SliderGrabActive] = kHudAccent;
    color[ImGuiCol_Button] = gray(0.80f, 0.10f);
    color[ImGuiCol_ButtonHovered] = accent(0.28f);
    color[ImGuiCol_ButtonActive] = accent(0.45f);
    color[ImGuiCol_Header] = accent(0.16f);
    color[ImGuiCol_HeaderHovered] = accent(0.24f);
    color[ImGuiCol_HeaderActive] = accent(0.34f);
    color[ImGuiCol_Separator] = gray(1.0f, 0.10f);
    color[ImGuiCol_SeparatorHovered] = accent(0.5f);
    color[ImGuiCol_SeparatorActive] = kHudAccent;
    color[ImGuiCol_ResizeGrip] = gray(0.80f, 0.10f);
    color[ImGuiCol_ResizeGripHovered] = accent(0.5f);
    color[ImGuiCol_ResizeGripActive] = kHudAccent;
    color[ImGuiCol_Tab] = gray(0.80f, 0.06f);
    color[ImGuiCol_TabHovered] = accent(0.30f);
    color[ImGuiCol_TabActive] = accent(0.22f);
    color[ImGuiCol_TabUnfocused] = gray(0.80f, 0.06f);
    color[ImGuiCol_TabUnfocusedActive] = accent(0.16f);
    color[ImGuiCol_PlotLines] = kHudAccent;
    color[ImGuiCol_PlotHistogram] = kHudAccent;
    color[ImGuiCol_TableHeaderBg] = gray(0.80f, 0.07f);
    color[ImGuiCol_TableBorderStrong] = gray(1.0f, 0.10f);
    color[ImGuiCol_TableBorderLight] = gray(1.0f, 0.06f);
    color[ImGuiCol_TableRowBgAlt] = gray(1.0f, 0.025f);
    color[ImGuiCol_TextSelectedBg] = accent(0.30f);
    color[ImGuiCol_NavHighlight] = accent(0.8f);
}

}  // namespace

float hud_scale(float content_scale, int window_height) {
    constexpr float kText = 14.0f;  // text size [px] at scale 1
    constexpr float kSmallest = 11.0f;
    const auto height = static_cast<float>(window_height);
    const float small = std::clamp(height / content_scale / 720.0f, kSmallest / kText, 1.0f);
    const float scale = std::max(content_scale * small, std::min(height / 900.0f, 2.5f));
    return std::round(kText * scale) / kText;
}

HudStyle apply_hud_style(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    set_colors(style);
    style.WindowPadding = {12, 10};
    style.FramePadding = {7, 3};
    style.CellPadding = {6, 2};
    style.ItemSpacing = {8, 5};
    style.ItemInnerSpacing = {6, 4};
    style.IndentSpacing = 14;
    style.ScrollbarSize = 11;
    style.GrabMinSize = 9;
    style.WindowRounding = 8;
    style.ChildRounding = 6;
    style.FrameRounding = 4;
    style.PopupRounding = 6;
    style.ScrollbarRounding = 6;
    style.GrabRounding = 3;
    style.TabRounding = 4;
    style.WindowBorderSize = 1;
    style.FrameBorderSize = 0;
    style.WindowTitleAlign = {0.0f, 0.5f};
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.ScaleAllSizes(scale);
    style.WindowBorderSize = 1;
    ImGui::GetStyle() = style;

    ImGui::GetIO().Fonts->Clear();
    const auto pixels = [scale](float size) { return std::round(size * scale); };
    HudStyle hud{.scale = scale};
    hud.text = load_font("DejaVuSans.ttf", pixels(14));
    hud.numbers = load_font("DejaVuSansMono.ttf", pixels(13));
    hud.title = load_font("DejaVuSans-Bold.ttf", pixels(16));
    return hud;
}

}  // namespace limn
