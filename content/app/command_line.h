#pragma once

namespace limn {

// The words of the program `limn`: one place that lists its commands, their options and their help.
// What a command does is in <command>_command.cpp.

/// Reads the command line and runs the command. 0 done; 1 failed, with one line on stderr; 2 wrong
/// usage.
[[nodiscard]] int run_command_line(int argc, char** argv);

}  // namespace limn
