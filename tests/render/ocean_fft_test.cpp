#include "render/gpu/readback.h"
#include "render/water/ocean_fft.h"
#include "systems/water/ocean_system.h"
#include "tests/render/render_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>

namespace limn::ocean_fft_test {
namespace {

constexpr double kTime = 12345.678;  // thousands of turns of the short waves

OceanState ocean_of(int resolution, int cascades) {
    const Ocean ocean = {
        .wind_speed = 7,
        .wind_direction = 0.8f,
        .choppiness = 1.2f,
        .cascades = cascades,
        .patch = 80,
        .resolution = resolution};
    OceanState state;
    step_ocean(ocean, kTime, 1.0f / 60.0f, state);
    return state;
}

OceanFft run_fft(gpu::Device& device, const OceanState& state) {
    Result<OceanFft> fft = create_ocean_fft(device, state);
    REQUIRE_MESSAGE(fft, fft.error().message);
    FrameGraph graph(device);
    graph.begin_frame();
    const OceanFieldIds ids = synthesize_ocean(graph, *fft, state.made_for.choppiness, state.time);
    graph.keep(ids.displacement);
    graph.keep(ids.derivatives);
    graph.execute();
    return *std::move(fft);
}

/// Largest difference between a channel and a field, over the largest value of the field.
double relative_error(const gpu::FloatImage& image, int channel, const std::vector<float>& field) {
    double error = 0;
    double largest = 0;
    for (int z = 0; z < image.height; ++z) {
        for (int x = 0; x < image.width; ++x) {
            const double expected = field[z * image.width + x];
            // The first row of an image is the last one of a texture.
            const double found = image.at(x, image.height - 1 - z, channel);
            error = std::max(error, std::abs(found - expected));
            largest = std::max(largest, std::abs(expected));
        }
    }
    return error / largest;
}

}  // namespace

TEST_CASE_FIXTURE(
    test::RenderTest, "ocean_fft: the GPU's fields match the simulation, within 1e-4 of the maximum"
                          * technique("water.fft-synthesis")) {
    for (const int size : {16, 32, 64, 128}) {
        const OceanState state = ocean_of(size, size == 64 ? 3 : 1);
        const OceanFft fft = run_fft(device(), state);
        for (int c = 0; c < fft.cascades; ++c) {
            const OceanCascade& cascade = state.cascades[c];
            const gpu::FloatImage moved = gpu::read_floats(fft.fields.displacement, 0, c);
            const gpu::FloatImage bent = gpu::read_floats(fft.fields.derivatives, 0, c);
            CAPTURE(size);
            CAPTURE(c);
            CHECK(relative_error(moved, 0, cascade.shift_x) < 1e-4);
            CHECK(relative_error(moved, 1, cascade.height) < 1e-4);
            CHECK(relative_error(moved, 2, cascade.shift_z) < 1e-4);
            CHECK(relative_error(moved, 3, cascade.shift_xz) < 1e-4);
            CHECK(relative_error(bent, 0, cascade.slope_x) < 1e-4);
            CHECK(relative_error(bent, 1, cascade.slope_z) < 1e-4);
            CHECK(relative_error(bent, 2, cascade.shift_xx) < 1e-4);
            CHECK(relative_error(bent, 3, cascade.shift_zz) < 1e-4);
        }
    }
}

TEST_CASE_FIXTURE(test::RenderTest, "ocean_fft: a cascade is independent of the others") {
    OceanState state = ocean_of(32, 3);
    const gpu::FloatImage among =
        gpu::read_floats(run_fft(device(), state).fields.displacement, 0, 1);
    state.cascades.erase(state.cascades.begin());
    const gpu::FloatImage first =
        gpu::read_floats(run_fft(device(), state).fields.displacement, 0, 0);
    CHECK(among.pixels == first.pixels);
}

TEST_CASE_FIXTURE(test::RenderTest, "ocean_fft: all cascades take two dispatches") {
    const OceanState state = ocean_of(16, 4);
    device().reset_stats();
    CHECK(run_fft(device(), state).cascades == 4);
    CHECK(device().stats().dispatches == 2);
}

}  // namespace limn::ocean_fft_test
