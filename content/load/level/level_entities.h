#pragma once

#include "content/load/files/error_list.h"
#include "content/load/files/json_document.h"
#include "content/load/level/component_json.h"
#include "content/load/level/level_nodes.h"
#include "content/load/level/level_repeat.h"
#include "ecs/base/result.h"
#include "ecs/prefab.h"

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace limn {

// Expands the nodes of a level file (level_load.h), with their prefabs, repeats and children, into
// one flat list of entities. Names are resolved from the innermost scope outwards: in the prefab
// instance that uses them, then around it; forward references are allowed.

/// Limits of the expansion.
struct EntityLimits {
    std::size_t max_entities = 2'000'000;
    std::size_t max_values = std::size_t{1} << 25;  ///< JSON values, counted at each use
    std::size_t max_depth = 128;                    ///< of nested children
};

/// A glTF file and the entities that use it.
struct GltfUse {
    std::string file;
    std::string variant;  ///< of its materials; empty: the default
    SourcePosition at;
    std::vector<std::uint32_t> entities;  ///< indices into the list
};

class LevelEntities {
  public:
    /// `prefabs` are those of `file` and must outlive this, as must `errors`, which collects
    /// errors. `names` resolves assets; if it resolves entities, then those that neither a separate
    /// prefab nor the list defines.
    LevelEntities(
        std::string file, const std::vector<JsonMember>& prefabs, NameResolver names,
        const EntityLimits& limits, ErrorList& errors);

    /// Appends the entity `node` and its descendants. `path` is used in messages if it has no name.
    /// Parts with an error are skipped, so that the rest is read.
    void add(const JsonValue& node, const std::string& path);
    /// Whether an entity exceeded the limits, as all further ones would.
    [[nodiscard]] bool is_full() const { return is_full_; }

    /// Replaces names by entity indices, after all nodes are added.
    void resolve_names();

    /// Index of the entity with this name outside of prefabs, or -1.
    [[nodiscard]] std::int64_t find(std::string_view name) const;
    [[nodiscard]] std::vector<std::string_view> names() const;
    /// Treats any name as that of an entity that could not be read.
    void expect_gaps() { has_gaps_ = true; }
    /// Whether an entity with this name, or a copy `name[i]`, was skipped because of an error:
    /// references to it report no further one.
    [[nodiscard]] bool has_failed(std::string_view name) const;

    /// `node` and its descendants as a separate prefab, after all nodes are added. Names that it
    /// does not define are those of the level and become level_entity(index). It may use no glTF.
    [[nodiscard]] Result<Prefab> read_prefab(const JsonValue& node, const std::string& path);

    /// Validates the prefabs that no entity uses.
    void check_unused_prefabs();

    [[nodiscard]] Prefab& entities() { return level_.entities; }
    /// Source position of each of them.
    [[nodiscard]] std::vector<SourcePosition>& positions() { return level_.positions; }
    [[nodiscard]] std::vector<GltfUse>& gltfs() { return level_.gltfs; }
    [[nodiscard]] std::vector<NodeChange>& node_changes() { return level_.node_changes; }

  private:
    /// Names visible in a part of a list. Scope 0 is the outermost.
    struct Scope {
        std::uint32_t outer = 0;
        std::unordered_map<std::string, std::uint32_t> names;
    };
    /// An entity that a component references by name.
    struct NameUse {
        std::string name;
        SourcePosition at;
    };
    struct List {
        Prefab entities;
        std::vector<SourcePosition> positions;
        std::vector<std::uint32_t> scope_of;  // in which each entity resolves names
        std::vector<Scope> scopes = {Scope{}};
        std::vector<NameUse> uses;
        std::vector<GltfUse> gltfs;
        std::vector<NodeChange> node_changes;
    };
    /// The "nodes" of an entity without a glTF file: changes of its descendants.
    struct Changes {
        std::vector<const JsonValue*> layers;  // the innermost prefab's first
        Changes* outer = nullptr;              // those of an ancestor
        std::set<std::string> descendants;     // their names
    };
    /// Context in which a node is added.
    struct Context {
        std::int64_t parent = -1;
        std::uint32_t scope = 0;
        std::size_t depth = 0;
        Changes* changes = nullptr;  // of the nearest ancestor
    };
    struct Node {
        const JsonValue* json = nullptr;
        std::vector<const JsonValue*> layers;  // the innermost prefab first, the node itself last
        std::string path;
        std::string name;
        bool has_children = false;
        bool is_copy = false;  // a prefab instance, or repeated: has its own scope
    };

    void
    add_node(List& list, const JsonValue& json, const Context& context, const std::string& path);
    [[nodiscard]] Status try_add_node(
        List& list, const JsonValue& json, const Context& context, const std::string& path);
    void check_without_prefab(List& list, Node& node);
    void note_missing(const JsonValue& node);
    [[nodiscard]] Status find_layers(Node& node);
    [[nodiscard]] Status add_changes(Node& node, Changes* changes) const;
    [[nodiscard]] Result<Changes> read_changes(const Node& node, Changes* outer) const;
    [[nodiscard]] Status check_changes(const Node& node, const Changes& changes) const;
    [[nodiscard]] Status read_own_keys(Node& node) const;
    [[nodiscard]] Status add_copies(List& list, Node& node, const Context& context);
    void add_copy(
        List& list, const Node& node, const Context& context, std::vector<AnyComponent> components,
        const std::string& name);
    [[nodiscard]] Status add_gltf(List& list, const Node& node, std::uint32_t index);
    [[nodiscard]] std::vector<AnyComponent> read_components(List& list, const Node& node);
    [[nodiscard]] Status read_member(
        const JsonMember& member, const Node& node, const NameResolver& names,
        std::vector<AnyComponent>& components);
    [[nodiscard]] Status charge_limits(const Node& node, std::uint64_t copies);
    [[nodiscard]] NameResolver names_in(List& list) const;
    void resolve(List& list, bool is_level);
    [[nodiscard]] Error
    unknown_name(List& list, std::size_t index, const NameUse& use, std::string_view field) const;
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
    std::vector<std::string> open_;  // prefabs being expanded
    NameResolver names_;
    EntityLimits limits_;
    std::size_t entities_ = 0;
    std::size_t values_ = 0;
    bool is_full_ = false;
    bool has_gaps_ = false;
    bool has_left_out_ = false;
    ErrorList& errors_;
    std::unordered_set<std::string> missing_;  // names of entities that were skipped
    List level_;
};

/// Placeholder for entity `index` of the level in a prefab that an event spawns.
[[nodiscard]] constexpr Entity level_entity(std::uint32_t index) {
    return {index, 0xfffffffeu};
}

}  // namespace limn
