#include "content/app/hud.h"

#include "content/app/window.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace limn {
namespace {

constexpr float kToastLife = 5.0f;  // [s]
constexpr float kToastFade = 0.6f;  // [s]
constexpr float kMargin = 14.0f;    // from the edge of the window, in units of the layout
constexpr std::size_t kMaxToasts = 5;

constexpr ImGuiWindowFlags kOverlay =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing
    | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;

const std::vector<KeyHelp>& program_keys() {
    static const std::vector<KeyHelp> keys = {
        {"", "Look"},
        {"Drag", "look around, or circle the target or model"},
        {"Right drag", "move the circling camera sideways"},
        {"Wheel", "speed when flying, distance when circling"},
        {"Double-click", "circle what is under the pointer"},
        {"C", "camera: those of the level, fly, orbit"},
        {"M", "clips, morph targets and cameras of a model"},
        {"Click", "select what is under the pointer, throw a stone into water"},
        {"", "Time and levels"},
        {"Space", "pause, resume"},
        {".", "one step"},
        {"R", "restart the level"},
        {"PgUp PgDn", "previous, next level (Tab too)"},
        {"", "Tools"},
        {"F1", "these keys"},
        {"F2", "inspector: every component, with undo"},
        {"F3", "profiler of systems and passes"},
        {"F4", "intermediate textures of the frame"},
        {"F5", "reload the shaders"},
        {"F6  F7", "what the level shows; on, off, side by side"},
        {"F9  F10", "screenshot as PNG; HDR image as EXR"},
        {"Ctrl Z  Y", "undo, redo"},
        {"F8  F11", "hide the status, full screen"},
        {"Esc", "quit"},
    };
    return keys;
}

/// Text in the monospaced font.
void numbers_text(const HudStyle& style, const ImVec4& color, const char* text) {
    ImGui::PushFont(style.numbers);
    ImGui::TextColored(color, "%s", text);
    ImGui::PopFont();
}

const ImVec4& toast_color(ToastKind kind) {
    switch (kind) {
    case ToastKind::Good:
        return kHudGood;
    case ToastKind::Bad:
        return kHudBad;
    case ToastKind::Note:
        break;
    }
    return kHudText;
}

/// Draws a key cap.
void draw_key_cap(const char* key, float width) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImVec2 text_size = ImGui::CalcTextSize(key);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 cap = {text_size.x + 2 * style.FramePadding.x, text_size.y + 2};
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(
        at, {at.x + cap.x, at.y + cap.y}, ImGui::GetColorU32(ImGuiCol_FrameBgHovered),
        style.FrameRounding);
    list->AddText({at.x + style.FramePadding.x, at.y + 1}, ImGui::GetColorU32(kHudAccent), key);
    ImGui::Dummy({width, cap.y});
}

}  // namespace

Hud::Hud(Window& window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // panels start at their default places; nothing is written to disk
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    // Readable on a fine display and from across the room on a large one.
    const float height = static_cast<float>(window.framebuffer_size().y);
    const float scale = std::max(window.content_scale(), std::clamp(height / 900.0f, 1.0f, 2.5f));
    style_ = apply_hud_style(scale);
    ImGui_ImplGlfw_InitForOpenGL(window.handle(), true);
    ImGui_ImplOpenGL3_Init("#version 450");
}

Hud::~Hud() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Hud::begin_frame(float dt) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    for (Toast& toast : toasts_) {
        toast.age += dt;
    }
    std::erase_if(toasts_, [](const Toast& toast) { return toast.age > kToastLife; });
}

void Hud::end_frame() {
    if (help_open) {
        draw_help();
    }
    draw_toasts();
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Hud::wants_mouse() const {
    return ImGui::GetIO().WantCaptureMouse;
}

bool Hud::wants_keyboard() const {
    return ImGui::GetIO().WantTextInput;
}

void Hud::toast(std::string text, ToastKind kind) {
    toasts_.push_back({std::move(text), kind});
    if (toasts_.size() > kMaxToasts) {
        toasts_.erase(toasts_.begin());
    }
}

void Hud::draw_status(const HudStatus& status) {
    if (!status_shown) {
        return;
    }
    std::array<char, 256> line;
    const auto format = [&line](auto&& text, auto&&... arguments) {
        const auto end =
            fmt::format_to_n(line.data(), line.size() - 1, fmt::runtime(text), arguments...);
        *end.out = '\0';
        return line.data();
    };
    ImGui::SetNextWindowPos({kMargin * style_.scale, kMargin * style_.scale});
    ImGui::SetNextWindowBgAlpha(0.62f);
    if (ImGui::Begin("##status", nullptr, kOverlay)) {
        ImGui::PushFont(style_.title);
        ImGui::TextUnformatted(status.level);
        ImGui::PopFont();
        ImGui::SameLine(0, 12 * style_.scale);
        ImGui::AlignTextToFramePadding();
        ImGui::TextColored(kHudDim, "%s", status.camera);
        if (status.paused) {
            ImGui::SameLine(0, 12 * style_.scale);
            ImGui::TextColored(kHudAccent, "paused");
        }
        const double rate = status.frame_ms > 0.0 ? 1000.0 / status.frame_ms : 0.0;
        numbers_text(
            style_, kHudText,
            format("{:.1f} fps   {:.2f} ms   {:.2f} s", rate, status.frame_ms, status.time));
        numbers_text(
            style_, kHudDim,
            status.render_size == status.window_size
                ? format("{} x {}", status.window_size.x, status.window_size.y)
                : format(
                    "{} x {} shown at {} x {}{}", status.render_size.x, status.render_size.y,
                    status.window_size.x, status.window_size.y,
                    status.scale_auto ? " (auto)" : ""));
        if (*status.weather != '\0') {
            ImGui::TextColored(kHudText, "%s", status.weather);
        }
        if (status.software_gl) {
            ImGui::TextColored(kHudAccent, "software OpenGL: rendering on the CPU");
        }
        if (!help_open) {
            ImGui::TextColored(kHudDim, "F1 keys");
        }
        style_.panel_top = ImGui::GetWindowPos().y + ImGui::GetWindowHeight() + 8 * style_.scale;
    }
    ImGui::End();
    if (status.error[0] != '\0') {
        const ImVec2 display = ImGui::GetIO().DisplaySize;
        ImGui::SetNextWindowPos(
            {0.5f * display.x, kMargin * style_.scale}, ImGuiCond_Always, {0.5f, 0.0f});
        ImGui::SetNextWindowBgAlpha(0.92f);
        ImGui::PushStyleColor(ImGuiCol_Border, kHudBad);
        if (ImGui::Begin("##error", nullptr, kOverlay)) {
            ImGui::PushTextWrapPos(std::min(0.6f * display.x, 760.0f * style_.scale));
            ImGui::TextColored(kHudBad, "A shader does not compile; the last good one is shown.");
            ImGui::PushFont(style_.numbers);
            ImGui::TextUnformatted(status.error);
            ImGui::PopFont();
            ImGui::PopTextWrapPos();
        }
        ImGui::End();
        ImGui::PopStyleColor();
    }
}

void Hud::draw_loading(const std::string& what, const std::string& step) {
    begin_frame(0.0f);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
    if (ImGui::Begin("##loading", nullptr, kOverlay)) {
        ImGui::TextColored(kHudDim, "loading");
        ImGui::SameLine();
        ImGui::PushFont(style_.title);
        ImGui::TextUnformatted(what.c_str());
        ImGui::PopFont();
        ImGui::TextColored(kHudDim, "%s", step.c_str());
    }
    ImGui::End();
    end_frame();
}

void Hud::draw_help() {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowBgAlpha(0.94f);
    if (ImGui::Begin("##help", nullptr, kOverlay)) {
        const float key_width = 104.0f * style_.scale;
        bool first = true;
        const auto draw_lines = [&](const std::vector<KeyHelp>& lines) {
            for (const KeyHelp& line : lines) {
                if (line.keys.empty()) {
                    if (!first) {
                        ImGui::Dummy({0, 3 * style_.scale});
                    }
                    ImGui::PushFont(style_.title);
                    ImGui::TextUnformatted(line.text.c_str());
                    ImGui::PopFont();
                } else {
                    draw_key_cap(line.keys.c_str(), key_width);
                    ImGui::SameLine();
                    ImGui::TextUnformatted(line.text.c_str());
                }
                first = false;
            }
        };
        draw_lines(actions);
        draw_lines(program_keys());
    }
    ImGui::End();
}

void Hud::draw_toasts() {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    float bottom = display.y - kMargin * style_.scale;
    for (std::size_t i = toasts_.size(); i-- > 0;) {
        const Toast& toast = toasts_[i];
        const float left = kToastLife - toast.age;
        const float alpha = std::clamp(left / kToastFade, 0.0f, 1.0f);
        ImGui::SetNextWindowPos({0.5f * display.x, bottom}, ImGuiCond_Always, {0.5f, 1.0f});
        ImGui::SetNextWindowBgAlpha(0.80f * alpha);
        std::array<char, 16> name;
        *fmt::format_to_n(name.data(), name.size() - 1, "##toast{}", i).out = '\0';
        ImGui::PushStyleVar(ImGuiStyleVar_Alpha, std::max(alpha, 0.01f));
        if (ImGui::Begin(name.data(), nullptr, kOverlay)) {
            ImGui::TextColored(toast_color(toast.kind), "%s", toast.text.c_str());
            bottom -= ImGui::GetWindowHeight() + 6 * style_.scale;
        }
        ImGui::End();
        ImGui::PopStyleVar();
    }
}

}  // namespace limn
