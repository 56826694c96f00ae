#include "tests/render/profile_renderer.h"

#include <utility>

namespace limn::test {

ProfileRenderer::ProfileRenderer(gpu::Profile profile, const RenderSettings& settings) {
    Result<std::unique_ptr<gpu::Device>> device = gpu::Device::from_current_context(profile);
    REQUIRE(device.ok());
    device_ = *std::move(device);
    Result<RendererPtr> renderer = create_renderer(*device_, settings);
    REQUIRE_MESSAGE(renderer.ok(), (renderer ? "" : renderer.error().message));
    renderer_ = *std::move(renderer);
    shared_device().invalidate_state();
}

ProfileRenderer::~ProfileRenderer() {
    renderer_.reset();
    device_.reset();
    shared_device().invalidate_state();
}

FrameOutput ProfileRenderer::draw(const World& world, const RenderView& view) {
    device_->invalidate_state();
    device_->reset_stats();
    const FrameOutput output = render_frame(*renderer_, world, view);
    shared_device().invalidate_state();
    return output;
}

gpu::FloatImage ProfileRenderer::radiance(const World& world, const RenderView& view) {
    return gpu::read_floats(*draw(world, view).radiance);
}

}  // namespace limn::test
