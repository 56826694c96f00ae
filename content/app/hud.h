#pragma once

#include "content/app/hud_style.h"
#include "ecs/base/math.h"

#include <string>
#include <vector>

namespace limn {

class Window;

// What lies over the picture while playing: a status line, the keys, short messages. The panels
// (inspector, profiler, buffer viewer) draw themselves between begin_frame and end_frame.

/// What the status line says; filled anew every frame.
struct HudStatus {
    const char* level = "";
    const char* camera = "";     ///< how the camera moves
    const char* weather = "";    ///< wind and rain, where there is any
    double time = 0.0;           ///< of the simulation [s]
    double frame_ms = 0.0;       ///< median of the last second
    IVec2 render_size = {0, 0};  ///< pixels drawn
    IVec2 window_size = {0, 0};  ///< pixels shown
    bool software_gl = false;    ///< the processor draws
    bool scale_auto = false;
    bool paused = false;
    const char* error = "";  ///< stays until it is mended: a shader that does not compile
};

enum class ToastKind : std::uint8_t { Note, Good, Bad };

class Hud {
  public:
    /// Draws into `window`, whose context is current. Its callbacks pass events on to those
    /// installed before.
    explicit Hud(Window& window);
    Hud(const Hud&) = delete;
    Hud& operator=(const Hud&) = delete;
    ~Hud();

    /// `dt`: real time since the last frame [s].
    void begin_frame(float dt);
    void draw_status(const HudStatus& status);
    /// A whole frame that says what is being loaded.
    void draw_loading(const std::string& what);
    /// Draws everything since begin_frame into the window's framebuffer.
    void end_frame();

    /// A line that fades after some seconds; the newest is lowest.
    void toast(std::string text, ToastKind kind = ToastKind::Note);

    /// The pointer is over a panel, or a field is being typed into: the game leaves them alone.
    [[nodiscard]] bool wants_mouse() const;
    [[nodiscard]] bool wants_keyboard() const;

    [[nodiscard]] const HudStyle& style() const { return style_; }

    bool help_open = false;  ///< F1
    bool status_shown = true;

  private:
    struct Toast {
        std::string text;
        ToastKind kind = ToastKind::Note;
        float age = 0.0f;  ///< [s]
    };

    void draw_help();
    void draw_toasts();

    Window& window_;
    HudStyle style_;
    std::vector<Toast> toasts_;
};

}  // namespace limn
