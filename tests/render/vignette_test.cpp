#include "render/lens/vignette_pass.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

namespace limn::test::vignette_test {
namespace {

/// An evenly bright sky.
struct VignetteScene : Scene {
    VignetteScene() {
        world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = Vec3(1)});
    }
    RenderView view = look({0, 0, 0}, {0, 0, -1}, 64, 32);

    gpu::FloatImage with(const Vignette& settings) {
        world.insert_resource(settings);
        return radiance(view);
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    VignetteScene, "vignette: a uniform sky shows the cos^4 law and the pupil overlap") {
    const Vignette settings = {.natural = 0.7f, .mechanical = 0.6f};
    const gpu::FloatImage plain = radiance(view);
    const gpu::FloatImage dark = with(settings);
    for (const IVec2 p : {IVec2(0, 0), IVec2(63, 31), IVec2(40, 3), IVec2(31, 16), IVec2(5, 20)}) {
        const Vec2 ndc = 2.0f * (Vec2(p) + 0.5f) / Vec2(64, 32) - 1.0f;
        const float expected = vignette(settings, {ndc.x, -ndc.y}, view.tangent);
        CHECK(
            dark.at(p.x, p.y, 1)
            == test::near(expected * plain.at(p.x, p.y, 1)).epsilon(5e-4));  // half floats
    }
}

TEST_CASE(
    "vignette: it has the closed-form values on the axis, in the corners and at the limits"
    * technique("post.effect-pipeline")) {
    const Vec2 tangent = {2, 1};  // corners at tan = sqrt(5)
    CHECK(vignette({1, 1}, {0, 0}, tangent) == test::near(1));
    CHECK(vignette({1, 0}, {1, 1}, tangent) == test::near(1.0 / 36));
    CHECK(vignette({0, 1}, {1, 1}, tangent) == test::near(0).scale(1));
    // Two circles whose centers are a radius apart share 2/3 - sqrt(3)/(2 pi) of their area.
    CHECK(vignette({0, 0.5f}, {1, -1}, tangent) == test::near(0.3910).epsilon(1e-4));
    float last = 1;
    for (float x = 0; x <= 1; x += 0.125f) {
        const float fraction = vignette({0.5f, 0.5f}, {x, x}, tangent);
        CHECK(fraction <= last);
        last = fraction;
    }
}

TEST_CASE_FIXTURE(
    VignetteScene, "vignette: without it, or with invalid values, there is no pass and no NaN") {
    (void)with({});
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("vignette"));
    const gpu::FloatImage image = with({.natural = NAN, .mechanical = 1e9f});
    for (const float value : image.pixels) {
        CHECK(std::isfinite(value));
    }
}

}  // namespace limn::test::vignette_test
