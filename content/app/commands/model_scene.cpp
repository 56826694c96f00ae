#include "content/app/commands/model_scene.h"

#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_skeleton.h"
#include "content/load/level/component_json.h"
#include "content/make/make_mesh.h"
#include "ecs/any_component.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace limn {
namespace {

Status set_fields(const ModelOptions& options, AnyComponent& parameters) {
    for (const Assignment& set : options.assignments) {
        const Result<JsonValue> json = parse_json(set.value, "--set");
        const JsonValue value = json ? *json : json_of(std::string_view(set.value));
        LIMN_TRY(read_component(
            json_object({{set.path, {}, value}}), parameters.info(), parameters.data(),
            {"--set", ""}, {}));
    }
    return Done{};
}

/// The values of the field `part`, without "all"; or nothing.
std::vector<std::string> part_names(const ComponentInfo& parameters) {
    std::vector<std::string> names;
    for (const FieldInfo& field : parameters.fields) {
        if (std::string_view(field.name) == "part") {
            for (const std::string_view value : field.values) {
                if (value != "all") {
                    names.emplace_back(value);
                }
            }
        }
    }
    return names;
}

/// Without weights of morph targets, which are not written.
std::vector<ClipData> motion_of_joints(std::vector<ClipData> clips) {
    for (ClipData& clip : clips) {
        for (ClipSheet& sheet : clip.sheets) {
            sheet.morphing.clear();
            sheet.weights.clear();
        }
        std::erase_if(clip.sheets, [](const ClipSheet& sheet) {
            return sheet.rotating.empty() && sheet.translating.empty() && sheet.scaling.empty();
        });
    }
    std::erase_if(clips, [](const ClipData& clip) { return clip.sheets.empty(); });
    return clips;
}

void add_mesh(GltfScene& scene, const std::string& name, MeshData mesh) {
    GltfNode& node = scene.nodes.emplace_back();
    node.name = name;
    node.parts.push_back(
        {static_cast<std::uint32_t>(scene.meshes.size()),
         static_cast<std::uint32_t>(scene.materials.size())});
    node.skin = !mesh.skin.empty() && !scene.skins.empty() ? 0 : -1;
    if (!mesh.morphs.empty()) {
        node.first_morph = static_cast<std::int32_t>(scene.morph_weights.size());
        scene.morph_weights.resize(scene.morph_weights.size() + mesh.morphs.size(), 0.0f);
    }
    if (!scene.joints.empty()) {
        scene.joints.push_back(-1);
    }
    mesh.name = name;
    scene.meshes.push_back(std::move(mesh));
    Material material;
    material.name = name;
    material.base_color = {1, 1, 1, 1};
    material.roughness = 0.6f;
    scene.materials.push_back(material);
}

}  // namespace

Result<GltfScene> make_model_scene(const ModelOptions& options) {
    const MeshKind* kind = find_kind(mesh_kinds(), options.kind);
    if (kind == nullptr) {
        return fail(
            "found the kind \"{}\", expected {}{}", options.kind, kind_names(mesh_kinds()),
            kind_suggestion(mesh_kinds(), options.kind));
    }
    AnyComponent parameters(*kind->parameters);
    LIMN_TRY(set_fields(options, parameters));
    std::vector<std::string> parts = {""};
    if (options.parts) {
        parts = part_names(*kind->parameters);
        if (parts.empty()) {
            return fail("--parts: a {} has no parts", options.kind);
        }
    }
    GltfScene scene;
    scene.name = options.name;
    if (kind->make_rig != nullptr) {
        const MeshRig rig = kind->make_rig(parameters.data());
        add_skeleton(scene, scene.name, rig.skeleton);
        scene.skins.push_back(below_scene(rig.skin));
        for (ClipData& clip : motion_of_joints(rig.clips)) {
            scene.clips.push_back(below_scene(std::move(clip)));
        }
    }
    const Assets none;
    for (const std::string& part : parts) {
        if (!part.empty()) {
            LIMN_TRY(read_component(
                json_object({{"part", {}, json_of(std::string_view(part))}}), parameters.info(),
                parameters.data(), {"--parts", ""}, {}));
        }
        MeshData mesh = kind->make(parameters.data(), none);
        if (!mesh.indices.empty()) {
            add_mesh(scene, part.empty() ? options.kind : part, std::move(mesh));
        }
    }
    if (scene.meshes.empty()) {
        return fail("a {} without other meshes or paths of a level is empty", options.kind);
    }
    return scene;
}

}  // namespace limn
