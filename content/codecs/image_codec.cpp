#include "content/codecs/image_codec.h"

#include "content/load/files/image_load.h"
#include "ecs/components/surface.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace limn {

namespace {

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
bool read_pixels(OIIO::ImageInput& input, OIIO::TypeDesc type, std::vector<std::uint8_t>& pixels) {
    const int channels = std::min(input.spec().nchannels, 4);
    const std::size_t count = static_cast<std::size_t>(input.spec().width)
                              * static_cast<std::size_t>(input.spec().height);
    std::vector<T> source(count * static_cast<std::size_t>(channels));
    if (!input.read_image(0, 0, 0, channels, type, source.data())) {
        return false;
    }
    pixels.resize(count * 4 * sizeof(T));
    expand_to_rgba(source.data(), count, channels, reinterpret_cast<T*>(pixels.data()));
    return true;
}

/// Undoes what OpenImageIO does to WebP, whatever it is told: colors are multiplied by alpha.
void divide_by_alpha(std::span<std::uint8_t> rgba) {
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const int alpha = std::max<int>(rgba[i + 3], 1);
        for (std::size_t k = i; k < i + 3; ++k) {
            rgba[k] = static_cast<std::uint8_t>(std::min((255 * rgba[k] + alpha / 2) / alpha, 255));
        }
    }
}

bool decode(
    std::span<const std::byte> bytes, const char* format, const ImageLimits& limits,
    ImageData& image, std::string& error) {
    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
    if (input == nullptr || !input->supports("ioproxy") || !input->set_ioproxy(&memory)) {
        OIIO::geterror();
        error = fmt::format("this OpenImageIO cannot read {} images from memory", format);
        return false;
    }
    OIIO::ImageSpec spec;
    if (!input->open(image.name, spec, config)) {
        error = fmt::format("corrupt {} image: {}", format, input->geterror());
        return false;
    }
    if (error = image_size_error(spec.width, spec.height, limits); !error.empty()) {
        return false;
    }
    if (spec.depth > 1 || spec.nchannels < 1 || spec.deep) {
        error = "found a deep or volume image, expected a flat one";
        return false;
    }
    image.width = spec.width;
    image.height = spec.height;
    const bool floats = spec.format.is_floating_point();
    image.format = floats ? PixelFormat::Rgba32F : PixelFormat::Rgba8;
    const bool complete = floats ? read_pixels<float>(*input, OIIO::TypeFloat, image.pixels)
                                 : read_pixels<std::uint8_t>(*input, OIIO::TypeUInt8, image.pixels);
    if (!complete || input->has_error()) {
        error = fmt::format("corrupt {} image: {}", format, input->geterror());
        return false;
    }
    if (std::string_view(format) == "webp" && !floats && spec.nchannels == 4) {
        divide_by_alpha(image.pixels);
    }
    return true;
}

}  // namespace

}  // namespace limn

/// A DecodeImage.
extern "C" bool limn_decode_image(
    std::span<const std::byte> bytes, const char* format, const limn::ImageLimits& limits,
    limn::ImageData& image, std::string& error) {
    try {
        return limn::decode(bytes, format, limits, image, error);
    } catch (const std::exception& exception) {
        error = fmt::format("corrupt {} image: {}", format, exception.what());
        return false;
    }
}
