#include "content/load/asset_lists.h"

#include "content/load/component_json.h"

#include <iterator>
#include <utility>
#include <vector>

namespace limn {

namespace {

template <typename T>
void append(std::vector<T>& target, std::vector<T>& source) {
    target.insert(
        target.end(), std::make_move_iterator(source.begin()),
        std::make_move_iterator(source.end()));
    source.clear();
}

}  // namespace

std::uint32_t AssetOffsets::of(std::string_view kind) const {
    return kind == asset_kind<MeshId>       ? mesh
           : kind == asset_kind<ImageId>    ? image
           : kind == asset_kind<MaterialId> ? material
           : kind == asset_kind<SkeletonId> ? skeleton
           : kind == asset_kind<SkinId>     ? skin
           : kind == asset_kind<ClipId>     ? clip
           : kind == asset_kind<PathId>     ? path
                                            : 0;
}

AssetOffsets ends_of(const Assets& assets) {
    const auto size = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
    return {
        .mesh = size(assets.meshes),
        .image = size(assets.images),
        .material = size(assets.materials),
        .skeleton = size(assets.skeletons),
        .skin = size(assets.skins),
        .clip = size(assets.clips),
        .path = size(assets.paths)};
}

void shift_assets(const ComponentInfo& info, void* object, const AssetOffsets& offsets) {
    for_each_asset(info.fields, object, [&](std::string_view kind, std::uint32_t& index) {
        if (index != kNoAsset) {
            index += offsets.of(kind);
        }
    });
}

AssetOffsets append_assets(Assets& target, Assets& source) {
    const AssetOffsets offsets = ends_of(target);
    for (Material& material : source.materials) {
        shift_assets(component_info<Material>(), &material, offsets);
    }
    append(target.images, source.images);
    append(target.meshes, source.meshes);
    append(target.materials, source.materials);
    append(target.skeletons, source.skeletons);
    append(target.skins, source.skins);
    append(target.clips, source.clips);
    append(target.paths, source.paths);
    return offsets;
}

}  // namespace limn
