#include "render/gpu/buffer.h"
#include "render/gpu/context.h"
#include "render/gpu/readback.h"
#include "tests/render/render_fixture.h"
#include "tests/technique.h"

#include <cstdlib>
#include <string>
#include <thread>

namespace limn::context_test {
namespace {

/// Sets LIMN_GL_DEVICE for a scope.
class DeviceChoice {
  public:
    explicit DeviceChoice(const char* value) {
        const char* old = std::getenv("LIMN_GL_DEVICE");
        had_ = old != nullptr;
        old_ = had_ ? old : "";
        setenv("LIMN_GL_DEVICE", value, 1);
    }
    ~DeviceChoice() {
        if (had_) {
            setenv("LIMN_GL_DEVICE", old_.c_str(), 1);
        } else {
            unsetenv("LIMN_GL_DEVICE");
        }
    }

  private:
    bool had_ = false;
    std::string old_;
};

TEST_CASE_FIXTURE(
    test::RenderTest, "context: the device is OpenGL 4.5 or later and names its limits") {
    const gpu::DeviceCaps& caps = device().caps();
    CHECK(caps.gl_major * 10 + caps.gl_minor >= 45);
    CHECK(caps.debug);
    CHECK(!caps.renderer.empty());
    CHECK(caps.max_texture_size >= 16384);
    CHECK(caps.max_samples >= 4);
    CHECK(caps.max_color_attachments >= 8);
    CHECK(caps.max_fragment_textures >= 16);
    CHECK(caps.max_compute_invocations >= 1024);
    CHECK(256 % caps.uniform_alignment == 0);
}

TEST_CASE_FIXTURE(test::RenderTest, "context: depth is reversed, 0 .. 1") {
    GLint depth_mode = 0;
    glGetIntegerv(GL_CLIP_DEPTH_MODE, &depth_mode);
    CHECK(depth_mode == GL_ZERO_TO_ONE);
    GLdouble clear = 1;
    glGetDoublev(GL_DEPTH_CLEAR_VALUE, &clear);
    CHECK(clear == 0.0);
    device().apply({});
    GLint func = 0;
    glGetIntegerv(GL_DEPTH_FUNC, &func);
    CHECK(func == GL_GREATER);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "context: a provoked error is counted, kept once and describes the mistake") {
    gpu::DebugOutput& output = device().debug_output();
    const std::uint64_t before = output.error_count();
    output.set_muted(true);
    glBindTextureUnit(0, 0xdeadu);
    glFinish();
    output.set_muted(false);
    CHECK(output.error_count() == before + 1);
    const std::vector<std::string> errors = output.take_errors();
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].find("OpenGL error") == 0);
    CHECK(output.take_errors().empty());
}

TEST_CASE_FIXTURE(
    test::RenderTest,
    "context: a second device restores the message callback when it is destroyed") {
    const std::uint64_t before = device().debug_output().error_count();
    {
        Result<std::unique_ptr<gpu::Device>> second = gpu::Device::from_current_context();
        REQUIRE(second.ok());
        (*second)->debug_output().set_muted(true);
        glBindTextureUnit(0, 0xdeadu);
        CHECK((*second)->debug_output().error_count() == 1);
        CHECK(device().debug_output().error_count() == before);
    }
    device().debug_output().set_muted(true);
    glBindTextureUnit(0, 0xdeadu);
    device().debug_output().set_muted(false);
    CHECK(device().debug_output().error_count() == before + 1);
    CHECK(device().debug_output().take_errors().size() == 1);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "context: another thread's shared context sees the same buffers") {
    // The shared context is the test's own pair, as the fixture's context is not handed out.
    std::uint32_t value_read = 0;
    std::string failure;
    std::thread worker([&] {
        Result<std::unique_ptr<gpu::Context>> first = gpu::create_headless_context();
        if (!first) {
            failure = first.error().message;
            return;
        }
        const std::uint32_t value = 0x1234abcd;
        const gpu::Buffer buffer("shared", sizeof(value), gpu::BufferUse::Static, &value);
        glFinish();
        Result<std::unique_ptr<gpu::Context>> second =
            gpu::create_headless_context({.share = first->get()});
        if (!second) {
            failure = second.error().message;
            return;
        }
        value_read = buffer.read_value<std::uint32_t>(0);
        second->reset();
        if (!(*first)->make_current()) {
            failure = "the first context cannot be made current again";
        }
    });
    worker.join();
    CHECK(failure.empty());
    CHECK(value_read == 0x1234abcd);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "context: one that is current on another thread cannot be made current") {
    std::unique_ptr<gpu::Context> context;
    std::thread([&] {
        Result<std::unique_ptr<gpu::Context>> made = gpu::create_headless_context();
        REQUIRE(made.ok());
        context = *std::move(made);
        std::thread([&] { CHECK(!context->make_current()); }).join();
        context->release_current();
        context.reset();
    }).join();
}

TEST_CASE("context: LIMN_GL_DEVICE is obeyed and a wrong one is one clear line") {
    const bool has_hardware = !test::shared_device().caps().software;
    std::thread([has_hardware] {  // contexts are current per thread: the shared one stays untouched
        for (const char* wrong : {"99", "-1", "fast", "1x", "123456789012345678901234567890"}) {
            const DeviceChoice choice(wrong);
            const auto context = gpu::create_headless_context();
            REQUIRE(!context.ok());
            CHECK(context.error().message.find("LIMN_GL_DEVICE: ") == 0);
            CHECK(context.error().message.find("expected") != std::string::npos);
            CHECK(context.error().message.find('\n') == std::string::npos);
        }
        {
            const DeviceChoice choice("software");
            const auto context = gpu::create_headless_context();
            REQUIRE((context.ok() || has_hardware));  // which may be all there is
            if (context.ok()) {
                CHECK(gpu::read_device_caps().software);
            } else {
                CHECK(context.error().message.find("LIMN_GL_DEVICE") != std::string::npos);
            }
        }
        {
            const DeviceChoice choice("surfaceless");
            const auto context = gpu::create_headless_context();
            REQUIRE(context.ok());
            CHECK((*context)->origin() == "EGL surfaceless");
        }
    })
        .join();
}

TEST_CASE_FIXTURE(
    test::RenderTest,
    "context: a limit is met, and exceeded by one more" * technique("shade.profile")) {
    const gpu::DeviceCaps& caps = device().caps();
    gpu::PassRequirements needs;
    needs.fragment_textures = caps.max_fragment_textures;
    needs.samples = caps.max_samples;
    CHECK(gpu::check_requirements(caps, needs).empty());
    ++needs.fragment_textures;
    const auto errors = gpu::check_requirements(caps, needs);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].kind == gpu::ProfileErrorKind::Capacity);
    const Status status = gpu::require(caps, "glow", needs);
    REQUIRE(!status.ok());
    CHECK(status.error().message.find("glow: capacity: ") == 0);
}

TEST_CASE("context: an absent feature is a capability error" * technique("shade.profile")) {
    gpu::DeviceCaps caps;
    caps.max_combined_textures = 16;
    caps.max_vertex_textures = 0;
    const auto errors = gpu::check_requirements(caps, {.vertex_textures = 1});
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].kind == gpu::ProfileErrorKind::Capability);
}

TEST_CASE("context: the first version of a pass that fits is chosen" * technique("shade.profile")) {
    gpu::DeviceCaps caps;
    caps.max_samples = 4;
    caps.max_texture_size = 16384;
    const std::array<gpu::PassRequirements, 3> versions = {{
        {.texture_size = 16384, .samples = 8},
        {.texture_size = 16384, .samples = 4},
        {.texture_size = 1024},
    }};
    CHECK(gpu::choose_version(caps, versions) == 1);
    caps.max_samples = 8;
    CHECK(gpu::choose_version(caps, versions) == 0);
    caps.max_texture_size = 512;
    CHECK(gpu::choose_version(caps, versions) == -1);
}

}  // namespace
}  // namespace limn::context_test
