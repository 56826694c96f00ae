#pragma once

namespace limn {

// The command line of `limn`: its commands, their options and their help. Each command is
// implemented in <command>_command.cpp.

/// Parses the command line and runs the command. Returns the exit status: 0 done; 1 failed, with
/// one line on stderr; 2 wrong usage.
[[nodiscard]] int run_command_line(int argc, char** argv);

}  // namespace limn
