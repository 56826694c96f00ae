#include "content/app/commands/log_sink.h"

#include "ecs/base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

namespace limn {

namespace {

spdlog::logger& logger() {
    static const std::shared_ptr<spdlog::logger> instance = [] {
        auto created = spdlog::stderr_color_mt("limn");
        created->set_pattern("%^%l%$: %v");
        created->set_level(spdlog::level::trace);  // filtered before it gets here
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

void log_through_spdlog() {
    set_log_sink([](LogLevel level, std::string_view message) {
        logger().log(spdlog_level(level), message);
    });
}

}  // namespace limn
