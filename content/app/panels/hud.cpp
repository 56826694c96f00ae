#include "content/app/panels/hud.h"

#include "content/app/player/window.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn {
namespace {

constexpr float kToastLife = 5.0f;       // [s]
constexpr float kToastFade = 0.6f;       // [s]
constexpr float kMargin = 14.0f;         // from the edge of the window, in units of the layout
constexpr float kLoadingWidth = 260.0f;  // of the loading message, in units of the layout
constexpr std::size_t kMaxToasts = 5;
constexpr float kTwoColumns =
    1050.0f;  // minimum width of the window for them, in units of the layout
constexpr double kSlowMotion = 0.95;  // of real time; below it the status line says so

constexpr ImGuiWindowFlags kOverlay =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing
    | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;

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

Hud::Hud(Window& window) : window_(&window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename =
        nullptr;  // panels start at their default positions; nothing is written to disk
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    style_ = apply_hud_style(hud_scale(window.content_scale(), window.framebuffer_size().y));
    // Keys and text go through the window's queue (feed_typing), not through ImGui's callbacks.
    GLFWwindow* const handle = window.handle();
    const GLFWkeyfun on_key = glfwSetKeyCallback(handle, nullptr);
    const GLFWcharfun on_character = glfwSetCharCallback(handle, nullptr);
    ImGui_ImplGlfw_InitForOpenGL(handle, true);
    glfwSetKeyCallback(handle, on_key);
    glfwSetCharCallback(handle, on_character);
    ImGui_ImplOpenGL3_Init("#version 450");
}

Hud::~Hud() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

/// The window's height may have changed.
void Hud::follow_window() {
    const int height = window_->framebuffer_size().y;
    const float scale = hud_scale(window_->content_scale(), height);
    if (height > 0 && scale != style_.scale) {
        style_ = apply_hud_style(scale);
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
    }
}

void Hud::begin_frame(float dt) {
    ImGui_ImplOpenGL3_NewFrame();
    follow_window();
    ImGui_ImplGlfw_NewFrame();
    feed_typing();
    ImGui::NewFrame();
    for (Toast& toast : toasts_) {
        toast.age += dt;
    }
    std::erase_if(toasts_, [](const Toast& toast) { return toast.age > kToastLife; });
}

/// In the order of typing, as far as one frame can preserve it.
void Hud::feed_typing() {
    ImGuiIO& io = ImGui::GetIO();
    for (const TypingEvent& event : window_->typing().take_frame()) {
        if (event.key < 0) {
            io.AddInputCharacter(event.character);
        } else if (event.key < IM_ARRAYSIZE(io.KeysDown)) {
            io.KeysDown[event.key] = event.down;
        }
    }
    const auto either = [&io](int left, int right) {
        return io.KeysDown[left] || io.KeysDown[right];
    };
    io.KeyCtrl = either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    io.KeyShift = either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    io.KeyAlt = either(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
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

bool Hud::close_popup() {
    const int open = ImGui::GetCurrentContext()->OpenPopupStack.Size;
    if (open > 0) {
        ImGui::ClosePopupToLevel(open - 1, true);
    }
    return open > 0;
}

std::string_view Hud::focused_panel() const {
    const ImGuiWindow* const window = ImGui::GetCurrentContext()->NavWindow;
    return window != nullptr ? window->RootWindow->Name : "";
}

void Hud::toast(std::string text, ToastKind kind) {
    std::erase_if(toasts_, [&](const Toast& toast) { return toast.text == text; });
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
        const double fps = status.frame_ms > 0.0 ? 1000.0 / status.frame_ms : 0.0;
        numbers_text(
            style_, kHudText,
            format("{:.1f} fps   {:.2f} ms   {:.2f} s", fps, status.frame_ms, status.time));
        if (!status.paused && status.rate < kSlowMotion) {
            ImGui::TextColored(
                kHudAccent, "%s", format("slow motion: time runs at {:.0f} %", 100 * status.rate));
        }
        numbers_text(
            style_, kHudDim,
            status.render_size == status.window_size
                ? format("{} x {}", status.window_size.x, status.window_size.y)
                : format(
                    "{} x {} shown at {} x {}{}", status.render_size.x, status.render_size.y,
                    status.window_size.x, status.window_size.y,
                    status.scale_auto ? " (auto)" : ""));
        if (status.particle_stride > 1) {
            numbers_text(
                style_, kHudDim,
                format("one in {} particles, to stay playable", status.particle_stride));
        }
        if (*status.motion != '\0') {
            numbers_text(style_, kHudDim, status.motion);
        }
        if (*status.weather != '\0') {
            ImGui::TextColored(kHudText, "%s", status.weather);
        }
        if (*status.detail != '\0') {
            numbers_text(style_, kHudText, status.detail);
        }
        if (*status.drops != '\0') {
            ImGui::TextColored(kHudBad, "%s", status.drops);
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
            ImGui::TextColored(
                kHudBad, "A file has an error; the last valid version stays in use.");
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
        ImGui::Dummy({kLoadingWidth * style_.scale, 0});  // loading steps differ in length
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
    const float margin = 2 * kMargin * style_.scale;
    const float key_width = 104.0f * style_.scale;
    ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {display.x - margin, display.y - margin});
    ImGui::SetNextWindowBgAlpha(0.94f);
    constexpr ImGuiWindowFlags kFlags =
        ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize
        | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;
    // Two columns if one is too high, split at a heading.
    auto second = help.end();
    const float line_height = ImGui::GetFrameHeightWithSpacing();
    const float height = static_cast<float>(help.size()) * line_height;
    if (height > display.y - 2 * margin && display.x > kTwoColumns * style_.scale) {
        const auto half = help.begin() + static_cast<std::ptrdiff_t>(help.size() / 2);
        second = std::find_if(half, help.end(), [](const KeyHelp& l) { return l.keys.empty(); });
    }
    if (ImGui::Begin("Keys", &help_open, kFlags)) {
        ImGui::BeginGroup();
        for (auto line = help.begin(); line != help.end(); ++line) {
            if (line == second) {
                ImGui::EndGroup();
                ImGui::SameLine(0, margin);
                ImGui::BeginGroup();
            }
            if (line->keys.empty()) {
                if (line != help.begin() && line != second) {
                    ImGui::Dummy({0, 3 * style_.scale});
                }
                ImGui::PushFont(style_.title);
                ImGui::TextUnformatted(line->text.c_str());
                ImGui::PopFont();
            } else {
                draw_key_cap(line->keys.c_str(), key_width);
                ImGui::SameLine();
                ImGui::TextUnformatted(line->text.c_str());
            }
        }
        ImGui::EndGroup();
    }
    ImGui::End();
}

/// In front of every panel.
void Hud::draw_toasts() {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImDrawList* const list = ImGui::GetForegroundDrawList();
    const ImVec2 pad = ImGui::GetStyle().WindowPadding;
    const float width = 0.9f * display.x - 2 * pad.x;
    float bottom = display.y - kMargin * style_.scale;
    for (std::size_t i = toasts_.size(); i-- > 0;) {
        const Toast& toast = toasts_[i];
        const float alpha = std::clamp((kToastLife - toast.age) / kToastFade, 0.0f, 1.0f);
        const char* const text = toast.text.c_str();
        const ImVec2 size = ImGui::CalcTextSize(text, nullptr, false, width);
        const float top = bottom - size.y - 2 * pad.y;
        const float left = 0.5f * (display.x - size.x) - pad.x;
        ImVec4 back = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
        back.w = 0.88f * alpha;
        ImVec4 color = toast_color(toast.kind);
        color.w = alpha;
        list->AddRectFilled(
            {left, top}, {left + size.x + 2 * pad.x, bottom}, ImGui::GetColorU32(back),
            ImGui::GetStyle().WindowRounding);
        list->AddText(
            style_.text, style_.text->FontSize, {left + pad.x, top + pad.y},
            ImGui::GetColorU32(color), text, nullptr, width);
        bottom = top - 6 * style_.scale;
    }
}

}  // namespace limn
