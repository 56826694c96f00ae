// Bytes into the reader of recorded markers (TRC) and the scene made of them: whatever they are,
// there are finite motions of whole triangles, or there is one line.

#include "content/load/faces/marker_file.h"
#include "content/load/faces/marker_import.h"

#include <cstdlib>
#include <string_view>

namespace {

constexpr limn::MarkerLimits kLimits = {.max_markers = 24, .max_positions = 480};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

template <typename T>
bool is_made(const limn::Result<T>& result) {
    if (!result) {
        require(!result.error().message.empty());
        require(result.error().message.find('\n') == std::string::npos);
    }
    return result.ok();
}

void check_scene(const limn::GltfScene& scene) {
    require(scene.meshes.size() == 1 && scene.clips.size() == 1);
    const limn::MeshData& mesh = scene.meshes[0];
    require(mesh.indices.size() % 3 == 0 && !mesh.indices.empty());
    for (const std::uint32_t index : mesh.indices) {
        require(index < mesh.positions.size());
    }
    const limn::ClipSheet& sheet = scene.clips[0].sheets[0];
    require(sheet.translations.size() == sheet.times.size() * sheet.translating.size());
    for (const limn::Vec3& position : sheet.translations) {
        require(limn::is_finite(position));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto motion = limn::parse_trc(text, "fuzz.trc", kLimits);
    if (!is_made(motion)) {
        return 0;
    }
    require(motion->markers() > 0 && motion->markers() <= kLimits.max_markers);
    require(motion->positions.size() == motion->markers() * motion->frames());
    require(motion->frames() > 0 && motion->rate > 0);
    const auto scene = limn::make_marker_scene("fuzz", *motion);
    if (is_made(scene)) {
        check_scene(*scene);
    }
    return 0;
}
