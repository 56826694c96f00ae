#include "content/app/commands/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <unistd.h>
#include <utility>

namespace limn {
namespace {

constexpr int kBarWidth = 24;  // characters
constexpr std::chrono::milliseconds kProgressRedraw{100};
constexpr const char* kClearProgressLine = "\r\033[K";

}  // namespace

Progress::Progress(std::string what, int total, bool shown)
    : what_(std::move(what)), total_(std::max(total, 1)),
      on_terminal_(shown && isatty(STDERR_FILENO) == 1), begin_(Clock::now()),
      last_draw_(begin_ - kProgressRedraw) {}

Progress::~Progress() {
    if (drawn_) {
        std::fputs(kClearProgressLine, stderr);
        std::fflush(stderr);
    }
}

void Progress::update(int done) {
    const Clock::time_point now = Clock::now();
    if (!on_terminal_ || now - last_draw_ < kProgressRedraw) {
        return;
    }
    last_draw_ = now;
    drawn_ = true;
    const double done_fraction = std::clamp(static_cast<double>(done) / total_, 0.0, 1.0);
    const int filled = static_cast<int>(done_fraction * kBarWidth);
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    std::string left;
    if (done > 0 && elapsed > 1.0) {
        left = fmt::format(" {:.0f} s left", elapsed / done_fraction * (1.0 - done_fraction));
    }
    const std::string line = fmt::format(
        "{}{} {} of {} [{:#>{}}{:->{}}]{}", kClearProgressLine, what_, done, total_, "", filled, "",
        kBarWidth - filled, left);
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace limn
