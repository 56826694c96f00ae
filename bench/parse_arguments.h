#pragma once

#include "content/app/commands/command_values.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string_view>

namespace limn::bench {

/// Empty if the arguments are right; otherwise what to exit with: 0 after --help, 2 after one line
/// that says what is wrong. `command` is that of `limn` which starts this program.
inline std::optional<int>
parse_arguments(CLI::App& program, std::string_view command, int argc, const char* const* argv) {
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& wanted) {
        return program.exit(wanted);
    } catch (const CLI::Error& error) {
        fmt::print(stderr, "{}: {} ({} --help)\n", command, one_line(error.what()), command);
        return 2;
    }
    return std::nullopt;
}

}  // namespace limn::bench
