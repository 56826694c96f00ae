#include "content/load/files/image_load.h"

#include "content/codecs/image_codec.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/dds_file.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/png_file.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/components/image_blocks.h"
#include "ecs/components/surface.h"

#include <algorithm>
#include <cstring>
#include <dlfcn.h>
#include <exception>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

namespace {

/// Name of the format of `bytes`; "" when unknown.
std::string sniff_format(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::pair<std::string_view, const char*> kMagic[] = {
        {"\x89PNG\r\n\x1a\n", "png"},
        {"\xff\xd8\xff", "jpeg"},
        {"BM", "bmp"},
        {"#?RADIANCE", "hdr"},
        {"#?RGBE", "hdr"},
        {"\x76\x2f\x31\x01", "exr"},
        {"DDS ", "dds"},
    };
    for (const auto& [magic, format] : kMagic) {
        if (text.starts_with(magic)) {
            return format;
        }
    }
    if (text.starts_with("RIFF")
        && text.substr(std::min<std::size_t>(text.size(), 8)).starts_with("WEBP")) {
        return "webp";
    }
    return "";
}

/// libjpeg fills a truncated image with gray and OpenImageIO accepts it, so check the end mark.
bool is_truncated_jpeg(std::span<const std::byte> bytes) {
    constexpr std::string_view kEnd = "\xff\xd9";
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.rfind(kEnd) == std::string_view::npos;
}

/// The first line of a library's message.
std::string one_line(std::string message) {
    message.resize(std::min(message.find('\n'), message.size()));
    return message.empty() ? "unknown reason" : message;
}

/// The decoder of the codec library, which is loaded when the first image needs it; nullptr if that
/// fails, with the reason in `error`.
DecodeImage load_decoder(std::string& error) {
    static const auto loaded = [] {
        void* const library = dlopen(kCodecLibrary, RTLD_NOW | RTLD_LOCAL);
        void* const symbol = library != nullptr ? dlsym(library, kDecodeImage) : nullptr;
        const char* const reason = symbol == nullptr ? dlerror() : nullptr;
        return std::pair(
            reinterpret_cast<DecodeImage>(symbol), std::string(reason != nullptr ? reason : ""));
    }();
    error = loaded.second;
    return loaded.first;
}

Result<ImageData> decode(
    std::span<const std::byte> bytes, const std::string& location, bool srgb,
    const ImageLimits& limits) {
    const std::string format = sniff_format(bytes);
    if (bytes.empty()) {
        return fail("{}: found an empty file, expected an image", location);
    }
    if (format.empty()) {
        return fail(
            "{}: found {} bytes in an unknown format, expected a PNG, JPEG, BMP, WebP, HDR, EXR or "
            "DDS image",
            location, bytes.size());
    }
    if (format == "png") {
        ImageData image = LIMN_TRY(decode_png(bytes, location, limits));
        image.srgb = srgb;
        return image;
    }
    if (format == "dds") {
        ImageData image = decoded_level(LIMN_TRY(decode_dds(bytes, location, limits)));
        image.srgb = srgb;
        return image;
    }
    if (format == "jpeg" && is_truncated_jpeg(bytes)) {
        return fail("{}: truncated JPEG image", location);
    }

    if (format == "exr") {
        const ExrLimits exr_limits{
            .max_size = limits.max_size, .max_values = 4 * limits.max_pixels, .max_channels = 64};
        const ExrImage exr = LIMN_TRY(decode_exr(bytes, location, exr_limits));
        if (const std::string shown = describe_shown(exr); !shown.empty()) {
            log_warn("{}: {}", location, shown);
        }
        return to_image_data(exr, location);
    }

    std::string error;
    const DecodeImage decode_image = load_decoder(error);
    if (decode_image == nullptr) {
        return fail("{}: cannot read {} images: {}", location, format, one_line(error));
    }
    ImageData image;
    image.name = location;
    if (!decode_image(bytes, format.c_str(), limits, image, error)) {
        return fail("{}: {}", location, one_line(error));
    }
    image.srgb = srgb && image.format == PixelFormat::Rgba8;
    return image;
}

}  // namespace

namespace {

/// Floats or halves by their bits: non-finite values have all bits of `exponent` set.
template <typename Bits>
std::size_t replace_bits(std::vector<std::uint8_t>& pixels, Bits exponent, Bits largest_half) {
    constexpr Bits kSign = static_cast<Bits>(Bits{1} << (8 * sizeof(Bits) - 1));
    std::size_t count = 0;
    for (std::size_t i = 0; i + sizeof(Bits) <= pixels.size(); i += sizeof(Bits)) {
        Bits bits = 0;
        std::memcpy(&bits, &pixels[i], sizeof(Bits));
        if ((bits & exponent) == exponent) {
            const bool infinite = (bits & ~kSign & ~exponent) == 0;
            bits = static_cast<Bits>(infinite ? (bits & kSign) | largest_half : 0);
            std::memcpy(&pixels[i], &bits, sizeof(Bits));
            ++count;
        }
    }
    return count;
}

}  // namespace

std::size_t replace_non_finite(ImageData& image) {
    switch (image.format) {
    case PixelFormat::Rgba16F:
        return replace_bits<std::uint16_t>(image.pixels, 0x7c00, 0x7bff);
    case PixelFormat::Rgba32F:
        return replace_bits<std::uint32_t>(image.pixels, 0x7f800000u, 0x477fe000u);
    case PixelFormat::Rgba8:
    case PixelFormat::Bc5:
    case PixelFormat::Bc7:
        break;
    }
    return 0;
}

Result<ImageData> load_image(const std::string& path, bool srgb, const ImageLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    Result<ImageData> image = decode_image(bytes, path, srgb, limits);
    if (image) {
        image->name = std::filesystem::path(path).stem().string();
    }
    return image;
}

Result<ImageData> decode_image(
    std::span<const std::byte> bytes, const std::string& location, bool srgb,
    const ImageLimits& limits) {
    try {
        return decode(bytes, location, srgb, limits);
    } catch (const std::exception& exception) {
        return fail("{}: corrupt image: {}", location, one_line(exception.what()));
    }
}

}  // namespace limn
