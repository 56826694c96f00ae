#include "tests/render/profile_renderer.h"
#include "tests/render/scene_fixture.h"

namespace limn::profile_test {
namespace {

using test::make_square;

TEST_CASE("profile: by default it follows the device") {
    const gpu::DeviceCaps& caps = test::shared_device().caps();
    CHECK((caps.profile == gpu::Profile::Software) == caps.software);
}

TEST_CASE_FIXTURE(test::Scene, "profile: a strong lamp on smooth metal gives finite radiance") {
    test::ProfileRenderer renderer(gpu::Profile::Gpu);
    const Material mirror = {.metalness = 1, .roughness = 0.02f};
    place(add(make_square()), add(mirror), affine_from({0, 0, 0}, {1, 0, 0, 0}, {4, 4, 1}));
    for (const float candela : {1e4f, 1e9f, 1e30f}) {
        const Entity lamp = shine(
            PointLight{.intensity = candela}, affine_from({0, 0.2f, 1}, {1, 0, 0, 0}, {1, 1, 1}));
        const FrameOutput frame = renderer.draw(world, look({0, 0, 1.5f}, {0, 0, 0}));
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
}  // namespace limn::profile_test
