#include "content/load/image_load.h"

#include "content/load/atomic_file.h"
#include "content/load/exr_file.h"
#include "content/load/png_check.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

namespace limn {

namespace {

/// Name of the format of `bytes`; "" when unknown.
std::string sniff_format(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::pair<std::string_view, const char*> kMagic[] = {
        {"\x89PNG\r\n\x1a\n", "png"}, {"\xff\xd8\xff", "jpeg"}, {"BM", "bmp"},
        {"#?RADIANCE", "hdr"},        {"#?RGBE", "hdr"},        {"\x76\x2f\x31\x01", "exr"},
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

template <typename T>
T one();
template <>
std::uint8_t one() {
    return 255;
}
template <>
float one() {
    return 1.0f;
}
/// Expands `count` pixels of `channels` interleaved values to RGBA.
template <typename T>
void expand_to_rgba(const T* source, std::size_t count, int channels, T* rgba) {
    for (std::size_t i = 0; i < count; ++i, source += channels, rgba += 4) {
        const bool gray = channels < 3;
        rgba[0] = source[0];
        rgba[1] = source[gray ? 0 : 1];
        rgba[2] = source[gray ? 0 : 2];
        rgba[3] = channels == 2 ? source[1] : channels >= 4 ? source[3] : one<T>();
    }
}

template <typename T>
bool read_pixels(
    OIIO::ImageInput& input, int channels, std::vector<std::uint8_t>& pixels, OIIO::TypeDesc type) {
    const std::size_t width = static_cast<std::size_t>(input.spec().width);
    const std::size_t height = static_cast<std::size_t>(input.spec().height);
    std::vector<T> source(width * height * static_cast<std::size_t>(channels));
    if (!input.read_image(0, 0, 0, channels, type, source.data())) {
        return false;
    }
    pixels.resize(width * height * 4 * sizeof(T));
    expand_to_rgba(source.data(), width * height, channels, reinterpret_cast<T*>(pixels.data()));
    return true;
}

Result<ImageData> decode(
    std::span<const std::byte> bytes, const std::string& place, bool srgb,
    const ImageLimits& limits) {
    const std::string format = sniff_format(bytes);
    if (bytes.empty()) {
        return fail("{}: found an empty file, expected an image", place);
    }
    if (format.empty()) {
        return fail(
            "{}: found {} bytes in an unknown format, expected a PNG, JPEG, BMP, WebP, HDR or EXR "
            "image",
            place, bytes.size());
    }
    if (format == "png") {
        LIMN_TRY(check_png(bytes, place));
    }
    if (format == "jpeg" && is_truncated_jpeg(bytes)) {
        return fail("{}: truncated JPEG image", place);
    }

    if (format == "exr") {
        const ExrLimits exr_limits{
            .max_size = limits.max_size, .max_values = 4 * limits.max_pixels, .max_channels = 64};
        const ExrImage exr = LIMN_TRY(decode_exr(bytes, place, exr_limits));
        return to_image_data(exr, place);
    }

    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
    if (input == nullptr || !input->supports("ioproxy") || !input->set_ioproxy(&memory)) {
        OIIO::geterror();
        return fail("{}: this OpenImageIO cannot read {} images from memory", place, format);
    }
    OIIO::ImageSpec spec;
    if (!input->open(place, spec, config)) {
        return fail("{}: corrupt {} image: {}", place, format, one_line(input->geterror()));
    }
    if (spec.width <= 0 || spec.height <= 0 || spec.width > limits.max_size
        || spec.height > limits.max_size
        || std::int64_t{spec.width} * spec.height > limits.max_pixels) {
        return fail(
            "{}: found {} x {} pixels, expected at most {} along a side and {} in all", place,
            spec.width, spec.height, limits.max_size, limits.max_pixels);
    }
    if (spec.depth > 1 || spec.nchannels < 1 || spec.deep) {
        return fail("{}: found a deep or volume image, expected a flat one", place);
    }

    ImageData image;
    image.name = place;
    image.width = spec.width;
    image.height = spec.height;
    const int channels = std::min(spec.nchannels, 4);
    bool complete = false;
    if (spec.format.is_floating_point()) {
        image.format = PixelFormat::Rgba32F;
        complete = read_pixels<float>(*input, channels, image.pixels, OIIO::TypeFloat);
    } else {
        image.srgb = srgb;
        complete = read_pixels<std::uint8_t>(*input, channels, image.pixels, OIIO::TypeUInt8);
    }
    if (!complete || input->has_error()) {
        return fail("{}: corrupt {} image: {}", place, format, one_line(input->geterror()));
    }
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
    std::span<const std::byte> bytes, const std::string& place, bool srgb,
    const ImageLimits& limits) {
    try {
        return decode(bytes, place, srgb, limits);
    } catch (const std::exception& exception) {
        return fail("{}: corrupt image: {}", place, one_line(exception.what()));
    }
}

}  // namespace limn
