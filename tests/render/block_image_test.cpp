#include "content/bake/block_image.h"
#include "ecs/base/block_texture.h"
#include "ecs/components/image_blocks.h"
#include "render/material/drawn_image.h"
#include "render/material/image_pool.h"
#include "tests/render/profile_renderer.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace limn::test::block_image_test {
namespace {

/// Random blocks, of BC7 with all modes alike.
ImageData random_blocks(PixelFormat format, int width, int height) {
    ImageData image;
    image.name = "blocks";
    image.width = width;
    image.height = height;
    image.format = format;
    std::mt19937 random(11);
    image.pixels.resize(image_bytes(image));
    for (std::uint8_t& byte : image.pixels) {
        byte = static_cast<std::uint8_t>(random());
    }
    for (std::size_t i = 0; i < image.pixels.size() && format == PixelFormat::Bc7;
         i += kBlockBytes) {
        const auto mode = static_cast<int>(i / kBlockBytes % 9);  // 8: reserved
        image.pixels[i] = static_cast<std::uint8_t>(
            mode == 8 ? 0 : (image.pixels[i] & ~((2 << mode) - 1)) | (1 << mode));
    }
    return image;
}

gpu::Texture upload(const ImageData& image, GLenum format) {
    gpu::Texture texture(
        "blocks", {.format = format,
                   .width = image.width,
                   .height = image.height,
                   .levels = image.mip_levels});
    for (int level = 0; level < image.mip_levels; ++level) {
        texture.upload(std::as_bytes(level_pixels(image, level)), level);
    }
    return texture;
}

/// The texels of a level as shaders read them, times 255.
std::vector<Vec4> fetched(const gpu::Texture& texture, int level) {
    std::vector<Vec4> positions;
    for (int y = 0; y < texture.height(level); ++y) {
        for (int x = 0; x < texture.width(level); ++x) {
            positions.emplace_back(x, y, level, 0);
        }
    }
    shared_device().bind_texture(0, texture);
    return evaluate_shader(
        "layout(binding = 0) uniform sampler2D blocks;",
        "y = 255.0 * texelFetch(blocks, ivec2(x.xy), int(x.z));", positions);
}

float largest_error(const std::vector<Vec4>& found, const ImageData& expected, int channels) {
    REQUIRE(4 * found.size() == expected.pixels.size());
    float error = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (int c = 0; c < channels; ++c) {
            const auto wanted =
                static_cast<float>(expected.pixels[4 * i + static_cast<std::size_t>(c)]);
            error = std::max(error, std::abs(found[i][c] - wanted));
        }
    }
    return error;
}

/// A channel of BC5, not rounded: of the two first bytes, what six more select for each texel in 3
/// bits (Khronos Data Format Specification 1.3, "RGTC").
double exact_bc5(const ImageData& image, int x, int y, int channel) {
    const int block =
        y / kBlockSide * ((image.width + kBlockSide - 1) / kBlockSide) + x / kBlockSide;
    const auto at = static_cast<std::size_t>(kBlockBytes * block + 8 * channel);
    const double first = image.pixels[at];
    const double second = image.pixels[at + 1];
    std::uint64_t codes = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        codes |= static_cast<std::uint64_t>(image.pixels[at + 2 + i]) << (8 * i);
    }
    const auto code =
        static_cast<int>(codes >> (3 * (kBlockSide * (y % kBlockSide) + x % kBlockSide)) & 7);
    if (code < 2) {
        return code == 0 ? first : second;
    }
    if (first > second) {
        return ((8 - code) * first + (code - 1) * second) / 7;
    }
    return code == 6 ? 0 : code == 7 ? 255 : ((6 - code) * first + (code - 1) * second) / 5;
}

/// A square that an image covers, lit from the side.
void place_square(Scene& scene, const Material& material) {
    scene.place(scene.add(make_square()), scene.add(material), at({0, 0, 0}));
    scene.shine(DirectionalLight{.illuminance = 3}, look_at({0, 0, 0}, {-1, 0, -1}));
}

ImageData waves(bool normals) {
    ImageData image;
    image.name = "waves";
    image.width = 64;
    image.height = 48;
    image.srgb = !normals;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const Vec3 n = glm::normalize(Vec3(
                0.5f * std::sin(0.3f * static_cast<float>(x)),
                0.4f * std::cos(0.2f * static_cast<float>(y)), 1));
            const Vec3 color = normals ? 0.5f * n + 0.5f : 0.6f + 0.4f * n;
            for (int c = 0; c < 3; ++c) {
                image.pixels.push_back(static_cast<std::uint8_t>(255 * color[c] + 0.5f));
            }
            image.pixels.push_back(255);
        }
    }
    return image;
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "block images: BC7 of any mode is decoded to the bits that the GPU samples"
                    * technique("engine.opt-texture")) {
    const ImageData image = random_blocks(PixelFormat::Bc7, 255, 254);
    const gpu::Texture texture = upload(image, GL_COMPRESSED_RGBA_BPTC_UNORM);
    CHECK(largest_error(fetched(texture, 0), decoded_level(image), 4) < 1e-3f);
}

TEST_CASE_FIXTURE(
    RenderTest, "block images: BC5 is decoded to what the GPU samples, within 2 / 255"
                    * technique("engine.opt-texture")) {
    const ImageData image = random_blocks(PixelFormat::Bc5, 97, 66);
    const gpu::Texture texture = upload(image, GL_COMPRESSED_RG_RGTC2);
    const std::vector<Vec4> found = fetched(texture, 0);
    const ImageData decoded = decoded_level(image);
    double ours = 0;
    double theirs = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (int c = 0; c < 2; ++c) {
            const int at = static_cast<int>(i);
            const double exact = exact_bc5(image, at % image.width, at / image.width, c);
            const double mine = decoded.pixels[4 * i + static_cast<std::size_t>(c)];
            ours = std::max(ours, std::abs(mine - exact));
            theirs = std::max(theirs, std::abs(static_cast<double>(found[i][c]) - exact));
        }
    }
    // Ours is the exact value, rounded. llvmpipe interpolates in fixed point and is up to 1.6 off,
    // on either side, so that no decoder that rounds correctly is within 1 of it.
    CHECK(ours <= 0.5);
    CHECK(theirs <= 1.61);
    CHECK(largest_error(found, decoded, 2) <= 2.001f);
    CHECK(std::all_of(found.begin(), found.end(), [](const Vec4& texel) {
        return texel.z == 0 && texel.w == 255;  // what shaders restore z by
    }));
}

TEST_CASE_FIXTURE(
    RenderTest, "block images: all levels of any size are uploaded, a quarter of the memory"
                    * technique("engine.opt-texture")) {
    for (const IVec2& size : {IVec2(64, 48), IVec2(13, 6), IVec2(1, 1), IVec2(3, 9)}) {
        ImageData image = waves(false);
        image.width = size.x;
        image.height = size.y;
        image.pixels.resize(4 * static_cast<std::size_t>(size.x * size.y));
        const ImageData blocks = encode_blocks(image, {.kind = TexelKind::Data});
        const std::int64_t before = gpu::gpu_memory_bytes();
        const gpu::Texture texture = upload(blocks, GL_COMPRESSED_RGBA_BPTC_UNORM);
        CHECK(gpu::gpu_memory_bytes() - before == static_cast<std::int64_t>(image_bytes(blocks)));
        for (int level = 0; level < blocks.mip_levels; ++level) {
            CHECK(largest_error(fetched(texture, level), decoded_level(blocks, level), 4) < 1e-3f);
        }
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "block images: the pool keeps blocks with the profile of a GPU, decodes them else"
                    * technique("engine.opt-texture")) {
    const std::vector<ImageData> images = {
        encode_blocks(waves(false), {}),
        encode_blocks(waves(true), {.format = PixelFormat::Bc5, .kind = TexelKind::Normal})};
    for (const gpu::Profile profile : {gpu::Profile::Gpu, gpu::Profile::Software}) {
        const bool keeps = profile == gpu::Profile::Gpu;
        const std::unique_ptr<gpu::Device> device = *gpu::Device::from_current_context(profile);
        ImagePool pool(*device);
        const std::int64_t before = gpu::gpu_memory_bytes();
        const std::vector<std::string> messages = messages_of([&] {
            pool.update(images, {{1, NormalMips::Toksvig}});
        });
        CHECK(messages.size() == (keeps ? 0 : 1));
        const auto blocks = static_cast<std::int64_t>(image_bytes(images[0]));
        const std::int64_t texels = gpu::texture_bytes({.width = 64, .height = 48, .levels = 0});
        CHECK(gpu::gpu_memory_bytes() - before == (keeps ? 2 * blocks + texels : 3 * texels));
        const gpu::Texture& color = *pool.find_texture({0});
        CHECK(color.desc().levels == 7);
        CHECK(
            color.desc().format
            == static_cast<GLenum>(keeps ? GL_COMPRESSED_SRGB_ALPHA_BPTC_UNORM : GL_SRGB8_ALPHA8));
        CHECK((find_drawn_image(pool, {0}).array == 0) == keeps);
        CHECK(pool.find_spread({1}).array != 0);
        // Its own levels, not those that OpenGL makes of the first.
        const gpu::Texture linear =
            color.view("codes", keeps ? GL_COMPRESSED_RGBA_BPTC_UNORM : GL_RGBA8);
        for (int level = 0; level < 7; ++level) {
            CHECK(
                largest_error(fetched(linear, level), decoded_level(images[0], level), 4) < 1e-3f);
        }
    }
    shared_device().invalidate_state();
}

TEST_CASE_FIXTURE(
    Scene, "block images: a surface with BC5 normals and BC7 color looks as with RGBA8"
               * technique("engine.opt-texture, bump.normal-encoding")) {
    const ImageData color = waves(false);
    const ImageData normals = waves(true);
    Material plain;
    plain.base_color = {1, 1, 1, 1};
    plain.base_color_texture.image = add(color);
    plain.normal_texture.image = add(normals);
    Material packed = plain;
    packed.base_color_texture.image = add(encode_blocks(color, {}));
    packed.normal_texture.image =
        add(encode_blocks(normals, {.format = PixelFormat::Bc5, .kind = TexelKind::Normal}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 96, 96);
    place_square(*this, plain);
    for (const gpu::Profile profile : {gpu::Profile::Gpu, gpu::Profile::Software}) {
        ProfileRenderer renderer(profile);
        world.resource<Assets>().materials[0] = plain;
        ++world.resource<Assets>().material_version;
        const gpu::FloatImage expected = renderer.radiance(world, view);
        world.resource<Assets>().materials[0] = packed;
        ++world.resource<Assets>().material_version;
        const gpu::FloatImage found = renderer.radiance(world, view);
        float brightest = 0;
        for (const float value : expected.pixels) {
            brightest = std::max(brightest, value);
        }
        CHECK(brightest > 0.2f);
        const float difference = largest_difference(found, expected);
        CHECK(difference < 0.04f * brightest);
        CHECK(difference > 0);
    }
}

}  // namespace limn::test::block_image_test
