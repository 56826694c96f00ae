// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "bench/oracles/environment_oracle.h"
#include "render/environment/environment_light.h"
#include "render/environment/environment_maps.h"
#include "render/environment/panorama.h"
#include "render/gpu/buffer.h"
#include "render/graph/frame_graph.h"

#include <glm/geometric.hpp>

#include <cstring>
#include <random>

namespace limn::test::sky_panorama_test {
namespace {

/// Smooth but for a sun: a disc of 6 degrees, 200 times as bright as the rest.
glm::dvec3 afternoon(const glm::dvec3& d) {
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.6, 0.5, -0.3));
    const double disc = std::clamp((glm::dot(d, sun) - std::cos(0.06)) * 2000, 0.0, 1.0);
    const glm::dvec3 sky = glm::dvec3(0.4, 0.6, 1.0) + 0.4 * glm::dvec3(d.y, d.x, -d.z);
    return sky + 200.0 * disc * glm::dvec3(1, 0.9, 0.7);
}

/// What `mapping` shows of a radiance function.
ImageData picture_of(
    const oracle::RadianceFunction& radiance, PanoramaMapping mapping, int width, int height) {
    ImageData image;
    image.name = "panorama";
    image.width = width;
    image.height = height;
    image.format = PixelFormat::Rgba32F;
    std::vector<float> pixels;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double u = (x + 0.5) / width;
            const double v = 1 - (y + 0.5) / height;
            const double phi = 2 * 3.14159265358979 * (u - 0.5);
            glm::dvec3 d;
            if (mapping == PanoramaMapping::Angular) {
                const glm::dvec2 p(u - 0.5, v - 0.5);
                const double away = 2 * 3.14159265358979 * glm::length(p);
                d = glm::dvec3(
                    std::sin(away) * p.x / glm::length(p), std::cos(away),
                    std::sin(away) * p.y / glm::length(p));
            } else {
                const double latitude = mapping == PanoramaMapping::Cylindrical
                                            ? std::atan(2 * (v - 0.5))
                                            : 3.14159265358979 * (v - 0.5);
                d = glm::dvec3(
                    std::cos(latitude) * std::sin(phi), std::sin(latitude),
                    -std::cos(latitude) * std::cos(phi));
            }
            const glm::dvec3 color = radiance(d);
            for (int c = 0; c < 3; ++c) {
                pixels.push_back(static_cast<float>(color[c]));
            }
            pixels.push_back(1);
        }
    }
    image.pixels.resize(pixels.size() * sizeof(float));
    std::memcpy(image.pixels.data(), pixels.data(), image.pixels.size());
    return image;
}

std::vector<Vec3> random_directions(int count) {
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    std::vector<Vec3> directions;
    for (int i = 0; i < count; ++i) {
        directions.push_back(glm::normalize(Vec3(normal(random), normal(random), normal(random))));
    }
    return directions;
}

struct PanoramaScene : Scene {
    void surround(ImageData image, Environment environment = {}) {
        environment.sky = SkyKind::Panorama;
        environment.panorama = add(std::move(image));
        world.insert_resource(environment);
    }
    /// The background along `direction`, in an image of a pixel.
    Vec3 seen(const Vec3& direction) {
        return rgb_at(radiance(look({0, 0, 0}, direction, 1, 1)), 0, 0);
    }
};

/// A panorama as a cube map, and what is made of that.
struct MadeSurroundings {
    PanoramaPass panorama;
    ReflectionPass reflection;

    explicit MadeSurroundings(const ImageData& image) {
        gpu::Device& device = shared_device();
        Result<PanoramaPass> made_panorama = create_panorama_pass(device);
        Result<ReflectionPass> made_reflection = create_reflection_pass(device, 128);
        REQUIRE(made_panorama.ok());
        REQUIRE(made_reflection.ok());
        panorama = *std::move(made_panorama);
        reflection = *std::move(made_reflection);
        gpu::Texture source(
            "source",
            {.format = GL_RGBA32F, .width = image.width, .height = image.height, .levels = 0});
        source.upload<std::uint8_t>(image.pixels, GL_RGBA, GL_FLOAT);
        source.generate_mipmaps();
        layout::EnvironmentBlock block{};
        const gpu::Buffer block_buffer =
            gpu::Buffer::of("block", std::span<const layout::EnvironmentBlock>(&block, 1));
        const gpu::RingSlice block_slice = {nullptr, block_buffer.id(), 0, sizeof(block)};
        FrameGraph graph(device);
        graph.begin_frame();
        draw_panorama(graph, panorama, source, {});
        draw_cube_reflection(graph, reflection, block_slice, panorama.cube, 0, 256);
        graph.execute();
        maps.resize(reflection.maps.desc().levels);
        for (int level = 0; level < reflection.maps.desc().levels; ++level) {
            maps[level] = gpu::read_floats(reflection.maps, level, 0);
        }
    }
    std::vector<gpu::FloatImage> maps;
};

/// The direction of a texel of the octahedral map (lib/octahedral.glsl), y counted upward.
Vec3 octahedral_direction(int x, int y, int size) {
    const float half = 0.5f * static_cast<float>(size);
    const Vec2 p = (Vec2(x, y) + 0.5f - half) / (half - 1);
    Vec3 d = {p.x, 1 - std::abs(p.x) - std::abs(p.y), p.y};
    const float fold = std::max(-d.y, 0.0f);
    d.x -= std::copysign(fold, d.x);
    d.z -= std::copysign(fold, d.z);
    return glm::normalize(d);
}

}  // namespace

TEST_CASE_FIXTURE(
    PanoramaScene, "sky_panorama: the background is the panorama's color, with any mapping"
                       * technique("env.angular-map, env.panorama")) {
    const auto smooth = [](const glm::dvec3& d) {
        return glm::dvec3(1.5, 1, 2) + glm::dvec3(d.x * d.y, d.z, d.y);
    };
    for (const PanoramaMapping mapping :
         {PanoramaMapping::Equirectangular, PanoramaMapping::Cylindrical,
          PanoramaMapping::Angular}) {
        const bool disc = mapping == PanoramaMapping::Angular;
        surround(picture_of(smooth, mapping, 256, disc ? 256 : 128), {.mapping = mapping});
        for (const Vec3& d : random_directions(25)) {
            if (mapping == PanoramaMapping::Cylindrical && std::abs(d.y) > 0.7f) {
                continue;  // beyond the strip
            }
            CAPTURE(static_cast<int>(mapping));
            CAPTURE(d.y);
            // The disc's rim is a single direction, approached from every side: coarse there.
            const double slack = disc && d.y < -0.9f ? 0.1 : 0.02;
            CHECK(glm::distance(glm::dvec3(seen(d)), smooth(glm::dvec3(d))) < slack);
        }
    }
}

TEST_CASE_FIXTURE(
    PanoramaScene,
    "sky_panorama: it follows its rotation and has no seam" * technique("env.panorama")) {
    const auto quarters = [](const glm::dvec3& d) {
        return glm::dvec3(d.x > 0 ? 1 : 0, d.z > 0 ? 1 : 0, d.y > 0 ? 1 : 0);
    };
    const ImageData image = picture_of(quarters, PanoramaMapping::Equirectangular, 128, 64);
    surround(image);
    CHECK(glm::distance(seen({1, 1, 1}), {1, 1, 1}) < 1e-3f);
    CHECK(glm::distance(seen({-1, -1, 2}), {0, 1, 0}) < 1e-3f);
    CHECK(glm::distance(seen({-1, 1, -1}), {0, 0, 1}) < 1e-3f);
    // A quarter turn counter-clockwise, viewed from above, moves what lay at +x to -z.
    surround(image, {.intensity = 2, .rotation = radians(90.0f)});
    CHECK(glm::distance(seen({1, 1, 1}), {0, 2, 2}) < 1e-2f);
    CHECK(glm::distance(seen({1, 1, -1}), {2, 2, 2}) < 1e-2f);
    CHECK(glm::distance(seen({-1, -1, -1}), {2, 0, 0}) < 1e-2f);

    const auto even = [](const glm::dvec3&) { return glm::dvec3(0.5, 0.25, 1); };
    surround(picture_of(even, PanoramaMapping::Equirectangular, 64, 32));
    const gpu::FloatImage image_of_seam = radiance(look({0, 0, 0}, {0, 0.2f, 1}, 64, 64));
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            REQUIRE(glm::distance(rgb_at(image_of_seam, x, y), Vec3(0.5f, 0.25f, 1)) < 1e-3f);
        }
    }
}

TEST_CASE_FIXTURE(RenderTest, "sky_panorama: irradiance is the integral over the hemisphere") {
    const MadeSurroundings made(picture_of(afternoon, PanoramaMapping::Equirectangular, 512, 256));
    const auto irradiance = made.reflection.irradiance.read_value<layout::Irradiance>(0);
    double worst = 0;
    glm::dvec3 brightest(0);
    for (const Vec3& n : random_directions(24)) {
        const glm::dvec3 want = oracle::irradiance(afternoon, n, 400);
        const glm::dvec3 got = irradiance_toward(irradiance, n);
        worst = std::max(worst, glm::length(got - want));
        brightest = glm::max(brightest, want);
    }
    // What nine harmonics cannot follow of the sun's cosine.
    CHECK(worst < 0.04 * glm::length(brightest));

    const MadeSurroundings even(picture_of(
        [](const glm::dvec3&) { return glm::dvec3(0.5, 1, 2); }, PanoramaMapping::Equirectangular,
        64, 32));
    const auto flat = even.reflection.irradiance.read_value<layout::Irradiance>(0);
    for (const Vec3& n : random_directions(5)) {
        CHECK(glm::distance(irradiance_toward(flat, n), Vec3(0.5f, 1, 2)) < 1e-4f);
    }
}

TEST_CASE_FIXTURE(RenderTest, "sky_panorama: rough mirrors show the GGX mean, including the sun") {
    const auto overcast = [](const glm::dvec3& d) {
        return glm::dvec3(1, 2, 3) + glm::dvec3(d.y * d.y * d.y, d.x * d.z, d.z);
    };
    const auto error = [](const oracle::RadianceFunction& sky, const MadeSurroundings& made,
                          int level, double roughness) {
        const gpu::FloatImage& map = made.maps[level];
        std::mt19937 random(6);
        double squares = 0;
        double scale = 0;
        for (int i = 0; i < 40; ++i) {
            const int x = 1 + static_cast<int>(random() % (map.width - 2));
            const int y = 1 + static_cast<int>(random() % (map.width - 2));
            const glm::dvec3 want =
                oracle::prefiltered(sky, octahedral_direction(x, y, map.width), roughness, 256);
            const glm::dvec3 got = rgb_at(map, x, map.height - 1 - y);
            squares += glm::dot(got - want, got - want);
            scale += glm::dot(want, want);
        }
        return std::sqrt(squares / scale);
    };
    const MadeSurroundings even(picture_of(overcast, PanoramaMapping::Equirectangular, 256, 128));
    const MadeSurroundings sunny(picture_of(afternoon, PanoramaMapping::Equirectangular, 512, 256));
    const int levels = even.reflection.maps.desc().levels;
    REQUIRE(levels == 4);
    for (int level = 1; level < levels; ++level) {
        const double roughness = std::pow(level / double(levels - 1), 2);
        CAPTURE(roughness);
        CHECK(error(overcast, even, level, roughness) < 0.01);
        if (level > 1) {  // whose lobe is wider than a texel: the sun's edge is too soft before
            CHECK(error(afternoon, sunny, level, roughness) < 0.08);
        }
    }
}

TEST_CASE_FIXTURE(
    PanoramaScene, "sky_panorama: a white ball vanishes in a uniform one, at any roughness") {
    surround(picture_of(
        [](const glm::dvec3&) { return glm::dvec3(1); }, PanoramaMapping::Equirectangular, 32, 16));
    const MeshId mesh = add(make_ball(64));
    for (const float metalness : {0.0f, 1.0f}) {
        for (const float roughness : {0.1f, 0.5f, 1.0f}) {
            const Entity ball = place(
                mesh,
                add(Material{
                    .base_color = {1, 1, 1, 1}, .metalness = metalness, .roughness = roughness}),
                at({0, 0, 0}));
            const gpu::FloatImage image = radiance(look({0, 0, 2}, {0, 0, 0}, 48, 48));
            float worst = 0;
            for (int y = 0; y < 48; ++y) {
                for (int x = 0; x < 48; ++x) {
                    worst = std::max(worst, glm::distance(rgb_at(image, x, y), Vec3(1)));
                }
            }
            CAPTURE(metalness);
            CAPTURE(roughness);
            CHECK(worst < 0.035f);
            world.destroy(ball);
        }
    }
}

TEST_CASE_FIXTURE(
    PanoramaScene, "sky_panorama: a replaced image is noticed, a missing one is magenta") {
    const auto red = [](const glm::dvec3&) { return glm::dvec3(1, 0, 0); };
    const auto green = [](const glm::dvec3&) { return glm::dvec3(0, 1, 0); };
    surround(picture_of(red, PanoramaMapping::Equirectangular, 32, 16));
    CHECK(seen({1, 0, 0}) == Vec3(1, 0, 0));
    world.insert_resource(Assets{});
    surround(picture_of(green, PanoramaMapping::Equirectangular, 32, 16));
    CHECK(seen({1, 0, 0}) == Vec3(0, 1, 0));
    world.insert_resource(Environment{.sky = SkyKind::Panorama});
    CHECK(seen({1, 0, 0}) == Vec3(1, 0, 1));
    world.insert_resource(Environment{.sky = SkyKind::Panorama, .panorama = {77}});
    CHECK(seen({1, 0, 0}) == Vec3(1, 0, 1));
}

TEST_CASE_FIXTURE(
    PanoramaScene, "sky_panorama: radiance is clamped to the range of half floats, and to 0") {
    surround(picture_of(
        [](const glm::dvec3& d) { return glm::dvec3(1e9, -5, d.y); },
        PanoramaMapping::Equirectangular, 32, 16));
    const Vec3 color = seen({1, 0.5f, 0});
    CHECK(color.x == 65504);
    CHECK(color.y == 0);
    CHECK(std::isfinite(color.z));
}

TEST_CASE_FIXTURE(
    PanoramaScene,
    "sky_panorama: NaN texels give finite images, the rest of the sky is unchanged") {
    ImageData image = picture_of(
        [](const glm::dvec3& d) { return glm::dvec3(0.5, 0.6, 0.7) + 0.2 * d; },
        PanoramaMapping::Equirectangular, 64, 32);
    const auto pictures = [&](const ImageData& of) {
        surround(of);
        const Entity ball = place(
            add(make_ball(16)),
            add(Material{.base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = 0.4f}),
            at({0, 0, 0}));
        gpu::FloatImage drawn = radiance(look({0, 0, 2.5f}, {0, 0, 0}));
        world.destroy(ball);
        return drawn;
    };
    const gpu::FloatImage whole = pictures(image);
    const float broken[] = {NAN, INFINITY, -INFINITY, NAN};
    // Three texels right before the camera's eyes.
    for (const int at : {16 * 64 + 32, 10 * 64 + 36, 20 * 64 + 28}) {
        std::memcpy(
            image.pixels.data() + static_cast<std::size_t>(at) * sizeof broken, broken,
            sizeof broken);
    }
    const gpu::FloatImage found = pictures(image);
    int not_finite = 0;
    for (const float value : found.pixels) {
        not_finite += std::isfinite(value) ? 0 : 1;
    }
    CHECK(not_finite == 0);
    CHECK(rgb_at(found, 2, 2) == rgb_at(whole, 2, 2));  // far from them
}

}  // namespace limn::test::sky_panorama_test
