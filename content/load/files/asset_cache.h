#pragma once

#include "content/make/patterns/pattern_maps.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace limn {

// Caches generated images and meshes in files, so that a level loads faster the second time.
// The key of an asset contains everything that it is generated from. A file stores its
// key and is used only if the key is equal. A file that is missing, damaged, or cannot be read
// counts as a miss: the asset is generated again.

/// A hash of the source files of all generators: assets of older generators are misses. The build
/// generates this function.
[[nodiscard]] std::string_view generators_hash();

class AssetCache {
  public:
    /// Keeps up to `max_bytes` of the newest files in `folder`; an empty `folder` disables the
    /// cache.
    explicit AssetCache(std::string folder, std::uint64_t max_bytes = std::uint64_t{1} << 30)
        : folder_(std::move(folder)), max_bytes_(max_bytes) {}
    /// The folder from LIMN_CACHE ("off": none), else XDG_CACHE_HOME/limn or
    /// HOME/.cache/limn.
    [[nodiscard]] static AssetCache of_user();

    [[nodiscard]] std::optional<PatternMaps> find_pattern(std::string_view key) const;
    [[nodiscard]] std::optional<MeshData> find_mesh(std::string_view key) const;
    [[nodiscard]] std::optional<ImageData> find_image(std::string_view key) const;
    void keep(std::string_view key, const PatternMaps& maps) const;
    void keep(std::string_view key, const MeshData& mesh) const;
    void keep(std::string_view key, const ImageData& image) const;

  private:
    std::string folder_;
    std::uint64_t max_bytes_ = 0;
};

}  // namespace limn
