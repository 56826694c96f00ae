#include "tests/render/render_fixture.h"

#include "render/gpu/context.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

namespace limn::test {

gpu::Device& shared_device() {
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

RenderTest::RenderTest() {
    device().debug_output().take_errors();
    device().invalidate_state();
}

RenderTest::~RenderTest() {
    glFinish();
    for (const std::string& error : device().debug_output().take_errors()) {
        FAIL_CHECK(error);
    }
}

}  // namespace limn::test
