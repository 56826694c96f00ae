#pragma once

#include "content/load/component_json.h"
#include "content/load/json_document.h"
#include "content/load/level_repeat.h"
#include "ecs/base/result.h"
#include "ecs/prefab.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace limn {

// The nodes of a level file (level_load.h), with their prefabs, repetitions and children, written
// out as one flat list of entities. Names are looked up from the inside out: in the copy of the
// prefab that uses them, then around it; they may be used before the entity they name is written.

/// What writing out may cost.
struct EntityLimits {
    std::size_t max_entities = 2'000'000;
    std::size_t max_values = std::size_t{1} << 25;  ///< JSON values, as often as they are used
    std::size_t max_depth = 128;                    ///< of children in each other
};

/// A glTF file and the entities that it belongs under.
struct GltfUse {
    std::string file;
    SourcePosition at;
    std::vector<std::uint32_t> entities;  ///< numbers in the list
};

class LevelEntities {
  public:
    /// `prefabs` is the object of that name in `file`, or null; it must outlive this. `names` knows
    /// the assets.
    LevelEntities(
        std::string file, const JsonValue* prefabs, FindNames names, const EntityLimits& limits);

    /// Appends the entity `node` and all below it. `path` names it in messages unless it has a
    /// name.
    [[nodiscard]] Status add(const JsonValue& node, const std::string& path);

    /// Puts numbers in the place of names, once all is added.
    [[nodiscard]] Status resolve_names();

    /// The number of the entity with this name outside of prefabs; -1: there is none.
    [[nodiscard]] std::int64_t find(std::string_view name) const;
    [[nodiscard]] std::vector<std::string_view> names() const;

    /// `node` and what is below it as a prefab of its own, after all is added. Names that it does
    /// not hold are the level's, and become level_entity(number). It may use no glTF.
    [[nodiscard]] Result<Prefab> read_prefab(const JsonValue& node, const std::string& path);

    /// Refuses prefabs that no entity uses but that could not be used either.
    [[nodiscard]] Status check_unused_prefabs();

    [[nodiscard]] Prefab& entities() { return level_.entities; }
    [[nodiscard]] std::vector<GltfUse>& gltfs() { return level_.gltfs; }

  private:
    /// Names that may be used in a part of a list. Scope 0 is around all.
    struct Scope {
        std::uint32_t outer = 0;
        std::unordered_map<std::string, std::uint32_t> names;
    };
    /// A name that a component uses.
    struct NameUse {
        std::string name;
        SourcePosition at;
    };
    struct List {
        Prefab entities;
        std::vector<std::uint32_t> scope_of;  // of each entity's own names
        std::vector<Scope> scopes = {Scope{}};
        std::vector<NameUse> uses;
        std::vector<GltfUse> gltfs;
    };
    /// Where a node is added.
    struct Around {
        std::int64_t parent = -1;
        std::uint32_t scope = 0;
        std::size_t depth = 0;
    };
    struct Node {
        const JsonValue* json = nullptr;
        std::vector<const JsonValue*> layers;  // the innermost prefab first, the node itself last
        std::string path;
        std::string name;
        bool has_children = false;
        bool is_copy = false;  // of a prefab, or repeated: it has a scope of its own
    };

    [[nodiscard]] Status
    add_node(List& list, const JsonValue& json, const Around& around, const std::string& path);
    [[nodiscard]] Status find_layers(Node& node);
    [[nodiscard]] Status read_own_keys(Node& node) const;
    [[nodiscard]] Status add_copies(List& list, Node& node, const Around& around);
    [[nodiscard]] Status add_copy(
        List& list, const Node& node, const Around& around, std::vector<AnyComponent> components,
        const std::string& name);
    [[nodiscard]] Status
    add_name(List& list, const Node& node, std::uint32_t scope, const std::string& name);
    [[nodiscard]] Result<std::vector<AnyComponent>> read_components(List& list, const Node& node);
    [[nodiscard]] Status read_layer(
        List& list, const JsonValue& layer, const Node& node,
        std::vector<AnyComponent>& components);
    [[nodiscard]] Status spend(const Node& node, std::uint64_t copies);
    [[nodiscard]] FindNames names_in(List& list) const;
    [[nodiscard]] Status resolve(List& list, bool is_level) const;
    [[nodiscard]] Error refuse(
        const std::string& path, SourcePosition at, std::string_view found,
        std::string_view expected) const {
        return error_at({file_, path}, at, found, expected);
    }

    struct PrefabJson {
        const JsonValue* json = nullptr;
        bool is_used = false;
    };

    std::string file_;
    std::map<std::string, PrefabJson, std::less<>> prefabs_;
    std::vector<std::string> open_;  // prefabs that are being written out
    FindNames names_;
    EntityLimits limits_;
    std::size_t entities_ = 0;
    std::size_t values_ = 0;
    List level_;
};

/// Entity `index` of the level, in what an event spawns.
[[nodiscard]] constexpr Entity level_entity(std::uint32_t index) {
    return {index, 0xfffffffeu};
}

}  // namespace limn
