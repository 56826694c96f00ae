#include "content/app/commands/bake_block.h"

#include "content/app/commands/bake_command.h"
#include "content/app/commands/bake_recipe.h"
#include "content/app/commands/progress.h"
#include "content/bake/block_image.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/dds_file.h"
#include "content/load/files/image_load.h"
#include "ecs/base/math.h"
#include "ecs/base/text.h"
#include "ecs/components/image_blocks.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

// Techniques: engine.opt-texture

namespace limn {

enum class BlockFormatChoice : std::uint8_t { Auto, Bc5, Bc7 };

struct BlockRecipe {
    TexelKind kind = TexelKind::Color;
    BlockFormatChoice format = BlockFormatChoice::Auto;
    bool levels = true;
};

LIMN_FIELDS(BlockRecipe) {
    LIMN_FIELD(kind, .doc = "what the texels are", .values = "color normal data");
    LIMN_FIELD(
        format, .doc = "auto: bc5 of normals, whose z shaders restore; bc7 of all else",
        .values = "auto bc5 bc7");
    LIMN_FIELD(levels, "mip levels down to 1 x 1, as averages of linear light or of unit vectors");
}

namespace {

PixelFormat format_of(const BlockRecipe& recipe) {
    const bool two = recipe.format == BlockFormatChoice::Auto
                         ? recipe.kind == TexelKind::Normal
                         : recipe.format == BlockFormatChoice::Bc5;
    return two ? PixelFormat::Bc5 : PixelFormat::Bc7;
}

Vec3 unit_normal(const std::uint8_t* rgb) {
    const Vec3 n = Vec3(rgb[0], rgb[1], rgb[2]) / 127.5f - 1.0f;
    const float length = glm::length(n);
    return length > 1e-3f ? n / length : Vec3(0, 0, 1);
}

/// Mean angle between the normals of the image and those of the blocks [deg].
double mean_angle(const ImageData& image, const ImageData& decoded) {
    double sum = 0;
    for (std::size_t i = 0; i < decoded.pixels.size(); i += 4) {
        const Vec3 a = unit_normal(&image.pixels[i]);
        const Vec3 b = unit_normal(&decoded.pixels[i]);
        sum +=
            static_cast<double>(degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b))));
    }
    return sum * 4 / static_cast<double>(decoded.pixels.size());
}

/// Of the first `channels` [dB]; at most 99.
double psnr_of(const ImageData& image, const ImageData& decoded, std::size_t channels) {
    double sum = 0;
    for (std::size_t i = 0; i < decoded.pixels.size(); ++i) {
        const int d = i % 4 < channels ? decoded.pixels[i] - image.pixels[i] : 0;
        sum += static_cast<double>(d * d);
    }
    const double values = static_cast<double>(decoded.pixels.size() * channels) / 4;
    return sum > 0 ? std::min(10 * std::log10(255.0 * 255.0 * values / sum), 99.0) : 99.0;
}

/// How near the first level is to the image.
std::string
describe_loss(const BlockRecipe& recipe, const ImageData& image, const ImageData& blocks) {
    const ImageData decoded = decoded_level(blocks);
    if (recipe.kind == TexelKind::Normal) {
        return fmt::format("mean angle {:.2f} degrees", mean_angle(image, decoded));
    }
    const std::size_t channels = blocks.format == PixelFormat::Bc5 ? 2 : 4;
    return fmt::format("PSNR {:.1f} dB", psnr_of(image, decoded, channels));
}

}  // namespace

Status bake_block(const BakeOptions& options) {
    BlockRecipe recipe;
    LIMN_TRY(read_recipe(options, recipe));
    const ImageData image = LIMN_TRY(load_image(options.in, recipe.kind == TexelKind::Color));
    if (image.format != PixelFormat::Rgba8) {
        return fail(
            "{}: found {} pixels, expected 8 bits: BC5 and BC7 have no floats", options.in,
            format_name(image.format));
    }
    Progress progress("row", block_rows(image.width, image.height, recipe.levels));
    const ImageData blocks = encode_blocks(
        image, {.format = format_of(recipe), .kind = recipe.kind, .levels = recipe.levels},
        [&](int rows) { progress.update(rows); });
    LIMN_TRY(write_file(options.out, encode_dds(blocks)));
    fmt::print(
        "{}: {} x {} pixels, {}, {} mip levels, {} bytes, {}\n", options.out, blocks.width,
        blocks.height, format_name(blocks.format), blocks.mip_levels, image_bytes(blocks),
        describe_loss(recipe, image, blocks));
    return Done{};
}

}  // namespace limn
