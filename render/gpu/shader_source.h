#pragma once

#include "ecs/base/result.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn::gpu {

// GLSL from files. `#include "path"` is resolved here: from the shader folder, then from the
// including file's own folder; each file once, cycles refused. Layouts shared with C++ (name_gpu.h)
// lose what stands under `#ifdef __cplusplus`. Every line of the result remembers where it stood,
// so that a compiler's message can name the file and line; #line is not used, as Mesa forgets its
// file number within expressions.

/// Where shader files come from: texts put in by hand, then a folder on disk, then those in the
/// program.
class ShaderFiles {
  public:
    /// The files in the program, and the folder they came from if it is still there: editing works.
    [[nodiscard]] static ShaderFiles standard();
    /// Nothing but what put() adds.
    ShaderFiles() = default;
    /// A folder alone.
    explicit ShaderFiles(std::string folder) : folder_(std::move(folder)) {}

    void put(std::string path, std::string text) { texts_[std::move(path)] = std::move(text); }
    /// `path` from the shader folder, '/' between names, without "..".
    [[nodiscard]] std::optional<std::string> read(std::string_view path) const;
    /// Changes whenever the file does: time of last change on disk, or a hash; 0 if it is not
    /// there.
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
    struct Place {
        std::uint32_t file;  ///< index into `files`
        std::uint32_t line;  ///< from 1
    };
    std::string text;                ///< ready for glShaderSource
    std::vector<std::string> files;  ///< the shader itself first
    std::vector<Place> places;       ///< of each line of `text`
};

/// A file and its ShaderFiles::version() from before it was read: an edit in between is noticed
/// later.
struct ShaderFileVersion {
    std::string path;
    std::uint64_t version = 0;
};

/// Fails with "file:line: ..." for a missing file, a cycle, a bad #include or a missing #version.
/// `files_seen`, if given, receives every file that was asked for, also on failure: reload watches
/// them.
[[nodiscard]] Result<ShaderSource> assemble_shader(
    const ShaderFiles& files, std::string_view path, const std::vector<ShaderDefine>& defines = {},
    std::vector<ShaderFileVersion>* files_seen = nullptr);

/// A compiler's log with its "0:line" (Mesa, AMD) or "0(line)" (NVIDIA) turned into "file:line".
[[nodiscard]] std::string name_files_in_log(std::string_view log, const ShaderSource& source);

}  // namespace limn::gpu
