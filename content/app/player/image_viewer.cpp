#include "content/app/player/image_viewer.h"

#include "content/load/files/png_file.h"
#include "render/gpu/readback.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

// Techniques: hdr.viewer

namespace limn {
namespace {

using ViewerClock = std::chrono::steady_clock;

constexpr double kPollInterval = 0.25;  // [s] longest wait for an event
constexpr float kEvStep = 0.5f;         // of a key press
constexpr float kZoomStep = 1.15f;      // of a step of the wheel
constexpr float kMaxZoom = 64.0f;
constexpr float kPanelWidth = 330.0f;  // in layout units
constexpr const char* kCurves[] = {"Neutral",  "ACES",           "Linear",
                                   "Reinhard", "Dodge and burn", "Knee"};
constexpr const char* kMetering[] = {"Manual", "Key", "Auto"};

void row(const char* name, const std::string& value) {
    ImGui::TextColored(kHudDim, "%s", name);
    ImGui::SameLine(0.42f * ImGui::GetContentRegionAvail().x);
    ImGui::TextUnformatted(value.c_str());
}

std::string range_row(double least, double largest) {
    const double ratio = range_ratio(least, largest);
    return fmt::format("{:.3g}:1, {:.1f} stops", ratio, std::log2(ratio));
}

}  // namespace

ImageViewer::ImageViewer(
    std::unique_ptr<Window> window, std::unique_ptr<gpu::Device> device,
    std::unique_ptr<HdrImage> image, const Exposure& exposure)
    : window_(std::move(window)), device_(std::move(device)), image_(std::move(image)),
      hud_(std::make_unique<Hud>(*window_)), exposure_(exposure), initial_(exposure) {}

Result<std::unique_ptr<ImageViewer>>
ImageViewer::open(const std::string& file, const Exposure& exposure, const IVec2& size) {
    const std::string name = std::filesystem::path(file).filename().string();
    Result<std::unique_ptr<Window>> window =
        Window::open({.title = name + " - Limn", .size = size});
    if (!window) {
        return window.error();
    }
    Result<std::unique_ptr<gpu::Device>> device = gpu::Device::from_current_context();
    if (!device) {
        return device.error();
    }
    Result<std::unique_ptr<HdrImage>> image = HdrImage::load(**device, file);
    if (!image) {
        return image.error();
    }
    fmt::print("{}", describe(**image));
    std::fflush(stdout);
    return std::unique_ptr<ImageViewer>(
        new ImageViewer(*std::move(window), *std::move(device), *std::move(image), exposure));
}

// ---- input -----------------------------------------------------------------------

void ImageViewer::handle_key(const KeyPress& press) {
    const float steps = press.key == GLFW_KEY_UP ? 1.0f : press.key == GLFW_KEY_DOWN ? -1.0f : 0.0f;
    if (steps != 0.0f) {
        exposure_.ev = std::clamp(exposure_.ev + steps * kEvStep, -24.0f, 24.0f);
        display_ = nullptr;
        return;
    }
    if (press.repeated) {
        return;
    }
    switch (press.key) {
    case GLFW_KEY_ESCAPE:
        window_->request_close();
        break;
    case GLFW_KEY_C:
        exposure_.curve = static_cast<ToneCurve>(
            (static_cast<std::size_t>(exposure_.curve) + 1) % std::size(kCurves));
        display_ = nullptr;
        break;
    case GLFW_KEY_R:
        exposure_ = initial_;
        zoom_ = 1.0f;
        shift_ = {0, 0};
        display_ = nullptr;
        break;
    case GLFW_KEY_F2:
        panel_open_ = !panel_open_;
        break;
    case GLFW_KEY_F9:
        save();
        break;
    case GLFW_KEY_F11:
        window_->toggle_fullscreen();
        break;
    default:
        break;
    }
}

void ImageViewer::move_image(const WindowEvents& events) {
    if (hud_->wants_mouse()) {
        return;
    }
    if (window_->is_button_down(GLFW_MOUSE_BUTTON_LEFT)) {
        shift_ += events.mouse_motion;
    }
    if (events.wheel != 0.0f) {
        const float zoom = std::clamp(zoom_ * std::pow(kZoomStep, events.wheel), 0.1f, kMaxZoom);
        // The point under the pointer stays fixed.
        const Vec2 pointer = window_->mouse_position() - 0.5f * Vec2(window_->framebuffer_size());
        shift_ = pointer - (pointer - shift_) * (zoom / zoom_);
        zoom_ = zoom;
    }
}

void ImageViewer::save() {
    const std::string stem = std::filesystem::path(image_->path()).stem().string();
    std::string path;
    std::error_code ignored;
    do {
        path = fmt::format("{}-{:04}.png", stem, ++files_saved_);
    } while (std::filesystem::exists(path, ignored));
    const gpu::ByteImage image = gpu::read_bytes(image_->show(exposure_));
    display_ = nullptr;
    const Status status = write_png(path, image.width, image.height, image.channels, image.pixels);
    if (status) {
        fmt::print("{}\n", path);
        std::fflush(stdout);
    }
    hud_->toast(
        status ? "saved " + path : status.error().message,
        status ? ToastKind::Good : ToastKind::Bad);
}

Status ImageViewer::run() {
    ViewerClock::time_point last = ViewerClock::now();
    while (!window_->wants_to_close()) {
        window_->wait_events(kPollInterval);
        const WindowEvents& events = window_->poll();
        for (const KeyPress& press : events.keys) {
            if (!hud_->wants_keyboard()) {
                handle_key(press);
            }
        }
        const IVec2 size = window_->framebuffer_size();
        if (size.x < 1 || size.y < 1) {
            continue;  // minimized
        }
        move_image(events);
        const ViewerClock::time_point now = ViewerClock::now();
        draw_frame(std::chrono::duration<float>(now - last).count());
        last = now;
        window_->swap();
    }
    return Done{};
}

// ---- a frame ------------------------------------------------------------------------------------

void ImageViewer::draw_frame(float dt) {
    if (display_ == nullptr) {
        display_ = &image_->show(exposure_);
        clipped_ = clipped_fraction(*display_);
    }
    const IVec2 size = window_->framebuffer_size();
    device_->bind_window(size.x, size.y);
    glClearColor(0.06f, 0.06f, 0.07f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    hud_->begin_frame(dt);
    draw_image();
    if (panel_open_) {
        draw_panel();
    }
    hud_->end_frame();
    device_->invalidate_state();
}

void ImageViewer::draw_image() {
    const Vec2 window = Vec2(window_->framebuffer_size());
    const Vec2 image = {image_->width(), image_->height()};
    const float scale = zoom_ * std::min(window.x / image.x, window.y / image.y);
    const Vec2 begin = glm::round(0.5f * (window - scale * image) + shift_);
    const Vec2 end = begin + scale * image;
    // ImGui's rows run down, OpenGL's up.
    const auto texture = reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(display_->id()));
    ImGui::GetBackgroundDrawList()->AddImage(
        texture, {begin.x, begin.y}, {end.x, end.y}, {0, 1}, {1, 0});
}

void ImageViewer::draw_panel() {
    const HudStyle& style = hud_->style();
    const float margin = 14 * style.scale;
    ImGui::SetNextWindowPos({margin, margin}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({kPanelWidth * style.scale, 0});
    if (ImGui::Begin("Exposure (F2)", &panel_open_, ImGuiWindowFlags_NoResize)) {
        const Exposure before = exposure_;
        draw_sliders();
        if (exposure_ != before) {
            display_ = nullptr;
        }
        ImGui::Separator();
        draw_statistics();
        ImGui::Separator();
        ImGui::TextColored(
            kHudDim,
            "Up Down exposure  C curve  R reset\nwheel zoom  drag move  F9 save  Esc quit");
    }
    ImGui::End();
}

void ImageViewer::draw_sliders() {
    ImGui::PushItemWidth(0.62f * ImGui::GetContentRegionAvail().x);
    const auto choose = [](const char* label, auto& value, const auto& names) {
        int index = static_cast<int>(value);
        if (ImGui::Combo(label, &index, names, static_cast<int>(std::size(names)))) {
            value = static_cast<std::decay_t<decltype(value)>>(index);
        }
    };
    constexpr ImGuiSliderFlags kClamp = ImGuiSliderFlags_AlwaysClamp;
    choose("curve", exposure_.curve, kCurves);
    choose("metering", exposure_.metering, kMetering);
    ImGui::SliderFloat("exposure", &exposure_.ev, -12.0f, 12.0f, "%.2f stops", kClamp);
    if (exposure_.metering != Metering::Manual || exposure_.curve == ToneCurve::Local) {
        ImGui::SliderFloat(
            "key", &exposure_.key, 0.01f, 1.0f, "%.3f", kClamp | ImGuiSliderFlags_Logarithmic);
    }
    ImGui::SliderFloat("defog", &exposure_.defog, 0.0f, 0.01f, "%.4f", kClamp);
    if (exposure_.curve == ToneCurve::Knee) {
        ImGui::SliderFloat(
            "contrast", &exposure_.contrast, 0.0f, 10.0f, "%.3f",
            kClamp | ImGuiSliderFlags_Logarithmic);
    }
    if (exposure_.curve == ToneCurve::Reinhard) {
        ImGui::SliderFloat(
            "white", &exposure_.white, 0.0f, 100.0f, "%.1f", kClamp | ImGuiSliderFlags_Logarithmic);
    }
    if (exposure_.curve == ToneCurve::Knee || exposure_.encoding == DisplayEncoding::Power) {
        ImGui::SliderFloat("gamma", &exposure_.gamma, 1.0f, 4.0f, "%.2f", kClamp);
    }
    ImGui::PopItemWidth();
}

void ImageViewer::draw_statistics() {
    const HdrStatistics& s = image_->statistics();
    row("size", fmt::format("{} x {}", image_->width(), image_->height()));
    row("log-average", fmt::format("{:.4g}", s.log_average));
    row("mean color", fmt::format("{:.3g} {:.3g} {:.3g}", s.mean.x, s.mean.y, s.mean.z));
    row("luminance", fmt::format("{:.3g} .. {:.3g}", s.least, s.largest));
    row("range", range_row(s.least, s.largest));
    row("inner 99.8 %", range_row(s.clipped_min_luminance, s.clipped_max_luminance));
    row("clipped", fmt::format("{:.2f} %", 100.0 * clipped_));
    if (s.not_finite > 0) {
        ImGui::TextColored(kHudBad, "%u pixels hold NaN or infinity", s.not_finite);
    }
}

}  // namespace limn
