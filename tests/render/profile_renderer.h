#pragma once

#include "render/gpu/readback.h"
#include "render/render_frame.h"
#include "tests/render/render_fixture.h"

#include <memory>

namespace limn::test {

/// A renderer with the choices of a profile, whatever the device; separate from the shared one.
class ProfileRenderer {
  public:
    explicit ProfileRenderer(gpu::Profile profile, const RenderSettings& settings = {});
    ~ProfileRenderer();
    ProfileRenderer(const ProfileRenderer&) = delete;
    ProfileRenderer& operator=(const ProfileRenderer&) = delete;

    /// What the frame draws is kept until the next one.
    FrameOutput draw(const World& world, const RenderView& view);
    gpu::FloatImage radiance(const World& world, const RenderView& view);

    [[nodiscard]] const FrameGraph& graph() { return frame_graph(*renderer_); }
    /// Of the last frame.
    [[nodiscard]] const gpu::DeviceStats& stats() const { return device_->stats(); }

  private:
    std::unique_ptr<gpu::Device> device_;
    RendererPtr renderer_;
};

}  // namespace limn::test
