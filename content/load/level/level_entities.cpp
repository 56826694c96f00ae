#include "content/load/level/level_entities.h"

#include "content/load/level/level_hints.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/component_bytes.h"
#include "ecs/components/animation.h"
#include "ecs/components/name.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"

#include <fmt/format.h>

#include <algorithm>

// Techniques: engine.object-text, engine.stock-active

namespace limn {

namespace {

constexpr std::uint32_t kUseGeneration = 0xfffffffdu;  // marks a placeholder for a NameUse
constexpr std::size_t kMaxLayers = 64;

const std::vector<std::string_view> kNodeKeys = {"name",  "prefab", "gltf",    "variant",
                                                 "nodes", "repeat", "children"};

bool is_node_key(std::string_view key) {
    return std::find(kNodeKeys.begin(), kNodeKeys.end(), key) != kNodeKeys.end();
}

/// The value of `key` in the last layer that has it, or null.
const JsonValue* find_in_layers(const std::vector<const JsonValue*>& layers, std::string_view key) {
    for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
        if (const JsonValue* const value = (*layer)->find(key)) {
            return value;
        }
    }
    return nullptr;
}

/// "repeat" of all layers: later ones replace single keys, as with components, or reset it with
/// null.
JsonValue merged_repeat(const std::vector<const JsonValue*>& layers) {
    JsonValue merged;
    for (const JsonValue* const layer : layers) {
        const JsonValue* const repeat = layer->find("repeat");
        if (repeat == nullptr) {
            continue;
        }
        if (repeat->kind != JsonKind::Object || merged.kind != JsonKind::Object) {
            merged = *repeat;
            continue;
        }
        merged.at = repeat->at;
        for (const JsonMember& member : repeat->members) {
            std::erase_if(
                merged.members, [&](const JsonMember& old) { return old.key == member.key; });
            merged.members.push_back(member);
        }
    }
    return merged;
}

/// Cost of reading a value, in values.
std::size_t weight(const JsonValue& json) {
    std::size_t sum = 1 + json.text.size() / 16;
    for (const JsonValue& item : json.items) {
        sum += weight(item);
    }
    for (const JsonMember& member : json.members) {
        sum += weight(member.value);
    }
    return sum;
}

/// Sets unset character references to the nearest character, the entity itself or an ancestor.
void follow_character(Prefab& list, std::uint32_t index) {
    std::vector<AnyComponent>& own = list.entities[index].components;
    std::vector<Entity*> open;
    if (auto* const deformed = find_in<Deformed>(own)) {
        open.push_back(&deformed->character);
    }
    if (auto* const attached = find_in<JointAttachment>(own)) {
        open.push_back(&attached->character);
    }
    std::erase_if(open, [](const Entity* character) { return !character->is_null(); });
    for (std::uint32_t at = index; !open.empty();) {
        std::vector<AnyComponent>& components = list.entities[at].components;
        if (find_in<Skeleton>(components) != nullptr
            || find_in<MorphWeights>(components) != nullptr) {
            for (Entity* const character : open) {
                *character = prefab_entity(at);
            }
            return;
        }
        const auto* const parent = find_in<Parent>(components);
        if (parent == nullptr) {
            return;
        }
        at = parent->entity.index;
    }
}

}  // namespace

LevelEntities::LevelEntities(
    std::string file, const std::vector<JsonMember>& prefabs, NameResolver names,
    const EntityLimits& limits, ErrorList& errors)
    : file_(std::move(file)), names_(std::move(names)), limits_(limits), errors_(errors) {
    for (const JsonMember& prefab : prefabs) {
        prefabs_[prefab.key].json = &prefab.value;
    }
}

void LevelEntities::add(const JsonValue& node, const std::string& path) {
    add_node(level_, node, {}, path);
}

void LevelEntities::add_node(
    List& list, const JsonValue& json, const Context& context, const std::string& path) {
    const std::size_t open_before = open_.size();
    const Status status = try_add_node(list, json, context, path);
    open_.resize(open_before);
    if (!status) {
        errors_.keep(status);
        note_missing(json);
        has_left_out_ = true;
    }
}

Status LevelEntities::try_add_node(
    List& list, const JsonValue& json, const Context& context, const std::string& path) {
    Node node;
    node.json = &json;
    node.path = path;
    LIMN_TRY(expect(json, JsonKind::Object, {file_, path}, "an entity (an object)"));
    if (context.depth >= limits_.max_depth) {
        return refuse(
            path, json.at, fmt::format("more than {} nested entities", limits_.max_depth), "fewer");
    }
    LIMN_TRY(read_own_keys(node));
    if (const Status found = find_layers(node); !found) {
        check_without_prefab(list, node);
        return found;
    }
    LIMN_TRY(add_changes(node, context.changes));
    return add_copies(list, node, context);
}

/// What is known of a node whose prefab cannot be used: its glTF file and its number of copies.
void LevelEntities::check_without_prefab(List& list, Node& node) {
    node.layers = {node.json};
    errors_.keep(add_gltf(list, node, 0));
    JsonValue json = merged_repeat(node.layers);
    std::erase_if(json.members, [](const JsonMember& member) {
        return member.key == "vary";  // of components that the prefab may have
    });
    if (json.kind != JsonKind::Null) {
        const Result<Repeat> repeat =
            read_repeat(json, {}, {file_, node.path + ".repeat"}, names_in(list));
        errors_.keep(repeat ? Status(Done{}) : repeat.error());
    }
}

/// Adds the changes that ancestors make to the node, the outermost last.
Status LevelEntities::add_changes(Node& node, Changes* changes) const {
    for (; changes != nullptr && !node.name.empty(); changes = changes->outer) {
        changes->descendants.insert(node.name);
        for (const JsonValue* const layer : changes->layers) {
            const JsonValue* const change = layer->find(node.name);
            if (change == nullptr) {
                continue;
            }
            const JsonLocation location{file_, "nodes." + node.name};
            LIMN_TRY(expect(*change, JsonKind::Object, location, "an object: components by name"));
            for (const JsonMember& member : change->members) {
                if (is_node_key(member.key)) {
                    return refuse(
                        location.path, member.at, "the key " + in_quotes(member.key), "components");
                }
            }
            node.layers.push_back(change);
        }
    }
    return Done{};
}

/// The "nodes" of a node with children; with a glTF file, they refer to the file instead.
Result<LevelEntities::Changes> LevelEntities::read_changes(const Node& node, Changes* outer) const {
    Changes changes{{}, outer, {}};
    if (find_in_layers(node.layers, "gltf") != nullptr) {
        return changes;
    }
    for (const JsonValue* const layer : node.layers) {
        const JsonValue* const nodes = layer->find("nodes");
        if (nodes == nullptr) {
            continue;
        }
        if (!node.has_children) {
            return refuse(
                node.path, nodes->at, "nodes without a glTF file or children",
                "\"gltf\", \"prefab\" or \"children\" as well");
        }
        LIMN_TRY(expect(
            *nodes, JsonKind::Object, {file_, node.path + ".nodes"},
            "an object: descendants by name"));
        changes.layers.push_back(nodes);
    }
    return changes;
}

Status LevelEntities::check_changes(const Node& node, const Changes& changes) const {
    const std::vector<std::string_view> names(
        changes.descendants.begin(), changes.descendants.end());
    for (const JsonValue* const layer : changes.layers) {
        for (const JsonMember& change : layer->members) {
            if (!changes.descendants.contains(change.key) && !has_failed(change.key)) {
                return refuse(
                    node.path + ".nodes", change.at, "the node " + in_quotes(change.key),
                    "the name of a child or of its children" + did_you_mean(change.key, names));
            }
        }
    }
    return Done{};
}

/// Records the names that `node` and its descendants would have had.
void LevelEntities::note_missing(const JsonValue& node) {
    if (const std::string& name = node["name"].text; !name.empty()) {
        missing_.insert(name);
    }
    for (const JsonValue& child : node["children"].items) {
        note_missing(child);
    }
}

bool LevelEntities::has_failed(std::string_view name) const {
    return has_gaps_ || missing_.contains(std::string(name.substr(0, name.find('['))));
}

Status LevelEntities::read_own_keys(Node& node) const {
    const JsonValue* const name = node.json->find("name");
    if (name == nullptr) {
        return Done{};
    }
    const bool good = name->kind == JsonKind::String && !name->text.empty()
                      && name->text.find('.') == std::string::npos;
    if (!good) {
        return unexpected(*name, {file_, node.path}, "a name: a non-empty string without '.'");
    }
    node.name = name->text;
    node.path = "entity " + in_quotes(name->text);
    return Done{};
}

/// Collects the chain of prefabs that the node is based on.
Status LevelEntities::find_layers(Node& node) {
    const JsonValue* layer = node.json;
    node.layers.push_back(layer);
    while (const JsonValue* const used = layer->find("prefab")) {
        const auto prefab =
            used->kind == JsonKind::String ? prefabs_.find(used->text) : prefabs_.end();
        if (prefab == prefabs_.end()) {
            std::vector<std::string_view> known;
            for (const auto& [name, ignored] : prefabs_) {
                known.emplace_back(name);
            }
            return refuse(
                node.path, used->at,
                used->kind == JsonKind::String ? "the prefab " + in_quotes(used->text)
                                               : describe(*used),
                "the name of one of \"prefabs\"" + did_you_mean(used->text, known));
        }
        if (std::find(open_.begin(), open_.end(), used->text) != open_.end()) {
            return refuse(
                node.path, used->at,
                fmt::format(
                    "the prefab {} inside itself ({} > {})", in_quotes(used->text),
                    fmt::join(open_, " > "), used->text),
                "one that does not contain itself");
        }
        layer = prefab->second.json;
        prefab->second.is_used = true;
        const std::string path = "prefabs." + used->text;
        LIMN_TRY(expect(*layer, JsonKind::Object, {file_, path}, "an entity (an object)"));
        if (const JsonValue* const name = layer->find("name")) {
            return refuse(
                path, name->at, "a name", "none, since the entities that use it have names");
        }
        open_.push_back(used->text);
        node.layers.push_back(layer);
        if (node.layers.size() > kMaxLayers) {
            return refuse(
                node.path, used->at, fmt::format("a chain of more than {} prefabs", kMaxLayers),
                "fewer");
        }
    }
    std::reverse(node.layers.begin(), node.layers.end());
    node.is_copy = node.layers.size() > 1;
    node.has_children = std::any_of(node.layers.begin(), node.layers.end(), [](const JsonValue* l) {
        return !(*l)["children"].items.empty();
    });
    return Done{};
}

/// Fails when the level as a whole exceeds its limits.
Status LevelEntities::charge_limits(const Node& node, std::uint64_t copies) {
    std::size_t values = 1;
    for (const JsonValue* const layer : node.layers) {
        for (const JsonMember& member : layer->members) {
            values += member.key == "children" ? 0 : weight(member.value);
        }
    }
    is_full_ = true;
    if (copies > limits_.max_entities - entities_) {
        return refuse(
            node.path, node.json->at, fmt::format("{} entities here", copies),
            fmt::format("at most {} in all", limits_.max_entities));
    }
    if (copies > (limits_.max_values - values_) / values) {
        return refuse(
            node.path, node.json->at, fmt::format("{} copies of {} values", copies, values),
            fmt::format("at most {} in all entities", limits_.max_values));
    }
    is_full_ = false;
    entities_ += copies;
    values_ += copies * values;
    return Done{};
}

NameResolver LevelEntities::names_in(List& list) const {
    NameResolver names = names_;
    names.entity = [&list](std::string_view name, SourcePosition at) -> std::optional<Entity> {
        list.uses.push_back({std::string(name), at});
        return Entity{static_cast<std::uint32_t>(list.uses.size() - 1), kUseGeneration};
    };
    return names;
}

Status LevelEntities::add_copies(List& list, Node& node, const Context& context) {
    LIMN_TRY(charge_limits(node, 1));
    std::vector<AnyComponent> components = read_components(list, node);
    const JsonValue json = merged_repeat(node.layers);
    if (json.kind == JsonKind::Null) {
        add_copy(list, node, context, std::move(components), node.name);
        return Done{};
    }
    node.is_copy = true;
    const Repeat repeat =
        LIMN_TRY(read_repeat(json, components, {file_, node.path + ".repeat"}, names_in(list)));
    const std::uint64_t count = repeat_count(repeat);
    LIMN_TRY(charge_limits(node, count - 1));
    const std::size_t errors_before = errors_.count();
    for (std::uint64_t i = 0; i < count; ++i) {
        if (errors_.count() > errors_before) {  // other copies would repeat them
            note_missing(*node.json);
            break;
        }
        std::vector<AnyComponent> copy = components;
        apply_repeat(repeat, i, copy);
        const std::string name = node.name.empty() ? "" : fmt::format("{}[{}]", node.name, i);
        add_copy(list, node, context, std::move(copy), name);
    }
    return Done{};
}

void LevelEntities::add_copy(
    List& list, const Node& node, const Context& context, std::vector<AnyComponent> components,
    const std::string& name) {
    const auto index = static_cast<std::uint32_t>(list.entities.entities.size());
    if (context.parent >= 0) {
        components.push_back(
            AnyComponent::of(Parent{prefab_entity(static_cast<std::uint32_t>(context.parent)), 0}));
    }
    if (!name.empty()) {
        components.push_back(AnyComponent::of(Name{name}));
        const auto [entry, is_new] = list.scopes[context.scope].names.try_emplace(name, index);
        if (!is_new) {
            errors_.keep(refuse(
                node.path, node.json->find("name")->at, "a duplicate name " + in_quotes(name),
                fmt::format(
                    "each name once (the first is in line {})",
                    list.positions[entry->second].line)));
        }
    }
    list.entities.entities.push_back({std::move(components)});
    list.positions.push_back(node.json->at);
    follow_character(list.entities, index);
    std::uint32_t scope = context.scope;
    if (node.is_copy && node.has_children) {
        scope = static_cast<std::uint32_t>(list.scopes.size());
        list.scopes.push_back({context.scope, {}});
    }
    list.scope_of.push_back(scope);

    errors_.keep(add_gltf(list, node, index));
    Result<Changes> changes = read_changes(node, context.changes);
    if (!changes) {
        errors_.keep(changes.error());
        return;
    }
    for (const JsonValue* const layer : node.layers) {
        const JsonValue* const children = layer->find("children");
        if (children == nullptr) {
            continue;
        }
        errors_.keep(
            expect(*children, JsonKind::Array, {file_, node.path}, "an array of entities"));
        for (std::size_t i = 0; i < children->items.size() && !is_full_; ++i) {
            add_node(
                list, children->items[i], {index, scope, context.depth + 1, &*changes},
                fmt::format("{}.children[{}]", node.path, i));
        }
    }
    errors_.keep(check_changes(node, *changes));
}

/// The file of an entity, and the changes of its nodes.
Status LevelEntities::add_gltf(List& list, const Node& node, std::uint32_t index) {
    const JsonLocation location{file_, node.path};
    const JsonValue* const gltf = find_in_layers(node.layers, "gltf");
    const JsonValue* const variant = find_in_layers(node.layers, "variant");
    if (variant != nullptr) {
        LIMN_TRY(expect(*variant, JsonKind::String, location, "a material variant of the file"));
        if (gltf == nullptr) {
            return refuse(
                node.path, variant->at, "a variant without a glTF file", "\"gltf\" as well");
        }
    }
    if (gltf != nullptr) {
        LIMN_TRY(expect(*gltf, JsonKind::String, location, "the path of a .gltf or .glb file"));
        const std::string chosen = variant != nullptr ? variant->text : "";
        const auto known =
            std::find_if(list.gltfs.begin(), list.gltfs.end(), [&](const GltfUse& use) {
                return use.file == gltf->text && use.variant == chosen;
            });
        GltfUse& use = known != list.gltfs.end()
                           ? *known
                           : list.gltfs.emplace_back(GltfUse{gltf->text, chosen, gltf->at, {}});
        use.entities.push_back(index);
    }
    for (const JsonValue* const layer : node.layers) {
        const JsonValue* const nodes = layer->find("nodes");
        if (nodes != nullptr && gltf != nullptr) {
            LIMN_TRY(read_node_changes(
                *nodes, index, location_in(location, "nodes"), names_in(list), list.node_changes));
        }
    }
    return Done{};
}

std::vector<AnyComponent> LevelEntities::read_components(List& list, const Node& node) {
    std::vector<AnyComponent> components;
    components.push_back(AnyComponent::of(Transform{}));
    const NameResolver names = names_in(list);
    bool has_center = false;
    for (const JsonValue* const layer : node.layers) {
        for (const JsonMember& member : layer->members) {
            errors_.keep(read_member(member, node, names, components));
        }
        has_center = has_center || (*layer)["sway"].find("center") != nullptr;
    }
    const auto* const transform = find_in<Transform>(components);
    auto* const sway = find_in<Sway>(components);
    if (transform != nullptr && sway != nullptr && !has_center) {
        sway->center = transform->position;
    }
    return components;
}

Status LevelEntities::read_member(
    const JsonMember& member, const Node& node, const NameResolver& names,
    std::vector<AnyComponent>& components) {
    if (is_node_key(member.key)) {
        return Done{};
    }
    const ComponentInfo* const info = find_component(member.key);
    if (info == &component_info<Parent>()) {
        return refuse(
            node.path, member.at, "the key \"parent\"",
            "the entity in the list \"children\" of its parent");
    }
    if (info == nullptr || info->ops.construct_default == nullptr
        || info->ops.construct_copy == nullptr) {
        std::vector<std::string_view> known = kNodeKeys;
        const std::vector<const ComponentInfo*> all = all_components();
        for (const ComponentInfo* const component : all) {
            known.emplace_back(component->name);
        }
        return refuse(
            node.path, member.at, "the component " + in_quotes(member.key),
            "one of `limn components`, or one of name prefab gltf variant nodes repeat children"
                + where_it_belongs(member.key, did_you_mean(member.key, known)));
    }
    if (is_internal(*info)) {
        log_warn(
            "{}: {}: systems keep {} and overwrite what is written here",
            location_text(file_, member.at), node.path, member.key);
    }
    if (member.value.kind == JsonKind::Null) {
        std::erase_if(components, [info](const AnyComponent& c) { return &c.info() == info; });
        return Done{};
    }
    AnyComponent* component = find_in(components, info->id);
    if (component == nullptr) {
        component = &components.emplace_back(*info);
    }
    return read_component(
        member.value, *info, component->data(), {file_, node.path + ": " + member.key}, names);
}

void LevelEntities::resolve_names() {
    resolve(level_, true);
}

void LevelEntities::resolve(List& list, bool is_level) {
    const auto find_use = [&](const NameUse& use, std::uint32_t scope) -> std::optional<Entity> {
        while (true) {
            const auto found = list.scopes[scope].names.find(use.name);
            if (found != list.scopes[scope].names.end()) {
                return prefab_entity(found->second);
            }
            if (scope == 0) {
                break;
            }
            scope = list.scopes[scope].outer;
        }
        const std::int64_t outside = is_level ? -1 : find(use.name);
        if (outside < 0 && names_.entity) {
            return names_.entity(use.name, use.at);  // else an entity of the loaded world
        }
        return outside < 0 ? std::nullopt
                           : std::optional(level_entity(static_cast<std::uint32_t>(outside)));
    };
    const auto read_names = [&](std::size_t i, AnyComponent& component) {
        const ComponentInfo& info = component.info();
        for (std::size_t k = 0; info.has_entities && k < info.fields.size(); ++k) {
            const FieldInfo& field = info.fields[k];
            for_each_entity(std::span(&field, 1), component.data(), [&](Entity& entity) {
                if (entity.generation != kUseGeneration) {
                    return;
                }
                const NameUse& use = list.uses[entity.index];
                const std::optional<Entity> named = find_use(use, list.scope_of[i]);
                if (!named && !has_failed(use.name)) {
                    errors_.keep(
                        unknown_name(list, i, use, fmt::format("{}.{}", info.name, field.name)));
                }
                entity = named.value_or(Entity{});
            });
        }
    };
    for (std::size_t i = 0; i < list.entities.entities.size(); ++i) {
        for (AnyComponent& component : list.entities.entities[i].components) {
            read_names(i, component);
        }
    }
    for (NodeChange& change : list.node_changes) {
        if (!change.set.value.is_empty()) {
            read_names(change.entity, change.set.value);
        }
    }
}

/// The error of a name that no entity has, in `field` of entity `index`.
Error LevelEntities::unknown_name(
    List& list, std::size_t index, const NameUse& use, std::string_view field) const {
    const auto* const name = find_in<Name>(list.entities.entities[index].components);
    std::vector<std::string_view> known = names();
    for (const auto& [inner, entity] : list.scopes[list.scope_of[index]].names) {
        known.emplace_back(inner);
    }
    return refuse(
        fmt::format(
            "entity {}: {}", name != nullptr ? in_quotes(name->text) : std::to_string(index),
            field),
        use.at, "the entity " + in_quotes(use.name),
        "an existing name" + did_you_mean(use.name, known));
}

std::int64_t LevelEntities::find(std::string_view name) const {
    const auto found = level_.scopes[0].names.find(std::string(name));
    return found == level_.scopes[0].names.end() ? -1 : std::int64_t{found->second};
}

std::vector<std::string_view> LevelEntities::names() const {
    std::vector<std::string_view> all;
    for (const auto& [name, index] : level_.scopes[0].names) {
        all.emplace_back(name);
    }
    std::sort(all.begin(), all.end());
    return all;
}

Result<Prefab> LevelEntities::read_prefab(const JsonValue& node, const std::string& path) {
    List list;
    add_node(list, node, {}, path);
    resolve(list, false);
    if (!list.gltfs.empty()) {
        return refuse(
            path, list.gltfs[0].at, "a glTF file",
            "none, since events can only spawn assets that the level has loaded");
    }
    return std::move(list.entities);
}

void LevelEntities::check_unused_prefabs() {
    if (has_left_out_) {
        return;  // one of them may be the user
    }
    for (const auto& [name, prefab] : prefabs_) {
        if (is_full_) {
            return;
        }
        if (prefab.is_used) {
            continue;
        }
        JsonValue node =
            json_object({{"prefab", prefab.json->at, json_of(std::string_view(name))}});
        node.at = prefab.json->at;
        node.members[0].value.at = prefab.json->at;
        List list;
        add_node(list, node, {}, "prefabs." + name);
        resolve(list, false);
    }
}

}  // namespace limn
