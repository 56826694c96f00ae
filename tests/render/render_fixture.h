#pragma once

#include "render/gpu/context.h"
#include "render/gpu/device.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

namespace limn::test {

// One headless debug context for all tests of the program, made when the first test draws and
// destroyed at exit. A test that uses RenderTest fails if OpenGL reported an error while it ran:
//
//     TEST_CASE_FIXTURE(test::RenderTest, "water: ...") { device().draw_fullscreen(); }

/// The shared device; without OpenGL the program stops and says why.
inline gpu::Device& shared_device() {
    struct Shared {
        std::unique_ptr<gpu::Context> context;
        std::unique_ptr<gpu::Device> device;
    };
    static const Shared shared = [] {
        const auto stop = [](const Error& error) {
            std::fprintf(stderr, "%s\n", error.message.c_str());
            std::exit(1);
        };
        Result<std::unique_ptr<gpu::Context>> context =
            gpu::create_headless_context({.debug = true});
        if (!context) {
            stop(context.error());
        }
        Result<std::unique_ptr<gpu::Device>> device = gpu::Device::from_current_context();
        if (!device) {
            stop(device.error());
        }
        return Shared{*std::move(context), *std::move(device)};
    }();
    return *shared.device;
}

class RenderTest {
  public:
    RenderTest() {
        device().debug_output().take_errors();
        device().invalidate_state();
    }
    ~RenderTest() {
        glFinish();
        for (const std::string& error : device().debug_output().take_errors()) {
            FAIL_CHECK(error);
        }
    }
    RenderTest(const RenderTest&) = delete;
    RenderTest& operator=(const RenderTest&) = delete;

    [[nodiscard]] static gpu::Device& device() { return shared_device(); }
};

}  // namespace limn::test
