#include "ecs/base/log.h"

#include <atomic>
#include <cstdio>

namespace limn {
namespace {

void write_to_stderr(LogLevel level, std::string_view message) {
    static constexpr const char* kNames[] = {"debug", "info", "warning", "error"};
    std::fprintf(
        stderr, "%s: %.*s\n", kNames[static_cast<std::size_t>(level)],
        static_cast<int>(message.size()), message.data());
}

std::atomic<LogSink> current_sink{write_to_stderr};
std::atomic<LogLevel> min_level{LogLevel::Info};
std::atomic<std::uint64_t> error_count{0};

}  // namespace

void set_log_sink(LogSink sink) {
    current_sink.store(sink != nullptr ? sink : write_to_stderr);
}

void set_log_level(LogLevel level) {
    min_level.store(level);
}

void log_message(LogLevel level, std::string_view message) {
    if (level == LogLevel::Error) {
        error_count.fetch_add(1, std::memory_order_relaxed);
    }
    if (level >= min_level.load()) {
        current_sink.load()(level, message);
    }
}

std::uint64_t logged_error_count() {
    return error_count.load(std::memory_order_relaxed);
}

}  // namespace limn
