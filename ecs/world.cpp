#include "ecs/world.h"

#include "ecs/any_component.h"
#include "ecs/world_internals.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <new>

namespace limn {

namespace detail {

namespace {
std::uint32_t bundle_count = 0;
std::uint32_t query_count = 0;
}  // namespace

// Only called before main, by one thread.
std::uint32_t next_bundle_index() {
    return bundle_count++;
}
std::uint32_t next_query_index() {
    return query_count++;
}

}  // namespace detail

std::uint32_t next_epoch() {
    static std::atomic<std::uint32_t> last = 0;
    return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

World::World() : internals_(std::make_unique<Internals>()) {
    static_cast<void>(archetype_of({}));  // index 0 is always the empty archetype
}

World::~World() {
    notify_all_removed();
    drop_all_rows();
    while (!resource_order_.empty()) {
        remove_resource(resource_order_.back());
    }
}

// ---- entities
// ------------------------------------------------------------------------------------

std::size_t World::entity_count() const {
    std::size_t count = 0;
    for (const auto& archetype : core_.archetypes) {
        count += archetype->size();
    }
    return count;
}

void World::destroy(Entity entity) {
    core_.check_unlocked();
    EntityLocation location = require(entity);
    bool observed = archetype(location.archetype).observes_remove;
    for (const SparseSet* set : core_.sparse_list) {
        observed = observed || (set->observes_remove && set->has(entity));
    }
    if (observed) {
        notify(ObserverEvent::Remove, components_of(entity), {&entity, 1});
        location = require(entity);
    }
    destroy_now(entity, location);
}

void World::destroy_now(Entity entity, EntityLocation location) {
    Archetype& rows = archetype(location.archetype);
    for (SparseSet* set : core_.sparse_list) {
        if (const std::uint32_t position = set->find(entity); position != SparseSet::kAbsent) {
            set->remove(position, core_.now());
        }
    }
    rows.destroy_components(location.row, 1);
    rows.fill_hole(location.row, core_.now());
    update_filler(rows, location.row);
    core_.entities.free(entity);
}

void World::clear() {
    core_.check_unlocked();
    notify_all_removed();
    drop_all_rows();
}

void World::shrink() {
    core_.check_unlocked();
    for (const auto& archetype : core_.archetypes) {
        archetype->shrink();
    }
    for (SparseSet* set : core_.sparse_list) {
        set->shrink();
    }
    core_.blocks.shrink();
    internals_->flush = nullptr;  // frees its lists; the next sync point creates new ones
}

void World::drop_all_rows() {
    for (SparseSet* set : core_.sparse_list) {
        set->clear(core_.now());
    }
    for (const auto& archetype : core_.archetypes) {
        for (const Entity entity : archetype->entities()) {
            core_.entities.free(entity);
        }
        archetype->clear(core_.now());
    }
}

// ---- archetypes
// ----------------------------------------------------------------------------------

Archetype&
World::archetype_of(std::span<const ComponentId> components, std::span<const SharedValue> shared) {
    std::vector<ComponentId> key(components.begin(), components.end());
    if (!shared.empty()) {
        key.push_back(kMaxComponents);  // separator: the keys of shared values follow
        for (const SharedValue& value : shared) {
            key.push_back(value.key);
        }
    }
    const auto found = internals_->archetype_by_components.find(key);
    if (found != internals_->archetype_by_components.end()) {
        return archetype(found->second);
    }
    const std::uint32_t index = static_cast<std::uint32_t>(core_.archetypes.size());
    LIMN_CHECK_NOTE(index < kMaxArchetypes, "too many archetypes");
    core_.archetypes.push_back(
        std::make_unique<Archetype>(index, components, core_.blocks, shared));
    for (const SharedValue& value : shared) {
        core_.shared.add_archetype(value.key, index);
    }
    internals_->archetype_by_components.emplace(std::move(key), index);
    Archetype& made = *core_.archetypes.back();
    const auto observed = [&](ObserverEvent event) {
        return std::any_of(components.begin(), components.end(), [&](ComponentId id) {
            return observes(id, event);
        });
    };
    made.observes_add = observed(ObserverEvent::Add);
    made.observes_remove = observed(ObserverEvent::Remove);
    return made;
}

const RowPlan& World::plan_with(Archetype& from, ComponentId id) {
    if (id < from.add_edges.size() && from.add_edges[id] != nullptr) {
        return *from.add_edges[id];
    }
    std::vector<ComponentId> components(from.components().begin(), from.components().end());
    components.insert(std::upper_bound(components.begin(), components.end(), id), id);
    from.add_edges.resize(component_count());
    return *(from.add_edges[id] = &from.plan_to(archetype_of(components, from.shared())));
}

Archetype&
World::archetype_with_value(Archetype& from, const ComponentInfo& info, const void* value) {
    const SharedValue wanted = core_.shared.value(core_.shared.add(info, value));
    if (const SharedValue* present = from.shared_value(info.id); present != nullptr) {
        if (present->key == wanted.key) {
            return from;
        }
        std::vector<SharedValue> shared(from.shared().begin(), from.shared().end());
        shared[static_cast<std::size_t>(present - from.shared().data())] = wanted;
        return archetype_of(from.components(), shared);
    }
    std::vector<ComponentId> components(from.components().begin(), from.components().end());
    components.insert(std::upper_bound(components.begin(), components.end(), info.id), info.id);
    std::vector<SharedValue> shared(from.shared().begin(), from.shared().end());
    insert_shared(shared, wanted);
    return archetype_of(components, shared);
}

const RowPlan& World::plan_without(Archetype& from, ComponentId id) {
    if (id < from.remove_edges.size() && from.remove_edges[id] != nullptr) {
        return *from.remove_edges[id];
    }
    std::vector<ComponentId> components(from.components().begin(), from.components().end());
    std::erase(components, id);
    std::vector<SharedValue> shared(from.shared().begin(), from.shared().end());
    std::erase_if(shared, [id](const SharedValue& value) { return value.component == id; });
    from.remove_edges.resize(component_count());
    return *(from.remove_edges[id] = &from.plan_to(archetype_of(components, shared)));
}

World::Bundle& World::make_bundle(std::uint32_t index, std::span<const ComponentId> components) {
    Bundle bundle;
    bundle.components.assign(components.begin(), components.end());
    bool has_shared = false;
    for (const ComponentId id : components) {
        const Storage storage = component_info(id).storage;
        bundle.has_sparse = bundle.has_sparse || storage == Storage::Sparse;
        has_shared = has_shared || storage == Storage::Shared;
        if (storage != Storage::Sparse) {
            bundle.table.push_back(id);
        }
    }
    std::sort(bundle.table.begin(), bundle.table.end());
    if (!has_shared) {
        bundle.archetype = &archetype_of(bundle.table);
        for (const ComponentId id : components) {
            bundle.columns.push_back(bundle.archetype->column_of(id));
        }
    }
    if (index >= bundles_.size()) {
        bundles_.resize(index + 1);
    }
    bundles_[index] = std::make_unique<Bundle>(std::move(bundle));
    return *bundles_[index];
}

void World::choose_archetype(Bundle& bundle, std::span<const void* const> values) {
    const auto is_same = [&](std::size_t i) {
        const ComponentInfo& info = component_info(bundle.components[i]);
        return info.storage != Storage::Shared
               || std::memcmp(bundle.archetype->shared_value(info.id)->value, values[i], info.size)
                      == 0;
    };
    if (bundle.archetype != nullptr) {
        bool all_same = true;
        for (std::size_t i = 0; i < values.size(); ++i) {
            all_same = all_same && is_same(i);
        }
        if (all_same) {
            return;
        }
    }
    std::vector<SharedValue> shared;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const ComponentInfo& info = component_info(bundle.components[i]);
        if (info.storage == Storage::Shared) {
            insert_shared(shared, core_.shared.value(core_.shared.add(info, values[i])));
        }
    }
    bundle.archetype = &archetype_of(bundle.table, shared);
    bundle.columns.clear();
    for (const ComponentId id : bundle.components) {
        bundle.columns.push_back(bundle.archetype->column_of(id));
    }
}

std::uint32_t World::move_row(Entity entity, EntityLocation location, const RowPlan& plan) {
    Archetype& from = archetype(location.archetype);
    const std::uint32_t row = from.move_row(location.row, plan, core_.now());
    update_filler(from, location.row);
    core_.entities.set_location(entity, plan.to->index(), row);
    return row;
}

SparseSet& World::use_sparse_set(ComponentId id) {
    if (SparseSet* set = core_.sparse_set(id); set != nullptr) {
        return *set;
    }
    if (id >= core_.sparse.size()) {
        core_.sparse.resize(component_count());
    }
    core_.sparse[id] = std::make_unique<SparseSet>(component_info(id));
    SparseSet& made = *core_.sparse[id];
    made.observes_add = observes(id, ObserverEvent::Add);
    made.observes_remove = observes(id, ObserverEvent::Remove);
    core_.sparse_list.push_back(&made);
    return made;
}

// ---- type-erased components
// ----------------------------------------------------------------------

std::vector<ComponentId> World::components_of(Entity entity) const {
    const EntityLocation location = require(entity);
    const auto table = archetype(location.archetype).components();
    std::vector<ComponentId> components(table.begin(), table.end());
    for (const SparseSet* set : core_.sparse_list) {
        if (set->has(entity)) {
            components.push_back(set->info().id);
        }
    }
    std::sort(components.begin() + static_cast<std::ptrdiff_t>(table.size()), components.end());
    std::inplace_merge(
        components.begin(), components.begin() + static_cast<std::ptrdiff_t>(table.size()),
        components.end());
    return components;
}

bool World::has(Entity entity, ComponentId id) const {
    const EntityLocation location = core_.entities.find(entity);
    return location && has_at(entity, location, id);
}

bool World::has_at(Entity entity, EntityLocation location, ComponentId id) const {
    const SparseSet* set = core_.sparse_set(id);
    return archetype(location.archetype).has(id) || (set != nullptr && set->has(entity));
}

const void* World::find(Entity entity, ComponentId id) const {
    const EntityLocation location = core_.entities.find(entity);
    if (!location) {
        return nullptr;
    }
    if (const SparseSet* set = core_.sparse_set(id); set != nullptr) {
        const std::uint32_t position = set->find(entity);
        return position == SparseSet::kAbsent ? nullptr : set->value(position);
    }
    const Archetype& rows = archetype(location.archetype);
    const int column = rows.column_of(id);
    if (column == kTagColumn) {
        return &rows;  // any non-null address: tags have no value
    }
    if (column == kSharedColumn) {
        return rows.shared_value(id)->value;
    }
    LIMN_CHECK_NOTE(
        column == kNoColumn || has_address(component_info(id)),
        "a split component has no address; use read and write");
    return column == kNoColumn ? nullptr : rows.column(column).at(location.row);
}

void* World::find(Entity entity, ComponentId id) {
    const void* value = std::as_const(*this).find(entity, id);
    if (value == nullptr) {
        return nullptr;
    }
    LIMN_CHECK_NOTE(
        has_address(component_info(id)),
        "the value of a shared component belongs to several entities; use read and write");
    if (SparseSet* set = core_.sparse_set(id); set != nullptr) {
        set->touch(set->find(entity), core_.now());
    } else {
        const EntityLocation location = core_.entities.find(entity);
        Archetype& rows = archetype(location.archetype);
        rows.write_row(rows.column_of(id), location.row, core_.now());
    }
    return const_cast<void*>(value);
}

void* World::make_room(Entity entity, EntityLocation location, ComponentId id) {
    if (component_info(id).storage == Storage::Sparse) {
        SparseSet& set = use_sparse_set(id);
        return set.value(set.append(entity, core_.now()));
    }
    return make_room_in_row(entity, location, id);
}

void* World::make_room_in_row(Entity entity, EntityLocation location, ComponentId id) {
    const RowPlan& plan = plan_with(archetype(location.archetype), id);
    const std::uint32_t row = move_row(entity, location, plan);
    const int column = plan.to->column_of(id);
    return column < 0 ? nullptr : plan.to->column(column).at(row);
}

bool World::read(Entity entity, ComponentId id, void* raw) const {
    const ComponentInfo& info = component_info(id);
    if (!has(entity, id)) {
        return false;
    }
    if (info.storage == Storage::Split) {
        const EntityLocation location = core_.entities.find(entity);
        const Archetype& rows = archetype(location.archetype);
        gather_values(&rows.column(rows.column_of(id)), location.row, 1, raw);
    } else if (!info.is_tag) {
        LIMN_CHECK_NOTE(info.ops.construct_copy != nullptr, info.name.c_str());
        info.ops.construct_copy(raw, find(entity, id), 1);
    }
    return true;
}

bool World::write(Entity entity, ComponentId id, void* value) {
    const ComponentInfo& info = component_info(id);
    if (!has(entity, id)) {
        return false;
    }
    if (!has_address(info)) {
        put_bytes(entity, id, value);
    } else if (!info.is_tag) {
        void* const present = find(entity, id);
        if (present != value) {
            info.ops.destroy(present, 1);
            info.ops.construct_move(present, value, 1);
        }
    }
    return true;
}

void World::put_bytes(Entity entity, ComponentId id, const void* value) {
    const ComponentInfo& info = component_info(id);
    const bool is_new = !has(entity, id);
    if (info.storage == Storage::Shared) {
        core_.check_unlocked();
        const EntityLocation location = require(entity);
        Archetype& from = archetype(location.archetype);
        Archetype& to = archetype_with_value(from, info, value);
        if (&to != &from) {
            move_row(entity, location, from.plan_to(to));
        }
    } else {
        if (is_new) {
            make_room(entity, require(entity), id);
        }
        const EntityLocation location = core_.entities.find(entity);
        Archetype& rows = archetype(location.archetype);
        const int column = rows.column_of(id);
        scatter_values(&rows.column(column), location.row, 1, value);
        rows.write_row(column, location.row, core_.now());
    }
    if (is_new) {
        notify(ObserverEvent::Add, {&id, 1}, {&entity, 1});
    }
}

void* World::add(Entity entity, ComponentId id) {
    core_.check_unlocked();
    const ComponentInfo& info = component_info(id);
    if (!has_address(info)) {
        if (!has(entity, id)) {
            const AnyComponent initial(info);
            put_bytes(entity, id, initial.data());
        }
        return nullptr;
    }
    if (!has(entity, id)) {
        LIMN_CHECK_NOTE(info.is_tag || info.ops.construct_default != nullptr, info.name.c_str());
        void* room = make_room(entity, require(entity), id);
        if (!info.is_tag) {
            info.ops.construct_default(room, 1);
        }
        notify(ObserverEvent::Add, {&id, 1}, {&entity, 1});
    } else {
        enable_present(entity, id);
    }
    return find(entity, id);
}

void* World::add_copy(Entity entity, ComponentId id, const void* value) {
    const ComponentInfo& info = component_info(id);
    LIMN_CHECK_NOTE(info.is_tag || info.ops.construct_copy != nullptr, info.name.c_str());
    return put_value(entity, AnyComponent(info, value));
}

void* World::add_move(Entity entity, ComponentId id, void* value) {
    return put_value(entity, AnyComponent::take(component_info(id), value));
}

/// Not from where the value came from: making room moves rows, perhaps that of the value.
void* World::put_value(Entity entity, AnyComponent value) {
    core_.check_unlocked();
    const ComponentInfo& info = value.info();
    if (!has_address(info)) {
        put_bytes(entity, info.id, value.data());
        return nullptr;
    }
    void* const present = find(entity, info.id);
    const bool is_new = present == nullptr;
    void* const room = is_new ? make_room(entity, require(entity), info.id) : present;
    if (!info.is_tag) {
        if (!is_new) {
            info.ops.destroy(room, 1);
        }
        info.ops.construct_move(room, value.data(), 1);
    }
    if (is_new) {
        notify(ObserverEvent::Add, {&info.id, 1}, {&entity, 1});
    } else {
        enable_present(entity, info.id);
    }
    return find(entity, info.id);
}

bool World::remove(Entity entity, ComponentId id) {
    core_.check_unlocked();
    const EntityLocation location = require(entity);
    if (!has_at(entity, location, id)) {
        return false;
    }
    if (observes(id, ObserverEvent::Remove)) {
        notify(ObserverEvent::Remove, {&id, 1}, {&entity, 1});
        remove_now(entity, require(entity), id);
    } else {
        remove_now(entity, location, id);
    }
    return true;
}

void World::remove_now(Entity entity, EntityLocation location, ComponentId id) {
    if (SparseSet* set = core_.sparse_set(id); set != nullptr) {
        set->remove(set->find(entity), core_.now());
    } else {
        move_row(entity, location, plan_without(archetype(location.archetype), id));
    }
}

// ---- enabling
// -------------------------------------------------------------------------------------

bool World::set_enabled(Entity entity, ComponentId id, bool enabled) {
    check_not_iterating();
    const EntityLocation location = require(entity);
    Archetype& rows = archetype(location.archetype);
    ToggleBits* toggle = rows.bits().toggle(id);
    LIMN_CHECK_NOTE(toggle != nullptr, component_info(id).name.c_str());
    return rows.set_enabled(*toggle, location.row, enabled, core_.now());
}

bool World::is_enabled(Entity entity, ComponentId id) const {
    const EntityLocation location = core_.entities.find(entity);
    if (!location) {
        return false;
    }
    const SparseSet* set = core_.sparse_set(id);
    return set != nullptr ? set->has(entity)
                          : archetype(location.archetype).is_enabled(id, location.row);
}

void World::enable_present(Entity entity, ComponentId id) {
    const EntityLocation location = core_.entities.find(entity);
    archetype(location.archetype).set_enabled(id, location.row, true, core_.now());
}

// ---- queries and versions
// ------------------------------------------------------------------------

QueryState& World::make_query_state(std::uint32_t index, MakeTerms terms) const {
    if (index >= queries_.size()) {
        queries_.resize(index + 1);
    }
    queries_[index] = std::make_unique<QueryState>(terms());
    return *queries_[index];
}

QueryState& World::shared_query_state(std::uint32_t index, MakeTerms terms) const {
    const std::lock_guard lock(internals_->query_mutex);
    QueryState* state = index < queries_.size() ? queries_[index].get() : nullptr;
    if (state == nullptr) {
        state = &make_query_state(index, terms);
    }
    state->update(core_);
    return *state;
}

std::uint32_t World::begin_run(std::uint32_t systems) {
    constexpr std::uint32_t kInterval = 1u << 28;  // kMaxVersionAge + kInterval < 2^31
    if (core_.now() - versions_clamped_at_ > kInterval
        && core_.iterations.load(std::memory_order_relaxed) == 0) {
        versions_clamped_at_ = core_.now();
        ++core_.version_clamp_count;
        const std::uint32_t oldest = core_.now() - kMaxVersionAge;
        for (const auto& archetype : core_.archetypes) {
            archetype->clamp_versions(oldest);
        }
        for (SparseSet* set : core_.sparse_list) {
            set->clamp_versions(oldest);
        }
        for (const auto& slot : resources_) {
            if (slot != nullptr) {
                slot->version = newer_of(slot->version, oldest);
            }
        }
    }
    return core_.version.fetch_add(systems, std::memory_order_relaxed);
}

void World::set_version(std::uint32_t version) {
    core_.version.store(version, std::memory_order_relaxed);
}

// ---- resources
// -----------------------------------------------------------------------------------

void* World::allocate_resource(ComponentId id) {
    if (id >= resources_.size()) {
        resources_.resize(component_count());
    }
    if (resources_[id] == nullptr) {
        resources_[id] = std::make_unique<ResourceSlot>();
    }
    const ComponentInfo& info = component_info(id);
    resources_[id]->value =
        ::operator new (std::max<std::size_t>(info.size, 1), std::align_val_t{info.align});
    resources_[id]->version = core_.now();
    resource_order_.push_back(id);
    return resources_[id]->value;
}

void* World::insert_default_resource(ComponentId id) {
    const ComponentInfo& info = component_info(id);
    LIMN_CHECK_NOTE(info.ops.construct_default != nullptr, info.name.c_str());
    remove_resource(id);
    void* value = allocate_resource(id);
    info.ops.construct_default(value, 1);
    return value;
}

void* World::find_resource(ComponentId id) {
    ResourceSlot* slot = resource_slot(id);
    if (slot == nullptr) {
        return nullptr;
    }
    slot->version = core_.now();
    return slot->value;
}

const void* World::find_resource(ComponentId id) const {
    const ResourceSlot* slot = resource_slot(id);
    return slot != nullptr ? slot->value : nullptr;
}

std::uint32_t World::resource_version(ComponentId id) const {
    const ResourceSlot* slot = resource_slot(id);
    LIMN_CHECK_NOTE(slot != nullptr, component_info(id).name.c_str());
    return slot->version;
}

void World::remove_resource(ComponentId id) {
    ResourceSlot* slot = resource_slot(id);
    if (slot == nullptr) {
        return;
    }
    const ComponentInfo& info = component_info(id);
    std::erase(resource_order_, id);
    info.ops.destroy(slot->value, 1);
    ::operator delete (slot->value, std::align_val_t{info.align});
    slot->value = nullptr;
}

// ---- restore
// -------------------------------------------------------------------------------------

void World::begin_restore(const EntityTableImage& image) {
    clear();
    bundles_.clear();
    for (std::unique_ptr<Archetype>& archetype : core_.archetypes) {
        if (archetype->is_promoted()) {
            internals_->spare_archetypes.push_back(std::move(archetype));
        }
    }
    core_.archetypes.clear();
    core_.sparse.clear();
    core_.sparse_list.clear();
    internals_->archetype_by_components.clear();
    core_.shared.clear();
    core_.epoch = next_epoch();
    core_.entities.restore(image);
    static_cast<void>(archetype_of({}));
}

Archetype& World::restore_rows(
    std::span<const ComponentId> components, std::span<const Entity> entities,
    std::span<const void* const> shared) {
    std::vector<SharedValue> values;
    for (const ComponentId id : components) {
        const ComponentInfo& info = component_info(id);
        if (info.storage == Storage::Shared) {
            LIMN_CHECK_NOTE(values.size() < shared.size(), info.name.c_str());
            values.push_back(core_.shared.value(core_.shared.add(info, shared[values.size()])));
        }
    }
    Archetype& rows = archetype_of(components, values);
    if (!entities.empty() && rows.capacity() == 0) {
        reuse_memory(rows);
    }
    const std::uint32_t first = rows.append(entities, core_.now());
    for (Column& column : rows.columns()) {
        if (column.info->value_bytes != ValueBytes::All) {
            column.info->ops.construct_default(column.at(first), entities.size());
        }
    }
    for (std::size_t i = 0; i < entities.size(); ++i) {
        core_.entities.set_location(
            entities[i], rows.index(), first + static_cast<std::uint32_t>(i));
    }
    return rows;
}

void World::reuse_memory(Archetype& rows) {
    std::vector<std::unique_ptr<Archetype>>& spare = internals_->spare_archetypes;
    const auto found = std::find_if(spare.begin(), spare.end(), [&](const auto& archetype) {
        return std::equal(
            archetype->components().begin(), archetype->components().end(),
            rows.components().begin(), rows.components().end());
    });
    if (found != spare.end()) {
        rows.take_memory(**found);
        spare.erase(found);
    }
}

SparseSet& World::restore_sparse(ComponentId id, std::span<const Entity> entities) {
    SparseSet& set = use_sparse_set(id);
    for (const Entity entity : entities) {
        static_cast<void>(require(entity));
        const std::uint32_t position = set.append(entity, core_.now());
        if (!set.info().is_tag) {
            set.info().ops.construct_default(set.value(position), 1);
        }
    }
    return set;
}

void World::end_restore() {
    internals_->spare_archetypes.clear();
    for (std::size_t i = 0; i < internals_->observers.size(); ++i) {
        const Observer& observer = *internals_->observers[i];
        if (observer.event != ObserverEvent::Add) {
            continue;
        }
        std::vector<Entity> added;
        each_entity([&](Entity entity) {
            if (has(entity, observer.component)) {
                added.push_back(entity);
            }
        });
        if (!added.empty()) {
            observer.function(*this, added);
        }
    }
}

}  // namespace limn
