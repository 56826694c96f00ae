#include "ecs/reflect.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>

// Techniques: engine.type-registry

namespace limn {

namespace {

/// Infos are written once, under the mutex, before their id is published; reading needs no lock.
struct Registry {
    std::mutex mutex;
    std::atomic<std::uint32_t> count = 0;
    std::array<ComponentInfo*, kMaxComponents> infos = {};
    std::map<std::string, ComponentInfo*, std::less<>> components;
    std::map<std::string, ComponentInfo*, std::less<>> resources;
};

Registry& registry() {
    static Registry* const instance = new Registry;  // outlives every static object
    return *instance;
}

const ComponentInfo*
find_in(const std::map<std::string, ComponentInfo*, std::less<>>& names, std::string_view name) {
    const std::lock_guard lock(registry().mutex);
    const auto found = names.find(name);
    return found == names.end() ? nullptr : found->second;
}

std::vector<const ComponentInfo*>
all_in(const std::map<std::string, ComponentInfo*, std::less<>>& names) {
    const std::lock_guard lock(registry().mutex);
    std::vector<const ComponentInfo*> all;
    for (const auto& [name, info] : names) {
        all.push_back(info);
    }
    return all;
}

std::string suggest(std::string_view name, const std::vector<const ComponentInfo*>& infos) {
    std::vector<std::string> names;
    for (const ComponentInfo* info : infos) {
        names.push_back(info->name);
    }
    const std::string nearest = nearest_name(name, names);
    return nearest.empty() ? "" : " (did you mean " + nearest + "?)";
}

bool holds_entities(const std::vector<FieldInfo>& fields) {
    return std::any_of(fields.begin(), fields.end(), [](const FieldInfo& field) {
        return field.type == FieldType::Entity || holds_entities(field.fields);
    });
}

}  // namespace

const ComponentInfo& component_info(ComponentId id) {
    LIMN_CHECK(id < registry().count.load(std::memory_order_acquire));
    return *registry().infos[id];
}

std::uint32_t component_count() {
    return registry().count.load(std::memory_order_acquire);
}

const ComponentInfo* find_component(std::string_view name) {
    return find_in(registry().components, name);
}
const ComponentInfo* find_resource(std::string_view name) {
    return find_in(registry().resources, name);
}
std::vector<const ComponentInfo*> all_components() {
    return all_in(registry().components);
}
std::vector<const ComponentInfo*> all_resources() {
    return all_in(registry().resources);
}

std::string component_suggestion(std::string_view name) {
    return suggest(name, all_components());
}
std::string resource_suggestion(std::string_view name) {
    return suggest(name, all_resources());
}

namespace detail {

ComponentId add_component(
    const ComponentType& type, std::string_view type_name, void (*describe)(ComponentInfo&)) {
    auto* const info = new ComponentInfo;
    static_cast<ComponentType&>(*info) = type;
    info->name = snake_case(short_name(type_name));
    describe(*info);
    info->has_entities = holds_entities(info->fields);
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const ComponentId id = all.count.load(std::memory_order_relaxed);
    LIMN_CHECK_NOTE(id < kMaxComponents, "too many component types");
    info->id = id;
    all.infos[id] = info;
    all.count.store(id + 1, std::memory_order_release);
    return id;
}

void name_component(ComponentId id, bool is_resource) {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    ComponentInfo* const info = all.infos[id];
    const auto [found, is_new] =
        (is_resource ? all.resources : all.components).try_emplace(info->name, info);
    LIMN_CHECK_NOTE(found->second == info, info->name.c_str());
    if (is_new) {
        info->is_registered = true;
        info->is_resource = is_resource;
    }
}

std::vector<std::string_view> split_words(const char* words) {
    std::vector<std::string_view> list;
    std::string_view rest = words;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(' '), rest.size());
        if (end > 0) {
            list.push_back(rest.substr(0, end));
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return list;
}

void add_field(
    std::vector<FieldInfo>& fields, const char* name, std::size_t offset, const FieldMeta& meta,
    const FieldClass& type) {
    FieldInfo& field = fields.emplace_back();
    field.name = name;
    field.meta = meta;
    field.type = type.type;
    field.shape = type.shape;
    field.offset = static_cast<std::uint32_t>(offset);
    field.size = type.size;
    field.count = type.count;
    field.asset = type.asset;
    field.list = type.list;
    if (type.type == FieldType::Enum) {
        field.values = split_words(meta.values);
    }
    if (type.describe != nullptr) {
        type.describe(field.fields);
    }
}

}  // namespace detail

}  // namespace limn
