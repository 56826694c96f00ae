#pragma once

#include "tests/support.h"

#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <signal.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace limn::test {

/// What a run of the program `limn` left behind.
struct ProgramRun {
    int exit_code = -1;  ///< 128 + signal if one ended it
    std::string out;
    std::string err;
};

inline std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_text(const std::string& path, std::string_view text) {
    std::ofstream(path, std::ios::binary) << text;
}

inline long count_lines(std::string_view text) {
    return std::count(text.begin(), text.end(), '\n');
}

/// A started `limn`; both its streams go to files in `folder`, which is its working directory.
class Program {
  public:
    Program(
        const TemporaryFolder& folder, std::vector<std::string> arguments,
        const std::string& program = LIMN_PROGRAM)
        : out_(folder.file("stdout.txt")), err_(folder.file("stderr.txt")) {
        arguments.insert(arguments.begin(), program);
        std::vector<char*> words;
        for (std::string& argument : arguments) {
            words.push_back(argument.data());
        }
        words.push_back(nullptr);
        pid_ = fork();
        if (pid_ == 0) {
            const int mode = O_WRONLY | O_CREAT | O_TRUNC;
            dup2(open(out_.c_str(), mode, 0600), STDOUT_FILENO);
            dup2(open(err_.c_str(), mode, 0600), STDERR_FILENO);
            if (chdir(folder.path().c_str()) == 0) {
                execv(words[0], words.data());
            }
            _exit(127);
        }
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program() {
        if (pid_ > 0) {
            kill(SIGKILL);
            wait();
        }
    }

    void kill(int signal) const { ::kill(pid_, signal); }
    [[nodiscard]] pid_t pid() const { return pid_; }

    /// Whether it still runs.
    [[nodiscard]] bool running() {
        if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) == pid_) {
            pid_ = -1;
        }
        return pid_ > 0;
    }

    ProgramRun wait() {
        if (pid_ > 0) {
            waitpid(pid_, &status_, 0);
            pid_ = -1;
        }
        ProgramRun run;
        run.exit_code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
        run.out = read_text(out_);
        run.err = read_text(err_);
        return run;
    }

    [[nodiscard]] std::string error_text() const { return read_text(err_); }

  private:
    pid_t pid_ = -1;
    int status_ = 0;
    std::string out_;
    std::string err_;
};

/// Runs `limn` to its end.
inline ProgramRun run_limn(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    return Program(folder, std::move(arguments)).wait();
}

}  // namespace limn::test
