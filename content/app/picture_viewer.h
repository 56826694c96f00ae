#pragma once

#include "content/app/hdr_picture.h"
#include "content/app/hud.h"
#include "content/app/window.h"
#include "ecs/components/post.h"
#include "render/gpu/device.h"

#include <memory>
#include <optional>
#include <string>

namespace limn {

// The window of `limn view`: the picture as large as fits, a panel with sliders and statistics.
// Sleeps until something happens; the picture is developed when the exposure changed.

class PictureViewer {
  public:
    [[nodiscard]] static Result<std::unique_ptr<PictureViewer>>
    open(const std::string& file, const Exposure& exposure, const IVec2& size);
    PictureViewer(const PictureViewer&) = delete;
    PictureViewer& operator=(const PictureViewer&) = delete;

    /// Until the window is closed.
    [[nodiscard]] Status run();

  private:
    PictureViewer(
        std::unique_ptr<Window> window, std::unique_ptr<gpu::Device> device,
        std::unique_ptr<HdrPicture> picture, const Exposure& exposure);

    void handle_key(const KeyPress& press);
    void move_picture(const WindowEvents& events);
    void draw_frame(float dt);
    void draw_picture();
    void draw_panel();
    void draw_sliders();
    void draw_statistics();
    void save();

    std::unique_ptr<Window> window_;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<HdrPicture> picture_;
    std::unique_ptr<Hud> hud_;

    Exposure exposure_;
    Exposure initial_;
    const gpu::Texture* display_ = nullptr;  // null: to be developed
    double clipped_ = 0.0;
    float zoom_ = 1.0f;    // 1: the picture fits the window
    Vec2 shift_ = {0, 0};  // of its middle from the window's [pixels]
    bool panel_open_ = true;
    int files_saved_ = 0;
};

}  // namespace limn
