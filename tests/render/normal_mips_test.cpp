#include "ecs/components/rendering.h"
#include "render/material/image_pool.h"
#include "render/material/normal_mips.h"
#include "tests/near.h"
#include "tests/render/normal_images.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace limn::test::normal_mips_test {
namespace {

using DVec3 = glm::dvec3;

constexpr NormalMips kAllMips[] = {NormalMips::Plain, NormalMips::Toksvig, NormalMips::Lean};

ImageData image_of_bytes(int width, int height, const std::vector<std::uint8_t>& bytes) {
    return {.name = "normals", .width = width, .height = height, .pixels = bytes};
}

/// Leaning along tangent and bitangent by these slopes.
Vec3 leaning(float x, float y) {
    return glm::normalize(Vec3(x, y, 1));
}

ImageData random_bumps(int width, int height) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> slope(-0.5f, 0.5f);
    std::vector<Vec3> normals;
    for (int i = 0; i < width * height; ++i) {
        const float along = slope(random);
        normals.push_back(leaning(along, 0.4f * slope(random) + 0.5f * along));
    }
    return image_of_normals(width, normals);
}

Vec4 float_texel(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    Vec4 texel;
    std::memcpy(&texel, bytes.data() + at * sizeof texel, sizeof texel);
    return texel;
}

Vec3 decoded_normal(const Vec4& texel) {
    return Vec3(texel) * 2.0f - 1.0f;
}

/// Variances along tangent and bitangent, and the covariance.
Vec3 decoded_spread(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    const Vec3 texel = Vec3(bytes[4 * at], bytes[4 * at + 1], bytes[4 * at + 2]) / 255.0f;
    return {texel.x * texel.x, texel.y * texel.y, (2 * texel.z - 1) * texel.x * texel.y};
}

/// Of the normals and slopes of a rectangle of an image of floats.
struct BumpMeans {
    DVec3 normal = DVec3(0);
    glm::dvec2 slope = {0, 0};
    DVec3 square = DVec3(0);  ///< about the mean slope
};

BumpMeans means_of(
    const ImageData& image, std::size_t left, std::size_t top, std::size_t columns,
    std::size_t rows) {
    BumpMeans means;
    const double share = 1.0 / static_cast<double>(columns * rows);
    for (std::size_t y = top; y < top + rows; ++y) {
        for (std::size_t x = left; x < left + columns; ++x) {
            const std::size_t at = y * static_cast<std::size_t>(image.width) + x;
            const DVec3 n(decoded_normal(float_texel(image.pixels, at)));
            const glm::dvec2 slope(n.x / n.z, n.y / n.z);
            means.normal += share * n;
            means.slope += share * slope;
            means.square += share * DVec3(slope.x * slope.x, slope.y * slope.y, slope.x * slope.y);
        }
    }
    const glm::dvec2 b = means.slope;
    means.square -= DVec3(b.x * b.x, b.y * b.y, b.x * b.y);
    return means;
}

/// A plane with so many bumps in a pixel that each sees the coarsest level of their map.
struct FarBumps : Scene {
    MaterialId material = add(Material{});

    FarBumps() {
        place(add(make_square()), material, at({0, 0, 0}));
        shine(
            PointLight{.color = {1, 0.9f, 0.8f}, .intensity = 3, .radius = 0},
            at({0.3f, 0.2f, 0.8f}));
    }
    gpu::FloatImage with(const Material& m) {
        auto& assets = world.resource<Assets>();
        assets.materials[material.index] = m;
        ++assets.material_version;
        return radiance(look({0, 0, 1}, {0, 0, 0}, 32, 32));
    }
    Material bumpy(Material m, const std::vector<Vec3>& normals, NormalMips mips) {
        m.normal_texture = {
            .image = add(image_of_normals(static_cast<int>(normals.size()), normals)),
            .scale = {512, 512}};
        m.normal_mips = mips;
        return m;
    }
};

float brightest(const gpu::FloatImage& image) {
    return *std::ranges::max_element(image.pixels);
}

const std::vector<Vec3> kRidges = {leaning(0.57735f, 0), leaning(-0.57735f, 0)};  // 30 degrees

}  // namespace

TEST_CASE(
    "normal mips: normals 30 degrees to either side have the mean (0, 0, 1)"
    * technique("bump.mipmap")) {
    for (const NormalMips mips : kAllMips) {
        const auto levels = make_normal_levels(image_of_normals(2, kRidges), mips);
        REQUIRE(levels.size() == 2);
        CHECK(levels[0].normals.empty());
        const Vec3 mean = decoded_normal(float_texel(levels[1].normals, 0));
        CHECK(glm::distance(mean, Vec3(0, 0, 1)) < 1e-6f);
        CHECK(levels[1].spread.empty() == (mips == NormalMips::Plain));
    }
}

TEST_CASE("normal mips: all normals are unit, of levels of any size" * technique("bump.mipmap")) {
    std::mt19937 random(3);
    std::vector<std::uint8_t> bytes(4 * 13 * 6);
    for (std::uint8_t& byte : bytes) {
        byte = static_cast<std::uint8_t>(random());
    }
    for (const NormalMips mips : kAllMips) {
        const auto levels = make_normal_levels(image_of_bytes(13, 6, bytes), mips);
        REQUIRE(levels.size() == 4);  // 13x6, 6x3, 3x1, 1x1
        const std::array<std::size_t, 4> sizes = {78, 18, 3, 1};
        for (std::size_t level = 1; level < 4; ++level) {
            REQUIRE(levels[level].normals.size() == 4 * sizes[level]);
            for (std::size_t i = 0; i < levels[level].normals.size(); i += 4) {
                const std::uint8_t* texel = levels[level].normals.data() + i;
                const Vec3 n = Vec3(texel[0], texel[1], texel[2]) / 127.5f - 1.0f;
                CHECK(std::abs(glm::length(n) - 1) <= std::sqrt(3.0f) * 0.5f / 127.5f);
            }
        }
    }
}

TEST_CASE(
    "normal mips: a constant map stays constant and has no spread" * technique("bump.mipmap")) {
    for (const std::array<std::uint8_t, 4> color :
         {std::array<std::uint8_t, 4>{128, 128, 255, 9}, {37, 128, 218, 255}, {70, 200, 220, 0}}) {
        std::vector<std::uint8_t> bytes;
        for (int i = 0; i < 7 * 4; ++i) {
            bytes.insert(bytes.end(), color.begin(), color.end());
        }
        for (const NormalMips mips : kAllMips) {
            for (const NormalLevel& level : make_normal_levels(image_of_bytes(7, 4, bytes), mips)) {
                for (std::size_t i = 0; i < level.normals.size(); ++i) {
                    // The normals of the image need not be unit.
                    const int tolerance = color[0] == 70 ? 2 : 1;
                    CHECK(std::abs(level.normals[i] - color[i % 4]) <= tolerance);
                }
                for (std::size_t i = 0; i < level.spread.size(); i += 4) {
                    CHECK(level.spread[i] == 0);
                    CHECK(level.spread[i + 1] == 0);
                }
            }
        }
    }
}

TEST_CASE(
    "normal mips: opposite normals become (0, 0, 1), as rough as can be"
    * technique("bump.mipmap")) {
    const ImageData opposite = image_of_bytes(2, 1, {255, 128, 128, 255, 0, 127, 127, 255});
    for (const NormalMips mips : kAllMips) {
        const auto levels = make_normal_levels(opposite, mips);
        CHECK(levels[1].normals == std::vector<std::uint8_t>{128, 128, 255, 255});
        CHECK((mips == NormalMips::Plain || levels[1].spread[0] == 255));
    }
}

TEST_CASE(
    "normal mips: Toksvig's shininess 20 becomes 4.885 where the mean has length 0.866"
    * technique("bump.mipmap")) {
    const auto levels = make_normal_levels(image_of_normals(2, kRidges), NormalMips::Toksvig);
    const Vec3 spread = decoded_spread(levels[1].spread, 0);
    const double length = std::sqrt(0.75);
    CHECK(spread.x == near((1 - length) / length).epsilon(0.01));
    CHECK(spread.y == spread.x);
    const std::vector<Vec4> found = evaluate_shader(
        "#define SHADE_BLINN\n#include \"lib/reflector.glsl\"",
        "y.xy = wider_highlight(x.x, x.y); y.z = length(y.xy - wider_highlight(x.x, x.z));",
        {{20, (1 - length) / length, spread.x, 0}, {20, 0, 0, 0}});
    CHECK(found[0].x == near(4.885).epsilon(1e-4));
    CHECK(found[0].y == near(5.885 / 21).epsilon(1e-4));
    CHECK(found[0].z < 0.05f);  // 8 bits
    CHECK(found[1].x == 20);
    CHECK(found[1].y == 1);
}

TEST_CASE(
    "normal mips: LEAN keeps the covariance of the slopes that a texel covers"
    * technique("bump.mipmap")) {
    const int width = 5;
    const int height = 3;
    const ImageData image = random_bumps(width, height);
    const auto levels = make_normal_levels(image, NormalMips::Lean);
    REQUIRE(levels.size() == 3);
    // A texel of level 1 covers two and a half texels of each row, so five halves.
    for (std::size_t texel = 0; texel < 2; ++texel) {
        DVec3 square(0);
        double x = 0;
        double y = 0;
        int count = 0;
        for (std::size_t half = 5 * texel; half < 5 * texel + 5; ++half) {
            for (std::size_t row = 0; row < 3; ++row) {
                const DVec3 n(decoded_normal(float_texel(image.pixels, 5 * row + half / 2)));
                x += n.x / n.z;
                y += n.y / n.z;
                square += DVec3(n.x * n.x, n.y * n.y, n.x * n.y) / (n.z * n.z);
                ++count;
            }
        }
        x /= count;
        y /= count;
        const DVec3 covariance = square / static_cast<double>(count) - DVec3(x * x, y * y, x * y);
        const Vec3 found = decoded_spread(levels[1].spread, texel);
        CHECK(std::sqrt(found.x) == near(std::sqrt(covariance.x)).scale(1).epsilon(0.51 / 255));
        CHECK(std::sqrt(found.y) == near(std::sqrt(covariance.y)).scale(1).epsilon(0.51 / 255));
        CHECK(found.z == near(covariance.z).scale(0.1).epsilon(0.02));
        const Vec3 mean = decoded_normal(float_texel(levels[1].normals, texel));
        CHECK(mean.x / mean.z == near(x).scale(1).epsilon(1e-5));
        CHECK(mean.y / mean.z == near(y).scale(1).epsilon(1e-5));
    }
}

TEST_CASE(
    "normal mips: a texel of any level has the means over the texels of the image that it covers"
    * technique("bump.mipmap")) {
    constexpr std::size_t kWidth = 16;
    const ImageData image = random_bumps(kWidth, 8);
    for (const NormalMips mips : kAllMips) {
        const auto levels = make_normal_levels(image, mips);
        REQUIRE(levels.size() == 5);  // the last two are of 2x1 and 1x1 texels
        for (std::size_t level = 1; level < levels.size(); ++level) {
            const std::size_t columns = std::size_t{1} << level;
            const std::size_t rows = std::min<std::size_t>(columns, 8);
            for (std::size_t texel = 0; texel < kWidth * 8 / (columns * rows); ++texel) {
                const std::size_t x = texel % (kWidth / columns) * columns;
                const std::size_t y = texel / (kWidth / columns) * rows;
                const BumpMeans means = means_of(image, x, y, columns, rows);
                const Vec3 found = decoded_normal(float_texel(levels[level].normals, texel));
                const DVec3 expected = mips == NormalMips::Lean
                                           ? DVec3(means.slope.x, means.slope.y, 1)
                                           : means.normal;
                CHECK(glm::distance(DVec3(found), glm::normalize(expected)) < 1e-5);
                if (mips == NormalMips::Plain) {
                    continue;
                }
                const double length = glm::length(means.normal);
                const DVec3 variances =
                    mips == NormalMips::Lean ? means.square : DVec3((1 - length) / length);
                const Vec3 spread = decoded_spread(levels[level].spread, texel);
                CHECK(std::abs(std::sqrt(spread.x) - std::sqrt(variances.x)) < 0.51 / 255);
                CHECK(std::abs(std::sqrt(spread.y) - std::sqrt(variances.y)) < 0.51 / 255);
            }
        }
    }
}

TEST_CASE(
    "normal mips: bytes, halves and floats of one image have the same levels, and keep its alpha"
    * technique("bump.mipmap")) {
    // Bytes, and the same normals as halves and floats.
    ImageData bytes = image_of_bytes(4, 2, {});
    ImageData halves = {
        .name = "halves", .width = 4, .height = 2, .format = PixelFormat::Rgba16F, .pixels = {}};
    ImageData floats = halves;
    floats.format = PixelFormat::Rgba32F;
    std::mt19937 random(11);
    const auto append = [](ImageData& image, const auto& value) {
        const auto* raw = reinterpret_cast<const std::uint8_t*>(&value);
        image.pixels.insert(image.pixels.end(), raw, raw + sizeof value);
    };
    for (int i = 0; i < 4 * 2 * 4; ++i) {
        const int byte = 96 + static_cast<int>(random() % 64) + (i % 4 == 2 ? 80 : 0);
        bytes.pixels.push_back(static_cast<std::uint8_t>(byte));
        append(halves, glm::packHalf1x16(static_cast<float>(byte) / 255));
        append(floats, static_cast<float>(byte) / 255);
    }
    for (const NormalMips mips : kAllMips) {
        const auto of_bytes = make_normal_levels(bytes, mips);
        const auto of_halves = make_normal_levels(halves, mips);
        const auto of_floats = make_normal_levels(floats, mips);
        REQUIRE(of_bytes.size() == 3);
        for (std::size_t level = 1; level < 3; ++level) {
            const std::size_t values = of_bytes[level].normals.size();
            REQUIRE(of_halves[level].normals.size() == 2 * values);
            REQUIRE(of_floats[level].normals.size() == 4 * values);
            for (std::size_t i = 0; i < values; ++i) {
                std::uint16_t half = 0;
                float value = 0;
                std::memcpy(&half, of_halves[level].normals.data() + 2 * i, sizeof half);
                std::memcpy(&value, of_floats[level].normals.data() + 4 * i, sizeof value);
                CHECK(std::abs(glm::unpackHalf1x16(half) - value) < 1.5e-3f);
                CHECK(std::abs(of_bytes[level].normals[i] / 255.0f - value) < 0.51f / 255);
            }
        }
        const auto alpha = [&](std::size_t i) { return bytes.pixels[4 * i + 3] / 255.0; };
        const double mean = (alpha(0) + alpha(1) + alpha(4) + alpha(5)) / 4;
        CHECK(float_texel(of_floats[1].normals, 0).w == near(mean).epsilon(1e-6));
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "normal mips: textures of normal maps have them, also after one is replaced"
                    * technique("bump.mipmap")) {
    ImagePool pool(device());
    const ImageData bumps = random_bumps(8, 8);
    const std::vector<ImageData> images = {bumps, random_bumps(8, 8), bumps};
    pool.update(images);
    const gpu::FloatImage averaged = gpu::read_floats(*pool.find_texture({0}), 3);
    CHECK(
        glm::length(
            Vec3(averaged.at(0, 0, 0), averaged.at(0, 0, 1), averaged.at(0, 0, 2)) * 2.0f - 1.0f)
        < 0.97f);
    CHECK(pool.find_spread({1}).array == 0);

    pool.update(images, {{0, NormalMips::Plain}, {1, NormalMips::Lean}});
    CHECK(pool.find_spread({0}).array == 0);
    REQUIRE(pool.find_spread({1}).array != 0);
    pool.replace({2}, images[1].pixels);
    pool.replace({0}, images[1].pixels);
    const auto is_as = [&](std::uint32_t id, NormalMips mips) {
        const auto levels = make_normal_levels(images[1], mips);
        for (std::size_t level = 1; level < levels.size(); ++level) {
            const gpu::FloatImage found =
                gpu::read_floats(*pool.find_texture({id}), static_cast<int>(level));
            for (int i = 0; i < found.width * found.height; ++i) {
                const int row = found.height - 1 - i / found.width;  // read from the other end
                const Vec4 texel = float_texel(levels[level].normals, static_cast<std::size_t>(i));
                for (int c = 0; c < 3; ++c) {
                    CHECK(found.at(i % found.width, row, c) == texel[c]);
                }
            }
        }
    };
    is_as(0, NormalMips::Plain);
    is_as(1, NormalMips::Lean);
    const ImageLayer spread = pool.find_spread({1});
    const gpu::ByteImage found =
        gpu::read_bytes(pool.array(spread.array), 3, static_cast<int>(spread.layer));
    CHECK(found.pixels == make_normal_levels(images[1], NormalMips::Lean)[3].spread);
}

TEST_CASE_FIXTURE(
    FarBumps, "normal mips: ridges far away are as a flat surface with the roughness they average"
                  * technique("bump.mipmap")) {
    const double length = std::sqrt(0.75);
    const double toksvig = (1 - length) / length;
    const Material blinn = {
        .shading = ShadingModel::Blinn, .specular = {0.6f, 0.6f, 0.6f}, .shininess = 20};
    Material wide = blinn;
    wide.shininess = static_cast<float>(20 / (1 + 20 * toksvig));
    wide.specular *= (1 + wide.shininess) / 21;
    const Material pbr = {.metalness = 1, .roughness = 0.3f};
    Material rough = pbr;
    rough.roughness = static_cast<float>(std::pow(std::pow(0.3, 4) + 2 * toksvig, 0.25));
    Material stretched = pbr;
    // The slopes are 1 / sqrt(3) either way.
    const double alpha = 0.3 * 0.3;
    const double along = std::sqrt(alpha * alpha + 2.0 / 3);
    stretched.anisotropy = static_cast<float>(std::sqrt((along - alpha) / (1 - alpha)));
    for (const LightMethod method : {LightMethod::Clustered, LightMethod::ObjectMajor}) {
        world.insert_resource(Rendering{.lights = method});
        const auto distance = [&](const Material& m, NormalMips mips, const Material& flat) {
            const gpu::FloatImage expected = with(flat);
            return largest_difference(with(bumpy(m, kRidges, mips)), expected)
                   / brightest(expected);
        };
        CHECK(distance(blinn, NormalMips::Plain, blinn) < 1e-3f);
        CHECK(distance(blinn, NormalMips::Toksvig, wide) < 0.01f);
        CHECK(distance(blinn, NormalMips::Toksvig, blinn) > 0.1f);
        CHECK(distance(pbr, NormalMips::Plain, pbr) < 1e-3f);
        CHECK(distance(pbr, NormalMips::Toksvig, rough) < 0.02f);
        CHECK(distance(pbr, NormalMips::Lean, stretched) < 0.02f);
        CHECK(distance(pbr, NormalMips::Lean, rough) > 0.1f);
    }
}

TEST_CASE_FIXTURE(
    FarBumps,
    "normal mips: highlights of LEAN stretch across slanted ridges" * technique("bump.mipmap")) {
    const std::vector<Vec3> slanted = {leaning(0.4f, 0.4f), leaning(-0.4f, -0.4f)};
    const Material pbr = {.metalness = 1, .roughness = 0.3f};
    Material stretched = pbr;
    const double alpha = 0.3 * 0.3;
    const double along = std::sqrt(alpha * alpha + 2 * 0.32);
    stretched.anisotropy = static_cast<float>(std::sqrt((along - alpha) / (1 - alpha)));
    stretched.anisotropy_rotation = radians(45.0f);
    const gpu::FloatImage expected = with(stretched);
    const gpu::FloatImage found = with(bumpy(pbr, slanted, NormalMips::Lean));
    CHECK(largest_difference(found, expected) / brightest(expected) < 0.02f);
    stretched.anisotropy_rotation = radians(-45.0f);
    CHECK(largest_difference(found, with(stretched)) / brightest(expected) > 0.1f);
}

TEST_CASE_FIXTURE(
    FarBumps,
    "normal mips: a normal scale scales the slopes that are averaged" * technique("bump.mipmap")) {
    const Material pbr = {.metalness = 1, .roughness = 0.3f};
    Material halved = bumpy(pbr, {leaning(0.4f, 0), leaning(-0.4f, 0)}, NormalMips::Lean);
    halved.normal_scale = 0.5f;
    const gpu::FloatImage expected =
        with(bumpy(pbr, {leaning(0.2f, 0), leaning(-0.2f, 0)}, NormalMips::Lean));
    CHECK(largest_difference(with(halved), expected) / brightest(expected) < 0.02f);
}

}  // namespace limn::test::normal_mips_test
