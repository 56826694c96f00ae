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
// lose what stands under
// `#ifdef __cplusplus`. #line directives number the files, so that a compiler's message can be
// given back with the file and line where the text stands.

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
    std::string text;  ///< ready for glShaderSource
    std::vector<std::string>
        files;  ///< by the number that #line gives them; the shader itself is 0
};

/// Fails with "file:line: ..." for a missing file, a cycle, a bad #include or a missing #version.
/// `files_seen`, if given, receives every path that was asked for, also on failure: reload watches
/// them.
[[nodiscard]] Result<ShaderSource> assemble_shader(
    const ShaderFiles& files,
    std::string_view path,
    const std::vector<ShaderDefine>& defines = {},
    std::vector<std::string>* files_seen = nullptr);

/// A compiler's log with "number:line" (Mesa, AMD) or "number(line)" (NVIDIA) turned into
/// "file:line".
[[nodiscard]] std::string
name_files_in_log(std::string_view log, const std::vector<std::string>& files);

}  // namespace limn::gpu
