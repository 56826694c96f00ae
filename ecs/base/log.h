#pragma once

#include "ecs/base/text.h"

#include <cstdint>
#include <string_view>

namespace limn {

// Messages for people. Errors that somebody can handle are Results; the log is for what has no
// caller left to ask. They go to stderr, or to where the application says.

enum class LogLevel : std::uint8_t { Debug, Info, Warn, Error };

/// Takes one message, without a line end. Called from any thread, also from several at once.
using LogSink = void (*)(LogLevel level, std::string_view message);

/// Where messages go from now on; nullptr: to stderr, as "error: message", as at start.
void set_log_sink(LogSink sink);

/// Messages below `level` are dropped; Info at start.
void set_log_level(LogLevel level);

void log_message(LogLevel level, std::string_view message);

/// How many messages of level Error were logged since the program began: tests assert on it.
[[nodiscard]] std::uint64_t logged_error_count();

template <typename... Args>
void log_debug(TextPattern<std::type_identity_t<Args>...> pattern, const Args&... args) {
    log_message(LogLevel::Debug, format_text<Args...>(pattern, args...));
}
template <typename... Args>
void log_info(TextPattern<std::type_identity_t<Args>...> pattern, const Args&... args) {
    log_message(LogLevel::Info, format_text<Args...>(pattern, args...));
}
template <typename... Args>
void log_warn(TextPattern<std::type_identity_t<Args>...> pattern, const Args&... args) {
    log_message(LogLevel::Warn, format_text<Args...>(pattern, args...));
}
template <typename... Args>
void log_error(TextPattern<std::type_identity_t<Args>...> pattern, const Args&... args) {
    log_message(LogLevel::Error, format_text<Args...>(pattern, args...));
}

}  // namespace limn
