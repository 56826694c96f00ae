#include "content/app/commands/head_scene.h"

#include "content/app/commands/model_scene.h"
#include "content/load/gltf/gltf_write.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// Techniques: face.talking-head

namespace limn {
namespace {

/// A part of the head and what it looks like in programs without this engine's skin.
struct PartLook {
    std::string_view part;
    bool of_portrait_only = false;
    Vec3 color = Vec3(1);
    float roughness = 0.5f;
};

constexpr std::array kLooks{
    PartLook{"skin", false, {0.55f, 0.34f, 0.26f}, 0.5f},
    PartLook{"eyes", false, {1, 1, 1}, 0.15f},
    PartLook{"teeth", false, {0.95f, 0.8f, 0.68f}, 0.25f},
    PartLook{"mouth", false, {0.5f, 0.3f, 0.28f}, 0.35f},
    PartLook{"hair", true, {0.03f, 0.02f, 0.014f}, 0.55f},
    PartLook{"scalp", true, {0.05f, 0.035f, 0.025f}, 0.7f},
};

/// By the part of a person that it is of; vertices have the colors.
void dress(Material& material) {
    const std::string& part = material.name;
    if (part == "skin") {
        material.shading = ShadingModel::Subsurface;
        material.roughness = 0.5f;
        material.specular = Vec3(0.028f);
        material.gloss = 0.18f;
        material.gloss_roughness = 0.34f;
        material.scatter = {0.00367f, 0.00137f, 0.00068f};
    } else if (part == "hair") {
        material.shading = ShadingModel::Hair;
        material.roughness = 0.36f;
        material.hair_scatter = 0.6f;
    } else if (part == "eyes") {
        material.roughness = 0.08f;
    } else if (part == "shoes") {
        material.roughness = 0.42f;
    } else {
        material.roughness = 0.88f;
        material.sheen = Vec3(0.05f);
        material.sheen_roughness = 0.55f;
    }
}

}  // namespace

bool is_head_name(std::string_view name) {
    return name == "head" || name == "portrait";
}

Result<GltfScene> make_head_scene(std::string_view name) {
    GltfScene scene =
        LIMN_TRY(make_model_scene({.kind = "head", .name = std::string(name), .parts = true}));
    for (GltfNode& node : scene.nodes) {
        std::erase_if(node.parts, [&](const GltfPart& part) {
            const auto look =
                std::ranges::find(kLooks, scene.meshes[part.mesh].name, &PartLook::part);
            if (look != kLooks.end()) {
                Material& material = scene.materials[part.material];
                material.base_color = Vec4(look->color, 1);
                material.roughness = look->roughness;
                material.double_sided = look->of_portrait_only;
            }
            return look == kLooks.end() || (look->of_portrait_only && name != "portrait");
        });
    }
    // Meshes that no node has are not part of it.
    std::vector<MeshData> kept;
    for (GltfNode& node : scene.nodes) {
        for (GltfPart& part : node.parts) {
            kept.push_back(std::move(scene.meshes[part.mesh]));
            part.mesh = static_cast<std::uint32_t>(kept.size() - 1);
        }
        if (node.parts.empty()) {
            node.skin = -1;
            node.first_morph = -1;
        }
    }
    scene.meshes = std::move(kept);
    scene.clips.clear();
    return scene;
}

Result<GltfScene> make_person_scene(const std::vector<Assignment>& assignments) {
    GltfScene scene = LIMN_TRY(make_model_scene(
        {.kind = "person", .name = "person", .parts = true, .assignments = assignments}));
    for (Material& material : scene.materials) {
        dress(material);
    }
    return scene;
}

Status run_export(const ExportOptions& options) {
    if (!options.out.ends_with(".glb")) {
        return fail("{}: expected a file name ending in .glb", options.out);
    }
    const bool is_person = options.name == "person";
    if (!is_person && !options.assignments.empty()) {
        return fail("--set: a {} has no parameters, expected a person", options.name);
    }
    const GltfScene scene = LIMN_TRY(
        is_person ? make_person_scene(options.assignments) : make_head_scene(options.name));
    LIMN_TRY(save_glb(options.out, scene));
    fmt::print(
        "{}: {} meshes, {} shapes\n", options.out, scene.meshes.size(),
        scene.meshes[0].morphs.size());
    return Done{};
}

}  // namespace limn
