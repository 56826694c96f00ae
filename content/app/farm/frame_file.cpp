#include "content/app/farm/frame_file.h"

#include "content/app/commands/image_file.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "ecs/base/hash.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <span>

namespace limn {
namespace {

Status check_size(const std::string& path, const IVec2& found, const IVec2& expected) {
    if (found != expected) {
        return fail(
            "{}: found {}x{} pixels, expected {}x{}", path, found.x, found.y, expected.x,
            expected.y);
    }
    return Done{};
}

std::uint64_t hash_channels(const ExrImage& image) {
    std::uint64_t hash = 0;
    for (const ExrChannel& channel : image.channels) {
        hash = hash_combine(hash, hash_text(channel.name));
        hash = hash_bytes(std::as_bytes(std::span(channel.values)), hash);
    }
    return hash;
}

}  // namespace

Result<FrameFile> read_frame_file(const std::string& path, const IVec2& size) {
    FrameFile file;
    if (has_extension(path, ".exr")) {
        const ExrImage image = LIMN_TRY(read_exr(path));
        file = {{image.width, image.height}, hash_channels(image)};
    } else {
        const ImageData image = LIMN_TRY(load_image(path, true));
        file = {{image.width, image.height}, hash_bytes(std::as_bytes(std::span(image.pixels)))};
    }
    LIMN_TRY(check_size(path, file.size, size));
    return file;
}

Result<FrameFile> read_task_file(const std::string& path) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    const auto* const text = reinterpret_cast<const char*>(bytes.data());
    if (!nlohmann::json::accept(text, text + bytes.size())) {
        return fail("{}: found no JSON, expected it", path);
    }
    return FrameFile{{0, 0}, hash_bytes(bytes)};
}

}  // namespace limn
