#pragma once

#include "ecs/base/result.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn::gpu {

// GLSL from files. `#include "path"` is resolved here: from the shader folder, then from the
// including file's own folder; each file once, cycles are errors. Of layouts shared with C++
// (name_gpu.h), everything under `#ifdef __cplusplus` is removed. The origin of every line is kept,
// so that compiler messages can name file and line; #line is not used, as Mesa loses its file
// number within expressions.

/// Where shader files are looked up: in-memory texts first, then a folder on disk, then the files
/// embedded in the program.
class ShaderFiles {
  public:
    /// The embedded and generated files, and the folder they came from if it still exists, so that
    /// edits work.
    [[nodiscard]] static ShaderFiles standard();
    /// Only what put() adds.
    ShaderFiles() = default;
    /// Only a folder.
    explicit ShaderFiles(std::string folder) : folder_(std::move(folder)) {}

    void put(std::string path, std::string text) { texts_[std::move(path)] = std::move(text); }
    /// `path` is relative to the shader folder, with '/' and without "..".
    [[nodiscard]] std::optional<std::string> read(std::string_view path) const;
    /// Changes whenever the file does: from its modification time on disk, or a hash; 0 if it does
    /// not exist.
    [[nodiscard]] std::uint64_t version(std::string_view path) const;

  private:
    std::map<std::string, std::string, std::less<>> texts_;
    std::string folder_;  // empty: none
    bool embedded_ = false;
};

/// `#define name value`, put after the #version line.
struct ShaderDefine {
    std::string name;
    std::string value = "1";

    bool operator==(const ShaderDefine&) const = default;
};

struct ShaderSource {
    struct Line {
        std::uint32_t file;  ///< index into `files`
        std::uint32_t line;  ///< from 1
    };
    std::string text;                ///< ready for glShaderSource
    std::vector<std::string> files;  ///< the shader itself first
    std::vector<Line> lines;         ///< origin of each line of `text`
};

/// A file and its ShaderFiles::version() from before it was read, so that no edit is missed.
struct ShaderFileVersion {
    std::string path;
    std::uint64_t version = 0;
};

/// Fails with "file:line: ..." for a missing file, a cycle, a bad #include or a missing #version.
/// `requested`, if given, receives every file that was requested, also on failure, for reloading.
[[nodiscard]] Result<ShaderSource> assemble_shader(
    const ShaderFiles& files, std::string_view path, const std::vector<ShaderDefine>& defines = {},
    std::vector<ShaderFileVersion>* requested = nullptr);

/// A compiler's log with its "0:line" (Mesa, AMD) or "0(line)" (NVIDIA) turned into "file:line".
[[nodiscard]] std::string name_files_in_log(std::string_view log, const ShaderSource& source);

}  // namespace limn::gpu
