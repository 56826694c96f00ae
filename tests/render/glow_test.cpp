#include "ecs/components/glow.h"
#include "render/passes/glow_pass.h"
#include "tests/render/scene_fixture.h"

#include <algorithm>
#include <numeric>

namespace limn::test {
namespace {

/// A lamp before the dark.
void furnish(Scene& scene) {
    const MaterialId bright = scene.add(Material{
        .shading = ShadingModel::Unlit, .base_color = {1, 0.5f, 0.25f, 1}, .emission = {9, 4, 2}});
    Affine small = at({0.2f, -0.1f, 0});
    for (Vec4& row : small.row) {
        row = {0.25f * row.x, 0.25f * row.y, 0.25f * row.z, row.w};
    }
    scene.place(scene.add(make_square()), bright, small);
}

double sum_of(const gpu::FloatImage& image) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                sum += image.at(x, y, c);
            }
        }
    }
    return sum;
}

std::string pass_names() {
    std::string names;
    for (const PassTiming& timing : frame_graph(shared_renderer()).timings()) {
        names += std::string(timing.name) + '\n';
    }
    return names;
}

}  // namespace

TEST_CASE_FIXTURE(Scene, "glow: switched off, it adds no pass and changes no bit") {
    furnish(*this);
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 61, 48);
    static_cast<void>(draw(view));  // what surrounds the scene is mirrored once
    const gpu::FloatImage without = radiance(view);
    const std::string passes = pass_names();
    world.insert_resource(Glow{.strength = 0});
    CHECK(radiance(view).pixels == without.pixels);
    CHECK(pass_names() == passes);
    world.insert_resource(Glow{.strength = 0.5f});
    CHECK(radiance(view).pixels != without.pixels);
    CHECK(frame_graph(shared_renderer()).was_run("glow"));
}

TEST_CASE_FIXTURE(Scene, "glow: a picture of many samples glows once, with the sum of its light") {
    furnish(*this);
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 61, 48);
    const auto accumulated = [&] {
        return gpu::read_floats(*render_accumulated(shared_renderer(), world, view, 4).radiance);
    };
    const gpu::FloatImage without = accumulated();
    world.insert_resource(Glow{.strength = 0.5f});
    const gpu::FloatImage with = accumulated();
    CHECK(with.pixels != without.pixels);
    CHECK(sum_of(with) == doctest::Approx(sum_of(without)).epsilon(1e-4));
    for (const PassTiming& timing : frame_graph(shared_renderer()).timings()) {
        CHECK(timing.name != "accumulate");  // the frame that glows is the last one alone
    }
}

TEST_CASE("glow: the weights of the levels sum to 1, and the last one comes in gradually") {
    for (const float radius : {0.001f, 0.01f, 0.1f, 0.15f, 1.0f}) {
        const std::vector<float> weights = glow_weights({.radius = radius}, 640, 360);
        CHECK(
            std::accumulate(weights.begin(), weights.end(), 0.0)
            == doctest::Approx(1).epsilon(1e-6));
    }
    std::vector<float> before = glow_weights({.radius = 0.05f}, 640, 360);
    for (float radius = 0.05f; radius < 0.5f; radius *= 1.01f) {
        std::vector<float> weights = glow_weights({.radius = radius}, 640, 360);
        before.resize(weights.size());
        for (std::size_t i = 0; i < weights.size(); ++i) {
            CHECK(std::abs(weights[i] - before[i]) < 0.01f);
        }
        before = weights;
    }
    CHECK(glow_weights({.radius = 1}, 1, 1).size() == 1);
    CHECK(glow_weights({.radius = 1}, 16384, 9216).size() <= 14);
}

}  // namespace limn::test
