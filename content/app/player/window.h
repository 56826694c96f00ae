#pragma once

#include "content/app/player/typing_queue.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace limn {

// A window with an OpenGL 4.5 core context, and the input events since the last poll. Uses GLFW, on
// the main thread only. Keys and buttons are GLFW's codes.

struct WindowOptions {
    std::string title = "Limn";
    IVec2 size = {1280, 720};  ///< of the client area [screen units]
    bool fullscreen = false;
    bool vsync = true;
};

/// A key went down (or repeated, while held).
struct KeyPress {
    int key = 0;
    int modifiers = 0;  ///< GLFW_MOD_*
    bool repeated = false;
};

/// Input events between two calls of poll.
struct WindowEvents {
    std::vector<KeyPress> keys;   ///< in order
    Vec2 mouse_motion = {0, 0};   ///< [pixels], x right, y down
    float wheel = 0.0f;           ///< steps, > 0 away from the player
    bool left_clicked = false;    ///< pressed and released without dragging
    bool double_clicked = false;  ///< the second click of two
};

class Window {
  public:
    /// Opens the window and makes its context current. Fails without a display or OpenGL 4.5.
    [[nodiscard]] static Result<std::unique_ptr<Window>> open(const WindowOptions& options);

    /// Whether there is a display to open a window on.
    [[nodiscard]] static bool has_display();

    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    /// Takes the events since the last call. The reference holds until the next one.
    const WindowEvents& poll();
    /// Sleeps until an event arrives, at most `seconds`; poll returns it.
    void wait_events(double seconds);
    /// Keys and text for panels since the last call.
    [[nodiscard]] TypingQueue& typing() { return typing_; }
    /// Presents the back buffer; if vsync is on it waits for the display, or where the driver
    /// cannot (software OpenGL, remote displays), as long as the display would.
    void swap();

    [[nodiscard]] bool wants_to_close() const;
    /// Makes wants_to_close() true, or false again if the user decides to stay.
    void request_close(bool close = true);

    [[nodiscard]] IVec2 framebuffer_size() const;  ///< [pixels]; 0 x 0 while minimized
    [[nodiscard]] Vec2 mouse_position() const;  ///< [pixels of the framebuffer], from the top left
    [[nodiscard]] float content_scale() const;  ///< 1 on a standard display, 2 on a high-DPI one
    [[nodiscard]] bool is_key_down(int key) const;
    [[nodiscard]] bool is_button_down(int button) const;

    /// Hides the pointer and unbounds its motion, for mouse look.
    void capture_mouse(bool captured);
    [[nodiscard]] bool is_mouse_captured() const { return captured_; }

    /// Switches between full screen on the primary monitor and the previous window.
    void toggle_fullscreen();

    void set_title(const std::string& title);
    [[nodiscard]] GLFWwindow* handle() const { return window_; }

  private:
    Window() = default;
    void install_callbacks();

    GLFWwindow* window_ = nullptr;
    WindowEvents collecting_;
    WindowEvents events_;
    TypingQueue typing_;
    Vec2 last_mouse_ = {0, 0};
    bool mouse_known_ = false;
    Vec2 press_position_ = {0, 0};
    double last_click_ = -1.0;  ///< [s]
    double refresh_ = 0.0;      ///< [s] of the display; 0 without vsync
    double last_swap_ = 0.0;    ///< [s]
    bool captured_ = false;
    IVec2 windowed_position_ = {60, 60};
    IVec2 windowed_size_ = {1280, 720};
};

}  // namespace limn
