#pragma once

#include "ecs/base/result.h"

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace limn {

/// How a process ended.
struct ProcessEnd {
    int status = 0;    ///< exit status; 128 + signal where a signal ended it
    int signal = 0;    ///< that ended it, or 0
    int peak_mib = 0;  ///< most memory that it held
};

/// Another program whose standard output is read line by line. It leads a process group of its own,
/// so that what it starts ends with it, and does not outlive the one that started it.
class ChildProcess {
  public:
    struct Options {
        std::vector<std::string> words;  ///< program, looked for in PATH, and arguments
        std::string errors;              ///< file to which it appends what it prints on stderr
        std::string folder;              ///< to start in; empty: this one
        std::vector<std::pair<std::string, std::string>> environment;  ///< variables to set
        std::vector<std::string> without;  ///< prefixes of variables that it does not inherit
    };
    /// Fails with "program: why".
    [[nodiscard]] static Result<ChildProcess> start(const Options& options);
    ChildProcess(ChildProcess&& other) noexcept;
    ChildProcess& operator=(ChildProcess&& other) = delete;
    ChildProcess(const ChildProcess&) = delete;
    /// Kills it if it still runs.
    ~ChildProcess();

    /// The next line of its output, waiting at most that long; none: nothing yet, or the output has
    /// ended (is_over).
    [[nodiscard]] std::optional<std::string> read_line(std::chrono::milliseconds longest);
    /// Whether the output has ended and all lines of it were read.
    [[nodiscard]] bool is_over() const { return over_ && text_.find('\n') == std::string::npos; }
    /// Memory that it holds now, and its peak [MiB]; 0 once it has ended.
    [[nodiscard]] int memory_mib() const;

    /// Ends it and what it started, at once.
    void kill();
    /// Waits for its end.
    ProcessEnd wait();

  private:
    ChildProcess() = default;
    int process_ = -1;
    int pipe_ = -1;
    bool over_ = false;
    std::string text_;  ///< read, and not yet returned
};

/// Runs a program to its end and returns what it printed; stderr goes where ours does. Fails with
/// "program: why" where it cannot start, or the last line of its output where it fails.
[[nodiscard]] Result<std::string> run_program(const std::vector<std::string>& words);

/// Whether PATH has a program of that name.
[[nodiscard]] bool has_program(const std::string& name);

}  // namespace limn
