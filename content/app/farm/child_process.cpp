#include "content/app/farm/child_process.h"

#include "ecs/base/text.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;  // NOLINT: of POSIX

namespace limn {
namespace {

std::vector<std::string> make_environment(const ChildProcess::Options& options) {
    std::vector<std::string> variables;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string text = *variable;
        const bool dropped =
            std::ranges::any_of(
                options.without,
                [&](const std::string& prefix) { return text.starts_with(prefix); })
            || std::ranges::any_of(options.environment, [&](const auto& set) {
                   return text.starts_with(set.first + "=");
               });
        if (!dropped) {
            variables.push_back(text);
        }
    }
    for (const auto& [name, value] : options.environment) {
        variables.push_back(name + "=" + value);
    }
    return variables;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> result;
    for (std::string& word : words) {
        result.push_back(word.data());
    }
    result.push_back(nullptr);
    return result;
}

/// The rest of fork(): nothing that allocates. Reports errno through `report`.
[[noreturn]] void
become(const char* folder, int output, int errors, char** words, char** variables, int report) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int input = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    ::dup2(input, STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    if (errors >= 0) {
        ::dup2(errors, STDERR_FILENO);
    }
    if (folder[0] == '\0' || ::chdir(folder) == 0) {
        ::execvpe(words[0], words, variables);
    }
    const int why = errno;
    const ssize_t told = ::write(report, &why, sizeof(why));
    ::_exit(told == sizeof(why) ? 127 : 126);
}

int read_status_mib(int process, const char* name) {
    std::ifstream file("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with(name)) {
            return static_cast<int>(
                std::strtol(line.c_str() + std::strlen(name), nullptr, 10) / 1024);
        }
    }
    return 0;
}

}  // namespace

Result<ChildProcess> ChildProcess::start(const Options& options) {
    std::vector<std::string> words = options.words;
    std::vector<std::string> variables = make_environment(options);
    const std::vector<char*> word_pointers = pointers(words);
    const std::vector<char*> variable_pointers = pointers(variables);
    const int errors =
        options.errors.empty()
            ? -1
            : ::open(options.errors.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (errors < 0 && !options.errors.empty()) {
        return fail("{}: {}", options.errors, std::strerror(errno));
    }
    std::array<int, 2> output{};
    std::array<int, 2> report{};
    if (::pipe2(output.data(), O_CLOEXEC) != 0 || ::pipe2(report.data(), O_CLOEXEC) != 0) {
        return fail("{}: {}", words[0], std::strerror(errno));
    }
    const pid_t process = ::fork();
    if (process == 0) {
        become(
            options.folder.c_str(), output[1], errors, const_cast<char**>(word_pointers.data()),
            const_cast<char**>(variable_pointers.data()), report[1]);
    }
    int why = process < 0 ? errno : 0;
    ::close(output[1]);
    ::close(report[1]);
    if (errors >= 0) {
        ::close(errors);
    }
    const bool failed = process < 0 || ::read(report[0], &why, sizeof(why)) == sizeof(why);
    ::close(report[0]);
    ChildProcess child;
    child.process_ = process;
    child.pipe_ = output[0];
    if (failed) {
        return fail(
            "{}: {}", words[0], why == ENOENT ? "found no such program" : std::strerror(why));
    }
    return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)), pipe_(std::exchange(other.pipe_, -1)),
      over_(other.over_), text_(std::move(other.text_)) {}

ChildProcess::~ChildProcess() {
    if (process_ > 0) {
        kill();
        wait();
    }
    if (pipe_ >= 0) {
        ::close(pipe_);
    }
}

std::optional<std::string> ChildProcess::read_line(std::chrono::milliseconds longest) {
    const auto end = std::chrono::steady_clock::now() + longest;
    for (;;) {
        if (const std::size_t length = text_.find('\n'); length != std::string::npos) {
            std::string line = text_.substr(0, length);
            text_.erase(0, length + 1);
            return line;
        }
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
            end - std::chrono::steady_clock::now());
        if (over_ || left.count() < 0) {
            return std::nullopt;
        }
        pollfd ready = {.fd = pipe_, .events = POLLIN, .revents = 0};
        if (::poll(&ready, 1, static_cast<int>(left.count())) <= 0) {
            return std::nullopt;
        }
        std::array<char, 4096> bytes{};
        const ssize_t got = ::read(pipe_, bytes.data(), bytes.size());
        if (got > 0) {
            text_.append(bytes.data(), static_cast<std::size_t>(got));
        } else if (got == 0 || errno != EINTR) {
            over_ = true;
        }
    }
}

int ChildProcess::memory_mib() const {
    return process_ > 0 ? read_status_mib(process_, "VmRSS:") : 0;
}

void ChildProcess::kill() {
    if (process_ > 0) {
        ::kill(-process_, SIGKILL);
        ::kill(process_, SIGKILL);
    }
}

ProcessEnd ChildProcess::wait() {
    int status = 0;
    rusage usage{};
    while (process_ > 0 && ::wait4(process_, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    process_ = -1;
    ProcessEnd end;
    end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    end.status = end.signal != 0 ? 128 + end.signal : WEXITSTATUS(status);
    end.peak_mib = static_cast<int>(usage.ru_maxrss / 1024);
    return end;
}

Result<std::string> run_program(const std::vector<std::string>& words) {
    ChildProcess program = LIMN_TRY(ChildProcess::start(
        {.words = words, .errors = {}, .folder = {}, .environment = {}, .without = {}}));
    std::string text;
    std::string last;
    while (!program.is_over()) {
        if (const auto line = program.read_line(std::chrono::milliseconds(1000))) {
            text += *line + "\n";
            last = line->empty() ? last : *line;
        }
    }
    const ProcessEnd end = program.wait();
    if (end.status != 0) {
        return fail(
            "{}: {}", words[0], last.empty() ? "exit status " + std::to_string(end.status) : last);
    }
    return text;
}

bool has_program(const std::string& name) {
    const char* const path = std::getenv("PATH");
    std::string folders = path != nullptr ? path : "/usr/bin:/bin";
    for (std::size_t begin = 0; begin <= folders.size();) {
        const std::size_t end = std::min(folders.find(':', begin), folders.size());
        const std::string file = folders.substr(begin, end - begin) + "/" + name;
        if (::access(file.c_str(), X_OK) == 0) {
            return true;
        }
        begin = end + 1;
    }
    return false;
}

}  // namespace limn
