#include "content/app/farm/farm_job.h"

#include "content/app/commands/image_file.h"
#include "content/app/farm/farm_json.h"
#include "content/load/files/atomic_file.h"
#include "ecs/base/hash.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace limn {

namespace {

constexpr std::array<const char*, 3> kSchedulers = {"local", "parallel", "slurm"};
constexpr std::array<const char*, 2> kOrders = {"plain", "preview"};
constexpr std::uint64_t kMaxJobFile = std::uint64_t{1} << 28;  // bytes

std::string hex(std::uint64_t hash) {
    return fmt::format("{:016x}", hash);
}

/// The value of an object's member, checked.
template <typename T>
Status take(const FarmJson& object, const char* name, T& value) {
    const auto member = object.find(name);
    if (member == object.end()) {
        return fail("found no \"{}\", expected it", name);
    }
    try {
        value = member->get<T>();
    } catch (const FarmJson::exception&) {
        return fail("\"{}\": found {}, expected another type", name, member->type_name());
    }
    return Done{};
}

Status take_hash(const FarmJson& object, const char* name, std::uint64_t& value) {
    std::string text;
    LIMN_TRY(take(object, name, text));
    char* end = nullptr;
    value = std::strtoull(text.c_str(), &end, 16);
    if (text.size() != 16 || *end != '\0') {
        return fail("\"{}\": found \"{}\", expected 16 hexadecimal digits", name, text);
    }
    return Done{};
}

template <typename Enum, std::size_t N>
Status take_name(
    const FarmJson& object, const char* name, const std::array<const char*, N>& names,
    Enum& value) {
    std::string text;
    LIMN_TRY(take(object, name, text));
    const auto found =
        std::ranges::find(names, text, [](const char* each) { return std::string_view(each); });
    if (found == names.end()) {
        return fail(
            "\"{}\": found \"{}\", expected one of {}", name, text,
            fmt::format("{}", fmt::join(names, " ")));
    }
    value = static_cast<Enum>(found - names.begin());
    return Done{};
}

FarmJson to_json(const FarmJob& job) {
    FarmJson inputs = FarmJson::array();
    for (const FarmInput& input : job.inputs) {
        inputs.push_back({{"path", input.path}, {"hash", hex(input.hash)}, {"bytes", input.bytes}});
    }
    return {
        {"limn_farm", 1},
        {"id", job.id},
        {"version", job.version},
        {"program", job.program},
        {"program_hash", hex(job.program_hash)},
        {"command", job.command},
        {"scene", job.scene},
        {"render", job.render},
        {"tasks", job.tasks},
        {"name", job.name},
        {"size", {job.size.x, job.size.y}},
        {"fps", job.fps},
        {"frames", write_frame_list(job.frames)},
        {"film", job.film},
        {"film_quality", job.film_settings.quality},
        {"film_sound", job.film_settings.sound},
        {"scene_sound", job.scene_sound},
        {"whole_sound", job.whole_sound},
        {"scheduler", kSchedulers[static_cast<std::size_t>(job.scheduler)]},
        {"hosts", job.hosts},
        {"partition", job.partition},
        {"slots", job.slots},
        {"chunk", job.chunk},
        {"order", kOrders[static_cast<std::size_t>(job.order)]},
        {"retries", job.retries},
        {"timeout", job.timeout},
        {"memory_mib", job.memory_mib},
        {"verify", job.verify},
        {"inputs", inputs}};
}

/// Below inputs/, and nowhere else.
bool is_inside(const std::string& path) {
    const std::filesystem::path normal = std::filesystem::path(path).lexically_normal();
    return !normal.empty() && normal.is_relative() && *normal.begin() != "..";
}

Status take_inputs(const FarmJson& object, std::vector<FarmInput>& inputs) {
    FarmJson list;
    LIMN_TRY(take(object, "inputs", list));
    for (const FarmJson& each : list) {
        FarmInput input;
        LIMN_TRY(take(each, "path", input.path));
        LIMN_TRY(take_hash(each, "hash", input.hash));
        LIMN_TRY(take(each, "bytes", input.bytes));
        if (!is_inside(input.path)) {
            return fail("inputs: found path \"{}\", expected one below inputs/", input.path);
        }
        inputs.push_back(std::move(input));
    }
    return Done{};
}

/// Values with which nothing that follows can hang or overflow.
Status check_ranges(const FarmJob& job) {
    const bool sane = job.chunk >= 1 && job.retries >= 1 && job.timeout > 0 && job.slots >= 0
                      && job.memory_mib >= 0 && job.fps > 0 && job.verify >= 0 && job.verify <= 1;
    if (!sane) {
        return fail(
            "found chunk {}, retries {}, timeout {}, slots {}, memory_mib {}, fps {}, verify {}, "
            "expected chunk, retries, timeout and fps above 0 and none below it",
            job.chunk, job.retries, job.timeout, job.slots, job.memory_mib, job.fps, job.verify);
    }
    if (job.name.find('/') != std::string::npos || !has_frame_number(job.name).ok()
        || !*has_frame_number(job.name)) {
        return fail("name: found \"{}\", expected a file name with %05d", job.name);
    }
    if (job.id.empty() || job.id.find_first_not_of("0123456789abcdef") != std::string::npos) {
        return fail("id: found \"{}\", expected hexadecimal digits", job.id);
    }
    if (!job.tasks.empty() && job.frames.back() >= static_cast<int>(job.tasks.size())) {
        return fail(
            "frames: found {}, expected less than {} tasks", job.frames.back(), job.tasks.size());
    }
    return Done{};
}

Status from_json(const FarmJson& object, FarmJob& job) {
    int format = 0;
    LIMN_TRY(take(object, "limn_farm", format));
    if (format != 1) {
        return fail("limn_farm: found {}, expected 1", format);
    }
    std::string frames;
    std::array<int, 2> size{};
    LIMN_TRY(take(object, "id", job.id));
    LIMN_TRY(take(object, "version", job.version));
    LIMN_TRY(take(object, "program", job.program));
    LIMN_TRY(take_hash(object, "program_hash", job.program_hash));
    LIMN_TRY(take(object, "command", job.command));
    LIMN_TRY(take(object, "scene", job.scene));
    LIMN_TRY(take(object, "render", job.render));
    LIMN_TRY(take(object, "tasks", job.tasks));
    LIMN_TRY(take(object, "name", job.name));
    LIMN_TRY(take(object, "size", size));
    LIMN_TRY(take(object, "fps", job.fps));
    LIMN_TRY(take(object, "frames", frames));
    LIMN_TRY(take(object, "film", job.film));
    LIMN_TRY(take(object, "film_quality", job.film_settings.quality));
    LIMN_TRY(take(object, "film_sound", job.film_settings.sound));
    LIMN_TRY(take(object, "scene_sound", job.scene_sound));
    LIMN_TRY(take(object, "whole_sound", job.whole_sound));
    LIMN_TRY(take_name(object, "scheduler", kSchedulers, job.scheduler));
    LIMN_TRY(take(object, "hosts", job.hosts));
    LIMN_TRY(take(object, "partition", job.partition));
    LIMN_TRY(take(object, "slots", job.slots));
    LIMN_TRY(take(object, "chunk", job.chunk));
    LIMN_TRY(take_name(object, "order", kOrders, job.order));
    LIMN_TRY(take(object, "retries", job.retries));
    LIMN_TRY(take(object, "timeout", job.timeout));
    LIMN_TRY(take(object, "memory_mib", job.memory_mib));
    LIMN_TRY(take(object, "verify", job.verify));
    LIMN_TRY(take_inputs(object, job.inputs));
    job.size = {size[0], size[1]};
    job.film_settings.fps = job.fps;
    job.frames = LIMN_TRY(parse_frame_list(frames));
    return check_ranges(job);
}

}  // namespace

Result<FarmJob> load_farm_job(const std::string& folder) {
    const std::string path = folder + "/job.json";
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return fail("{}: found no job.json, expected the folder of a job", folder);
    }
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path, kMaxJobFile));
    const auto* const text = reinterpret_cast<const char*>(bytes.data());
    const FarmJson object = FarmJson::parse(text, text + bytes.size(), nullptr, false);
    if (!object.is_object()) {
        return fail("{}: found no JSON object, expected one", path);
    }
    FarmJob job;
    job.folder = folder;
    if (const Status read = from_json(object, job); !read) {
        return fail("{}: {}", path, read.error().message);
    }
    return job;
}

Status save_farm_job(const FarmJob& job) {
    for (const char* const name :
         {"inputs", "frames", "state", "nodes", "workers", "plan", "log"}) {
        std::error_code error;
        std::filesystem::create_directories(job.folder + "/" + name, error);
        if (error) {
            return fail("{}/{}: {}", job.folder, name, error.message());
        }
    }
    return write_file(job.folder + "/job.json", farm_json_text(to_json(job), 1));
}

Status check_space(const FarmJob& job) {
    const std::string path = fmt::format("{}/frames/.space.{}", job.folder, ::getpid());
    const auto pixels = static_cast<std::size_t>(job.size.x) * static_cast<std::size_t>(job.size.y);
    const std::vector<std::byte> bytes(4 * pixels + 4096, std::byte{1});
    const Status written = write_file(path, bytes);
    ::unlink(path.c_str());
    return written;
}

std::string frame_path(const FarmJob& job, int frame) {
    return job.folder + "/frames/" + numbered_path(job.name, frame);
}

std::string program_path() {
    std::error_code ignored;
    return std::filesystem::read_symlink("/proc/self/exe", ignored).string();
}

Result<std::uint64_t> hash_program() {
    return hash_bytes(LIMN_TRY(read_file("/proc/self/exe")));
}

std::string node_name() {
    std::string name;
    for (const char* const variable : {"LIMN_FARM_NODE", "SLURMD_NODENAME", "PARALLEL_SSHHOST"}) {
        const char* const value = std::getenv(variable);
        if (name.empty() && value != nullptr && std::string_view(value) != ":") {
            name = value;
        }
    }
    if (name.empty()) {
        std::array<char, 256> host{};
        ::gethostname(host.data(), host.size() - 1);
        name = host.data();
    }
    for (char& letter : name) {
        if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '.'
            && letter != '-') {
            letter = '_';
        }
    }
    return name.empty() || name[0] == '.' ? "node" : name;
}

std::string find_difference(const FarmJob& job) {
    const Result<std::uint64_t> program = hash_program();
    if (!program) {
        return program.error().message;
    }
    if (*program != job.program_hash) {
        return fmt::format(
            "found program {} ({}, {}), expected {} ({})", hex(*program), LIMN_VERSION,
            program_path(), hex(job.program_hash), job.version);
    }
    for (const FarmInput& input : job.inputs) {
        const std::string path = job.folder + "/inputs/" + input.path;
        const auto bytes = read_file(path);
        if (!bytes) {
            return bytes.error().message;
        }
        if (hash_bytes(*bytes) != input.hash) {
            return fmt::format(
                "{}: found {} ({} bytes), expected {} ({} bytes)", path, hex(hash_bytes(*bytes)),
                bytes->size(), hex(input.hash), input.bytes);
        }
    }
    return {};
}

Status freeze_inputs(FarmJob& job, const std::string& root, const std::vector<std::string>& files) {
    const std::set<std::string> once(files.begin(), files.end());
    for (const std::string& file : once) {
        const std::string path = std::filesystem::path(file).lexically_relative(root).string();
        const std::vector<std::byte> bytes = LIMN_TRY(read_file(file));
        const std::filesystem::path copy = std::filesystem::path(job.folder) / "inputs" / path;
        std::error_code error;
        std::filesystem::create_directories(copy.parent_path(), error);
        if (error) {
            return fail("{}: {}", copy.parent_path().string(), error.message());
        }
        LIMN_TRY(write_file(copy.string(), bytes));
        job.inputs.push_back({path, hash_bytes(bytes), bytes.size()});
    }
    return Done{};
}

Result<std::string>
freeze_other_file(FarmJob& job, const std::string& folder, const std::string& file) {
    const std::filesystem::path whole = std::filesystem::absolute(file).lexically_normal();
    const std::string name = folder + "/" + whole.filename().string();
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(file));
    const std::filesystem::path copy = std::filesystem::path(job.folder) / "inputs" / name;
    std::error_code error;
    std::filesystem::create_directories(copy.parent_path(), error);
    if (error) {
        return fail("{}: {}", copy.parent_path().string(), error.message());
    }
    LIMN_TRY(write_file(copy.string(), bytes));
    job.inputs.push_back({name, hash_bytes(bytes), bytes.size()});
    return name;
}

}  // namespace limn
