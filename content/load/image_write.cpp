#include "content/load/image_write.h"

#include "content/load/atomic_file.h"
#include "ecs/base/text.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <exception>
#include <memory>
#include <vector>

namespace limn {

namespace {

/// The PNG as bytes; `values` has width * height * channels entries of `type`.
Result<std::vector<unsigned char>>
encode_png(int width, int height, int channels, OIIO::TypeDesc type, const void* values) {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
    if (output == nullptr || !output->set_ioproxy(&memory)) {
        return fail("this OpenImageIO cannot write PNG: {}", OIIO::geterror());
    }
    OIIO::ImageSpec spec(width, height, channels, type);
    if (channels == 2 || channels == 4) {
        spec.alpha_channel = channels - 1;
    }
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:ColorSpace", "sRGB");
    if (!output->open("memory.png", spec) || !output->write_image(type, values)
        || !output->close()) {
        return fail("cannot encode PNG: {}", output->geterror());
    }
    return bytes;
}

/// The same with checked sizes and without exceptions.
Result<std::vector<unsigned char>> encode_values(
    int width, int height, int channels, OIIO::TypeDesc type, std::size_t count,
    const void* values) {
    LIMN_CHECK(width > 0 && height > 0 && channels >= 1 && channels <= 4);
    LIMN_CHECK(
        count
        == static_cast<std::size_t>(width) * static_cast<std::size_t>(height)
               * static_cast<std::size_t>(channels));
    try {
        return encode_png(width, height, channels, type, values);
    } catch (const std::exception& exception) {
        return fail("cannot encode PNG: {}", exception.what());
    }
}

Status write_values(
    const std::string& path, int width, int height, int channels, OIIO::TypeDesc type,
    std::size_t count, const void* values) {
    const Result<std::vector<unsigned char>> bytes =
        encode_values(width, height, channels, type, count, values);
    if (!bytes) {
        return fail("{}: {}", path, bytes.error().message);
    }
    return write_file(path, std::as_bytes(std::span(*bytes)));
}

}  // namespace

Status write_png(
    const std::string& path, int width, int height, int channels,
    std::span<const std::uint8_t> pixels) {
    return write_values(
        path, width, height, channels, OIIO::TypeUInt8, pixels.size(), pixels.data());
}

Status write_png16(
    const std::string& path, int width, int height, int channels,
    std::span<const std::uint16_t> pixels) {
    return write_values(
        path, width, height, channels, OIIO::TypeUInt16, pixels.size(), pixels.data());
}

Result<std::vector<std::uint8_t>>
png_bytes(int width, int height, int channels, std::span<const std::uint8_t> pixels) {
    return encode_values(width, height, channels, OIIO::TypeUInt8, pixels.size(), pixels.data());
}

}  // namespace limn
