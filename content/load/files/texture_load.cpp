#include "content/load/files/texture_load.h"

#include "content/load/files/dds_file.h"
#include "ecs/components/surface.h"

namespace limn {

Result<ImageData> decode_texture(
    std::span<const std::byte> bytes, const std::string& location, bool srgb,
    const ImageLimits& limits) {
    if (!is_dds_file(bytes)) {
        return decode_image(bytes, location, srgb, limits);
    }
    ImageData image = LIMN_TRY(decode_dds(bytes, location, limits));
    image.srgb = srgb && image.format == PixelFormat::Bc7;
    return image;
}

}  // namespace limn
