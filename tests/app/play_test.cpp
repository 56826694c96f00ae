#include "tests/app/run_program.h"

#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

// `limn play` as a player meets it: a window on a virtual display (Xvfb), real key presses
// (xdotool), and what the display shows, read from the memory of its screen.

namespace limn {

using test::Program;
using test::ProgramRun;
using test::TemporaryFolder;

namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 400;

/// Small enough that a processor draws it quickly. The spinning box shows whether time passes.
constexpr const char* kLevel = R"({
  "title": "A box to play with",
  "resources": {"environment": {"sky": "gradient"}},
  "materials": {"red": {"base_color": [0.8, 0.1, 0.05], "roughness": 0.4}},
  "meshes": {"box": {"make": "box", "size": [1, 1, 1]}},
  "entities": [
    {"name": "box", "mesh_instance": {"mesh": "box", "material": "red"}, "spin": {"axis": [0, 1, 0], "speed": 2}},
    {"name": "sun", "transform": {"rotation": [-40, -50, 0]}, "directional_light": {"illuminance": 3}},
    {"name": "eye", "transform": {"position": [0, 0.6, 3], "rotation": [0, -10, 0]}, "camera": {}}
  ]
})";

void sleep_ms(int ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

/// Asks until the answer is yes; false after `seconds`.
bool wait_for(const std::function<bool()>& condition, double seconds = 60.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) {
            return true;
        }
        sleep_ms(50);
    }
    return false;
}

/// RGB, rows from top to bottom.
struct Pixels {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> bytes;

    bool operator==(const Pixels&) const = default;
};

std::uint32_t big_endian(const std::string& text, std::size_t word) {
    std::uint32_t value = 0;
    for (std::size_t i = 4 * word; i < 4 * word + 4 && i < text.size(); ++i) {
        value = (value << 8) | static_cast<std::uint8_t>(text[i]);
    }
    return value;
}

/// A display without a screen, whose picture is a file in the XWD format.
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
            const std::string size = std::to_string(kWidth) + "x" + std::to_string(kHeight) + "x24";
            const std::string path = folder.path();
            execlp(
                "Xvfb",
                "Xvfb",
                "-displayfd",
                "9",
                "-screen",
                "0",
                size.c_str(),
                "-fbdir",
                path.c_str(),
                "-nocursor",  // the screen's memory would hold the pointer
                "-nolisten",
                "tcp",
                nullptr);
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
        const std::string file = test::read_text(screen_);
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
int count_different(const Pixels& a, const Pixels& b) {
    if (a.bytes.size() != b.bytes.size()) {
        return std::max(a.width * a.height, b.width * b.height);
    }
    int different = 0;
    for (std::size_t i = 0; i < a.bytes.size(); i += 3) {
        different += std::equal(&a.bytes[i], &a.bytes[i] + 3, &b.bytes[i]) ? 0 : 1;
    }
    return different;
}

bool has_program(const char* name) {
    return std::system((std::string("command -v ") + name + " >/dev/null 2>&1").c_str()) == 0;
}

void xdotool(const std::string& words) {
    CHECK(std::system(("xdotool " + words + " >/dev/null 2>&1").c_str()) == 0);
}

Pixels read_png(const std::string& path) {
    Pixels pixels;
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
    if (input == nullptr || input->spec().nchannels != 3) {
        return pixels;
    }
    pixels.width = input->spec().width;
    pixels.height = input->spec().height;
    pixels.bytes.resize(static_cast<std::size_t>(pixels.width) * pixels.height * 3);
    if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.bytes.data())) {
        return {};
    }
    return pixels;
}

/// A display, the level, and `limn play` in a window that fills the display.
struct PlaySession {
    TemporaryFolder folder;
    VirtualDisplay display{folder};
    std::unique_ptr<Program> program;

    void start() {
        test::write_text(folder.file("toy.level.json"), kLevel);
        setenv("DISPLAY", display.name().c_str(), 1);
        program = std::make_unique<Program>(
            folder,
            std::vector<std::string>{
                "play",
                "toy.level.json",
                "--size",
                std::to_string(kWidth) + "x" + std::to_string(kHeight)});
        // The first picture replaces the black of an empty display.
        const Pixels empty = display.grab();
        CHECK(wait_for([&] {
            return !program->running()
                   || count_different(display.grab(), empty) > kWidth * kHeight / 2;
        }));
        CAPTURE(program->error_text());
        REQUIRE(program->running());
    }
    ~PlaySession() { unsetenv("DISPLAY"); }

    /// Whether the display changes by more than `pixels` from `before` within some seconds.
    bool changes_from(const Pixels& before, int pixels) const {
        return wait_for([&] { return count_different(display.grab(), before) > pixels; }, 20.0);
    }
    /// Waits until six looks in a row are the same: a busy machine may take long for a picture.
    [[nodiscard]] Pixels wait_until_still() const {
        Pixels last = display.grab();
        int same = 0;
        CHECK(wait_for([&] {
            sleep_ms(250);
            Pixels now = display.grab();
            same = now == last ? same + 1 : 0;
            last = std::move(now);
            return same >= 5;
        }));
        return last;
    }
};

/// Skips where there is no virtual display; CI installs one.
bool can_play() {
    for (const char* name : {"Xvfb", "xdotool"}) {
        if (!has_program(name)) {
            std::printf("SKIP: %s is not installed\n", name);
            return false;
        }
    }
    return true;
}

/// The first line of the program's standard output, once it is complete.
std::string first_line(const TemporaryFolder& folder) {
    const std::string text = test::read_text(folder.file("stdout.txt"));
    const std::size_t end = text.find('\n');
    return end == std::string::npos ? "" : text.substr(0, end);
}

}  // namespace

TEST_CASE("play: keys move the camera and open the inspector, and F9 saves what is shown") {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    session.start();

    // Time passes until Space stops it. F8 hides the status, whose numbers never rest.
    xdotool("key F8");
    const Pixels first = session.display.grab();
    CHECK(session.changes_from(first, 500));
    xdotool("key space");
    const Pixels paused = session.wait_until_still();

    // W flies nearer: the box grows.
    xdotool("keydown w sleep 0.5 keyup w");
    CHECK(session.changes_from(paused, 2000));
    const Pixels moved = session.wait_until_still();

    // The inspector covers the right side.
    xdotool("key F2");
    CHECK(session.changes_from(moved, 20000));
    const Pixels inspected = session.wait_until_still();

    xdotool("key F9");
    REQUIRE(wait_for([&] { return !first_line(session.folder).empty(); }));
    const Pixels saved = read_png(session.folder.file(first_line(session.folder)));
    CHECK(saved.width == kWidth);
    CHECK(saved.height == kHeight);
    CHECK(count_different(saved, inspected) == 0);

    xdotool("key Escape");
    CHECK(wait_for([&] { return !session.program->running(); }));
    CHECK(session.program->wait().exit_code == 0);
}

TEST_CASE("play: a drag looks around, and the level comes back with R") {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    session.start();
    xdotool("key F8 key space");
    const Pixels start = session.wait_until_still();
    xdotool("mousemove 320 200 mousedown 1 sleep 0.5 mousemove_relative 60 0 sleep 0.3 "
            "mousemove_relative "
            "60 0 sleep 0.3 mouseup 1");
    CHECK(session.changes_from(start, 5000));
    xdotool("key F3");  // the profiler opens without harm
    sleep_ms(500);
    xdotool("key F3 key r key Escape");
    CHECK(wait_for([&] { return !session.program->running(); }));
    const ProgramRun run = session.program->wait();
    CHECK(run.exit_code == 0);
    CHECK(run.err.find("error") == std::string::npos);
}

TEST_CASE("play: without a display it renders the camera's way and says where the pictures are") {
    const TemporaryFolder folder;
    test::write_text(folder.file("toy.level.json"), kLevel);
    const char* display = std::getenv("DISPLAY");
    const std::string saved = display != nullptr ? display : "";
    unsetenv("DISPLAY");
    const ProgramRun run =
        test::run_limn(folder, {"play", "toy.level.json", "--size", "96x54", "-o", "pictures"});
    if (!saved.empty()) {
        setenv("DISPLAY", saved.c_str(), 1);
    }
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("no display") != std::string::npos);
    CHECK(run.out.find("pictures") != std::string::npos);
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.file("pictures"))) {
        CHECK(read_png(entry.path().string()).width >= 0);
        ++count;
    }
    CHECK(count == 8);
}

}  // namespace limn
