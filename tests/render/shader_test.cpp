#include "render/gpu/embedded_shaders.h"
#include "render/gpu/shader_library.h"
#include "render/gpu/shader_source.h"
#include "tests/render/render_fixture.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

namespace limn::shader_test {
namespace {

using gpu::ShaderFiles;

const std::string kFullscreen = R"(#version 450
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.5, 1.0);
})";

std::string message_of(const auto& result) {
    return result.ok() ? "" : result.error().message;
}

void write_file(const std::string& path, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path, std::ios::binary) << text;
    // Times of files are coarse: an edit within the same tick would go unseen.
    static int edits = 0;
    std::filesystem::last_write_time(
        path, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++edits));
}

/// What the fragment shader says of itself through its uniforms: the names that are active.
std::string
compile_error(const ShaderFiles& files, const std::vector<gpu::ShaderDefine>& defines = {}) {
    gpu::ShaderLibrary library(test::shared_device().caps(), files);
    return message_of(library.load({.vertex = "v.vert", .fragment = "f.frag", .defines = defines}));
}

ShaderFiles with_fragment(const std::string& text) {
    ShaderFiles files;
    files.put("v.vert", kFullscreen);
    files.put("f.frag", text);
    return files;
}

TEST_CASE("shader: an include is pasted once, with the lines of its file") {
    ShaderFiles files;
    files.put("a.frag", "#version 450\n#include \"lib/b.glsl\"\n#include \"lib/c.glsl\"\nmain\n");
    files.put("lib/b.glsl", "in b\n#include \"c.glsl\"\nafter c\n");
    files.put("lib/c.glsl", "in c\n");
    const auto source = gpu::assemble_shader(files, "a.frag");
    REQUIRE(source.ok());
    CHECK(source->files == std::vector<std::string>{"a.frag", "lib/b.glsl", "lib/c.glsl"});
    CHECK(source->text == "#version 450\nin b\nin c\nafter c\nmain\n");
    REQUIRE(source->lines.size() == 5);
    CHECK(source->lines[2].file == 2);
    CHECK(source->lines[2].line == 1);
    CHECK(source->lines[3].file == 1);
    CHECK(source->lines[3].line == 3);
    CHECK(source->lines[4].file == 0);
    CHECK(source->lines[4].line == 4);
}

TEST_CASE("shader: definitions stand after the version and keep the line numbers") {
    ShaderFiles files;
    files.put("a.frag", "// comment\n#version 450\nline 3\n");
    const auto source = gpu::assemble_shader(files, "a.frag", {{"SAMPLES", "4"}, {"FAST"}});
    REQUIRE(source.ok());
    CHECK(source->text == "#version 450\n#define SAMPLES 4\n#define FAST 1\nline 3\n");
    CHECK(source->lines.back().line == 3);
}

TEST_CASE("shader: the C++ part of a shared layout is removed") {
    ShaderFiles files;
    files.put("a.frag", "#version 450\n#include \"x_gpu.h\"\nend\n");
    files.put(
        "x_gpu.h", "#pragma once\n#ifdef __cplusplus\n#include \"ecs/base/math.h\"\n#if "
                   "1\ncpp\n#endif\n#else\nglsl\n#endif\n"
                   "struct\n#ifndef __cplusplus\nglsl too\n#if X\nkept\n#endif\n#else\nmore "
                   "cpp\n#endif\nlast\n");
    const auto source = gpu::assemble_shader(files, "a.frag");
    REQUIRE_MESSAGE(source.ok(), message_of(source));
    CHECK(source->text == "#version 450\nglsl\nstruct\nglsl too\n#if X\nkept\n#endif\nlast\nend\n");
    CHECK(source->lines[2].line == 10);
}

TEST_CASE("shader: a bad include is one line that begins with file and line") {
    const auto error = [](const std::string& line) {
        ShaderFiles files;
        files.put("a.frag", "#version 450\n\n" + line + "\n");
        files.put("loop.glsl", "#include \"pool.glsl\"\n");
        files.put("pool.glsl", "\n#include \"loop.glsl\"\n");
        files.put("version.glsl", "#version 330\n");
        return message_of(gpu::assemble_shader(files, "a.frag"));
    };
    CHECK(
        error("#include \"no.glsl\"")
        == "a.frag:3: no file no.glsl found, expected it in the shader folder");
    CHECK(error("#include no.glsl").find("a.frag:3: '#include no.glsl' found, expected") == 0);
    CHECK(error("#include \"\"").find("a.frag:3: ") == 0);
    CHECK(error("#include \"").find("a.frag:3: ") == 0);
    CHECK(error("#include").find("a.frag:3: ") == 0);
    CHECK(error("#include \"../a.frag\"").find("a.frag:3: include of '../a.frag' found") == 0);
    CHECK(error("#include \"/etc/passwd\"").find("a.frag:3: include of '/etc/passwd' found") == 0);
    CHECK(error("#include \"x/../../../etc/passwd\"").find("a.frag:3: include of") == 0);
    CHECK(
        error("#include \"loop.glsl\"")
        == "pool.glsl:2: include cycle loop.glsl -> pool.glsl -> loop.glsl found, expected none");
    CHECK(error("#include \"a.frag\"").find("a.frag:3: include cycle a.frag -> a.frag") == 0);
    CHECK(error("#include \"version.glsl\"").find("version.glsl:1: #version found") == 0);
    CHECK(error("fine").empty());
    CHECK(error("#includes are not directives").empty());
}

TEST_CASE("shader: a shader that is missing, empty or without a version is an error") {
    ShaderFiles files;
    files.put("empty.frag", "");
    files.put("comment.frag", "// nothing\n");
    files.put("none.frag", "\nvoid main() {}\n");
    CHECK(
        message_of(gpu::assemble_shader(files, "absent.frag")).find("absent.frag")
        != std::string::npos);
    CHECK(
        message_of(gpu::assemble_shader(files, "empty.frag"))
            .find("empty.frag:1: no #version found")
        == 0);
    CHECK(
        message_of(gpu::assemble_shader(files, "comment.frag")).find("comment.frag:1: no #version")
        == 0);
    CHECK(
        message_of(gpu::assemble_shader(files, "none.frag"))
            .find("none.frag:2: 'void main() {}' found")
        == 0);
}

TEST_CASE("shader: compilers' locations become files and lines") {
    const gpu::ShaderSource source = {
        .text = "", .files = {"a.frag", "lib/b.glsl"}, .lines = {{0, 1}, {1, 12}, {0, 7}}};
    const auto named = [&](std::string_view log) { return gpu::name_files_in_log(log, source); };
    CHECK(named("0:2(5): error: `x' undeclared\n") == "lib/b.glsl:12: error: `x' undeclared");
    CHECK(named("0(3) : error C1008: undefined") == "a.frag:7: error C1008: undefined");
    CHECK(named("ERROR: 0:2: 'x' : undeclared") == "lib/b.glsl:12: 'x' : undeclared");
    CHECK(named("0:4: who?\n\nlinked") == "0:4: who?\nlinked");  // no such line
    CHECK(named("0:0: who?") == "0:0: who?");
    CHECK(named("").empty());
    CHECK(named("1:") == "1:");
    CHECK(named("0:2(") == "lib/b.glsl:12: ");
    CHECK(named("0:99999999999999999999: x") == "0:99999999999999999999: x");
}

TEST_CASE_FIXTURE(
    test::RenderTest,
    "shader: a compile error names the real file and line" * technique("shade.program-lifecycle")) {
    ShaderFiles files = with_fragment("#version 450\n#include \"lib/ok.glsl\"\nlayout(location = "
                                      "0) out vec4 c;\nvoid main() { c = vec4(oops); }\n");
    files.put("lib/ok.glsl", "float two() { return 2.0; }\n\n\n");
    CHECK(compile_error(files).find("f.frag:4: ") == 0);
    CHECK(compile_error(files, {{"A"}, {"B"}, {"C"}}).find("f.frag:4: ") == 0);
    CHECK(compile_error(files).find("oops") != std::string::npos);
    files.put("lib/ok.glsl", "\n\nfloat two() { return nonsense; }\n");
    CHECK_MESSAGE(compile_error(files).find("lib/ok.glsl:3: ") == 0, compile_error(files));
}

TEST_CASE_FIXTURE(
    test::RenderTest, "shader: a vertex shader that writes no position is a context error") {
    ShaderFiles files = with_fragment("#version 450\nvoid main() {}\n");
    CHECK(compile_error(files).empty());
    files.put(
        "v.vert", "#version 450\n// gl_Position\n/* gl_Position = vec4(0) */ void main() {}\n");
    CHECK(compile_error(files) == "v.vert: context: no write of gl_Position found, expected one");
}

TEST_CASE_FIXTURE(
    test::RenderTest, "shader: more textures than the device has is a capacity error") {
    ShaderFiles files = with_fragment(R"(#version 450
layout(binding = 0) uniform sampler2D a[4];
layout(location = 0) out vec4 c;
void main() { c = texture(a[0], vec2(0)) + texture(a[1], vec2(0)) + texture(a[2], vec2(0)) + texture(a[3], vec2(0)); }
)");
    gpu::DeviceCaps caps = device().caps();
    caps.max_fragment_textures = 4;
    gpu::ShaderLibrary enough(caps, files);
    CHECK(enough.load({.vertex = "v.vert", .fragment = "f.frag"}).ok());
    caps.max_fragment_textures = 3;
    gpu::ShaderLibrary small(caps, files);
    const std::string message = message_of(small.load({.vertex = "v.vert", .fragment = "f.frag"}));
    CHECK(message == "v.vert + f.frag: capacity: 4 fragment textures required, this device has 3");
    caps.max_fragment_textures = 0;
    gpu::ShaderLibrary none(caps, files);
    CHECK(
        message_of(none.load({.vertex = "v.vert", .fragment = "f.frag"}))
            .find("capability: 4 fragment textures")
        != std::string::npos);
}

TEST_CASE_FIXTURE(test::RenderTest, "shader: two resources at one binding are rejected") {
    const auto message_for = [](const std::string& declarations, const std::string& sum) {
        return compile_error(with_fragment(
            "#version 450\n" + declarations
            + "layout(location = 0) out vec4 c;\nvoid main() { c = " + sum + "; }\n"));
    };
    const std::string types = message_for(
        "layout(binding = 3) uniform sampler2D a;\nlayout(binding = 3) uniform samplerBuffer b;\n",
        "texture(a, vec2(0)) + texelFetch(b, 0)");
    CHECK(
        types == "v.vert + f.frag: context: a and b found at texture unit 3, expected one of them");
    const std::string textures = message_for(
        "layout(binding = 3) uniform sampler2D a[2];\nlayout(binding = 4) uniform sampler2D b;\n",
        "texture(a[0], vec2(0)) + texture(a[1], vec2(0)) + texture(b, vec2(0))");
    CHECK(textures.find("a[0] and b found at texture unit 4, expected one") != std::string::npos);
    const std::string blocks = message_for(
        "layout(std140, binding = 2) uniform A { vec4 a; };\n"
        "layout(std140, binding = 2) uniform B { vec4 b; };\n",
        "a + b");
    CHECK(blocks.find("A and B found at uniform binding 2, expected one") != std::string::npos);
    CHECK(message_for(
              "layout(std140, binding = 2) uniform A { vec4 a; };\n"
              "layout(std430, binding = 2) readonly buffer B { vec4 b; };\n"
              "layout(binding = 2) uniform sampler2D t;\n",
              "a + b + texture(t, vec2(0))")
              .empty());
}

/// Adds the name of each texture that a shader may declare, by unit; fails if a unit has two names.
void add_units(const std::string& path, std::map<int, std::string>& names) {
    const auto source = gpu::assemble_shader(ShaderFiles::standard(), path, {});
    REQUIRE_MESSAGE(source.ok(), message_of(source));
    const bool unmasked = source->text.find("#define UNMASKED") != std::string::npos;
    std::map<std::string, int> numbers;
    const std::regex constant(R"(const uint (k\w+Unit) = (\d+)u;)");
    for (std::sregex_iterator it(source->text.begin(), source->text.end(), constant), end;
         it != end; ++it) {
        numbers[(*it)[1]] = std::stoi((*it)[2]);
    }
    const std::regex declaration(R"(binding = (k\w+)[^)]*\) uniform \w*sampler\w+ (\w+))");
    for (std::sregex_iterator it(source->text.begin(), source->text.end(), declaration), end;
         it != end; ++it) {
        if ((*it)[2] == "sky_cube" || (*it)[2] == "sky_view"
            || ((*it)[2] == "shadow_masks" && unmasked)) {
            continue;  // those are only for the sky, which has no surfaces
        }
        CAPTURE(path);
        REQUIRE(numbers.contains((*it)[1]));
        const int unit = numbers[(*it)[1]];
        const std::string& name = names.emplace(unit, (*it)[2]).first->second;
        CHECK_MESSAGE(name == (*it)[2].str(), "unit ", unit);
    }
}

TEST_CASE("shader: no definition gives two textures of a program one unit") {
    const std::vector<std::vector<std::string>> programs = {
        {"water.vert", "water_surface.frag"},
        {"water.frag"},
        {"mesh.vert", "gbuffer.frag"},
        {"mesh.vert", "blend.frag"},
        {"mesh.vert", "forward_list.frag"},
        {"mesh.vert", "forward_one.frag"},
        {"light_pass.frag"},
        {"light_one.frag"},
        {"water_veil.frag"},
        {"shadow_classify.frag"},
        {"gouraud.vert", "gouraud.frag"},
        {"sampled.vert", "six_samples.geom", "quadratic.frag"},
        {"caustics_rays.comp"}};
    for (const std::vector<std::string>& stages : programs) {
        std::map<int, std::string> names;
        for (const std::string& stage : stages) {
            add_units(stage, names);
        }
        CHECK(!names.empty());
    }
}

TEST_CASE_FIXTURE(
    test::RenderTest,
    "shader: stages that do not fit together do not link" * technique("shade.profile")) {
    ShaderFiles files =
        with_fragment("#version 450\nlayout(location = 0) in vec3 normal;\nlayout(location = 0) "
                      "out vec4 c;\nvoid main() { c = vec4(normal, 1); }\n");
    const std::string message = compile_error(files);
    CHECK(message.find("v.vert + f.frag: ") == 0);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "shader: equal descriptions share a program, definitions make another") {
    const auto programs = gpu::live_objects(gpu::ObjectKind::Program);
    {
        gpu::ShaderLibrary library(
            device().caps(),
            with_fragment("#version 450\nuniform float x;\nlayout(location = 0) out vec4 "
                          "c;\n#ifdef RED\nvoid main() { c = vec4(x); }\n#else\nvoid main() { c = "
                          "vec4(0); }\n#endif\n"));
        const auto a = library.load({.vertex = "v.vert", .fragment = "f.frag"});
        const auto b = library.load({.vertex = "v.vert", .fragment = "f.frag"});
        const auto red =
            library.load({.vertex = "v.vert", .fragment = "f.frag", .defines = {{"RED"}}});
        REQUIRE(a.ok());
        REQUIRE(red.ok());
        CHECK(*a == *b);
        CHECK(*a != *red);
        CHECK((*a)->find_uniform("x") < 0);
        CHECK((*red)->find_uniform("x") >= 0);
        CHECK(library.program_count() == 2);
        CHECK(gpu::live_objects(gpu::ObjectKind::Program) == programs + 2);
    }
    CHECK(gpu::live_objects(gpu::ObjectKind::Program) == programs);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "shader: a changed file is compiled again, a broken one changes nothing") {
    const test::TemporaryFolder folder;
    const std::string good = "#version 450\n#include \"lib/value.glsl\"\nuniform float "
                             "kept;\nlayout(location = 0) out vec4 c;\n"
                             "void main() { c = vec4(value(), kept, 0, 1); }\n";
    write_file(folder.file("v.vert"), kFullscreen);
    write_file(folder.file("f.frag"), good);
    write_file(folder.file("lib/value.glsl"), "float value() { return 1.0; }\n");
    gpu::ShaderLibrary library(device().caps(), ShaderFiles(folder.path()));
    const auto loaded = library.load({.vertex = "v.vert", .fragment = "f.frag"});
    REQUIRE_MESSAGE(loaded.ok(), message_of(loaded));
    const gpu::Program& program = **loaded;
    const GLuint first = program.id();
    program.set("kept", 0.625f);
    CHECK(library.reload_changed().reloaded == 0);

    write_file(
        folder.file("lib/value.glsl"), "uniform float fresh;\nfloat value() { return fresh; }\n");
    CHECK(library.reload_changed().reloaded == 1);
    CHECK(program.find_uniform("fresh") >= 0);
    GLfloat kept = 0;
    glGetUniformfv(program.id(), program.find_uniform("kept"), &kept);
    CHECK(kept == 0.625f);  // uniforms survive a reload
    const GLuint second = program.id();

    write_file(folder.file("lib/value.glsl"), "\nfloat value() { return broken; }\n");
    gpu::ReloadReport report = library.reload_changed();
    CHECK(report.reloaded == 0);
    REQUIRE(report.errors.size() == 1);
    CHECK(report.errors[0].find("lib/value.glsl:2: ") == 0);
    CHECK(program.id() == second);
    CHECK(glIsProgram(second) == GL_TRUE);
    CHECK(library.reload_changed().errors.empty());  // said once, until the file changes again

    std::filesystem::remove(folder.file("lib/value.glsl"));
    report = library.reload_changed();
    REQUIRE(report.errors.size() == 1);
    CHECK(report.errors[0].find("f.frag:2: no file lib/value.glsl found") == 0);
    write_file(folder.file("lib/value.glsl"), "float value() { return 3.0; }\n");
    CHECK(library.reload_changed().reloaded == 1);
    CHECK(program.find_uniform("fresh") < 0);
    CHECK(library.reload_all().reloaded == 1);
    static_cast<void>(first);
}

TEST_CASE("shader: the files in the program are those of the folder") {
    const std::filesystem::path root =
        std::filesystem::path(LIMN_SOURCE_DIR) / "render" / "shaders";
    REQUIRE(gpu::kEmbeddedShaderCount > 0);
    for (unsigned i = 0; i < gpu::kEmbeddedShaderCount; ++i) {
        const gpu::EmbeddedShader& shader = gpu::kEmbeddedShaders[i];
        std::ifstream stream(root / shader.path, std::ios::binary);
        std::stringstream text;
        text << stream.rdbuf();
        INFO(shader.path);
        CHECK(text.str() == shader.text);
    }
}

TEST_CASE("shader: every shader of the folder finds its includes") {
    const ShaderFiles files = ShaderFiles::standard();
    for (unsigned i = 0; i < gpu::kEmbeddedShaderCount; ++i) {
        const std::string path = gpu::kEmbeddedShaders[i].path;
        const std::string extension = std::filesystem::path(path).extension().string();
        if (extension == ".vert" || extension == ".frag" || extension == ".comp"
            || extension == ".geom" || extension == ".tesc") {
            const auto source = gpu::assemble_shader(files, path);
            CHECK_MESSAGE(source.ok(), message_of(source));
        }
    }
}

}  // namespace
}  // namespace limn::shader_test
