#include "content/load/made_assets.h"

#include "content/load/level/component_json.h"
#include "ecs/base/hash.h"

#include <fmt/format.h>

#include <bit>
#include <chrono>
#include <span>
#include <type_traits>

namespace limn {
namespace {

template <typename T>
std::uint64_t hash_of(std::uint64_t hash, const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return hash_bytes(values.data(), values.size() * sizeof(T), hash_combine(hash, values.size()));
}

/// Hash of everything that another mesh can be made from.
std::uint64_t hash_of(const MeshData& mesh) {
    std::uint64_t hash = hash_text(mesh.name);
    hash = hash_of(hash, mesh.positions);
    hash = hash_of(hash, mesh.normals);
    hash = hash_of(hash, mesh.tangents);
    hash = hash_of(hash, mesh.uvs);
    hash = hash_of(hash, mesh.uvs1);
    hash = hash_of(hash, mesh.colors);
    hash = hash_of(hash, mesh.indices);
    hash = hash_of(hash, mesh.skin.first);
    hash = hash_of(hash, mesh.skin.joints);
    hash = hash_of(hash, mesh.skin.weights);
    for (const MorphTarget& morph : mesh.morphs) {
        hash = hash_text(morph.name + ' ' + morph.action_unit, hash);
        hash = hash_of(hash, morph.vertices);
        hash = hash_of(hash, morph.positions);
        hash = hash_of(hash, morph.normals);
        hash = hash_of(hash, morph.tangents);
        for (const ShapeDriver& driver : morph.drivers) {
            hash = hash_combine(hash, driver.target);
            hash = hash_combine(hash, std::bit_cast<std::uint32_t>(driver.peak));
        }
    }
    for (const VertexRegion& region : mesh.regions) {
        hash = hash_text(region.name, hash);
        hash = hash_of(hash, region.weights);
        hash = hash_of(hash, region.across);
    }
    return hash;
}

/// The kind and all parameters as text; referenced meshes by their content.
std::string key_of(const char* kind, const AnyComponent& parameters, const Assets* assets) {
    const NameProvider names = {
        .asset =
            [assets](std::string_view, std::uint32_t index) {
                return assets != nullptr && index < assets->meshes.size()
                           ? fmt::format("{:016x}", hash_of(assets->meshes[index]))
                           : std::string();
            },
        .entity = [](Entity) { return std::string(); }};
    return kind + write_json(write_component(parameters.info(), parameters.data(), names));
}

/// Whether it refers to assets other than meshes, or to meshes in pieces.
bool names_more_than_meshes(AnyComponent parameters, const Assets& assets) {
    bool found = false;
    for_each_asset(
        parameters.info().fields, parameters.data(),
        [&](std::string_view kind, const std::uint32_t& index) {
            const bool in_pieces =
                index < assets.meshes.size() && !assets.meshes[index].pieces.empty();
            found = found || kind != asset_kind<MeshId> || in_pieces;
        });
    return found;
}

/// Calls `make` and, if it took long, `keep` with the result.
template <typename Make, typename Keep>
auto make_and_keep(Make&& make, Keep&& keep) {
    constexpr std::chrono::milliseconds kLong{20};
    const auto start = std::chrono::steady_clock::now();
    auto asset = make();
    if (std::chrono::steady_clock::now() - start >= kLong) {
        keep(asset);
    }
    return asset;
}

}  // namespace

void MadeAssets::begin_level() {
    ++load_;
    const auto is_old = [this](const auto& item) { return item.second.used + kKeptLoads < load_; };
    std::erase_if(meshes_, is_old);
    std::erase_if(patterns_, is_old);
    std::erase_if(blocks_, is_old);
}

MadeMesh
MadeAssets::mesh(const MeshKind& kind, const AnyComponent& parameters, const Assets& assets) {
    MadeMesh mesh;
    if (kind.make_rig != nullptr) {
        mesh.rig = kind.make_rig(parameters.data());
    }
    const auto generate = [&] { return kind.make(parameters.data(), assets); };
    if (names_more_than_meshes(parameters, assets)) {
        mesh.data = generate();
        return mesh;
    }
    const auto [found, is_new] = meshes_.try_emplace(key_of(kind.name, parameters, &assets));
    if (is_new) {
        const std::string& key = found->first;
        std::optional<MeshData> data = files_.find_mesh(key);
        found->second.value =
            data ? *std::move(data) : make_and_keep(generate, [&](const MeshData& made) {
                if (made.pieces.empty()) {  // pieces refer to other meshes
                    files_.keep(key, made);
                }
            });
    }
    found->second.used = load_;
    mesh.data = found->second.value;
    return mesh;
}

PatternMaps MadeAssets::pattern(const PatternKind& kind, const AnyComponent& parameters) {
    const auto [found, is_new] = patterns_.try_emplace(key_of(kind.name, parameters, nullptr));
    if (is_new) {
        const std::string& key = found->first;
        std::optional<PatternMaps> maps = files_.find_pattern(key);
        found->second.value = maps ? *std::move(maps)
                                   : make_and_keep(
                                       [&] { return kind.make(parameters.data()); },
                                       [&](const PatternMaps& made) { files_.keep(key, made); });
    }
    found->second.used = load_;
    return found->second.value;
}

ImageData MadeAssets::blocks(const ImageData& image, const BlockOptions& options) {
    const auto [found, is_new] = blocks_.try_emplace(fmt::format(
        "blocks {} {} {} {} {} {:016x}", image.width, image.height,
        static_cast<int>(options.format), static_cast<int>(options.kind), options.levels,
        hash_bytes(std::as_bytes(std::span(image.pixels)))));
    if (is_new) {
        const std::string& key = found->first;
        std::optional<ImageData> made = files_.find_image(key);
        found->second.value = made ? *std::move(made)
                                   : make_and_keep(
                                       [&] { return encode_blocks(image, options); },
                                       [&](const ImageData& blocks) { files_.keep(key, blocks); });
    }
    found->second.used = load_;
    ImageData blocks = found->second.value;
    blocks.name = image.name;
    return blocks;
}

}  // namespace limn
