#include "content/app/commands/activity.h"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>
#include <utility>

namespace limn {
namespace {

constexpr std::chrono::milliseconds kFirst{1000};
constexpr std::chrono::milliseconds kRedraw{250};
constexpr const char* kClearLine = "\r\033[K";

}  // namespace

Activity::Activity(std::string what, bool shown) : what_(std::move(what)) {
    if (shown && isatty(STDERR_FILENO) == 1) {
        thread_ = std::thread([this] { draw_until_done(); });
    }
}

Activity::~Activity() {
    if (!thread_.joinable()) {
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    done_changed_.notify_one();
    thread_.join();
}

void Activity::draw_until_done() {
    std::unique_lock lock(mutex_);
    bool drawn = false;
    while (!done_changed_.wait_for(lock, drawn ? kRedraw : kFirst, [this] { return done_; })) {
        const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
        const std::string line = fmt::format("{}{}, {:.0f} s", kClearLine, what_, elapsed);
        std::fputs(line.c_str(), stderr);
        std::fflush(stderr);
        drawn = true;
    }
    if (drawn) {
        std::fputs(kClearLine, stderr);
        std::fflush(stderr);
    }
}

}  // namespace limn
