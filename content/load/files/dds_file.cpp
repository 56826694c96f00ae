#include "content/load/files/dds_file.h"

#include "content/load/files/image_load.h"
#include "ecs/base/check.h"
#include "ecs/base/text.h"
#include "ecs/components/image_blocks.h"
#include "ecs/components/surface.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

// Techniques: engine.opt-texture

namespace limn {
namespace {

constexpr std::uint32_t four_letters(std::string_view text) {
    std::uint32_t code = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        code |= std::uint32_t{static_cast<unsigned char>(text[i])} << (8 * i);
    }
    return code;
}

/// The first 128 bytes of a file: 4 of magic and DDS_HEADER, with DDS_PIXELFORMAT inside.
struct DdsHeader {
    std::uint32_t magic = four_letters("DDS ");
    std::uint32_t size = 124;
    std::uint32_t flags = 0;
    std::uint32_t height = 0;
    std::uint32_t width = 0;
    std::uint32_t linear_size = 0;  ///< bytes of the first level
    std::uint32_t depth = 0;
    std::uint32_t levels = 0;
    std::array<std::uint32_t, 11> reserved = {};
    std::uint32_t format_size = 32;
    std::uint32_t format_flags = 0;
    std::uint32_t four_cc = 0;
    std::array<std::uint32_t, 5> masks = {};
    std::uint32_t caps = 0;
    std::uint32_t caps2 = 0;
    std::array<std::uint32_t, 3> reserved2 = {};
};
static_assert(sizeof(DdsHeader) == 128);

/// DDS_HEADER_DXT10.
struct DdsHeader10 {
    std::uint32_t format = 0;  ///< DXGI_FORMAT
    std::uint32_t dimension = 3;
    std::uint32_t misc = 0;
    std::uint32_t array_size = 1;
    std::uint32_t misc2 = 0;
};
static_assert(sizeof(DdsHeader10) == 20);

constexpr std::uint32_t kDx10 = four_letters("DX10");
constexpr std::uint32_t kRequiredFlags = 0x1 | 0x2 | 0x4 | 0x1000;  // caps, height, width, format
constexpr std::uint32_t kLevelFlag = 0x20000;
constexpr std::uint32_t kLinearSizeFlag = 0x80000;
constexpr std::uint32_t kFourCcFlag = 0x4;
constexpr std::uint32_t kTextureCaps = 0x1000;
constexpr std::uint32_t kLevelCaps = 0x8 | 0x400000;  // complex, mipmap
constexpr std::uint32_t kCubeOrVolume = 0x200 | 0x200000;
constexpr std::uint32_t kCubeMisc = 0x4;
constexpr std::uint32_t kTexture2D = 3;
constexpr std::uint32_t kBc5 = 83;
constexpr std::uint32_t kBc7 = 98;
constexpr std::uint32_t kBc7Srgb = 99;

struct DdsReader {
    std::span<const std::byte> bytes;
    const std::string& location;
    std::size_t at = 0;

    template <typename Header>
    Result<Header> take() {
        Header header;
        if (bytes.size() - at < sizeof header) {
            return fail(
                "{}: found {} bytes, expected at least {} of a DDS header", location, bytes.size(),
                at + sizeof header);
        }
        std::memcpy(&header, bytes.data() + at, sizeof header);
        at += sizeof header;
        return header;
    }
};

/// "DXT5", or as a number.
std::string four_cc_text(std::uint32_t code) {
    std::string text;
    for (int i = 0; i < 4; ++i) {
        const auto letter = static_cast<char>((code >> (8 * i)) & 0xff);
        if (letter < ' ' || letter > '~') {
            return fmt::format("{:#x}", code);
        }
        text += letter;
    }
    return text;
}

Status read_format(DdsReader& reader, const DdsHeader& header, ImageData& image) {
    const std::string& location = reader.location;
    if ((header.format_flags & kFourCcFlag) == 0) {
        return fail("{}: found a DDS image without blocks, expected BC5 or BC7", location);
    }
    if (header.four_cc == four_letters("ATI2") || header.four_cc == four_letters("BC5U")) {
        image.format = PixelFormat::Bc5;
        return Done{};
    }
    if (header.four_cc != kDx10) {
        return fail(
            "{}: found the DDS format {}, expected BC5 or BC7", location,
            four_cc_text(header.four_cc));
    }
    const DdsHeader10 more = LIMN_TRY(reader.take<DdsHeader10>());
    if (more.format != kBc5 && more.format != kBc7 && more.format != kBc7Srgb) {
        return fail(
            "{}: found the DXGI format {}, expected 83 (BC5), 98 or 99 (BC7)", location,
            more.format);
    }
    if (more.dimension != kTexture2D || more.array_size != 1 || (more.misc & kCubeMisc) != 0) {
        return fail(
            "{}: found a DDS volume, cube or array, expected one two-dimensional image", location);
    }
    image.format = more.format == kBc5 ? PixelFormat::Bc5 : PixelFormat::Bc7;
    image.srgb = more.format == kBc7Srgb;
    return Done{};
}

Status
check_header(const DdsHeader& header, const std::string& location, const ImageLimits& limits) {
    if (header.size != 124 || header.format_size != 32) {
        return fail(
            "{}: found headers of {} and {} bytes, expected those of a DDS file, 124 and 32",
            location, header.size, header.format_size);
    }
    if (const std::string error = image_size_error(header.width, header.height, limits);
        !error.empty()) {
        return Error{location + ": " + error};
    }
    if ((header.caps2 & kCubeOrVolume) != 0) {
        return fail("{}: found a DDS cube or volume, expected one two-dimensional image", location);
    }
    return Done{};
}

}  // namespace

bool is_dds_file(std::span<const std::byte> bytes) {
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "DDS ", 4) == 0;
}

Result<ImageData> decode_dds(
    std::span<const std::byte> bytes, const std::string& location, const ImageLimits& limits) {
    DdsReader reader{bytes, location};
    const DdsHeader header = LIMN_TRY(reader.take<DdsHeader>());
    if (header.magic != DdsHeader().magic) {
        return fail("{}: found another file, expected a DDS image", location);
    }
    LIMN_TRY(check_header(header, location, limits));
    ImageData image;
    image.name = location;
    image.width = static_cast<int>(header.width);
    image.height = static_cast<int>(header.height);
    LIMN_TRY(read_format(reader, header, image));
    const auto max_levels = static_cast<std::uint32_t>(max_mip_levels(image.width, image.height));
    if (header.levels > max_levels) {
        return fail(
            "{}: found {} mip levels of {} x {} pixels, expected at most {}", location,
            header.levels, image.width, image.height, max_levels);
    }
    image.mip_levels = header.levels == 0 ? 1 : static_cast<int>(header.levels);
    const std::span<const std::byte> data = bytes.subspan(reader.at);
    const std::size_t wanted = image_bytes(image);
    if (data.size() < wanted) {
        return fail(
            "{}: found {} bytes of blocks, expected {} of {} mip levels", location, data.size(),
            wanted, image.mip_levels);
    }
    const auto* const first = reinterpret_cast<const std::uint8_t*>(data.data());
    image.pixels.assign(first, first + wanted);
    return image;
}

std::vector<std::byte> encode_dds(const ImageData& image) {
    LIMN_CHECK(is_in_blocks(image.format) && image.pixels.size() == image_bytes(image));
    DdsHeader header;
    header.flags = kRequiredFlags | kLevelFlag | kLinearSizeFlag;
    header.height = static_cast<std::uint32_t>(image.height);
    header.width = static_cast<std::uint32_t>(image.width);
    header.linear_size = static_cast<std::uint32_t>(level_bytes(image, 0));
    header.levels = static_cast<std::uint32_t>(image.mip_levels);
    header.format_flags = kFourCcFlag;
    header.four_cc = kDx10;
    header.caps = kTextureCaps | (image.mip_levels > 1 ? kLevelCaps : 0);
    DdsHeader10 more;
    more.format = image.format == PixelFormat::Bc5 ? kBc5 : image.srgb ? kBc7Srgb : kBc7;
    std::vector<std::byte> bytes;
    const auto append = [&](const void* data, std::size_t size) {
        const auto* const begin = static_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), begin, begin + size);
    };
    append(&header, sizeof header);
    append(&more, sizeof more);
    append(image.pixels.data(), image.pixels.size());
    return bytes;
}

}  // namespace limn
