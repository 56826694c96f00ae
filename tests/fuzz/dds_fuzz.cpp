// Bytes into the DDS reader, and its blocks into the decoder: whatever they are, the image is
// complete and decodes, or there is one line. A file written of it holds the same.

#include "content/load/files/dds_file.h"
#include "content/load/files/image_load.h"
#include "ecs/components/image_blocks.h"

#include <cstdlib>
#include <span>

namespace {

constexpr limn::ImageLimits kDdsLimits = {.max_size = 256, .max_pixels = 1 << 14};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
    const auto image = limn::decode_dds(bytes, "fuzz.dds", kDdsLimits);
    if (!image) {
        require(!image.error().message.empty());
        require(image.error().message.find('\n') == std::string::npos);
        return 0;
    }
    require(image->pixels.size() == limn::image_bytes(*image));
    for (int level = 0; level < image->mip_levels; ++level) {
        const limn::ImageData decoded = limn::decoded_level(*image, level);
        require(decoded.pixels.size() == limn::image_bytes(decoded));
    }
    const auto again = limn::decode_dds(limn::encode_dds(*image), "again.dds", kDdsLimits);
    require(again.ok());
    require(again->pixels == image->pixels && again->srgb == image->srgb);
    return 0;
}
