#pragma once

#include "ecs/base/result.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace limn {

// Messages for people, on stderr, through spdlog. Errors that somebody can handle are Results; the
// log is for what has no caller left to ask.

enum class LogLevel : std::uint8_t { Debug, Info, Warn, Error };

/// Messages below `level` are dropped; Info at start.
void set_log_level(LogLevel level);

void log_message(LogLevel level, std::string_view message);

/// How many messages of level Error were logged since the program began: tests assert on it.
[[nodiscard]] std::uint64_t logged_error_count();

template <typename... Args>
void log_debug(fmt::format_string<Args...> format, Args&&... args) {
    log_message(LogLevel::Debug, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
    log_message(LogLevel::Info, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void log_warn(fmt::format_string<Args...> format, Args&&... args) {
    log_message(LogLevel::Warn, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void log_error(fmt::format_string<Args...> format, Args&&... args) {
    log_message(LogLevel::Error, fmt::format(format, std::forward<Args>(args)...));
}

/// The error with a formatted message: `return fail("{}: no such file", path);`
template <typename... Args>
[[nodiscard]] Error fail(fmt::format_string<Args...> format, Args&&... args) {
    return Error{fmt::format(format, std::forward<Args>(args)...)};
}

}  // namespace limn
