#pragma once

#include "content/bake/block_image.h"
#include "content/load/files/asset_cache.h"
#include "content/make/make_mesh.h"
#include "content/make/patterns/patterns.h"
#include "ecs/any_component.h"

#include <map>
#include <optional>
#include <string>

namespace limn {

// Cache of generated meshes and patterns, and of images in blocks, for levels that are reloaded, or
// loaded with a show on and off. Keeps in memory what the last loads used, and in files what takes
// long to generate.

struct MadeMesh {
    MeshData data;
    std::optional<MeshRig> rig;
};

class MadeAssets {
  public:
    explicit MadeAssets(AssetCache files = AssetCache::of_user()) : files_(std::move(files)) {}

    /// Drops assets that the last kKeptLoads levels did not use.
    void begin_level();

    /// Returns equal meshes for equal parameters and referenced meshes. A mesh whose parameters
    /// refer to other assets is generated each time.
    [[nodiscard]] MadeMesh
    mesh(const MeshKind& kind, const AnyComponent& parameters, const Assets& assets);
    [[nodiscard]] PatternMaps pattern(const PatternKind& kind, const AnyComponent& parameters);

    /// encode_blocks(), which takes about a second for a million texels.
    [[nodiscard]] ImageData blocks(const ImageData& image, const BlockOptions& options);

    /// Number of assets kept.
    [[nodiscard]] std::size_t size() const {
        return meshes_.size() + patterns_.size() + blocks_.size();
    }

  private:
    static constexpr int kKeptLoads = 4;
    template <typename T>
    struct Entry {
        T value;
        int used = 0;  ///< the last load that used it
    };
    AssetCache files_;
    std::map<std::string, Entry<MeshData>> meshes_;
    std::map<std::string, Entry<PatternMaps>> patterns_;
    std::map<std::string, Entry<ImageData>> blocks_;
    int load_ = 0;
};

}  // namespace limn
