#pragma once

#include "ecs/world.h"

// The templates of World; included by ecs/world.h.

namespace limn {

namespace detail {

std::uint32_t next_bundle_index();
std::uint32_t next_query_index();

/// Indices of type combinations, assigned before main.
template <typename... Ts>
inline const std::uint32_t bundle_index = next_bundle_index();
template <typename... Terms>
inline const std::uint32_t query_index = next_query_index();

}  // namespace detail

// ---- entities
// ------------------------------------------------------------------------------------

template <typename... Ts>
World::Bundle& World::bundle_of() {
    static_assert(detail::all_different<Ts...>, "an entity has each component only once");
    static_assert(
        (detail::Component<Ts> && ...), "components are values, not pointers, arrays or entities");
    const std::uint32_t index = detail::bundle_index<Ts...>;
    if (index < bundles_.size() && bundles_[index] != nullptr) {
        return *bundles_[index];
    }
    const ComponentId components[sizeof...(Ts) + 1] = {component_id<Ts>..., 0};
    return make_bundle(index, {components, sizeof...(Ts)});
}

template <typename... Ts>
const World::Bundle& World::bundle_with(const Ts&... components) {
    Bundle& bundle = bundle_of<Ts...>();
    if constexpr ((detail::is_shared<Ts> || ...)) {
        const void* const values[] = {&components...};
        choose_archetype(bundle, values);
    }
    return bundle;
}

template <typename... Ts>
Entity World::create(Ts... components) {
    core_.check_unlocked();
    const Bundle& bundle = bundle_with<Ts...>(components...);
    const std::uint32_t now = core_.now();
    const Entity entity = core_.entities.allocate();
    const std::uint32_t row = bundle.archetype->append(entity, now);
    core_.entities.set_location(entity, bundle.archetype->index(), row);

    [[maybe_unused]] std::size_t position = 0;
    [[maybe_unused]] const auto put = [&]<typename Value>(Value& component) {
        if constexpr (detail::is_sparse<Value>) {
            SparseSet& set = use_sparse_set(component_id<Value>);
            [[maybe_unused]] const std::uint32_t index = set.append(entity, now);
            if constexpr (!std::is_empty_v<Value>) {
                ::new (static_cast<void*>(set.value(index))) Value(std::move(component));
            }
        } else if constexpr (detail::is_shared<Value>) {
            // Stored in the archetype.
        } else if constexpr (detail::is_split<Value>) {
            detail::Lanes<Value>(&bundle.archetype->column(bundle.columns[position]), 0)
                .store(row, component);
        } else if constexpr (!std::is_empty_v<Value>) {
            Column& column = bundle.archetype->column(bundle.columns[position]);
            ::new (static_cast<void*>(reinterpret_cast<Value*>(column.data) + row))
                Value(std::move(component));
        }
        ++position;
    };
    (put(components), ...);

    if (bundle.archetype->observes_add || bundle.has_sparse) {
        notify(ObserverEvent::Add, bundle.components, {&entity, 1});
    }
    return entity;
}

template <typename... Ts>
void World::create_many(std::span<Entity> entities, Ts... components) {
    core_.check_unlocked();
    const Bundle& bundle = bundle_with<Ts...>(components...);
    const std::uint32_t now = core_.now();
    for (Entity& entity : entities) {
        entity = core_.entities.allocate();
    }
    const std::uint32_t first = bundle.archetype->append(entities, now);
    for (std::size_t i = 0; i < entities.size(); ++i) {
        core_.entities.set_location(
            entities[i], bundle.archetype->index(), first + static_cast<std::uint32_t>(i));
    }

    [[maybe_unused]] std::size_t position = 0;
    [[maybe_unused]] const auto put = [&]<typename T>(const T& component) {
        if constexpr (detail::is_sparse<T>) {
            SparseSet& set = use_sparse_set(component_id<T>);
            for (const Entity entity : entities) {
                [[maybe_unused]] const std::uint32_t index = set.append(entity, now);
                if constexpr (!std::is_empty_v<T>) {
                    ::new (static_cast<void*>(set.value(index))) T(component);
                }
            }
        } else if constexpr (detail::is_shared<T>) {
            // Stored in the archetype.
        } else if constexpr (detail::is_split<T>) {
            fill_values(
                &bundle.archetype->column(bundle.columns[position]), first, entities.size(),
                &component);
        } else if constexpr (!std::is_empty_v<T>) {
            T* rows = reinterpret_cast<T*>(bundle.archetype->column(bundle.columns[position]).data)
                      + first;
            for (std::size_t i = 0; i < entities.size(); ++i) {
                ::new (static_cast<void*>(rows + i)) T(component);
            }
        }
        ++position;
    };
    (put(components), ...);

    if (bundle.archetype->observes_add || bundle.has_sparse) {
        notify(ObserverEvent::Add, bundle.components, entities);
    }
}

template <typename... Ts>
std::vector<Entity> World::create_many(std::size_t count, const Ts&... components) {
    std::vector<Entity> entities(count);
    create_many(std::span<Entity>(entities), components...);
    return entities;
}

template <typename F>
void World::each_entity(F&& function) const {
    for (const auto& archetype : core_.archetypes) {
        for (const Entity entity : archetype->entities()) {
            function(entity);
        }
    }
}

// ---- components
// ----------------------------------------------------------------------------------

template <typename T>
detail::Added<T> World::add(Entity entity, T component) {
    static_assert(detail::Component<T>, "components are values, not pointers, arrays or entities");
    core_.check_unlocked();
    if constexpr (detail::is_split<T> || detail::is_shared<T>) {
        put_bytes(entity, component_id<T>, &component);
    } else {
        const EntityLocation location = require(entity);
        if (T* present = find_at<T>(entity, location); present != nullptr) {
            if constexpr (detail::is_toggle<T>) {
                enable_present(entity, component_id<T>);
            }
            if constexpr (!std::is_empty_v<T>) {
                // Not operator=: a component need not be assignable.
                present->~T();
                return *::new (static_cast<void*>(present)) T(std::move(component));
            } else {
                return *present;
            }
        }
        void* room = nullptr;
        if constexpr (detail::is_sparse<T>) {
            room = make_room(entity, location, component_id<T>);
        } else {
            room = make_room_in_row(entity, location, component_id<T>);
        }
        T* value = static_cast<T*>(room);
        if constexpr (!std::is_empty_v<T>) {
            value = ::new (static_cast<void*>(value)) T(std::move(component));
        }
        if (observes(component_id<T>, ObserverEvent::Add)) {
            notify(ObserverEvent::Add, {&component_id<T>, 1}, {&entity, 1});
            value = find<T>(entity);
            LIMN_CHECK_NOTE(
                value != nullptr, "an observer removed the component that was being added");
        }
        if constexpr (std::is_empty_v<T>) {
            return detail::tag_value<T>;
        } else {
            return *value;
        }
    }
}

template <typename T>
inline T* World::find(Entity entity) {
    static_assert(detail::Component<T>, "components are values, not pointers, arrays or entities");
    static_assert(
        !detail::is_split<T>,
        "get, find: a split component has no address; use value<T>(entity) and set(entity, value)");
    static_assert(
        !detail::is_shared<T> || std::is_const_v<T>,
        "get, find: a shared component is read as const T; set(entity, value) replaces it");
    const EntityLocation location = core_.entities.find(entity);
    return location ? find_at<T>(entity, location) : nullptr;
}

template <typename T>
inline T* World::find_at([[maybe_unused]] Entity entity, EntityLocation location) {
    using Value = std::remove_const_t<T>;
    if constexpr (detail::is_sparse<Value>) {
        return detail::SparseOptionalAccess<T>{
            core_.sparse_set(component_id<Value>), &entity, core_.now()}[0];
    } else {
        Archetype& rows = archetype(location.archetype);
        const int column = rows.column_of(component_id<Value>);
        if (column == kNoColumn) {
            return nullptr;
        }
        if constexpr (detail::is_shared<Value>) {
            return static_cast<T*>(rows.shared_value(component_id<Value>)->value);
        } else if constexpr (std::is_empty_v<Value>) {
            return &detail::tag_value<Value>;
        } else {
            if constexpr (!std::is_const_v<T>) {
                rows.touch_row(column, location.row, core_.now());
                if constexpr (detail::tracks_rows<T>) {
                    rows.bits().track(component_id<T>)->mark(location.row);
                }
            }
            return reinterpret_cast<T*>(rows.column(column).data) + location.row;
        }
    }
}

template <typename T>
inline const T* World::find(Entity entity) const {
    return const_cast<World*>(this)->find<const T>(entity);
}

template <typename T>
inline T& World::get(Entity entity) {
    T* value = find<T>(entity);
    LIMN_CHECK_NOTE(value != nullptr, component_info<T>().name.c_str());
    return *value;
}

template <typename T>
inline const T& World::get(Entity entity) const {
    const T* value = find<T>(entity);
    LIMN_CHECK_NOTE(value != nullptr, component_info<T>().name.c_str());
    return *value;
}

template <typename T>
T World::value(Entity entity) const {
    if constexpr (detail::is_split<T>) {
        const EntityLocation location = require(entity);
        const Archetype& rows = archetype(location.archetype);
        const int column = rows.column_of(component_id<T>);
        LIMN_CHECK_NOTE(column >= 0, component_info<T>().name.c_str());
        return detail::Lanes<const T>(&rows.column(column), 0).load(location.row);
    } else {
        return get<T>(entity);
    }
}

template <typename T>
void World::set(Entity entity, T component) {
    if constexpr (detail::is_split<T>) {
        const EntityLocation location = require(entity);
        Archetype& rows = archetype(location.archetype);
        const int column = rows.column_of(component_id<T>);
        LIMN_CHECK_NOTE(column >= 0, component_info<T>().name.c_str());
        detail::Lanes<T>(&rows.column(column), 0).store(location.row, component);
        rows.write_row(column, location.row, core_.now());
    } else if constexpr (detail::is_shared<T>) {
        static_cast<void>(get<const T>(entity));
        put_bytes(entity, component_id<T>, &component);
    } else if constexpr (std::is_empty_v<T>) {
        static_cast<void>(get<const T>(entity));
    } else {
        // Not operator=: a component need not be assignable.
        T* present = &get<T>(entity);
        present->~T();
        ::new (static_cast<void*>(present)) T(std::move(component));
    }
}

/// Always inlined: the call would be a third of its time.
template <typename T>
[[gnu::always_inline]] inline bool World::set_enabled(Entity entity, bool enabled) {
    static_assert(detail::is_toggle<T>, "T cannot be disabled: its storage is not Storage::Toggle");
    check_not_iterating();
    const EntityLocation location = require(entity);
    Archetype& rows = archetype(location.archetype);
    ToggleBits* toggle = rows.bits().toggle(component_id<T>);
    LIMN_CHECK_NOTE(toggle != nullptr, component_info<T>().name.c_str());
    if (!toggle->set_enabled(location.row, enabled)) {
        return false;
    }
    if constexpr (std::is_empty_v<T> || detail::tracks_rows<T>) {
        rows.touch_toggle(*toggle, location.row, core_.now());
    } else {
        rows.touch_row(toggle->column, location.row, core_.now());
    }
    return true;
}

// ---- queries
// -------------------------------------------------------------------------------------

template <typename... Terms>
Query<Terms...> World::query() {
    const std::uint32_t index = detail::query_index<Terms...>;
    QueryState* state = index < queries_.size() ? queries_[index].get() : nullptr;
    if (state == nullptr) {
        state = &make_query_state(index, detail::query_terms<Terms...>);
    }
    return Query<Terms...>(core_, *state, IterationLock::Plain);
}

template <typename... Terms>
Query<Terms...> World::query() const {
    static_assert(
        Query<Terms...>::kReadOnly, "a const World has only const components: query<const A>()");
    QueryState& state =
        shared_query_state(detail::query_index<Terms...>, detail::query_terms<Terms...>);
    return Query<Terms...>(const_cast<WorldCore&>(core_), state, IterationLock::Shared);
}

namespace detail {

template <typename... Terms>
std::vector<ArchetypeRows> rows_of(const Query<Terms...>& query) {
    std::vector<ArchetypeRows> all;
    query.ranges([&](const Archetype& archetype, std::uint32_t first, std::uint32_t count) {
        if (!all.empty() && all.back().archetype == archetype.index()
            && all.back().rows.first + all.back().rows.count == first) {
            all.back().rows.count += count;
        } else {
            all.push_back({archetype.index(), {first, count}});
        }
    });
    return all;
}

}  // namespace detail

template <typename... Terms>
void World::destroy_all(const Query<Terms...>& query) {
    change_rows({&key_layout<>, CommandOp::Destroy}, nullptr, detail::rows_of(query));
}

template <typename T, typename... Terms>
void World::add_all(const Query<Terms...>& query, const T& component) {
    static_assert(std::is_copy_constructible_v<T>, "add_all: every entity gets a copy");
    change_rows(
        {&record_layout<T>, CommandOp::Add},
        reinterpret_cast<std::byte*>(const_cast<T*>(&component)), detail::rows_of(query));
}

template <typename T, typename... Terms>
void World::remove_all(const Query<Terms...>& query) {
    change_rows({&key_layout<T>, CommandOp::Remove}, nullptr, detail::rows_of(query));
}

// ---- resources
// -----------------------------------------------------------------------------------

template <typename T>
T& World::insert_resource(T resource) {
    if (ResourceSlot* slot = resource_slot(component_id<T>); slot != nullptr) {
        T* present = static_cast<T*>(slot->value);
        present->~T();
        slot->version = core_.now();
        return *::new (static_cast<void*>(present)) T(std::move(resource));
    }
    return *::new (allocate_resource(component_id<T>)) T(std::move(resource));
}

template <typename T>
T* World::find_resource() {
    if constexpr (std::is_const_v<T>) {
        return std::as_const(*this).template find_resource<T>();
    } else {
        return static_cast<T*>(find_resource(component_id<T>));
    }
}

template <typename T>
const T* World::find_resource() const {
    return static_cast<const T*>(find_resource(component_id<std::remove_const_t<T>>));
}

template <typename T>
T& World::resource() {
    T* value = find_resource<T>();
    LIMN_CHECK_NOTE(value != nullptr, component_info<std::remove_const_t<T>>().name.c_str());
    return *value;
}

template <typename T>
const T& World::resource() const {
    const T* value = find_resource<T>();
    LIMN_CHECK_NOTE(value != nullptr, component_info<std::remove_const_t<T>>().name.c_str());
    return *value;
}

// ---- systems
// --------------------------------------------------------------------------------------

template <typename F>
void World::run(F&& system) {
    using Function = std::decay_t<F>;
    if constexpr (std::is_pointer_v<Function> || std::is_empty_v<Function>) {
        const void* type = &detail::type_key<Function>;
        const void* address = nullptr;
        if constexpr (std::is_pointer_v<Function>) {
            address = reinterpret_cast<const void*>(system);
        }
        System* known = SystemCache::find(*this, type, address);
        run_system(
            *this, known != nullptr ? *known
                                    : SystemCache::insert(
                                        *this, type, address, make_system<Function>("", system)));
    } else {
        System once = make_system<Function>("", std::forward<F>(system));
        run_system(*this, once);
    }
}

}  // namespace limn
