#pragma once

#include "content/app/panels/hud_style.h"
#include "ecs/base/math.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

class Window;

// The overlay of the player: a status line, the key help, short messages. The panels (inspector,
// profiler, buffer viewer) draw themselves between begin_frame and end_frame.

/// Contents of the status line, filled in every frame.
struct HudStatus {
    const char* level = "";
    const char* camera = "";     ///< name of the camera mode
    const char* weather = "";    ///< wind and rain, if the level has weather
    const char* detail = "";     ///< cost of the surface detail, if the player changed it
    const char* drops = "";      ///< warning about dropped particles
    double time = 0.0;           ///< of the simulation [s]
    double rate = 1.0;           ///< simulated seconds per real second; < 1: slow motion
    const char* motion = "";     ///< of the player's camera: speed, position
    double frame_ms = 0.0;       ///< median of the last second
    IVec2 render_size = {0, 0};  ///< rendered resolution [px]
    IVec2 window_size = {0, 0};  ///< of the framebuffer [px]
    bool software_gl = false;    ///< OpenGL runs on the CPU
    bool scale_auto = false;
    int particle_stride = 1;  ///< one in this many particles is drawn
    bool paused = false;
    const char* error = "";  ///< of a shader or the level, shown until it is fixed
};

/// A line of the key help.
struct KeyHelp {
    std::string keys;  ///< empty: `text` is a heading
    std::string text;
};

enum class ToastKind : std::uint8_t { Note, Good, Bad };

class Hud {
  public:
    /// Draws into `window`, whose context is current. Its GLFW callbacks chain to those already
    /// installed.
    explicit Hud(Window& window);
    Hud(const Hud&) = delete;
    Hud& operator=(const Hud&) = delete;
    ~Hud();

    /// `dt`: real time since the last frame [s].
    void begin_frame(float dt);
    void draw_status(const HudStatus& status);
    /// Draws a whole frame with a message on what is being loaded.
    void draw_loading(const std::string& what, const std::string& step);
    /// Draws everything since begin_frame into the window's framebuffer.
    void end_frame();

    /// A line that fades after some seconds; the newest is at the bottom. Repeating a visible one
    /// restarts its timer.
    void toast(std::string text, ToastKind kind = ToastKind::Note);

    /// The pointer is over a panel, or a text field has the focus: the game ignores that input.
    [[nodiscard]] bool wants_mouse() const;
    [[nodiscard]] bool wants_keyboard() const;

    [[nodiscard]] const HudStyle& style() const { return style_; }

    /// Closes the innermost popup; false where none is open.
    bool close_popup();
    /// Title of the panel that has the focus; empty: none.
    [[nodiscard]] std::string_view focused_panel() const;

    bool help_open = false;     ///< F1
    std::vector<KeyHelp> help;  ///< its lines
    bool status_shown = true;

  private:
    struct Toast {
        std::string text;
        ToastKind kind = ToastKind::Note;
        float age = 0.0f;  ///< [s]
    };

    void feed_typing();
    void follow_window();
    void draw_help();
    void draw_toasts();

    Window* window_;
    HudStyle style_;
    std::vector<Toast> toasts_;
};

}  // namespace limn
