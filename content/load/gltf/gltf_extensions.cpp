#include "content/load/gltf/gltf_extensions.h"

#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

namespace limn {

namespace {

constexpr std::string_view kReadExtensions[] = {
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "MSFT_texture_dds",
};

/// Prefixes of extensions that only affect looks: without them every part is still in the right
/// position.
constexpr std::string_view kOptionalExtensions[] = {
    "KHR_materials_", "ADOBE_materials_", "EXT_materials_",          "MSFT_packing_",
    "KHR_lights_",    "EXT_lights_",      "EXT_structural_metadata", "EXT_mesh_features",
    "KHR_xmp",        "KHR_audio",        "KHR_animation_pointer",   "KHR_physics",
    "MSFT_lod",       "MSFT_physics",     "KHR_interactivity",       "VRM",
};

/// How to convert a file that requires an extension. gltf-transform is a free command-line tool.
constexpr std::pair<std::string_view, std::string_view> kExtensionHints[] = {
    {"KHR_draco_mesh_compression", "decompress with `gltf-transform copy in.glb out.glb`"},
    {"KHR_meshopt_compression", "decompress with `gltf-transform copy in.glb out.glb`"},
    {"KHR_texture_basisu",
     "convert its textures with `gltf-transform ktxdecompress in.glb out.glb`"},
    {"EXT_texture_avif", "convert its textures with `gltf-transform png in.glb out.glb`"},
    {"KHR_techniques_webgl", "export it with metallic-roughness materials"},
};

bool is_read(std::string_view name) {
    return std::ranges::find(kReadExtensions, name) != std::end(kReadExtensions);
}

bool is_optional(std::string_view name) {
    return std::ranges::any_of(
        kOptionalExtensions, [name](std::string_view prefix) { return name.starts_with(prefix); });
}

std::string_view hint_of(std::string_view name) {
    const auto hint = std::ranges::find(
        kExtensionHints, name, &std::pair<std::string_view, std::string_view>::first);
    return hint != std::end(kExtensionHints) ? hint->second : "export the model without it";
}

/// Names of the extensions in `json`, whether the file lists them or not.
void find_extensions(const JsonValue& json, std::set<std::string_view>& names) {
    for (const JsonValue& item : json.items) {
        find_extensions(item, names);
    }
    for (const JsonMember& member : json.members) {
        if (member.key == "extensions") {
            for (const JsonMember& extension : member.value.members) {
                names.insert(extension.key);
            }
        } else if (member.key != "extras") {
            find_extensions(member.value, names);
        }
    }
}

}  // namespace

Status check_gltf_extensions(
    const JsonValue& json, const std::string& file, std::vector<std::string>& warnings) {
    constexpr std::size_t kMaxNamed = 4;
    std::vector<std::string> missing;
    std::set<std::string_view> used;
    for (const JsonValue& name : json["extensionsRequired"].items) {
        if (used.insert(name.text).second && !is_read(name.text) && !is_optional(name.text)) {
            missing.push_back(fmt::format("{} ({})", in_quotes(name.text), hint_of(name.text)));
        }
    }
    if (!missing.empty()) {
        const std::size_t rest = missing.size() - std::min(missing.size(), kMaxNamed);
        missing.resize(missing.size() - rest);
        return fail(
            "{}: extensionsRequired: found {}{}, expected extensions that can be read", file,
            join_text(missing, ", "), rest > 0 ? fmt::format(" and {} more", rest) : "");
    }
    for (const JsonValue& name : json["extensionsUsed"].items) {
        used.insert(name.text);
    }
    find_extensions(json, used);
    for (const std::string_view name : used) {
        if (!is_read(name)) {
            warnings.push_back(
                fmt::format("{}: the extension {} is ignored", file, in_quotes(name)));
        }
    }
    return Done{};
}

}  // namespace limn
