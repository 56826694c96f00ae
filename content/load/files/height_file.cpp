#include "content/load/files/height_file.h"

#include "content/load/files/atomic_file.h"
#include "content/load/files/png_file.h"
#include "ecs/base/log.h"
#include "ecs/components/surface.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <vector>

namespace limn {

namespace {

bool is_png_file(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.starts_with("\x89PNG\r\n\x1a\n");
}

float red_at(const ImageData& image, std::size_t texel) {
    if (image.format == PixelFormat::Rgba8) {
        return static_cast<float>(image.pixels[4 * texel]) / 255;
    }
    if (image.format == PixelFormat::Rgba16F) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, &image.pixels[8 * texel], sizeof bits);
        return glm::unpackHalf1x16(bits);
    }
    float value = 0;
    std::memcpy(&value, &image.pixels[16 * texel], sizeof value);
    return value;
}

}  // namespace

bool is_image_name(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    constexpr std::array<std::string_view, 8> kImages = {".png", ".exr",  ".jpg", ".jpeg",
                                                         ".bmp", ".webp", ".hdr", ".dds"};
    return std::ranges::find(kImages, extension) != kImages.end();
}

Result<HeightMap> load_heights(const std::string& path, const ImageLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    HeightMap map;
    if (is_png_file(bytes)) {
        const Png16 png = LIMN_TRY(decode_png16(bytes, path, limits));
        map.width = png.width;
        map.height = png.height;
        for (std::size_t i = 0; i < png.pixels.size(); i += 4) {
            map.heights.push_back(static_cast<float>(png.pixels[i]) / 65535);
        }
        return map;
    }
    const ImageData image = LIMN_TRY(decode_image(bytes, path, false, limits));
    map.width = image.width;
    map.height = image.height;
    const auto count =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::size_t replaced = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const float height = red_at(image, i);
        replaced += std::isfinite(height) ? 0 : 1;
        map.heights.push_back(finite_or(height, 0));
    }
    if (replaced > 0) {
        log_warn("{}: found {} heights that are not finite; they become 0", path, replaced);
    }
    return map;
}

}  // namespace limn
