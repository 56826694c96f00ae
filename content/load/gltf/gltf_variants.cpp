#include "content/load/gltf/gltf_document.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {

namespace {

constexpr std::string_view kVariants = "KHR_materials_variants";

/// The material of a primitive in a variant; -1 where that is the default.
int find_variant_material(const JsonValue& primitive, std::size_t variant) {
    for (const JsonValue& mapping : primitive["extensions"][kVariants]["mappings"].items) {
        for (const JsonValue& listed : mapping["variants"].items) {
            if (static_cast<std::size_t>(listed.number) == variant) {
                return static_cast<int>(mapping["material"].number);
            }
        }
    }
    return -1;
}

}  // namespace

Status choose_variant(GltfDocument& document, const std::string& name, GltfScene& scene) {
    for (const JsonValue& variant : document.json["extensions"][kVariants]["variants"].items) {
        scene.variants.push_back(variant["name"].text);
    }
    if (name.empty()) {
        return Done{};
    }
    const auto chosen = std::ranges::find(scene.variants, name);
    if (chosen == scene.variants.end()) {
        return fail(
            "{}: found no material variant {}, expected {}{}", document.file, in_quotes(name),
            scene.variants.empty() ? "none, since the file has none" : "one of ",
            join_text(scene.variants, ", "));
    }
    const auto variant = static_cast<std::size_t>(chosen - scene.variants.begin());
    const std::vector<JsonValue>& meshes = document.json["meshes"].items;
    for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh) {
        const std::vector<JsonValue>& primitives = meshes[mesh]["primitives"].items;
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            if (const int material = find_variant_material(primitives[i], variant); material >= 0) {
                document.model.meshes[mesh].primitives[i].material = material;
            }
        }
    }
    return Done{};
}

}  // namespace limn
