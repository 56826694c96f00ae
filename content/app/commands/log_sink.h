#pragma once

namespace limn {

/// Routes log messages to stderr through spdlog, colored on a terminal.
void log_through_spdlog();

}  // namespace limn
