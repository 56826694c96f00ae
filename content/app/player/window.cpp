#include "content/app/player/window.h"

#include "ecs/base/check.h"
#include "ecs/base/text.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <thread>
#include <utility>

namespace limn {
namespace {

constexpr float kDragThreshold = 4.0f;  // [px] a press that moves farther is a drag, not a click
constexpr double kDoubleClick = 0.35;   // [s] between two clicks

/// GLFW's last error, for our next message; GLFW reports through a callback only.
std::string& last_glfw_error() {
    static std::string error;
    return error;
}

/// Initializes GLFW once; false without a display.
bool start_glfw() {
    static const bool started = [] {
        glfwSetErrorCallback([](int, const char* text) { last_glfw_error() = text; });
        return glfwInit() == GLFW_TRUE;
    }();
    return started;
}

/// A procedural sun over water: 64 x 64 pixels, antialiased by distance.
void set_icon(GLFWwindow* window) {
    constexpr int kSide = 64;
    std::vector<unsigned char> pixels;
    pixels.reserve(std::size_t{4} * kSide * kSide);
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const Vec2 p = Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f - 32.0f;
            const Vec2 corner = glm::max(glm::abs(p) - 22.0f, Vec2(0));
            const float inside = std::clamp(9.5f - glm::length(corner), 0.0f, 1.0f);
            const float sun = std::clamp(14.5f - glm::length(p + Vec2(0, 2)), 0.0f, 1.0f);
            const float wave = 6.0f + 2.5f * std::sin(0.25f * p.x);
            const float water = std::clamp(p.y - wave + 0.5f, 0.0f, 1.0f);
            Vec3 color = glm::mix(Vec3(28, 32, 44), Vec3(246, 184, 84), sun);
            color = glm::mix(color, Vec3(40, 104, 138) * (1.0f - 0.012f * (p.y - wave)), water);
            for (int c = 0; c < 3; ++c) {
                pixels.push_back(static_cast<unsigned char>(color[c]));
            }
            pixels.push_back(static_cast<unsigned char>(255.0f * inside));
        }
    }
    const GLFWimage icon = {kSide, kSide, pixels.data()};
    glfwSetWindowIcon(window, 1, &icon);
}

Window& window_of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

}  // namespace

bool Window::has_display() {
    return start_glfw();
}

Result<std::unique_ptr<Window>> Window::open(const WindowOptions& options) {
    if (!start_glfw()) {
        return fail("window: found no display ({}), expected one", last_glfw_error());
    }
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
#if defined(LIMN_GL_DEBUG)
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
#endif
    // The scene is drawn into textures; the window itself needs color only.
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_ALPHA_BITS, 0);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);  // high-DPI displays get more pixels

    GLFWmonitor* monitor = options.fullscreen ? glfwGetPrimaryMonitor() : nullptr;
    IVec2 size = options.size;
    if (monitor != nullptr) {
        const GLFWvidmode* mode = glfwGetVideoMode(monitor);
        size = mode != nullptr ? IVec2(mode->width, mode->height) : size;
    }
    std::unique_ptr<Window> window(new Window);
    window->window_ = glfwCreateWindow(size.x, size.y, options.title.c_str(), monitor, nullptr);
    if (window->window_ == nullptr) {
        return fail(
            "window: found no OpenGL 4.5 core context on this display ({}), expected one",
            last_glfw_error());
    }
    glfwMakeContextCurrent(window->window_);
    glfwSwapInterval(options.vsync ? 1 : 0);
    if (options.vsync) {
        const GLFWvidmode* const mode = glfwGetVideoMode(glfwGetPrimaryMonitor());
        window->refresh_ =
            1.0 / (mode != nullptr && mode->refreshRate > 0 ? mode->refreshRate : 60);
    }
    glfwSetWindowUserPointer(window->window_, window.get());
    window->install_callbacks();
    set_icon(window->window_);
    return window;
}

Window::~Window() {
    if (window_ != nullptr) {
        glfwDestroyWindow(window_);
    }
}

void Window::install_callbacks() {
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
        if (action != GLFW_RELEASE) {
            window_of(window).collecting_.keys.push_back(
                {.key = key, .modifiers = modifiers, .repeated = action == GLFW_REPEAT});
        }
        if (action != GLFW_REPEAT && key >= 0) {
            window_of(window).typing_.add({.key = key, .down = action == GLFW_PRESS});
        }
    });
    glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned character) {
        window_of(window).typing_.add({.character = character});
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double y) {
        window_of(window).collecting_.wheel += static_cast<float>(y);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
        Window& self = window_of(window);
        const Vec2 position(static_cast<float>(x), static_cast<float>(y));
        if (self.mouse_known_) {
            self.collecting_.mouse_motion += position - self.last_mouse_;
        }
        self.last_mouse_ = position;
        self.mouse_known_ = true;
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int) {
        Window& self = window_of(window);
        if (button != GLFW_MOUSE_BUTTON_LEFT) {
            return;
        }
        if (action == GLFW_PRESS) {
            self.press_position_ = self.last_mouse_;
        } else if (glm::distance(self.press_position_, self.last_mouse_) <= kDragThreshold) {
            self.collecting_.left_clicked = true;
            const double now = glfwGetTime();
            self.collecting_.double_clicked = now - self.last_click_ < kDoubleClick;
            self.last_click_ = self.collecting_.double_clicked ? -1.0 : now;
        }
    });
}

const WindowEvents& Window::poll() {
    glfwPollEvents();
    std::swap(events_, collecting_);
    collecting_.keys.clear();  // keeps its memory
    collecting_.mouse_motion = {0, 0};
    collecting_.wheel = 0.0f;
    collecting_.left_clicked = false;
    collecting_.double_clicked = false;
    return events_;
}

void Window::wait_events(double seconds) {
    glfwWaitEventsTimeout(seconds);
}

void Window::toggle_fullscreen() {
    if (glfwGetWindowMonitor(window_) != nullptr) {
        glfwSetWindowMonitor(
            window_, nullptr, windowed_position_.x, windowed_position_.y, windowed_size_.x,
            windowed_size_.y, GLFW_DONT_CARE);
        return;
    }
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* const mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode == nullptr) {
        return;
    }
    glfwGetWindowPos(window_, &windowed_position_.x, &windowed_position_.y);
    glfwGetWindowSize(window_, &windowed_size_.x, &windowed_size_.y);
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::swap() {
    glfwSwapBuffers(window_);
    // Much less than a refresh interval means that the driver does not wait.
    const double elapsed = glfwGetTime() - last_swap_;
    if (elapsed < 0.8 * refresh_) {
        std::this_thread::sleep_for(std::chrono::duration<double>(refresh_ - elapsed));
    }
    last_swap_ = glfwGetTime();
}

bool Window::wants_to_close() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::request_close(bool close) {
    glfwSetWindowShouldClose(window_, close ? GLFW_TRUE : GLFW_FALSE);
}

IVec2 Window::framebuffer_size() const {
    IVec2 size = {0, 0};
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    return size;
}

Vec2 Window::mouse_position() const {
    IVec2 size = {0, 0};
    glfwGetWindowSize(window_, &size.x, &size.y);
    const Vec2 pixels_per_unit = Vec2(framebuffer_size()) / Vec2(glm::max(size, IVec2(1)));
    return last_mouse_ * pixels_per_unit;
}

float Window::content_scale() const {
    float x = 1.0f;
    float y = 1.0f;
    glfwGetWindowContentScale(window_, &x, &y);
    return x;
}

bool Window::is_key_down(int key) const {
    return glfwGetKey(window_, key) == GLFW_PRESS;
}

bool Window::is_button_down(int button) const {
    return glfwGetMouseButton(window_, button) == GLFW_PRESS;
}

void Window::capture_mouse(bool captured) {
    if (captured == captured_) {
        return;
    }
    captured_ = captured;
    glfwSetInputMode(window_, GLFW_CURSOR, captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    // The pointer may jump when its mode changes; that must not count as motion.
    double x = 0;
    double y = 0;
    glfwGetCursorPos(window_, &x, &y);
    last_mouse_ = {static_cast<float>(x), static_cast<float>(y)};
}

void Window::set_title(const std::string& title) {
    glfwSetWindowTitle(window_, title.c_str());
}

}  // namespace limn
