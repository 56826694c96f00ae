#include "render/gpu/shader_source.h"

#include "ecs/base/hash.h"
#include "ecs/base/text.h"
#include "render/gpu/embedded_shaders.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace limn::gpu {
namespace {

constexpr std::string_view kSpace = " \t\r";

std::string_view trim(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kSpace);
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

/// Whether `line` is the directive `#name rest`; stores `rest`.
bool is_directive(std::string_view line, std::string_view name, std::string_view& rest) {
    line = trim(line);
    if (line.empty() || line.front() != '#') {
        return false;
    }
    line = trim(line.substr(1));
    if (!line.starts_with(name)) {
        return false;
    }
    line.remove_prefix(name.size());
    if (!line.empty() && kSpace.find(line.front()) == std::string_view::npos
        && line.front() != '"') {
        return false;  // a longer word
    }
    rest = trim(line);
    return true;
}

/// "a/b/../c" becomes "a/c"; nothing if it leaves the folder or is absolute.
std::optional<std::string> clean_path(std::string_view path) {
    const std::filesystem::path normal = std::filesystem::path(path).lexically_normal();
    if (normal.empty() || normal.is_absolute() || *normal.begin() == "..") {
        return std::nullopt;
    }
    return normal.generic_string();
}

std::optional<std::string_view> find_embedded(std::string_view path) {
    for (unsigned i = 0; i < kEmbeddedShaderCount; ++i) {
        if (path == kEmbeddedShaders[i].path) {
            return kEmbeddedShaders[i].text;
        }
    }
    return std::nullopt;
}

/// Expands includes and definitions.
class Assembler {
  public:
    Assembler(
        const ShaderFiles& files, const std::vector<ShaderDefine>& defines,
        std::vector<ShaderFileVersion>* requested)
        : files_(files), defines_(defines), requested_(requested) {}

    Result<ShaderSource> run(std::string_view path) {
        const Status status = add_file(path, "shader");
        if (!status) {
            return status.error();
        }
        return std::move(source_);
    }

  private:
    /// `location` prefixes the error message if the file is missing.
    Status add_file(std::string_view path, const std::string& location) {
        if (requested_ != nullptr) {
            requested_->push_back({std::string(path), files_.version(path)});
        }
        const std::optional<std::string> body = files_.read(path);
        if (!body) {
            return fail("{}: no file {} found, expected it in the shader folder", location, path);
        }
        const auto number = source_.files.size();
        source_.files.emplace_back(path);
        open_.emplace_back(path);
        const Status status = number == 0 ? add_main(*body) : add_lines(*body, 1, number);
        open_.pop_back();
        return status;
    }

    /// The shader itself: definitions go between its #version and the rest.
    Status add_main(std::string_view body) {
        int line = 1;
        std::string_view rest;
        while (true) {
            if (body.empty()) {
                return fail(
                    "{}:1: no #version found, expected '#version 450' before any code",
                    source_.files[0]);
            }
            const std::string_view current = take_line(body);
            if (is_directive(current, "version", rest)) {
                emit(trim(current), 0, line);
                break;
            }
            const std::string_view stripped = trim(current);
            if (!stripped.empty() && !stripped.starts_with("//")) {
                return fail(
                    "{}:{}: '{}' found, expected '#version 450' before any code", source_.files[0],
                    line, stripped);
            }
            ++line;
        }
        for (const ShaderDefine& define : defines_) {
            emit(fmt::format("#define {} {}", define.name, define.value), 0, line);
        }
        return add_lines(body, line + 1, 0);
    }

    Status add_lines(std::string_view body, int line, std::size_t number) {
        // Depth of #if blocks inside a C++ part; 0 when not in one.
        int cpp_depth = 0;
        // For each open `__cplusplus` block whose GLSL part is read: depth of plain #if inside it.
        std::vector<int> guards;
        for (; !body.empty(); ++line) {
            const std::string_view current = take_line(body);
            if (skip_cpp(current, cpp_depth, guards)) {
                continue;
            }
            // The extension is for editors (drivers reject it), the pragma for C++.
            std::string_view rest;
            const bool drop = (is_directive(current, "pragma", rest) && rest == "once")
                              || (is_directive(current, "extension", rest)
                                  && rest.starts_with("GL_GOOGLE_include_directive"));
            if (drop) {
                continue;
            }
            if (is_directive(current, "include", rest)) {
                const Status status = add_include(rest, line, number);
                if (!status) {
                    return status;
                }
            } else if (number != 0 && is_directive(current, "version", rest)) {
                return fail(
                    "{}:{}: #version found in an included file, expected it only in the shader",
                    source_.files[number], line);
            } else {
                emit(current, number, line);
            }
        }
        return Done{};
    }

    /// Whether the line is C++ only (or a directive that delimits it). Only `#ifdef __cplusplus`,
    /// `#ifndef __cplusplus` and their #else and #endif are evaluated; everything else is left to
    /// GLSL.
    static bool skip_cpp(std::string_view line, int& cpp_depth, std::vector<int>& guards) {
        std::string_view rest;
        const bool opens = is_directive(line, "ifdef", rest) || is_directive(line, "ifndef", rest)
                           || is_directive(line, "if", rest);
        const bool closes = !opens && is_directive(line, "endif", rest);
        if (cpp_depth > 0) {
            if (opens) {
                ++cpp_depth;
            } else if (closes) {
                --cpp_depth;
            } else if (cpp_depth == 1 && is_directive(line, "else", rest)) {
                cpp_depth = 0;
                guards.push_back(0);
            }
            return true;
        }
        if (is_directive(line, "ifdef", rest) && rest == "__cplusplus") {
            cpp_depth = 1;
            return true;
        }
        if (is_directive(line, "ifndef", rest) && rest == "__cplusplus") {
            guards.push_back(0);
            return true;
        }
        if (guards.empty()) {
            return false;
        }
        if (opens) {
            ++guards.back();
        } else if (closes && guards.back() > 0) {
            --guards.back();
        } else if (closes) {
            guards.pop_back();
            return true;
        } else if (guards.back() == 0 && is_directive(line, "else", rest)) {
            guards.pop_back();
            cpp_depth = 1;
            return true;
        }
        return false;
    }

    void emit(std::string_view text, std::size_t number, int line) {
        source_.text += text;
        source_.text += '\n';
        source_.lines.push_back(
            {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(line)});
    }

    Status add_include(std::string_view argument, int line, std::size_t number) {
        const std::string location = fmt::format("{}:{}", source_.files[number], line);
        const std::size_t end = argument.find('"', 1);
        if (argument.size() < 3 || argument.front() != '"' || end == std::string_view::npos
            || end == 1) {
            return fail("{}: '#include {}' found, expected #include \"path\"", location, argument);
        }
        constexpr std::string_view kRootInCpp = "render/shaders/";
        std::string_view wanted = argument.substr(1, end - 1);
        if (wanted.starts_with(kRootInCpp)) {
            wanted.remove_prefix(kRootInCpp.size());
        }
        std::optional<std::string> path = clean_path(wanted);
        if (!path) {
            return fail(
                "{}: include of '{}' found, expected a path inside the shader folder", location,
                wanted);
        }
        if (!files_.read(*path)) {
            // Not found from the root: try the including file's folder.
            const std::filesystem::path beside =
                std::filesystem::path(source_.files[number]).parent_path() / *path;
            if (files_.read(beside.generic_string())) {
                path = beside.generic_string();
            }
        }
        const auto cycle = std::find(open_.begin(), open_.end(), *path);
        if (cycle != open_.end()) {
            std::string chain;
            for (auto it = cycle; it != open_.end(); ++it) {
                chain += *it + " -> ";
            }
            return fail("{}: include cycle {}{} found, expected none", location, chain, *path);
        }
        if (std::find(source_.files.begin(), source_.files.end(), *path) != source_.files.end()) {
            return Done{};  // each file once
        }
        return add_file(*path, location);
    }

    static std::string_view take_line(std::string_view& body) {
        const std::size_t end = body.find('\n');
        std::string_view line = body.substr(0, end);
        body.remove_prefix(end == std::string_view::npos ? body.size() : end + 1);
        if (line.ends_with('\r')) {
            line.remove_suffix(1);
        }
        return line;
    }

    const ShaderFiles& files_;
    const std::vector<ShaderDefine>& defines_;
    std::vector<ShaderFileVersion>* requested_;
    ShaderSource source_;
    std::vector<std::string> open_;  // files that are being read, outermost first
};

}  // namespace

ShaderFiles ShaderFiles::standard() {
    ShaderFiles files;
    files.embedded_ = true;
    for (unsigned i = 0; i < kGeneratedShaderCount; ++i) {
        files.put(kGeneratedShaders[i].path, kGeneratedShaders[i].text());
    }
    std::error_code ignored;
    if (std::filesystem::is_directory(LIMN_SHADER_DIR, ignored)) {
        files.folder_ = LIMN_SHADER_DIR;
    }
    return files;
}

std::optional<std::string> ShaderFiles::read(std::string_view path) const {
    const std::optional<std::string> clean = clean_path(path);
    if (!clean) {
        return std::nullopt;
    }
    if (const auto found = texts_.find(*clean); found != texts_.end()) {
        return found->second;
    }
    if (!folder_.empty()) {
        const std::filesystem::path file = std::filesystem::path(folder_) / *clean;
        std::error_code ignored;
        if (std::filesystem::is_regular_file(file, ignored)) {
            std::ifstream stream(file, std::ios::binary);
            std::string text{std::istreambuf_iterator<char>(stream), {}};
            if (stream) {
                return text;
            }
        }
    }
    if (embedded_) {
        if (const auto text = find_embedded(*clean)) {
            return std::string(*text);
        }
    }
    return std::nullopt;
}

std::uint64_t ShaderFiles::version(std::string_view path) const {
    const std::optional<std::string> clean = clean_path(path);
    if (!clean) {
        return 0;
    }
    if (const auto found = texts_.find(*clean); found != texts_.end()) {
        return 1 | hash_text(found->second);
    }
    if (!folder_.empty()) {
        std::error_code error;
        const std::filesystem::path file = std::filesystem::path(folder_) / *clean;
        const auto time = std::filesystem::last_write_time(file, error);
        if (!error) {
            const std::uint64_t size = std::filesystem::file_size(file, error);
            return 1
                   | hash_combine(
                       size, static_cast<std::uint64_t>(time.time_since_epoch().count()));
        }
    }
    return embedded_ && find_embedded(*clean) ? 1 : 0;
}

Result<ShaderSource> assemble_shader(
    const ShaderFiles& files, std::string_view path, const std::vector<ShaderDefine>& defines,
    std::vector<ShaderFileVersion>* requested) {
    return Assembler(files, defines, requested).run(path);
}

namespace {

/// Parses digits at the front of `text`; false if there are none or too many for a line number.
bool take_number(std::string_view& text, std::size_t& number) {
    constexpr std::size_t kMaxDigits = 8;
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    if (digits == 0 || digits > kMaxDigits) {
        return false;
    }
    number = 0;
    for (const char c : text.substr(0, digits)) {
        number = 10 * number + static_cast<std::size_t>(c - '0');
    }
    text.remove_prefix(digits);
    return true;
}

/// If `line` begins with a source location, removes it and stores its line number.
bool take_location(std::string_view& line, std::size_t& number) {
    std::string_view rest = line;
    for (const std::string_view prefix : {"ERROR: ", "WARNING: "}) {
        if (rest.starts_with(prefix)) {
            rest.remove_prefix(prefix.size());
        }
    }
    std::size_t string_number = 0;
    if (!take_number(rest, string_number) || rest.empty()
        || (rest.front() != ':' && rest.front() != '(')) {
        return false;
    }
    rest.remove_prefix(1);
    if (!take_number(rest, number)) {
        return false;
    }
    // Mesa adds the column in parentheses, NVIDIA closes its own.
    if (rest.starts_with('(')) {
        rest.remove_prefix(std::min(rest.find(')'), rest.size() - 1) + 1);
    } else if (rest.starts_with(')')) {
        rest.remove_prefix(1);
    }
    rest = trim(rest);
    if (rest.starts_with(':')) {
        rest = trim(rest.substr(1));
    }
    line = rest;
    return true;
}

}  // namespace

std::string name_files_in_log(std::string_view log, const ShaderSource& source) {
    std::string out;
    while (!log.empty()) {
        const std::size_t end = std::min(log.find('\n'), log.size());
        std::string_view line = log.substr(0, end);
        log.remove_prefix(std::min(end + 1, log.size()));
        if (trim(line).empty()) {
            continue;
        }
        out += out.empty() ? "" : "\n";
        std::string_view message = line;
        std::size_t number = 0;
        if (take_location(message, number) && number >= 1 && number <= source.lines.size()) {
            const ShaderSource::Line origin = source.lines[number - 1];
            out += fmt::format("{}:{}: {}", source.files[origin.file], origin.line, message);
        } else {
            out += line;
        }
    }
    return out;
}

}  // namespace limn::gpu
