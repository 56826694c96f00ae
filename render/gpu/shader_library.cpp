#include "render/gpu/shader_library.h"

#include "ecs/base/hash.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "render/gpu/device_caps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

// Techniques: shade.parameters, shade.profile, shade.program-lifecycle

namespace limn::gpu {

struct ShaderLibrary::Entry {
    ProgramDesc desc;
    Program program;
    std::vector<ShaderFileVersion> watched;
    bool counted = true;  ///< by loaded_count()
};

namespace {

/// Owns a shader object until its program is linked.
class Shader {
  public:
    explicit Shader(GLenum stage) : id_(glCreateShader(stage)) {}
    Shader(Shader&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Shader& operator=(Shader&&) = delete;
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    ~Shader() { glDeleteShader(id_); }
    [[nodiscard]] GLuint id() const { return id_; }

  private:
    GLuint id_;
};

std::string shader_log(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader, length, &length, log.data());
    log.resize(static_cast<std::size_t>(std::max(length, 0)));
    return log;
}

std::string program_log(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program, length, &length, log.data());
    log.resize(static_cast<std::size_t>(std::max(length, 0)));
    return log;
}

/// `text` without comments, so that words in comments are not found.
std::string strip_comments(std::string_view text) {
    std::string code;
    while (!text.empty()) {
        const std::size_t at = std::min(text.find("//"), text.find("/*"));
        code += text.substr(0, at);
        if (at == std::string_view::npos) {
            break;
        }
        const bool block = text[at + 1] == '*';
        const std::size_t end = block ? text.find("*/", at + 2) : text.find('\n', at);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + (block ? 2 : 0));
    }
    return code;
}

/// The parts of `desc` as "water.vert + water.frag".
std::string describe(const ProgramDesc& desc) {
    std::string text;
    for (const std::string* part :
         {&desc.vertex, &desc.control, &desc.evaluation, &desc.geometry, &desc.fragment,
          &desc.compute}) {
        if (!part->empty()) {
            text += (text.empty() ? "" : " + ") + *part;
        }
    }
    for (const ShaderDefine& define : desc.defines) {
        text += fmt::format(" {}={}", define.name, define.value);
    }
    return text;
}

using StageSources = std::vector<std::pair<GLenum, ShaderSource>>;

const char* file_extension(GLenum stage) {
    switch (stage) {
    case GL_VERTEX_SHADER:
        return "vert";
    case GL_TESS_CONTROL_SHADER:
        return "tesc";
    case GL_TESS_EVALUATION_SHADER:
        return "tese";
    case GL_GEOMETRY_SHADER:
        return "geom";
    case GL_FRAGMENT_SHADER:
        return "frag";
    default:
        return "comp";
    }
}

/// Writes the assembled sources below the folder LIMN_SHADER_DUMP, if that is set.
void dump_sources(const ProgramDesc& desc, const StageSources& sources) {
    const char* root = std::getenv("LIMN_SHADER_DUMP");
    if (root == nullptr || *root == '\0') {
        return;
    }
    std::uint64_t hash = 0;
    for (const auto& [stage, source] : sources) {
        hash = hash_combine(hash, hash_text(source.text));
    }
    const std::string& name = desc.compute.empty() ? desc.fragment : desc.compute;
    const std::filesystem::path folder =
        std::filesystem::path(root)
        / fmt::format("{}-{:016x}", std::filesystem::path(name).stem().string(), hash);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    std::ofstream(folder / "program.txt") << describe(desc) << '\n';
    for (const auto& [stage, source] : sources) {
        std::ofstream file(folder / fmt::format("program.{}", file_extension(stage)));
        file << source.text;
        if (!file.flush()) {
            log_error("LIMN_SHADER_DUMP: cannot write to {}", folder.string());
            return;
        }
    }
}

/// Too many textures in one stage are a capability or capacity error, by the device's limits.
Status check_textures(const DeviceCaps& caps, const ProgramDesc& desc, const Program& program) {
    constexpr std::array<std::pair<GLenum, int PassRequirements::*>, 4> kStages = {{
        {GL_REFERENCED_BY_VERTEX_SHADER, &PassRequirements::vertex_textures},
        {GL_REFERENCED_BY_TESS_EVALUATION_SHADER, &PassRequirements::evaluation_textures},
        {GL_REFERENCED_BY_FRAGMENT_SHADER, &PassRequirements::fragment_textures},
        {GL_REFERENCED_BY_COMPUTE_SHADER, &PassRequirements::compute_textures},
    }};
    PassRequirements needs;
    for (const ProgramBinding& binding : program.bindings()) {
        if (binding.kind != BindingKind::Texture) {
            continue;
        }
        const GLuint index =
            glGetProgramResourceIndex(program.id(), GL_UNIFORM, binding.name.c_str());
        for (const auto& [stage, field] : kStages) {
            GLint used = 0;
            glGetProgramResourceiv(program.id(), GL_UNIFORM, index, 1, &stage, 1, nullptr, &used);
            needs.*field += used != 0 ? binding.size : 0;
        }
    }
    return require(caps, describe(desc).c_str(), needs);
}

const char* binding_name(BindingKind kind) {
    switch (kind) {
    case BindingKind::UniformBlock:
        return "uniform binding";
    case BindingKind::StorageBlock:
        return "storage binding";
    case BindingKind::Texture:
        return "texture unit";
    case BindingKind::Image:
        return "image unit";
    }
    return "";
}

/// The binding after the last one that a resource takes: arrays take several.
int end_of(const ProgramBinding& resource) {
    const bool is_block =
        resource.kind == BindingKind::UniformBlock || resource.kind == BindingKind::StorageBlock;
    return resource.binding + (is_block ? 1 : resource.size);
}

/// Two resources at one binding, in whichever stages, would be the same one; textures of different
/// types are an error at draw time that not every driver reports.
Status check_bindings(const ProgramDesc& desc, const Program& program) {
    const std::vector<ProgramBinding>& all = program.bindings();
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t j = i + 1; j < all.size(); ++j) {
            const ProgramBinding& a = all[i];
            const ProgramBinding& b = all[j];
            if (a.kind == b.kind && a.binding < end_of(b) && b.binding < end_of(a)) {
                return fail(
                    "{}: context: {} and {} found at {} {}, expected one of them", describe(desc),
                    a.name, b.name, binding_name(a.kind), std::max(a.binding, b.binding));
            }
        }
    }
    return Done{};
}

}  // namespace

ShaderLibrary::ShaderLibrary(const DeviceCaps& caps, ShaderFiles files)
    : caps_(caps), files_(std::move(files)) {}

ShaderLibrary::~ShaderLibrary() = default;

Result<const Program*> ShaderLibrary::load(const ProgramDesc& desc) {
    LIMN_CHECK(desc.compute.empty() != desc.vertex.empty());
    for (const std::unique_ptr<Entry>& entry : entries_) {
        if (entry->desc == desc) {
            entry->counted = true;
            return &entry->program;
        }
    }
    auto entry = std::make_unique<Entry>();
    entry->desc = desc;
    Result<Program> program = build(desc, entry->watched);
    if (!program) {
        return program.error();
    }
    entry->program = *std::move(program);
    entries_.push_back(std::move(entry));
    return &entries_.back()->program;
}

std::size_t ShaderLibrary::loaded_count() const {
    return static_cast<std::size_t>(
        std::count_if(entries_.begin(), entries_.end(), [](const std::unique_ptr<Entry>& entry) {
            return entry->counted;
        }));
}

void ShaderLibrary::count_loaded() {
    for (const std::unique_ptr<Entry>& entry : entries_) {
        entry->counted = false;
    }
}

ReloadReport ShaderLibrary::reload_changed() {
    return reload(false);
}

ReloadReport ShaderLibrary::reload_all() {
    return reload(true);
}

ReloadReport ShaderLibrary::reload(bool all) {
    ReloadReport report;
    // Programs share most of their files: query each once.
    std::map<std::string, std::uint64_t> versions;
    const auto changed = [&](const ShaderFileVersion& file) {
        const auto [found, fresh] = versions.try_emplace(file.path, 0);
        if (fresh) {
            found->second = files_.version(file.path);
        }
        return found->second != file.version;
    };
    for (const std::unique_ptr<Entry>& entry : entries_) {
        if (!all && std::none_of(entry->watched.begin(), entry->watched.end(), changed)) {
            continue;
        }
        Result<Program> program = build(entry->desc, entry->watched);
        if (program) {
            program->copy_uniforms_from(entry->program);
            entry->program = *std::move(program);
            ++report.reloaded;
        } else {
            report.errors.push_back(program.error().message);
        }
    }
    return report;
}

Result<Program>
ShaderLibrary::build(const ProgramDesc& desc, std::vector<ShaderFileVersion>& watched) const {
    const std::array<std::pair<GLenum, const std::string*>, 6> stages = {{
        {GL_VERTEX_SHADER, &desc.vertex},
        {GL_TESS_CONTROL_SHADER, &desc.control},
        {GL_TESS_EVALUATION_SHADER, &desc.evaluation},
        {GL_GEOMETRY_SHADER, &desc.geometry},
        {GL_FRAGMENT_SHADER, &desc.fragment},
        {GL_COMPUTE_SHADER, &desc.compute},
    }};
    std::vector<ShaderDefine> defines = desc.defines;
    if (caps_.profile == Profile::Gpu) {
        defines.push_back({"HALF_FLOATS"});  // lib/radiance.glsl
    }
    if (caps_.opaque_uniforms) {
        defines.push_back({"OPAQUE_UNIFORMS"});
    }
    // All files first: files that fail to compile must be watched too, or a fix would go unnoticed.
    StageSources sources;
    watched.clear();
    Status assembled = Done{};
    for (const auto& [stage, path] : stages) {
        if (path->empty() || !assembled) {
            continue;
        }
        Result<ShaderSource> source = assemble_shader(files_, *path, defines, &watched);
        if (source) {
            sources.emplace_back(stage, *std::move(source));
        } else {
            assembled = source.error();
        }
    }
    if (!assembled) {
        return assembled.error();
    }
    dump_sources(desc, sources);

    std::vector<Shader> shaders;
    for (const auto& [stage, source] : sources) {
        if (stage == GL_VERTEX_SHADER && desc.geometry.empty() && desc.evaluation.empty()
            && strip_comments(source.text).find("gl_Position") == std::string::npos) {
            return fail("{}: context: no write of gl_Position found, expected one", desc.vertex);
        }
        Shader shader(stage);
        const char* text = source.text.c_str();
        glShaderSource(shader.id(), 1, &text, nullptr);
        glCompileShader(shader.id());
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
        if (compiled != GL_TRUE) {
            const std::string log = name_files_in_log(shader_log(shader.id()), source);
            return fail(
                "{}",
                log.empty() ? source.files[0] + ":1: does not compile, no reason given" : log);
        }
        shaders.push_back(std::move(shader));
    }

    const GLuint id = glCreateProgram();
    for (const Shader& shader : shaders) {
        glAttachShader(id, shader.id());
    }
    glLinkProgram(id);
    for (const Shader& shader : shaders) {
        glDetachShader(id, shader.id());
    }
    GLint linked = GL_FALSE;
    glGetProgramiv(id, GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        std::string log = program_log(id);
        while (!log.empty() && (log.back() == '\n' || log.back() == '\0')) {
            log.pop_back();
        }
        glDeleteProgram(id);
        return fail(
            "{}: context: {}", describe(desc),
            log.empty() ? "the stages do not link, no reason given" : log);
    }
    Program program(id, describe(desc));
    program.tessellated_ = !desc.evaluation.empty();
    LIMN_TRY(check_bindings(desc, program));
    LIMN_TRY(check_textures(caps_, desc, program));
    return program;
}

}  // namespace limn::gpu
