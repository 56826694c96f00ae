#include "ecs/base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>

namespace limn {
namespace {

std::atomic<std::uint64_t> error_count{0};

spdlog::logger& logger() {
    static const std::shared_ptr<spdlog::logger> instance = [] {
        auto created = spdlog::stderr_color_mt("limn");
        created->set_pattern("%^%l%$: %v");
        return created;
    }();
    return *instance;
}

spdlog::level::level_enum spdlog_level(LogLevel level) {
    switch (level) {
    case LogLevel::Debug:
        return spdlog::level::debug;
    case LogLevel::Info:
        return spdlog::level::info;
    case LogLevel::Warn:
        return spdlog::level::warn;
    case LogLevel::Error:
        return spdlog::level::err;
    }
    return spdlog::level::info;
}

}  // namespace

void set_log_level(LogLevel level) {
    logger().set_level(spdlog_level(level));
}

void log_message(LogLevel level, std::string_view message) {
    if (level == LogLevel::Error) {
        error_count.fetch_add(1, std::memory_order_relaxed);
    }
    logger().log(spdlog_level(level), message);
}

std::uint64_t logged_error_count() {
    return error_count.load(std::memory_order_relaxed);
}

}  // namespace limn
