#pragma once

#include "ecs/base/text.h"

#include <cstdint>
#include <string_view>

namespace limn {

// Messages for people. Errors that a caller can handle are Results; the log is for the rest.
// Messages go to stderr unless the application sets another sink.

enum class LogLevel : std::uint8_t { Debug, Info, Warn, Error };

/// Takes one message, without a line end. Must be thread-safe.
using LogSink = void (*)(LogLevel level, std::string_view message);

/// Redirects messages to `sink`; nullptr restores the default, stderr as "error: message".
void set_log_sink(LogSink sink);

/// Drops messages below `level`; the default is Info.
void set_log_level(LogLevel level);

void log_message(LogLevel level, std::string_view message);

/// How many messages of level Error were logged since program start; tests assert on it.
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
