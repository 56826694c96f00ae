#include "content/load/gltf_extras.h"

#include "content/load/asset_lists.h"
#include "content/load/component_json.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace limn {

namespace {

/// Calls visit(name of the asset of that kind) in order.
template <typename Visit>
void visit_names(const GltfScene& scene, std::string_view kind, Visit&& visit) {
    if (kind == asset_kind<SkeletonId>) {
        if (!scene.skeleton.joints.empty()) {
            visit(scene.skeleton.name);
        }
        return;
    }
    struct Lists {
        const std::vector<MeshData>& meshes;
        const std::vector<Material>& materials;
        const std::vector<ImageData>& images;
        std::vector<SkeletonData> skeletons;
        const std::vector<SkinData>& skins;
        const std::vector<ClipData>& clips;
        std::vector<PathData> paths;
    };
    const Lists lists{
        scene.meshes, scene.materials, scene.images, {}, scene.skins, scene.clips, {}};
    visit_asset_list(lists, kind, [&](const auto& list) {
        for (const auto& asset : list) {
            visit(asset.name);
        }
    });
}

std::optional<std::uint32_t>
find_asset(const GltfScene& scene, std::string_view kind, std::string_view name) {
    std::optional<std::uint32_t> found;
    std::uint32_t index = 0;
    visit_names(scene, kind, [&](const std::string& candidate) {
        found = !found && candidate == name ? std::optional(index) : found;
        ++index;
    });
    return found;
}

std::vector<std::string_view> all_names(const GltfScene& scene, std::string_view kind) {
    std::vector<std::string_view> names;
    visit_names(scene, kind, [&](const std::string& name) { names.emplace_back(name); });
    if (kind == "entity") {
        for (const GltfNode& node : scene.nodes) {
            names.emplace_back(node.name);
        }
    }
    return names;
}

class ExtrasReader {
  public:
    ExtrasReader(const GltfDocument& document, GltfScene& scene)
        : document_(document), scene_(scene) {
        for (std::uint32_t i = 0; i < scene.nodes.size(); ++i) {
            by_name_.try_emplace(scene.nodes[i].name, i);
        }
        by_name_.erase("");
        names_.entity = [this](std::string_view name, SourcePosition) -> std::optional<Entity> {
            const auto found = by_name_.find(name);
            return found == by_name_.end() ? std::nullopt
                                           : std::optional(gltf_node_entity(found->second));
        };
        names_.asset = [this](std::string_view kind, std::string_view name) {
            return find_asset(scene_, kind, name);
        };
        names_.all = [this](std::string_view kind) { return all_names(scene_, kind); };
    }

    Status read() {
        for (std::size_t index = 0; index < document_.scene_nodes.size(); ++index) {
            if (document_.scene_nodes[index] < 0) {
                continue;
            }
            const JsonValue& source = json_item(document_, "nodes", index);
            const JsonValue* extras = source.find("extras");
            const JsonValue* limn = extras != nullptr ? extras->find("limn") : nullptr;
            if (limn != nullptr) {
                if (Status status = read_components(*limn, index); !status) {
                    return status;
                }
            }
        }
        return Done{};
    }

  private:
    /// An object with a member for each component; or that object as text, as Blender writes a
    /// custom property that somebody typed.
    Status read_components(const JsonValue& limn, std::size_t index) {
        const std::string where = fmt::format("nodes[{}].extras.limn", index);
        if (limn.kind == JsonKind::String) {
            const Result<JsonValue> parsed =
                parse_json(limn.text, fmt::format("{}: {}", document_.file, where));
            if (!parsed) {
                return parsed.error();
            }
            return read_object(*parsed, index, where);
        }
        return read_object(limn, index, where);
    }

    Status read_object(const JsonValue& object, std::size_t index, const std::string& where) {
        if (object.kind != JsonKind::Object) {
            return fail(
                "{}: {}: found {}, expected an object with a member for each component",
                document_.file, where, describe(object));
        }
        for (const JsonMember& member : object.members) {
            const ComponentInfo* info = find_component(member.key);
            if (info == nullptr) {
                std::vector<std::string_view> known;
                for (const ComponentInfo* other : all_components()) {
                    known.emplace_back(other->name);
                }
                return fail(
                    "{}: {}: found {}, expected the name of a component{}", document_.file, where,
                    in_quotes(member.key), did_you_mean(member.key, known));
            }
            Result<AnyComponent> component = read_component(
                member.value, *info, {document_.file, where + "." + member.key}, names_);
            if (!component) {
                return component.error();
            }
            const auto node = static_cast<std::size_t>(document_.scene_nodes[index]);
            scene_.nodes[node].components.push_back(std::move(*component));
        }
        return Done{};
    }

    const GltfDocument& document_;
    GltfScene& scene_;
    std::unordered_map<std::string_view, std::uint32_t> by_name_;  ///< nodes of the scene
    FindNames names_;
};

}  // namespace

Status read_extras(const GltfDocument& document, GltfScene& scene) {
    return ExtrasReader(document, scene).read();
}

}  // namespace limn
