#pragma once

namespace limn {

/// Messages of the log go to stderr through spdlog from now on, colored where it is a terminal.
void log_through_spdlog();

}  // namespace limn
