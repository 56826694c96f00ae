#include "content/load/made_assets.h"

#include "content/load/component_json.h"

namespace limn {
namespace {

/// The kind and all parameters as text.
std::string key_of(const char* kind, const AnyComponent& parameters) {
    const NameProvider no_names = {
        .asset = [](std::string_view, std::uint32_t) { return std::string(); },
        .entity = [](Entity) { return std::string(); }};
    return kind + write_json(write_component(parameters.info(), parameters.data(), no_names));
}

bool names_assets(AnyComponent parameters) {
    bool found = false;
    for_each_asset(
        parameters.info().fields, parameters.data(),
        [&found](std::string_view, std::uint32_t&) { found = true; });
    return found;
}

MadeMesh make(const MeshKind& kind, const AnyComponent& parameters, const Assets& assets) {
    MadeMesh mesh{kind.make(parameters.data(), assets), std::nullopt};
    if (kind.make_rig != nullptr) {
        mesh.rig = kind.make_rig(parameters.data());
    }
    return mesh;
}

}  // namespace

void MadeAssets::begin_level() {
    ++load_;
    const auto is_old = [this](const auto& item) { return item.second.used + kKeptLoads < load_; };
    std::erase_if(meshes_, is_old);
    std::erase_if(patterns_, is_old);
}

MadeMesh
MadeAssets::mesh(const MeshKind& kind, const AnyComponent& parameters, const Assets& assets) {
    if (names_assets(parameters)) {
        return make(kind, parameters, assets);
    }
    const auto [found, is_new] = meshes_.try_emplace(key_of(kind.name, parameters));
    if (is_new) {
        found->second.value = make(kind, parameters, assets);
    }
    found->second.used = load_;
    return found->second.value;
}

PatternMaps MadeAssets::pattern(const PatternKind& kind, const AnyComponent& parameters) {
    const auto [found, is_new] = patterns_.try_emplace(key_of(kind.name, parameters));
    if (is_new) {
        found->second.value = kind.make(parameters.data());
    }
    found->second.used = load_;
    return found->second.value;
}

}  // namespace limn
