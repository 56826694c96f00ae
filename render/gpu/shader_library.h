#pragma once

#include "render/gpu/program.h"
#include "render/gpu/shader_source.h"

#include <memory>
#include <string>
#include <vector>

namespace limn::gpu {

class Device;
struct DeviceCaps;

// All programs of a device, each compiled once and reloaded when one of its files changes.
//
//     Result<const Program*> program =
//         device.shaders().load({.vertex = "water.vert", .fragment = "water.frag"});
//
// With the environment variable LIMN_SHADER_DUMP, the assembled sources are also written to that
// folder, one subfolder per program, for glslangValidator -l (tests/glslang.cmake).

/// The source files of a program and its preprocessor definitions. Set either `compute` or `vertex`
/// (with the others). The file of a stage may be one that is usually that of another.
struct ProgramDesc {
    std::string vertex = {};
    std::string control = {};  ///< of tessellation, with `evaluation`
    std::string evaluation = {};
    std::string geometry = {};
    std::string fragment = {};
    std::string compute = {};
    std::vector<ShaderDefine> defines = {};

    bool operator==(const ProgramDesc&) const = default;
};

struct ReloadReport {
    int reloaded = 0;                 ///< programs replaced by a new version
    std::vector<std::string> errors;  ///< "file:line: ..." of programs that keep their old version
};

class ShaderLibrary {
  public:
    explicit ShaderLibrary(const DeviceCaps& caps, ShaderFiles files = ShaderFiles::standard());
    ~ShaderLibrary();
    ShaderLibrary(const ShaderLibrary&) = delete;
    ShaderLibrary& operator=(const ShaderLibrary&) = delete;

    /// The program, compiled now if it is new; the same one for equal descriptions. The pointer is
    /// valid as long as the library. Fails with the shader compiler's message, by file and line, or
    /// a profile error.
    [[nodiscard]] Result<const Program*> load(const ProgramDesc& desc);

    /// Recompiles programs whose files have changed. One that fails to compile keeps its old
    /// version. Costs one stat() per file.
    ReloadReport reload_changed();
    /// Recompiles everything.
    ReloadReport reload_all();

    [[nodiscard]] std::size_t program_count() const { return entries_.size(); }
    /// Programs that load() has returned since the last call of count_loaded().
    [[nodiscard]] std::size_t loaded_count() const;
    void count_loaded();
    [[nodiscard]] ShaderFiles& files() { return files_; }

  private:
    struct Entry;
    [[nodiscard]] Result<Program>
    build(const ProgramDesc& desc, std::vector<ShaderFileVersion>& watched) const;
    ReloadReport reload(bool all);

    const DeviceCaps& caps_;
    ShaderFiles files_;
    std::vector<std::unique_ptr<Entry>> entries_;
};

}  // namespace limn::gpu
