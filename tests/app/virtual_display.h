#pragma once

#include "tests/app/read_image.h"
#include "tests/app/run_program.h"

#include <doctest/doctest.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace limn::test {

// Windows as their users meet them: a virtual display (Xvfb), real key presses (xdotool), and what
// the display shows, read from the memory of its screen.

inline constexpr int kDisplayWidth = 640;
inline constexpr int kDisplayHeight = 400;

inline void sleep_ms(int ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

/// Asks until the answer is yes; false after `seconds`.
inline bool wait_for(const std::function<bool()>& condition, double seconds = 60.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) {
            return true;
        }
        sleep_ms(50);
    }
    return false;
}

inline std::uint32_t big_endian(const std::string& text, std::size_t word) {
    std::uint32_t value = 0;
    for (std::size_t i = 4 * word; i < 4 * word + 4 && i < text.size(); ++i) {
        value = (value << 8) | static_cast<std::uint8_t>(text[i]);
    }
    return value;
}

/// A display without a screen, whose image is a file in the XWD format.
class VirtualDisplay {
  public:
    explicit VirtualDisplay(const TemporaryFolder& folder) : screen_(folder.file("Xvfb_screen0")) {
        int ends[2] = {-1, -1};
        if (pipe(ends) != 0) {
            return;
        }
        pid_ = fork();
        if (pid_ == 0) {
            const int quiet = open("/dev/null", O_WRONLY);
            dup2(quiet, STDERR_FILENO);
            dup2(ends[1], 9);
            const std::string size =
                std::to_string(kDisplayWidth) + "x" + std::to_string(kDisplayHeight) + "x24";
            const std::string path = folder.path();
            execlp(
                "Xvfb", "Xvfb", "-displayfd", "9", "-screen", "0", size.c_str(), "-fbdir",
                path.c_str(),
                "-nocursor",  // the screen's memory would hold the pointer
                "-nolisten", "tcp", nullptr);
            _exit(127);
        }
        close(ends[1]);
        // The display's number and a line feed, which may come apart.
        std::string number;
        for (char digit = 0; read(ends[0], &digit, 1) == 1 && digit != '\n';) {
            number += digit;
        }
        close(ends[0]);
        name_ = ":" + number;
    }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;
    ~VirtualDisplay() {
        if (pid_ > 0) {
            kill(pid_, SIGTERM);
            waitpid(pid_, nullptr, 0);
        }
    }

    [[nodiscard]] const std::string& name() const { return name_; }

    /// What it shows now.
    [[nodiscard]] Pixels grab() const {
        const std::string file = read_text(screen_);
        Pixels pixels;
        if (file.size() < 100) {
            return pixels;
        }
        // XWD: big-endian words; 0 header size, 4 width, 5 height, 11 bits a pixel, 12 bytes a row,
        // 19 colors of 12 bytes each; then rows of B G R X on a little-endian machine.
        const std::size_t begin = big_endian(file, 0) + std::size_t{12} * big_endian(file, 19);
        const std::size_t row = big_endian(file, 12);
        pixels.width = static_cast<int>(big_endian(file, 4));
        pixels.height = static_cast<int>(big_endian(file, 5));
        if (big_endian(file, 11) != 32 || file.size() < begin + row * pixels.height) {
            return {};
        }
        for (int y = 0; y < pixels.height; ++y) {
            for (int x = 0; x < pixels.width; ++x) {
                const char* texel = file.data() + begin + row * y + std::size_t{4} * x;
                for (const int channel : {2, 1, 0}) {
                    pixels.bytes.push_back(static_cast<std::uint8_t>(texel[channel]));
                }
            }
        }
        return pixels;
    }

  private:
    pid_t pid_ = -1;
    std::string name_;
    std::string screen_;
};

/// How many pixels differ.
inline int count_different(const Pixels& a, const Pixels& b) {
    if (a.bytes.size() != b.bytes.size()) {
        return std::max(a.width * a.height, b.width * b.height);
    }
    int different = 0;
    for (std::size_t i = 0; i < a.bytes.size(); i += 3) {
        different += std::equal(&a.bytes[i], &a.bytes[i] + 3, &b.bytes[i]) ? 0 : 1;
    }
    return different;
}

inline bool has_program(const char* name) {
    return std::system((std::string("command -v ") + name + " >/dev/null 2>&1").c_str()) == 0;
}

inline void xdotool(const std::string& words) {
    CHECK(std::system(("xdotool " + words + " >/dev/null 2>&1").c_str()) == 0);
}

/// A display, and `limn` in a window that fills it.
struct DisplaySession {
    TemporaryFolder folder;
    VirtualDisplay display{folder};
    std::unique_ptr<Program> program;

    void start(std::vector<std::string> words) {
        setenv("DISPLAY", display.name().c_str(), 1);
        words.insert(
            words.end(),
            {"--size", std::to_string(kDisplayWidth) + "x" + std::to_string(kDisplayHeight)});
        program = std::make_unique<Program>(folder, std::move(words));
        // The first image replaces the black of an empty display.
        const Pixels empty = display.grab();
        CHECK(wait_for([&] {
            return !program->running()
                   || count_different(display.grab(), empty) > kDisplayWidth * kDisplayHeight / 2;
        }));
        CAPTURE(program->error_text());
        REQUIRE(program->running());
    }
    ~DisplaySession() { unsetenv("DISPLAY"); }

    /// Whether the display changes by more than `pixels` from `before` within some seconds.
    bool changes_from(const Pixels& before, int pixels) const {
        return wait_for([&] { return count_different(display.grab(), before) > pixels; }, 20.0);
    }
    /// Waits until six looks in a row are the same: a busy machine may take long for an image.
    [[nodiscard]] Pixels wait_until_still() const {
        Pixels last = display.grab();
        int same = 0;
        CHECK(wait_for([&] {
            sleep_ms(120);
            Pixels now = display.grab();
            same = now == last ? same + 1 : 0;
            last = std::move(now);
            return same >= 5;
        }));
        return last;
    }
};

/// Skips where there is no virtual display; CI installs one.
inline bool can_play() {
    for (const char* name : {"Xvfb", "xdotool"}) {
        if (!has_program(name)) {
            std::printf("SKIP: %s is not installed\n", name);
            return false;
        }
    }
    return true;
}

/// The first line of the program's standard output, once it is complete.
inline std::string first_line(const TemporaryFolder& folder) {
    const std::string text = read_text(folder.file("stdout.txt"));
    const std::size_t end = text.find('\n');
    return end == std::string::npos ? "" : text.substr(0, end);
}

}  // namespace limn::test
