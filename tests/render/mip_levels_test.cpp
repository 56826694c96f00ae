#include "render/gpu/mip_levels.h"
#include "render/gpu/readback.h"
#include "tests/near.h"
#include "tests/render/render_fixture.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace limn::test::mip_levels_test {
namespace {

constexpr gpu::Profile kProfiles[] = {gpu::Profile::Software, gpu::Profile::Gpu};

/// A texture of uneven values, 0 .. 1, with all levels, filled as with the profile.
gpu::Texture uneven_texture(gpu::Profile profile, GLenum format, const IVec2& size) {
    gpu::Texture texture(
        "levels", {.format = format, .width = size.x, .height = size.y, .levels = 0});
    std::vector<Vec4> texels;
    for (int i = 0; i < size.x * size.y; ++i) {
        const auto x = static_cast<float>(i);
        texels.emplace_back(
            std::fmod(0.618f * x, 1.0f), std::fmod(0.755f * x, 1.0f), std::fmod(0.1f * x, 1.0f), 1);
    }
    texture.upload<Vec4>(texels, GL_RGBA, GL_FLOAT);
    const std::unique_ptr<gpu::Device> device = *gpu::Device::from_current_context(profile);
    fill_mip_levels(*device, *create_mip_levels(*device), texture);
    CHECK(
        device->stats().dispatches
        == (profile == gpu::Profile::Gpu ? texture.desc().levels - 1 : 0));
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    shared_device().invalidate_state();
    return texture;
}

/// Filtered linearly at the center of texel (x, y) of the next smaller level.
double sampled(const gpu::FloatImage& image, const gpu::FloatImage& smaller, int x, int y, int c) {
    const double u = (x + 0.5) * image.width / smaller.width - 0.5;
    const double v = (y + 0.5) * image.height / smaller.height - 0.5;
    const auto at = [&](double column, double row) {
        return static_cast<double>(image.at(
            std::clamp(static_cast<int>(column), 0, image.width - 1),
            std::clamp(static_cast<int>(row), 0, image.height - 1), c));
    };
    const double left = std::floor(u);
    const double top = std::floor(v);
    return std::lerp(
        std::lerp(at(left, top), at(left + 1, top), u - left),
        std::lerp(at(left, top + 1), at(left + 1, top + 1), u - left), v - top);
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "mip levels: each computed level is the finer one sampled at its texel centers") {
    for (const auto& [format, rounding] :
         {std::pair(GL_RGBA32F, 1e-5), std::pair(GL_RG32F, 1e-5), std::pair(GL_RGBA16F, 1e-3)}) {
        for (const IVec2& size : {IVec2(64, 32), IVec2(37, 21), IVec2(1, 9), IVec2(3, 1)}) {
            const gpu::Texture texture = uneven_texture(gpu::Profile::Gpu, format, size);
            REQUIRE(texture.desc().levels > 1);
            double largest = 0;
            for (int level = 1; level < texture.desc().levels; ++level) {
                const gpu::FloatImage above = gpu::read_floats(texture, level - 1);
                const gpu::FloatImage image = gpu::read_floats(texture, level);
                for (int i = 0; i < image.width * image.height * image.channels; ++i) {
                    const int c = i % image.channels;
                    const int x = i / image.channels % image.width;
                    const int y = i / image.channels / image.width;
                    const auto found = static_cast<double>(image.at(x, y, c));
                    largest = std::max(largest, std::abs(found - sampled(above, image, x, y, c)));
                }
            }
            // Hardware filters with weights of 8 bits.
            CHECK(largest < (device().caps().software ? rounding : rounding + 1.0 / 256));
        }
    }
}

TEST_CASE_FIXTURE(RenderTest, "mip levels: with power-of-two sides all levels have the same mean") {
    for (const gpu::Profile profile : kProfiles) {
        const gpu::Texture texture = uneven_texture(profile, GL_RGBA32F, {64, 16});
        for (int c = 0; c < 3; ++c) {
            std::vector<double> means;
            for (int level = 0; level < 5; ++level) {
                const gpu::FloatImage image = gpu::read_floats(texture, level);
                double sum = 0;
                for (int i = 0; i < image.width * image.height; ++i) {
                    sum += static_cast<double>(image.at(i % image.width, i / image.width, c));
                }
                means.push_back(sum / (image.width * image.height));
                CHECK(means.back() == near(means[0]).epsilon(1e-5));
            }
        }
    }
}

}  // namespace limn::test::mip_levels_test
