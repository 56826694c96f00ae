#include "content/app/farm/farm_scheduler.h"

#include "content/app/farm/child_process.h"
#include "content/app/farm/farm_job.h"
#include "content/load/files/atomic_file.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>

extern char** environ;  // NOLINT: of POSIX

namespace limn {
namespace {

constexpr int kDefaultArray = 1001;  // MaxArraySize of a Slurm that does not say

std::string quoted(const std::string& word) {
    std::string text = "'";
    for (const char letter : word) {
        text += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    }
    return text + "'";
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

/// How workers on a host, "user@host:port", call their node (node_name).
std::string node_of_host(const std::string& host) {
    if (host == ":") {
        return node_name();
    }
    std::string name = host.substr(host.find('@') == std::string::npos ? 0 : host.find('@') + 1);
    name = name.substr(0, name.find(':'));
    std::ranges::replace_if(
        name,
        [](unsigned char letter) {
            return std::isalnum(letter) == 0 && letter != '.' && letter != '-';
        },
        '_');
    return name;
}

/// Why a node is left out.
std::string reason_of(const FarmJob& job, const FarmNode& node) {
    if (!node.refused.empty()) {
        return node.refused;
    }
    std::string last;
    for (const int frame : node.failed) {
        for (const FrameAttempt& attempt : read_frame_state(job, frame).attempts) {
            last = attempt.node == node.name && !attempt.why.empty() ? attempt.why : last;
        }
    }
    return fmt::format("{} frames failed there, the last one: {}", node.failed.size(), last);
}

/// Hosts for a group: those that are not left out, without `without` if others remain.
Result<std::vector<std::string>> hosts_of(const FarmJob& job, const FarmGroup& group) {
    std::vector<std::string> usable;
    std::vector<std::string> preferred;
    std::string reasons;
    for (const std::string& host : job.hosts.empty() ? std::vector<std::string>{":"} : job.hosts) {
        const FarmNode node = read_node(job, node_of_host(host));
        if (node.left_out()) {
            reasons += fmt::format("; {}: {}", node.name, reason_of(job, node));
            continue;
        }
        usable.push_back(host);
        if (!contains(group.without, node.name)) {
            preferred.push_back(host);
        }
    }
    if (usable.empty()) {
        return fail("{}: every node is left out{}", job.folder, reasons);
    }
    return preferred.empty() ? usable : preferred;
}

/// Variables that choose OpenGL and caches, to be the same on all hosts.
std::vector<std::string> variables_to_send() {
    std::vector<std::string> names;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view text = *variable;
        for (const std::string_view prefix :
             {"LIMN_", "LP_", "MESA_", "GALLIUM_", "LIBGL_", "EGL_"}) {
            if (text.starts_with(prefix) && !text.starts_with("LIMN_FARM_")) {
                names.emplace_back(text.substr(0, text.find('=')));
            }
        }
    }
    return names;
}

/// Environment of Slurm's commands: not that of the job in which we may be.
ChildProcess::Options slurm_options(std::vector<std::string> words) {
    ChildProcess::Options options;
    options.words = std::move(words);
    options.without = {"SLURM"};
    if (const char* const conf = std::getenv("SLURM_CONF")) {
        options.environment.emplace_back("SLURM_CONF", conf);
    }
    return options;
}

Result<std::string> run_slurm(std::vector<std::string> words) {
    const std::string name = words[0];
    ChildProcess::Options options = slurm_options(std::move(words));
    ChildProcess program = LIMN_TRY(ChildProcess::start(options));
    std::string text;
    while (!program.is_over()) {
        if (const auto line = program.read_line(std::chrono::milliseconds(1000))) {
            text += *line + "\n";
        }
    }
    if (const ProcessEnd end = program.wait(); end.status != 0) {
        return fail("{}: exit status {}", name, end.status);
    }
    return text;
}

int max_array_size() {
    const Result<std::string> config = run_slurm({"scontrol", "show", "config"});
    const std::size_t at = config ? config->find("MaxArraySize") : std::string::npos;
    if (at == std::string::npos) {
        return kDefaultArray;
    }
    const std::size_t digits = config->find_first_of("0123456789", at);
    return std::max(std::atoi(config->c_str() + std::min(digits, config->size())), 2);
}

/// Nodes of Slurm that can work now or soon.
std::vector<std::string> usable_nodes(const FarmJob& job) {
    std::vector<std::string> words = {"sinfo", "-h", "-N", "-t", "idle,alloc,mix,comp", "-o", "%N"};
    if (!job.partition.empty()) {
        words.push_back("--partition=" + job.partition);
    }
    std::vector<std::string> nodes;
    if (const Result<std::string> text = run_slurm(words)) {
        std::istringstream lines(*text);
        for (std::string name; lines >> name;) {
            nodes.push_back(name);
        }
    }
    return nodes;
}

/// Nodes that must not get the chunks of a group: those that are left out, and those that it is to
/// avoid, unless no other could take it.
Result<std::vector<std::string>> nodes_to_exclude(
    const FarmJob& job, const FarmGroup& group, const std::vector<std::string>& usable) {
    std::vector<std::string> excluded;
    for (const FarmNode& node : list_nodes(job)) {
        if (node.left_out()) {
            excluded.push_back(node.name);
        }
    }
    const auto none_left = [&usable](const std::vector<std::string>& without) {
        return !usable.empty() && std::ranges::all_of(usable, [&](const std::string& node) {
            return contains(without, node);
        });
    };
    if (none_left(excluded)) {
        return fail("{}: every node is left out", job.folder);
    }
    std::vector<std::string> avoided = excluded;
    for (const std::string& node : group.without) {
        if (!contains(avoided, node)) {
            avoided.push_back(node);
        }
    }
    return none_left(avoided) ? excluded : avoided;
}

Result<std::string> first_line(const Result<std::string>& text) {
    if (!text) {
        return text.error();
    }
    return text->substr(0, text->find_first_of(";\n"));
}

/// Of its jobs in the queue: so others are never taken for them.
std::string slurm_name(const FarmJob& job) {
    return "limn-" + job.id;
}

/// What sbatch has in common for the chunks and for what follows them.
std::vector<std::string> sbatch_words(
    const FarmJob& job, const std::string& output, const std::vector<std::string>& excluded) {
    std::vector<std::string> words = {
        "sbatch",
        "--parsable",
        "--requeue",
        "--open-mode=append",
        "--job-name=" + slurm_name(job),
        "--chdir=" + job.folder,
        "--output=log/" + output};
    if (!job.partition.empty()) {
        words.push_back("--partition=" + job.partition);
    }
    if (!excluded.empty()) {
        words.push_back(fmt::format("--exclude={}", fmt::join(excluded, ",")));
    }
    return words;
}

/// Notes that the program is not on a node; else the command. Shell text.
std::string on_node(const FarmJob& job, const std::string& command) {
    const std::string node = quoted(job.folder) + "/nodes/$SLURMD_NODENAME";
    return fmt::format(
        "if [ ! -x {0} ]; then mkdir -p {1}; echo 'found no program' {0}', expected it' > "
        "{1}/refused; exit 1; fi; {2}",
        quoted(program_path()), node, command);
}

}  // namespace

Result<std::string>
write_plan(const FarmJob& job, const std::string& name, const FarmGroup& group) {
    std::string text;
    for (const std::vector<int>& chunk : group.chunks) {
        text += fmt::format(
            "{} {}\n", group.kind == StateFile::Frame ? "render" : "verify",
            write_frame_list(chunk));
    }
    const std::string path = fmt::format("{}/plan/{}.txt", job.folder, name);
    LIMN_TRY(write_file(path, text));
    return path;
}

Result<PlannedChunk> read_plan(const std::string& path, int line) {
    std::ifstream file(path);
    std::string text;
    for (int i = 0; i < line && std::getline(file, text); ++i) {
    }
    std::istringstream words(text);
    std::string kind;
    std::string frames;
    words >> kind >> frames;
    if (!file || (kind != "render" && kind != "verify")) {
        return fail("{}:{}: found \"{}\", expected \"render FRAMES\"", path, line, text);
    }
    PlannedChunk chunk;
    chunk.kind = kind == "render" ? StateFile::Frame : StateFile::Verify;
    chunk.frames = LIMN_TRY(parse_frame_list(frames));
    return chunk;
}

Status check_scheduler(const FarmJob& job) {
    const bool slurm = job.scheduler == FarmScheduler::Slurm;
    for (const char* const program :
         slurm ? std::vector<const char*>{"sbatch", "squeue", "scontrol", "scancel"}
               : std::vector<const char*>{"parallel"}) {
        if (!has_program(program)) {
            return fail(
                "found no program {}, expected {} (Debian packages: {})", program,
                slurm ? "Slurm" : "GNU Parallel", slurm ? "slurm-client" : "parallel");
        }
    }
    return Done{};
}

void check_hosts(const FarmJob& job) {
    if (job.scheduler != FarmScheduler::Parallel) {
        return;
    }
    ChildProcess::Options options;
    options.environment = {{"LIMN_FARM_PROGRAM", program_path()}, {"LIMN_FARM_JOB", job.folder}};
    options.words = {
        "parallel",
        "--plain",
        "--nonall",
        "--tag",
        "-S",
        fmt::format("{}", fmt::join(job.hosts, ",")),
        "--env",
        "LIMN_FARM_PROGRAM",
        "--env",
        "LIMN_FARM_JOB",
        "test -x \"$LIMN_FARM_PROGRAM\" || echo no program \"$LIMN_FARM_PROGRAM\"; test -r "
        "\"$LIMN_FARM_JOB/job.json\" || echo no folder \"$LIMN_FARM_JOB\""};
    options.errors = job.folder + "/log/coordinator.txt";
    Result<ChildProcess> asked = ChildProcess::start(options);
    while (asked && !asked->is_over()) {
        const auto line = asked->read_line(std::chrono::milliseconds(500));
        if (is_cancelled(job)) {
            return;
        }
        const std::size_t tab = line ? line->find('\t') : std::string::npos;
        if (tab != std::string::npos) {
            note_refusal(
                job, node_of_host(line->substr(0, tab)),
                "found " + line->substr(tab + 1) + ", expected it");
        }
    }
}

Status run_parallel(const FarmJob& job, const std::string& name, const FarmGroup& group) {
    const std::string plan = LIMN_TRY(write_plan(job, name, group));
    const std::vector<std::string> hosts = LIMN_TRY(hosts_of(job, group));
    const bool remote = job.scheduler == FarmScheduler::Parallel;
    const int slots = std::max(job.slots, 1);
    ChildProcess::Options options;
    options.words = {"parallel",   "--plain",
                     "--arg-file", plan,
                     "-j",         std::to_string(slots),
                     "--joblog",   fmt::format("{}/log/parallel_{}.txt", job.folder, name)};
    options.errors = job.folder + "/log/coordinator.txt";
    if (remote) {
        std::string logins;
        for (const std::string& host : hosts) {
            logins += fmt::format("{}{}/{}", logins.empty() ? "" : ",", slots, host);
        }
        options.words.insert(
            options.words.end(), {"-S", logins, "--filter-hosts", "--retries",
                                  std::to_string(std::max<std::size_t>(hosts.size(), 2))});
        for (const char* const variable :
             {"LIMN_FARM_PROGRAM", "LIMN_FARM_JOB", "LIMN_FARM_PLAN"}) {
            options.words.insert(options.words.end(), {"--env", variable});
        }
        for (const std::string& variable : variables_to_send()) {
            options.words.insert(options.words.end(), {"--env", variable});
        }
    } else if (std::getenv("LP_NUM_THREADS") == nullptr) {  // software OpenGL: cores, shared
        const int cores = static_cast<int>(std::thread::hardware_concurrency());
        options.environment.emplace_back(
            "LP_NUM_THREADS", std::to_string(std::max(cores / slots, 1)));
    }
    // Not in the command: "{}" in a path would be replaced there.
    options.environment.insert(
        options.environment.end(), {{"LIMN_FARM_PROGRAM", program_path()},
                                    {"LIMN_FARM_JOB", job.folder},
                                    {"LIMN_FARM_PLAN", plan}});
    options.words.insert(
        options.words.end(), {"\"$LIMN_FARM_PROGRAM\"", "farm", "work", "\"$LIMN_FARM_JOB\"",
                              "--plan", "\"$LIMN_FARM_PLAN\"", "--line", "{#}"});
    ChildProcess parallel = LIMN_TRY(ChildProcess::start(options));
    while (!parallel.is_over()) {
        if (const auto line = parallel.read_line(std::chrono::milliseconds(500))) {
            fmt::print("{}\n", *line);
            std::fflush(stdout);
        }
        if (is_cancelled(job)) {
            break;  // workers see it, too; the rest is not started
        }
    }
    if (is_cancelled(job)) {
        parallel.kill();
    }
    parallel.wait();
    return Done{};
}

Status
submit_slurm(const FarmJob& job, const std::string& name, const std::vector<FarmGroup>& groups) {
    const int most = max_array_size() - 1;
    const std::vector<std::string> usable = usable_nodes(job);
    std::vector<std::string> ids;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const FarmGroup& group = groups[g];
        const std::string plan = LIMN_TRY(write_plan(job, fmt::format("{}_{}", name, g), group));
        const std::vector<std::string> excluded = LIMN_TRY(nodes_to_exclude(job, group, usable));
        const int count = static_cast<int>(group.chunks.size());
        for (int first = 0; first < count; first += most) {
            std::vector<std::string> words = sbatch_words(job, "slurm_%A_%a.txt", excluded);
            words.push_back(fmt::format(
                "--array=0-{}{}", std::min(count - first, most) - 1,
                job.slots > 0 ? fmt::format("%{}", job.slots) : ""));
            if (job.memory_mib > 0) {
                words.push_back(fmt::format("--mem={}", job.memory_mib + job.memory_mib / 4));
            }
            // 75 would put it into the queue again, where Slurm is set up so: rounds do that here.
            words.push_back(
                "--wrap="
                + on_node(
                    job, fmt::format(
                             "{} farm work {} --plan {} --line $((SLURM_ARRAY_TASK_ID + {})) || [ "
                             "$? = 75 ]",
                             quoted(program_path()), quoted(job.folder), quoted(plan), first + 1)));
            ids.push_back(LIMN_TRY(first_line(run_slurm(words))));
        }
    }
    std::vector<std::string> words =
        sbatch_words(job, "coordinator.txt", LIMN_TRY(nodes_to_exclude(job, {}, usable)));
    words.push_back(fmt::format("--dependency=afterany:{}", fmt::join(ids, ":")));
    words.push_back(
        "--wrap="
        + on_node(job, fmt::format("{} farm next {}", quoted(program_path()), quoted(job.folder))));
    const Result<std::string> next = first_line(run_slurm(words));
    return next ? Status(Done{}) : Status(next.error());
}

bool is_queued(const FarmJob& job) {
    if (job.scheduler != FarmScheduler::Slurm || !has_program("squeue")) {
        return false;
    }
    const Result<std::string> queue =
        run_slurm({"squeue", "-h", "-n", slurm_name(job), "-t", "PD,R,CG,CF,S,RQ", "-o", "%i"});
    // No answer: better to wait than to queue everything twice.
    return !queue || queue->find_first_of("0123456789") != std::string::npos;
}

void cancel_slurm(const FarmJob& job) {
    if (job.scheduler == FarmScheduler::Slurm && has_program("scancel")) {
        const Result<std::string> cancelled = run_slurm({"scancel", "--name=" + slurm_name(job)});
        static_cast<void>(cancelled);  // some ended before
    }
}

}  // namespace limn
