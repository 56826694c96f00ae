#pragma once

#include "render/gpu/device.h"

#include <doctest/doctest.h>

namespace limn::test {

// One headless debug context for all tests of the program, made when the first test draws and
// destroyed at exit. A test that uses RenderTest fails if OpenGL reported an error while it ran:
//
//     TEST_CASE_FIXTURE(test::RenderTest, "water: ...") { device().draw_fullscreen(); }

/// The shared device; without OpenGL the program stops and says why.
gpu::Device& shared_device();

class RenderTest {
  public:
    RenderTest();
    ~RenderTest();
    RenderTest(const RenderTest&) = delete;
    RenderTest& operator=(const RenderTest&) = delete;

    [[nodiscard]] static gpu::Device& device() { return shared_device(); }
};

}  // namespace limn::test
