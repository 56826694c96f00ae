#include "content/load/asset_lists.h"

#include "content/load/level/component_json.h"
#include "ecs/world.h"

#include <iterator>
#include <utility>
#include <vector>

namespace limn {

namespace {

template <typename T>
void append_all(std::vector<T>& target, std::vector<T>& source) {
    target.insert(
        target.end(), std::make_move_iterator(source.begin()),
        std::make_move_iterator(source.end()));
    source.clear();
}

}  // namespace

WorldAssetLists list_assets(const World& world) {
    WorldAssetLists lists;
    if (const Assets* const assets = world.find_resource<Assets>()) {
        lists = {assets->meshes, assets->materials, assets->images, assets->skeletons,
                 assets->skins,  assets->clips,     assets->paths,  {}};
    }
    if (const MotionGraphs* const graphs = world.find_resource<MotionGraphs>()) {
        lists.motion_graphs = graphs->graphs;
    }
    return lists;
}

AssetOffsets asset_counts(const Assets& assets) {
    const auto size = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
    return {
        .meshes = size(assets.meshes),
        .images = size(assets.images),
        .materials = size(assets.materials),
        .skeletons = size(assets.skeletons),
        .skins = size(assets.skins),
        .clips = size(assets.clips),
        .paths = size(assets.paths)};
}

void offset_asset_ids(const ComponentInfo& info, void* object, const AssetOffsets& offsets) {
    for_each_asset(info.fields, object, [&](std::string_view kind, std::uint32_t& index) {
        if (index != kNoAsset) {
            visit_asset_list(offsets, kind, [&](std::uint32_t offset) { index += offset; });
        }
    });
}

AssetOffsets append_assets(Assets& target, Assets& source) {
    const AssetOffsets offsets = asset_counts(target);
    for (Material& material : source.materials) {
        offset_asset_ids(component_info<Material>(), &material, offsets);
    }
    append_all(target.images, source.images);
    append_all(target.meshes, source.meshes);
    append_all(target.materials, source.materials);
    append_all(target.skeletons, source.skeletons);
    append_all(target.skins, source.skins);
    append_all(target.clips, source.clips);
    append_all(target.paths, source.paths);
    return offsets;
}

void append_graphs(
    MotionGraphs& target, std::vector<MotionGraphData>& source, AssetOffsets& offsets) {
    offsets.motion_graphs = static_cast<std::uint32_t>(target.graphs.size());
    for (MotionGraphData& graph : source) {
        offset_asset_ids(component_info<MotionGraphData>(), &graph, offsets);
    }
    append_all(target.graphs, source);
}

}  // namespace limn
