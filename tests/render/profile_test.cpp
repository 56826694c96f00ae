#include "tests/render/scene_fixture.h"

namespace limn {
namespace {

using test::make_square;

/// A world rendered with the GPU profile, whatever the device.
class GpuProfileScene : public test::Scene {
  public:
    GpuProfileScene() {
        Result<std::unique_ptr<gpu::Device>> made =
            gpu::Device::from_current_context(gpu::Profile::Gpu);
        REQUIRE(made.ok());
        device_ = *std::move(made);
        Result<RendererPtr> renderer = create_renderer(*device_);
        REQUIRE_MESSAGE(renderer.ok(), (renderer ? "" : renderer.error().message));
        renderer_ = *std::move(renderer);
    }
    ~GpuProfileScene() {
        renderer_.reset();
        device_.reset();
        device().invalidate_state();
    }

    FrameOutput draw_with_gpu_profile(const RenderView& view) {
        return render_frame(*renderer_, world, view);
    }

  private:
    std::unique_ptr<gpu::Device> device_;
    RendererPtr renderer_;
};

TEST_CASE("profile: by default it follows the device") {
    const gpu::DeviceCaps& caps = test::shared_device().caps();
    CHECK((caps.profile == gpu::Profile::Software) == caps.software);
}

TEST_CASE_FIXTURE(GpuProfileScene, "profile: a strong lamp on smooth metal gives finite radiance") {
    const Material mirror = {.metalness = 1, .roughness = 0.02f};
    place(add(make_square()), add(mirror), affine_from({0, 0, 0}, {1, 0, 0, 0}, {4, 4, 1}));
    for (const float candela : {1e4f, 1e9f, 1e30f}) {
        const Entity lamp = shine(
            PointLight{.intensity = candela}, affine_from({0, 0.2f, 1}, {1, 0, 0, 0}, {1, 1, 1}));
        const FrameOutput frame = draw_with_gpu_profile(look({0, 0, 1.5f}, {0, 0, 0}));
        CHECK(frame.radiance->desc().format == GL_RGBA16F);
        const gpu::FloatImage image = gpu::read_floats(*frame.radiance);
        float largest = 0;
        for (const float value : image.pixels) {
            CHECK(std::isfinite(value));
            largest = std::max(largest, value);
        }
        CHECK(largest <= 65504.0f);
        CHECK(largest > 1000.0f);
        world.destroy(lamp);
    }
}

}  // namespace
}  // namespace limn
