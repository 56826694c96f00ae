#include "content/load/asset_lists.h"
#include "content/load/gltf/gltf_document.h"
#include "content/load/level/component_json.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace limn {

namespace {

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
        names_.asset = [this](std::string_view kind, std::string_view name, SourcePosition) {
            return find_asset(list_assets(scene_), kind, name);
        };
        names_.all = [this](std::string_view kind) {
            std::vector<std::string_view> all = asset_names(list_assets(scene_), kind);
            for (std::size_t i = 0; kind == "entity" && i < scene_.nodes.size(); ++i) {
                all.emplace_back(scene_.nodes[i].name);
            }
            return all;
        };
    }

    Status read() {
        for (std::size_t index = 0; index < document_.scene_nodes.size(); ++index) {
            if (document_.scene_nodes[index] < 0) {
                continue;
            }
            if (const JsonValue* const limn = extras_of(document_, "nodes", index).find("limn")) {
                LIMN_TRY(read_components(*limn, index));
            }
        }
        return Done{};
    }

  private:
    /// An object with a member for each component; or that object as a string, as Blender exports
    /// custom properties.
    Status read_components(const JsonValue& limn, std::size_t index) {
        const std::string where = fmt::format("nodes[{}].extras.limn", index);
        if (limn.kind == JsonKind::String) {
            const JsonValue parsed =
                LIMN_TRY(parse_json(limn.text, fmt::format("{}: {}", document_.file, where)));
            return read_object(parsed, index, where);
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
            const auto node = static_cast<std::size_t>(document_.scene_nodes[index]);
            scene_.nodes[node].components.push_back(LIMN_TRY(read_component(
                member.value, *info, {document_.file, where + "." + member.key}, names_)));
        }
        return Done{};
    }

    const GltfDocument& document_;
    GltfScene& scene_;
    std::unordered_map<std::string_view, std::uint32_t> by_name_;  ///< nodes of the scene
    NameResolver names_;
};

}  // namespace

Status read_extras(const GltfDocument& document, GltfScene& scene) {
    return ExtrasReader(document, scene).read();
}

}  // namespace limn
