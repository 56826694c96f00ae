#pragma once

#include "ecs/components/surface.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace limn {

// Assets by the kind that a reference to them has ("mesh", "clip" ...: asset_kind in reflect.h).

/// Calls visit(list) with the list of that kind in `assets`, which is an Assets or has lists of the
/// same names; an unknown kind has none.
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
    }
}

/// How many of each kind stand before others: what is to be added to an index when its list is
/// appended to another.
struct AssetOffsets {
    std::uint32_t mesh = 0;
    std::uint32_t image = 0;
    std::uint32_t material = 0;
    std::uint32_t skeleton = 0;
    std::uint32_t skin = 0;
    std::uint32_t clip = 0;
    std::uint32_t path = 0;

    [[nodiscard]] std::uint32_t of(std::string_view kind) const;
};

/// The ends of the lists.
[[nodiscard]] AssetOffsets ends_of(const Assets& assets);

/// Adds the offsets to every asset that the object of type `info` names.
void shift_assets(const ComponentInfo& info, void* object, const AssetOffsets& offsets);

/// Moves everything in `source` behind what `target` has, its references with it; returns where it
/// begins there.
AssetOffsets append_assets(Assets& target, Assets& source);

}  // namespace limn
