#pragma once

#include "content/app/commands/hdr_image.h"
#include "content/app/panels/hud.h"
#include "content/app/player/window.h"
#include "ecs/components/post.h"
#include "render/gpu/device.h"

#include <memory>
#include <optional>
#include <string>

namespace limn {

// The window of `limn view`: the image, fitted to the window, and a panel with sliders and
// statistics. Sleeps until an event arrives; tone maps again only when the exposure changes.

class ImageViewer {
  public:
    [[nodiscard]] static Result<std::unique_ptr<ImageViewer>>
    open(const std::string& file, const Exposure& exposure, const IVec2& size);
    ImageViewer(const ImageViewer&) = delete;
    ImageViewer& operator=(const ImageViewer&) = delete;

    /// Runs until the window is closed.
    [[nodiscard]] Status run();

  private:
    ImageViewer(
        std::unique_ptr<Window> window, std::unique_ptr<gpu::Device> device,
        std::unique_ptr<HdrImage> image, const Exposure& exposure);

    void handle_key(const KeyPress& press);
    void move_image(const WindowEvents& events);
    void draw_frame(float dt);
    void draw_image();
    void draw_panel();
    void draw_sliders();
    void draw_statistics();
    void save();

    std::unique_ptr<Window> window_;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<HdrImage> image_;
    std::unique_ptr<Hud> hud_;

    Exposure exposure_;
    Exposure initial_;
    const gpu::Texture* display_ = nullptr;  // null: needs tone mapping
    double clipped_ = 0.0;
    float zoom_ = 1.0f;    // 1: the image fits the window
    Vec2 shift_ = {0, 0};  // of the image's center from the window's [px]
    bool panel_open_ = true;
    int files_saved_ = 0;
};

}  // namespace limn
