#pragma once

#include "ecs/components/motion_graph.h"
#include "ecs/components/surface.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace limn {

class World;

// Access to asset lists by kind: "mesh", "clip" ... (asset_kind in reflect.h).

/// Calls visit(list) with the list of `kind` in `assets`: an Assets, or any struct with lists of
/// the same names. Does nothing for an unknown kind.
template <typename AssetsT, typename Visit>
void visit_asset_list(AssetsT& assets, std::string_view kind, Visit&& visit) {
    if (kind == asset_kind<MeshId>) {
        visit(assets.meshes);
    } else if (kind == asset_kind<MaterialId>) {
        visit(assets.materials);
    } else if (kind == asset_kind<ImageId>) {
        visit(assets.images);
    } else if (kind == asset_kind<SkeletonId>) {
        visit(assets.skeletons);
    } else if (kind == asset_kind<SkinId>) {
        visit(assets.skins);
    } else if (kind == asset_kind<ClipId>) {
        visit(assets.clips);
    } else if (kind == asset_kind<PathId>) {
        visit(assets.paths);
    } else if (kind == asset_kind<MotionGraphId>) {
        if constexpr (requires { assets.motion_graphs; }) {  // a resource of their own
            visit(assets.motion_graphs);
        }
    }
}

/// Index of the first asset of that kind and name, in a struct as above.
template <typename AssetsT>
[[nodiscard]] std::optional<std::uint32_t>
find_asset(const AssetsT& assets, std::string_view kind, std::string_view name) {
    std::optional<std::uint32_t> found;
    visit_asset_list(assets, kind, [&](const auto& list) {
        for (std::uint32_t i = 0; i < list.size() && !found; ++i) {
            found = list[i].name == name ? std::optional(i) : std::nullopt;
        }
    });
    return found;
}

template <typename AssetsT>
[[nodiscard]] std::vector<std::string_view>
asset_names(const AssetsT& assets, std::string_view kind) {
    std::vector<std::string_view> names;
    visit_asset_list(assets, kind, [&](const auto& list) {
        for (const auto& asset : list) {
            names.emplace_back(asset.name);
        }
    });
    return names;
}

/// All assets of a world, as lists of the names that Assets has; empty without resources.
struct WorldAssetLists {
    std::span<const MeshData> meshes;
    std::span<const Material> materials;
    std::span<const ImageData> images;
    std::span<const SkeletonData> skeletons;
    std::span<const SkinData> skins;
    std::span<const ClipData> clips;
    std::span<const PathData> paths;
    std::span<const MotionGraphData> motion_graphs;
};
[[nodiscard]] WorldAssetLists list_assets(const World& world);

/// Number of assets of each kind: the offset of an index when its list is appended to another.
struct AssetOffsets {
    std::uint32_t meshes = 0;
    std::uint32_t images = 0;
    std::uint32_t materials = 0;
    std::uint32_t skeletons = 0;
    std::uint32_t skins = 0;
    std::uint32_t clips = 0;
    std::uint32_t paths = 0;
    std::uint32_t motion_graphs = 0;
};

/// The sizes of the lists.
[[nodiscard]] AssetOffsets asset_counts(const Assets& assets);

/// Adds the offsets to every asset index in `object`, which is of type `info`.
void offset_asset_ids(const ComponentInfo& info, void* object, const AssetOffsets& offsets);

/// Moves all assets of `source` to the end of the lists of `target` and remaps their references;
/// returns the offsets at which they begin.
AssetOffsets append_assets(Assets& target, Assets& source);

/// The same for motion graphs, whose clips are those of `offsets`; sets offsets.motion_graphs.
void append_graphs(
    MotionGraphs& target, std::vector<MotionGraphData>& source, AssetOffsets& offsets);

}  // namespace limn
