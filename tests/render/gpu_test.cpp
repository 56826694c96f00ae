#include "render/gpu/buffer.h"
#include "render/gpu/gpu_query.h"
#include "render/gpu/gpu_timer.h"
#include "render/gpu/readback.h"
#include "render/gpu/shader_library.h"
#include "tests/near.h"
#include "tests/render/render_fixture.h"
#include "tests/technique.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>

namespace limn::gpu_test {
namespace {

using gpu::Buffer;
using gpu::BufferUse;
using gpu::Texture;

/// A library with one program that covers the screen with the color of its uniform.
std::unique_ptr<gpu::ShaderLibrary> make_library(const gpu::Device& device) {
    gpu::ShaderFiles files;
    files.put("full.vert", R"(#version 450
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.5, 1.0);
})");
    files.put("fill.frag", R"(#version 450
uniform vec4 value;
layout(location = 0) out vec4 color;
void main() { color = value; })");
    files.put("copy.frag", R"(#version 450
layout(binding = 3) uniform sampler2D source;
layout(std140, binding = 2) uniform Scale { vec4 scale; };
layout(location = 0) out vec4 color;
void main() { color = scale * texture(source, gl_FragCoord.xy / 4.0); })");
    return std::make_unique<gpu::ShaderLibrary>(device.caps(), std::move(files));
}

gpu::Pipeline load(
    gpu::ShaderLibrary& library, const char* fragment,
    const gpu::PipelineState& state = gpu::kFullscreenState) {
    const auto program = library.load({.vertex = "full.vert", .fragment = fragment});
    REQUIRE_MESSAGE(program.ok(), (program.ok() ? "" : program.error().message));
    return {*program, state};
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: a buffer gives back what was written") {
    std::array<int, 64> numbers = {};
    std::iota(numbers.begin(), numbers.end(), 0);
    const Buffer fixed = Buffer::of("numbers", std::span<const int>(numbers));
    CHECK(fixed.size() == sizeof(numbers));
    CHECK(fixed.read_value<int>(17 * sizeof(int)) == 17);

    Buffer dynamic("dynamic", sizeof(numbers), BufferUse::Dynamic);
    dynamic.write(4 * sizeof(int), std::span<const int>(numbers).first(8));
    CHECK(dynamic.read_value<int>(4 * sizeof(int)) == 0);
    CHECK(dynamic.read_value<int>(11 * sizeof(int)) == 7);
    CHECK(Buffer::of("none", std::span<const int>()).size() == 1);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: LIMN_UNDEFINED=nan shows reads of uninitialized memory") {
    const char* const found = std::getenv("LIMN_UNDEFINED");
    const std::string before = found != nullptr ? found : "";
    REQUIRE(::setenv("LIMN_UNDEFINED", "nan", 1) == 0);
    const Buffer buffer("unwritten", 8, BufferUse::GpuOnly);
    CHECK(std::isnan(buffer.read_value<float>(4)));
    const float half = 0.5f;
    const Buffer written("written", 4, BufferUse::Static, &half);
    CHECK(written.read_value<float>(0) == half);
    for (const GLenum format : {GL_RGBA16F, GL_RGBA32F}) {
        const Texture texture("unwritten", {.format = format, .width = 3, .height = 2});
        CHECK(std::isnan(gpu::read_floats(texture).at(2, 1, 3)));
    }
    const Texture codes("unwritten codes", {.format = GL_RGBA8, .width = 3, .height = 2});
    CHECK(gpu::read_bytes(codes).at(2, 1, 3) == 255);
    REQUIRE(::setenv("LIMN_UNDEFINED", before.c_str(), 1) == 0);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "gpu: data written after a clear or a copy on the GPU is kept") {
    for (int round = 0; round < 20; ++round) {
        CAPTURE(round);
        constexpr std::size_t kWords = 1 << 18;
        std::vector<std::uint32_t> numbers(1000);
        std::iota(numbers.begin(), numbers.end(), 7u + round);
        const Buffer source = Buffer::of("source", std::span<const std::uint32_t>(numbers));
        Buffer cleared("cleared", kWords * 4, BufferUse::Dynamic);
        cleared.clear(5);
        cleared.write(400, std::span<const std::uint32_t>(numbers).first(10));
        CHECK(cleared.read_value<std::uint32_t>(396) == 5);
        CHECK(cleared.read_value<std::uint32_t>(400) == numbers[0]);
        CHECK(cleared.read_value<std::uint32_t>(kWords * 4 - 4) == 5);
        cleared.copy_from(source, 4, 8, 40);
        const std::uint32_t one = 1;
        cleared.write(12, std::span(&one, 1));
        CHECK(cleared.read_value<std::uint32_t>(4) == 5);
        CHECK(cleared.read_value<std::uint32_t>(8) == numbers[1]);
        CHECK(cleared.read_value<std::uint32_t>(12) == 1);
        CHECK(cleared.read_value<std::uint32_t>(44) == numbers[10]);
        CHECK(cleared.read_value<std::uint32_t>(48) == 5);
        cleared.clear(3, 12);
        CHECK(cleared.read_value<std::uint32_t>(8) == 3);
        CHECK(cleared.read_value<std::uint32_t>(12) == 1);
    }
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: objects and their memory are counted while they live") {
    const auto buffers = gpu::live_objects(gpu::ObjectKind::Buffer);
    const auto textures = gpu::live_objects(gpu::ObjectKind::Texture);
    const auto memory = gpu::gpu_memory_bytes();
    {
        Buffer a("a", 1000, BufferUse::GpuOnly);
        Buffer b = std::move(a);
        CHECK(!a);
        CHECK(gpu::live_objects(gpu::ObjectKind::Buffer) == buffers + 1);
        b = Buffer("c", 500, BufferUse::GpuOnly);
        CHECK(gpu::gpu_memory_bytes() == memory + 500);
        const Texture t("t", {.format = GL_RGBA16F, .width = 8, .height = 4, .levels = 0});
        CHECK(t.desc().levels == 4);
        CHECK(gpu::gpu_memory_bytes() == memory + 500 + 8 * (32 + 8 + 2 + 1));
        CHECK(gpu::live_objects(gpu::ObjectKind::Texture) == textures + 1);
    }
    CHECK(gpu::live_objects(gpu::ObjectKind::Buffer) == buffers);
    CHECK(gpu::live_objects(gpu::ObjectKind::Texture) == textures);
    CHECK(gpu::gpu_memory_bytes() == memory);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: an object carries its label") {
    const Texture texture("water.height", {});
    std::array<char, 64> label = {};
    glGetObjectLabel(
        GL_TEXTURE, texture.id(), static_cast<GLsizei>(label.size()), nullptr, label.data());
    CHECK(std::string(label.data()) == "water.height");
    const Buffer buffer(std::string(5000, 'x'), 4, BufferUse::GpuOnly);  // longer than drivers take
    CHECK(buffer.id() != 0);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: texels are read back as uploaded, top row first") {
    // 3 x 2 with rows that are no multiple of four bytes.
    const std::array<std::uint8_t, 18> rgb = {1,  2,  3,  4,  5,  6,  7,  8,  9,
                                              10, 11, 12, 13, 14, 15, 16, 17, 18};
    Texture bytes("bytes", {.format = GL_RGB8, .width = 3, .height = 2});
    bytes.upload(std::span<const std::uint8_t>(rgb), GL_RGB, GL_UNSIGNED_BYTE);
    const gpu::ByteImage image = gpu::read_bytes(bytes);
    CHECK(image.width == 3);
    CHECK(image.height == 2);
    CHECK(image.channels == 3);
    CHECK(image.at(0, 1, 0) == 1);  // OpenGL's first row is the bottom one
    CHECK(image.at(2, 0, 2) == 18);
    CHECK(gpu::read_floats(bytes).at(0, 1, 1) == test::near(2.0 / 255.0));
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: floats, integers and depth are read back exactly") {
    const std::array<float, 4> values = {-1.5f, 0.0f, 65504.0f, 0.125f};
    for (const GLenum format : {GL_R32F, GL_R16F}) {
        Texture texture("floats", {.format = format, .width = 2, .height = 2});
        texture.upload(std::span<const float>(values), GL_RED, GL_FLOAT);
        const gpu::FloatImage image = gpu::read_floats(texture);
        CHECK(image.channels == 1);
        CHECK(image.at(0, 1, 0) == -1.5f);
        CHECK(image.at(0, 0, 0) == 65504.0f);
        CHECK(image.at(1, 0, 0) == 0.125f);
    }
    const std::array<std::uint32_t, 2> numbers = {7, 3'000'000'000u};
    Texture integers("integers", {.format = GL_R32UI, .width = 2, .height = 1});
    integers.upload(std::as_bytes(std::span(numbers)));
    CHECK(gpu::read_floats(integers).at(0, 0, 0) == 7.0f);
    CHECK(gpu::read_floats(integers).at(1, 0, 0) == 3e9f);

    Texture depth("depth", {.format = GL_DEPTH_COMPONENT32F, .width = 2, .height = 2});
    depth.clear({0.375f, 0, 0, 0});
    CHECK(gpu::read_floats(depth).at(1, 1, 0) == 0.375f);
    Texture stencil("stencil", {.format = GL_DEPTH32F_STENCIL8, .width = 2, .height = 2});
    stencil.clear({0.25f, 3, 0, 0});
    CHECK(gpu::read_floats(stencil).at(0, 0, 0) == 0.25f);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: layers, faces and levels are separate") {
    const std::array<float, 4> one = {1, 1, 1, 1};
    const std::array<float, 4> two = {2, 2, 2, 2};
    for (const GLenum target : {GL_TEXTURE_2D_ARRAY, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP}) {
        const int depth = target == GL_TEXTURE_CUBE_MAP ? 1 : 4;
        Texture texture(
            "layers",
            {.format = GL_R32F, .width = 2, .height = 2, .depth = depth, .target = target});
        CHECK(texture.layers() == (target == GL_TEXTURE_CUBE_MAP ? 6 : 4));
        for (int layer = 0; layer < texture.layers(); ++layer) {
            texture.upload(
                std::span<const float>(layer == 3 ? two : one), GL_RED, GL_FLOAT, 0, layer);
        }
        CHECK(gpu::read_floats(texture, 0, 3).at(1, 1, 0) == 2.0f);
        CHECK(gpu::read_floats(texture, 0, 2).at(1, 1, 0) == 1.0f);
    }
    Texture chain("chain", {.format = GL_R32F, .width = 4, .height = 4, .levels = 0});
    chain.clear({5, 0, 0, 0});
    chain.generate_mipmaps();
    CHECK(chain.desc().levels == 3);
    CHECK(gpu::read_floats(chain, 2).at(0, 0, 0) == 5.0f);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "gpu: a texture too large for the device is one line, not a crash") {
    const gpu::DeviceCaps& caps = device().caps();
    CHECK(gpu::check_texture(caps, {.width = caps.max_texture_size, .height = 1}).ok());
    for (const gpu::TextureDesc& bad :
         {gpu::TextureDesc{.width = caps.max_texture_size + 1}, gpu::TextureDesc{.width = 0},
          gpu::TextureDesc{.depth = caps.max_texture_layers + 1, .target = GL_TEXTURE_2D_ARRAY},
          gpu::TextureDesc{.samples = caps.max_samples + 1}, gpu::TextureDesc{.format = GL_RGBA}}) {
        const Status status = gpu::check_texture(caps, bad);
        REQUIRE(!status.ok());
        CHECK(status.error().message.find("expected") != std::string::npos);
    }
}

TEST_CASE_FIXTURE(
    test::RenderTest, "gpu: an asynchronous readback gives the same bytes as a waiting one") {
    Texture texture("picture", {.format = GL_RGBA8, .width = 5, .height = 3});
    std::array<std::uint8_t, 60> pixels = {};
    std::iota(pixels.begin(), pixels.end(), std::uint8_t{0});
    texture.upload(std::span<const std::uint8_t>(pixels), GL_RGBA, GL_UNSIGNED_BYTE);
    gpu::AsyncReadback readback;
    CHECK(!readback.poll());
    readback.request(texture);
    texture.clear({0, 0, 0, 0});  // after the request: does not change what arrives
    readback.request(texture);
    glFinish();
    const std::optional<gpu::ByteImage> image = readback.poll();
    REQUIRE(image);
    CHECK(image->at(0, 2, 3) == 3);
    CHECK(image->at(4, 0, 3) == 59);
    const std::optional<gpu::ByteImage> cleared = readback.poll();
    REQUIRE(cleared);
    CHECK(cleared->pixels == gpu::read_bytes(texture).pixels);
    CHECK(readback.pending() == 0);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "gpu: a full-screen draw fills its framebuffer with the uniform's color") {
    const auto library = make_library(device());
    const gpu::Pipeline fill = load(*library, "fill.frag");
    const Texture target("target", {.format = GL_RGBA32F, .width = 4, .height = 4});
    const gpu::Attachment color = {&target};
    const gpu::Framebuffer framebuffer("target", std::span(&color, 1));
    fill.program->set("value", Vec4(1, 2, 3, 4));
    fill.program->set("no_such_uniform", 1.0f);  // no error: the compiler may drop uniforms
    CHECK(fill.program->find_uniform("no_such_uniform") == -1);
    device().bind_framebuffer(framebuffer);
    device().use(fill);
    device().draw_fullscreen();
    const gpu::FloatImage image = gpu::read_floats(target);
    for (int i = 0; i < 16; ++i) {
        CHECK(image.at(i % 4, i / 4, 2) == 3.0f);
    }

    // The value stays through draws with another program.
    const gpu::Pipeline copy = load(*library, "copy.frag");
    const Buffer scale = Buffer::of("scale", std::span<const Vec4>(std::array{Vec4(0.5f)}));
    const Texture other("other", {.format = GL_RGBA32F, .width = 4, .height = 4});
    const gpu::Attachment other_color = {&other};
    const gpu::Framebuffer other_framebuffer("other", std::span(&other_color, 1));
    device().bind_framebuffer(other_framebuffer);
    device().use(copy);
    device().bind_texture(3, target);
    device().bind_uniforms(2, scale);
    device().draw_fullscreen();
    CHECK(gpu::read_floats(other).at(2, 2, 1) == 1.0f);
    device().bind_framebuffer(framebuffer);
    device().use(fill);
    device().draw_fullscreen();
    CHECK(gpu::read_floats(target).at(0, 0, 3) == 4.0f);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: redundant state changes do not call OpenGL") {
    const Texture texture("bound", {});
    const Buffer buffer("bound", 256, BufferUse::GpuOnly);
    const auto set_all = [&] {
        device().apply({.blend = gpu::kBlendAdd});
        device().bind_texture(5, texture);
        device().bind_uniforms(1, buffer);
        device().bind_storage(2, buffer);
        device().set_viewport(0, 0, 7, 7);
    };
    set_all();
    device().reset_stats();
    set_all();
    CHECK(device().stats().state_changes == 0);
    CHECK(device().stats().state_skipped == 6);  // a texture unit has a sampler as well
}

TEST_CASE_FIXTURE(
    test::RenderTest, "gpu: every pipeline state is applied and restored to the default") {
    // A framebuffer without stencil clamps the reference to no bits.
    const Texture target("target", {.format = GL_DEPTH32F_STENCIL8});
    const gpu::Framebuffer framebuffer("target", {}, {&target});
    device().bind_framebuffer(framebuffer);
    gpu::PipelineState state;
    state.depth = {.test = false, .write = false, .func = GL_LESS};
    state.blend = gpu::kBlendPremultiplied;
    state.stencil.test = true;
    state.stencil.reference = 3;
    state.stencil.front.func = GL_EQUAL;
    state.stencil.back.depth_fail = GL_INCR_WRAP;
    state.cull = GL_FRONT;
    state.color_mask = 0b0101;
    state.depth_clamp = true;
    state.depth_bias = 2;
    const auto get = [](GLenum what) {
        GLint value = 0;
        glGetIntegerv(what, &value);
        return static_cast<GLenum>(value);
    };
    device().apply(state);
    CHECK(glIsEnabled(GL_DEPTH_TEST) == GL_FALSE);
    CHECK(get(GL_DEPTH_WRITEMASK) == GL_FALSE);
    CHECK(get(GL_DEPTH_FUNC) == GL_LESS);
    CHECK(glIsEnabled(GL_BLEND) == GL_TRUE);
    CHECK(get(GL_BLEND_DST_RGB) == GL_ONE_MINUS_SRC_ALPHA);
    CHECK(glIsEnabled(GL_STENCIL_TEST) == GL_TRUE);
    CHECK(get(GL_STENCIL_FUNC) == GL_EQUAL);
    CHECK(get(GL_STENCIL_REF) == 3);
    CHECK(get(GL_STENCIL_BACK_PASS_DEPTH_FAIL) == GL_INCR_WRAP);
    CHECK(get(GL_CULL_FACE_MODE) == GL_FRONT);
    std::array<GLboolean, 4> mask = {};
    glGetBooleanv(GL_COLOR_WRITEMASK, mask.data());
    CHECK(mask == std::array<GLboolean, 4>{GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE});
    CHECK(glIsEnabled(GL_DEPTH_CLAMP) == GL_TRUE);
    CHECK(glIsEnabled(GL_POLYGON_OFFSET_FILL) == GL_TRUE);

    device().apply({});
    CHECK(glIsEnabled(GL_DEPTH_TEST) == GL_TRUE);
    CHECK(get(GL_DEPTH_FUNC) == GL_GREATER);
    CHECK(glIsEnabled(GL_BLEND) == GL_FALSE);
    CHECK(glIsEnabled(GL_STENCIL_TEST) == GL_FALSE);
    CHECK(get(GL_CULL_FACE_MODE) == GL_BACK);
    CHECK(glIsEnabled(GL_DEPTH_CLAMP) == GL_FALSE);
    CHECK(glIsEnabled(GL_POLYGON_OFFSET_FILL) == GL_FALSE);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: after an object is deleted bindings are set again") {
    // OpenGL unbinds a dying name and hands it out again (Mesa 22.3 happens not to), so that what
    // is remembered may be another object.
    const Texture texture("bound", {});
    auto other = std::make_unique<Texture>("other", gpu::TextureDesc{});
    device().bind_texture(6, texture);
    device().reset_stats();
    device().bind_texture(6, texture);
    CHECK(device().stats().state_changes == 0);
    other.reset();
    device().bind_texture(6, texture);
    CHECK(device().stats().state_changes > 0);
    glActiveTexture(GL_TEXTURE6);
    GLint bound = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    CHECK(static_cast<GLuint>(bound) == texture.id());
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: missing bindings of a program are named") {
    const auto library = make_library(device());
    const gpu::Pipeline copy = load(*library, "copy.frag");
    // Bindings of earlier tests are unknown after their objects died: bind nothing for sure.
    Result<std::unique_ptr<gpu::Device>> fresh = gpu::Device::from_current_context();
    REQUIRE(fresh.ok());
    const std::string missing = (*fresh)->missing_bindings(*copy.program);
    CHECK(missing.find("texture unit 3 (source)") != std::string::npos);
    CHECK(missing.find("uniform binding 2 (Scale)") != std::string::npos);
    const Texture texture("source", {});
    const Buffer scale("scale", 16, BufferUse::GpuOnly);
    (*fresh)->bind_texture(3, texture);
    (*fresh)->bind_uniforms(2, scale);
    CHECK((*fresh)->missing_bindings(*copy.program).empty());
}

TEST_CASE_FIXTURE(
    test::RenderTest,
    "gpu: a program's interface matches its shaders" * technique("shade.program-lifecycle")) {
    const auto library = make_library(device());
    const gpu::Program& copy = *load(*library, "copy.frag").program;
    CHECK(copy.expect(gpu::BindingKind::UniformBlock, "Scale", 2, 16).ok());
    CHECK(copy.expect(gpu::BindingKind::Texture, "source", 3).ok());
    const auto message = [](const Status& status) {
        return status.ok() ? "" : status.error().message;
    };
    CHECK(
        message(copy.expect(gpu::BindingKind::UniformBlock, "View", 0))
        == "full.vert + copy.frag: no uniform block named View found, expected one at binding 0");
    CHECK(
        message(copy.expect(gpu::BindingKind::Texture, "source", 4))
        == "full.vert + copy.frag: texture source found at binding 3, expected 4");
    CHECK(
        message(copy.expect(gpu::BindingKind::UniformBlock, "Scale", 2, 8))
        == "full.vert + copy.frag: uniform block Scale of 16 bytes found, expected at most 8");
}

TEST_CASE_FIXTURE(
    test::RenderTest, "gpu: the depth test keeps the nearer fragment, with reversed depth") {
    gpu::ShaderFiles files;
    files.put("at.vert", R"(#version 450
uniform float depth;
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, depth, 1.0);
})");
    files.put(
        "fill.frag",
        "#version 450\nlayout(location = 0) out vec4 c; uniform vec4 value; void main() { c = "
        "value; }");
    gpu::ShaderLibrary library(device().caps(), std::move(files));
    const auto program = library.load({.vertex = "at.vert", .fragment = "fill.frag"});
    REQUIRE(program.ok());
    Texture color("color", {.format = GL_RGBA8, .width = 2, .height = 2});
    Texture depth("depth", {.format = GL_DEPTH_COMPONENT32F, .width = 2, .height = 2});
    depth.clear({0, 0, 0, 0});
    const gpu::Attachment attachment = {&color};
    const gpu::Framebuffer framebuffer("both", std::span(&attachment, 1), {&depth});
    device().bind_framebuffer(framebuffer);
    device().use(gpu::Pipeline{*program, {}});
    (*program)->set("value", Vec4(1, 0, 0, 1));
    (*program)->set("depth", 0.5f);
    device().draw_fullscreen();
    (*program)->set("value", Vec4(0, 1, 0, 1));
    (*program)->set("depth", 0.25f);  // farther
    device().draw_fullscreen();
    CHECK(gpu::read_bytes(color).at(0, 0, 0) == 255);
    CHECK(gpu::read_floats(depth).at(0, 0, 0) == 0.5f);  // written as it is: 0 .. 1, not -1 .. 1
    (*program)->set("depth", 0.75f);                     // nearer
    device().draw_fullscreen();
    CHECK(gpu::read_bytes(color).at(0, 0, 1) == 255);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: draws read vertices, instances and indirect arguments") {
    gpu::ShaderFiles files;
    files.put("point.vert", R"(#version 450
layout(location = 0) in vec2 corner;
layout(location = 1) in float column;
void main() { gl_Position = vec4((corner.x + column + 0.5) / 2.0 - 1.0, corner.y, 0.5, 1.0); gl_PointSize = 1.0; })");
    files.put(
        "one.frag",
        "#version 450\nlayout(location = 0) out vec4 c; void main() { c = vec4(1.0); }");
    gpu::ShaderLibrary library(device().caps(), std::move(files));
    const auto program = library.load({.vertex = "point.vert", .fragment = "one.frag"});
    REQUIRE_MESSAGE(program.ok(), (program.ok() ? "" : program.error().message));
    const std::array corners = {Vec2(9, 9), Vec2(0, 0)};
    const std::array columns = {0.0f, 2.0f, 3.0f};
    const std::array<std::uint16_t, 1> indices = {1};
    const Buffer vertices = Buffer::of("vertices", std::span<const Vec2>(corners));
    const Buffer instances = Buffer::of("instances", std::span<const float>(columns));
    const Buffer index_buffer = Buffer::of("indices", std::span<const std::uint16_t>(indices));
    // count, instance count, first index, base vertex, base instance
    const std::array<std::uint32_t, 10> commands = {1, 1, 0, 0, 0, 1, 2, 0, 0, 1};
    const Buffer indirect = Buffer::of("indirect", std::span<const std::uint32_t>(commands));
    const std::array attributes = {
        gpu::VertexAttribute{.location = 0, .stream = 0, .components = 2},
        gpu::VertexAttribute{.location = 1, .stream = 1, .components = 1}};
    gpu::VertexArray array("points", attributes);
    array.set_vertices(0, vertices, 0, sizeof(Vec2));
    array.set_vertices(1, instances, 0, sizeof(float), 1);
    array.set_indices(index_buffer);

    Texture target("target", {.format = GL_R8, .width = 4, .height = 1});
    const gpu::Attachment attachment = {&target};
    const gpu::Framebuffer framebuffer("target", std::span(&attachment, 1));
    const auto columns_drawn = [&] {
        std::string text;
        const gpu::ByteImage image = gpu::read_bytes(target);
        for (int x = 0; x < 4; ++x) {
            text += image.at(x, 0, 0) != 0 ? '#' : '.';
        }
        target.clear(Vec4(0));
        return text;
    };
    target.clear(Vec4(0));
    device().reset_stats();
    device().bind_framebuffer(framebuffer);
    device().use(gpu::Pipeline{*program, gpu::kFullscreenState});
    device().bind_vertex_array(array);
    device().bind_indirect(indirect.id());
    device().draw_indexed_indirect(GL_POINTS, GL_UNSIGNED_SHORT, 0, 1);
    CHECK(columns_drawn() == "#...");
    device().draw_indexed_indirect(GL_POINTS, GL_UNSIGNED_SHORT, 0, 2);
    CHECK(columns_drawn() == "#.##");
    device().draw_indexed(GL_POINTS, 1, GL_UNSIGNED_SHORT, 0, 0, 1, 2);
    CHECK(columns_drawn() == "...#");
    device().draw(GL_POINTS, 1, 1, 2);
    CHECK(columns_drawn() == "#.#.");
    device().draw_indexed_indirect(GL_POINTS, GL_UNSIGNED_SHORT, 0, 0);
    CHECK(columns_drawn() == "....");
    CHECK(device().stats().draws == 4);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: a compute dispatch covers every item once") {
    gpu::ShaderFiles files;
    files.put("count.comp", R"(#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Counts { uint count[]; };
layout(binding = 1, r32f) uniform writeonly image2D image;
void main() {
    uvec2 p = gl_GlobalInvocationID.xy;
    if (p.x < 13u && p.y < 9u) {
        atomicAdd(count[p.y * 13u + p.x], 1u);
        imageStore(image, ivec2(p), vec4(float(p.x)));
    }
})");
    gpu::ShaderLibrary library(device().caps(), std::move(files));
    const auto program = library.load({.compute = "count.comp"});
    REQUIRE_MESSAGE(program.ok(), (program.ok() ? "" : program.error().message));
    const std::array<std::uint32_t, 117> zeros = {};
    const Buffer counts = Buffer::of("counts", std::span<const std::uint32_t>(zeros));
    const Texture texture("image", {.format = GL_R32F, .width = 13, .height = 9});
    device().use(**program);
    device().bind_storage(0, counts);
    device().bind_image(1, texture, GL_WRITE_ONLY);
    device().dispatch_over(13, 9, 8);
    for (std::size_t i = 0; i < zeros.size(); ++i) {
        CHECK(counts.read_value<std::uint32_t>(i * 4) == 1);
    }
    CHECK(gpu::read_floats(texture).at(12, 8, 0) == 12.0f);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: a query counts the samples that passed") {
    const auto library = make_library(device());
    const gpu::Pipeline fill = load(*library, "fill.frag");
    const Texture target("target", {.format = GL_RGBA8, .width = 16, .height = 16});
    const gpu::Attachment color = {&target};
    const gpu::Framebuffer framebuffer("target", std::span(&color, 1));
    gpu::GpuQuery query("samples", GL_SAMPLES_PASSED);
    CHECK(!query.poll());
    device().bind_framebuffer(framebuffer);
    device().set_scissor(0, 0, 5, 4);
    device().use(fill);
    query.begin();
    device().draw_fullscreen();
    query.end();
    device().disable_scissor();
    CHECK(query.wait() == 20);
    CHECK(query.poll().value_or(0) == 20);
}

TEST_CASE_FIXTURE(
    test::RenderTest,
    "gpu: timestamps arrive in order, and surplus frames are skipped without waiting") {
    gpu::GpuTimer timer;
    CHECK(timer.take().empty());
    for (int frame = 0; frame < gpu::GpuTimer::kFrames + 2; ++frame) {
        timer.begin_frame();
        timer.mark(static_cast<std::uint32_t>(frame));
        timer.mark(100);
        timer.end_frame();
    }
    glFinish();
    int frames = 0;
    while (true) {
        const auto marks = timer.take(true);
        if (marks.empty()) {
            break;
        }
        REQUIRE(marks.size() == 2);
        CHECK(marks[0].tag == static_cast<std::uint32_t>(frames));
        CHECK(marks[1].tag == 100);
        CHECK(marks[1].time_ns >= marks[0].time_ns);
        ++frames;
    }
    CHECK(frames == gpu::GpuTimer::kFrames);
}

TEST_CASE_FIXTURE(test::RenderTest, "gpu: a sampler replaces the texture's own filter and wrap") {
    const auto library = make_library(device());
    const gpu::Pipeline copy = load(*library, "copy.frag");
    const std::array<float, 4> texels = {0, 1, 0, 1};
    Texture source("source", {.format = GL_R32F, .width = 2, .height = 2});
    source.upload(std::span<const float>(texels), GL_RED, GL_FLOAT);
    const Buffer scale = Buffer::of("scale", std::span<const Vec4>(std::array{Vec4(1)}));
    const Texture target("target", {.format = GL_R32F, .width = 4, .height = 4});
    const gpu::Attachment color = {&target};
    const gpu::Framebuffer framebuffer("target", std::span(&color, 1));
    const gpu::Sampler nearest(
        "nearest", {.minify = GL_NEAREST, .magnify = GL_NEAREST, .wrap = GL_REPEAT});
    device().bind_framebuffer(framebuffer);
    device().use(copy);
    device().bind_uniforms(2, scale);
    device().bind_texture(3, source);
    device().draw_fullscreen();
    CHECK(gpu::read_floats(target).at(1, 0, 0) == test::near(0.25f));  // linear by default
    device().bind_texture(3, source, &nearest);
    device().draw_fullscreen();
    CHECK(gpu::read_floats(target).at(1, 0, 0) == 0.0f);
}

}  // namespace
}  // namespace limn::gpu_test
