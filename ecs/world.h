#pragma once

#include "ecs/entity.h"
#include "ecs/observer.h"
#include "ecs/query.h"
#include "ecs/reflect.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "ecs/world_core.h"

#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace limn {

struct FlushStats;
struct WorldMemory;
class ChangeApplier;
class ChangePlans;
class CommandBuffer;
class CommandFlush;

// Everything there is: entities with their components, and resources. Entities with the same
// components are rows of one Archetype (ecs/archetype.h has the layout); sparse components are in
// sets of their own.
//
//     World world;
//     const Entity lamp = world.create(Transform{}, PointLight{});
//     world.get<PointLight>(lamp).intensity = 40;
//     world.insert_resource(FrameTime{});
//     world.run(update_lights);
//
// Using a stale handle or asking for a component that is not there stops the program with a
// message, and so does a structural change (create, destroy, add, remove) while a query iterates or
// systems run. One thread at a time, unless all only read. The functions that take a ComponentId
// are for code that knows no types: level files, the inspector, snapshots.

class World {
  public:
    World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    ~World();

    // ---- entities
    // ---------------------------------------------------------------------------------

    /// A new entity with these components.
    template <typename... Ts>
    Entity create(Ts&&... components);
    /// `count` entities with copies of these components, in neighboring rows.
    template <typename... Ts>
    std::vector<Entity> create_many(std::size_t count, const Ts&... components);
    /// As many as `entities` has room for.
    template <typename... Ts>
    void create_many(std::span<Entity> entities, const Ts&... components);
    void destroy(Entity entity);
    [[nodiscard]] bool alive(Entity entity) const {
        return static_cast<bool>(core_.entities.find(entity));
    }
    [[nodiscard]] std::size_t entity_count() const;
    /// Destroys all entities; resources, observers and memory stay.
    void clear();
    /// Gives back the memory that nothing uses now; handles keep theirs. A structural change: rows
    /// may move in memory.
    void shrink();

    // ---- components
    // -------------------------------------------------------------------------------

    /// Adds the component or replaces its value. Returns a reference that holds until the next
    /// structural change; of a split or shared component nothing. Another value of a shared
    /// component moves the entity.
    template <typename T>
    detail::Added<T> add(Entity entity, T component = T{});
    /// Returns whether it was there.
    template <typename T>
    bool remove(Entity entity) {
        return remove(entity, component_id<T>);
    }
    template <typename T>
    [[nodiscard]] bool has(Entity entity) const {
        return has(entity, component_id<T>);
    }
    /// The component, which must be there; get<T> counts as a change, get<const T> does not.
    template <typename T>
    [[nodiscard]] T& get(Entity entity);
    template <typename T>
    [[nodiscard]] const T& get(Entity entity) const;
    /// nullptr: the entity is gone or has none.
    template <typename T>
    [[nodiscard]] T* find(Entity entity);
    template <typename T>
    [[nodiscard]] const T* find(Entity entity) const;

    /// A copy of the component, which must be there. For all kinds of storage.
    template <typename T>
    [[nodiscard]] T value(Entity entity) const;
    /// Replaces the component, which must be there. For all kinds of storage; for a shared
    /// component it is a structural change.
    template <typename T>
    void set(Entity entity, T component);

    // ---- enabling, of components whose storage is Storage::Toggle
    // --------------------------------------------------------------------------------

    /// To queries a disabled component is as if it were not there; has, get and find see it all the
    /// same. Not a structural change: no row moves and no observer is told. The entity must have
    /// the component, and no query may iterate (see ChunkView::set_enabled and Commands). add()
    /// enables. Returns whether it was disabled before.
    template <typename T>
    bool enable(Entity entity) {
        return set_enabled<T>(entity, true);
    }
    template <typename T>
    bool disable(Entity entity) {
        return set_enabled<T>(entity, false);
    }
    /// Returns whether it was otherwise before; if so, that counts as a change of T.
    template <typename T>
    bool set_enabled(Entity entity, bool enabled);
    /// Whether the entity has the component and it is not disabled.
    template <typename T>
    [[nodiscard]] bool is_enabled(Entity entity) const {
        return is_enabled(entity, component_id<T>);
    }

    // ---- queries and systems
    // ----------------------------------------------------------------------

    /// Cheap: the archetypes that match are remembered for each type of query. Changed means
    /// always, unless since() says from when.
    template <typename... Terms>
    [[nodiscard]] Query<Terms...> query();
    template <typename... Terms>
    [[nodiscard]] Query<Terms...> query() const;
    /// To all entities that the query would visit at this moment, whole archetypes at once where
    /// possible. Observers are told once, in the order of archetypes and rows.
    template <typename... Terms>
    void destroy_all(const Query<Terms...>& query);
    /// Adds a copy of the component, or replaces the value there is with one.
    template <typename T, typename... Terms>
    void add_all(const Query<Terms...>& query, const T& component = T{});
    template <typename T, typename... Terms>
    void remove_all(const Query<Terms...>& query);
    /// Runs one system, its parameters taken from this world; then applies its commands.
    template <typename F>
    void run(F&& system);

    /// Applies everything recorded in the buffers, in their order, and empties them.
    void apply(std::span<CommandBuffer* const> buffers);

    /// This moment, for Query::since: what is changed from now on is later.
    [[nodiscard]] std::uint32_t version() const {
        return core_.version.fetch_add(1, std::memory_order_relaxed);
    }

    // ---- resources
    // --------------------------------------------------------------------------------

    /// Adds the resource or replaces it. Stays where it is until removed.
    template <typename T>
    T& insert_resource(T resource);
    /// The resource, which must be there; resource<T> counts as a change, resource<const T> does
    /// not.
    template <typename T>
    [[nodiscard]] T& resource();
    template <typename T>
    [[nodiscard]] const T& resource() const;
    template <typename T>
    [[nodiscard]] T* find_resource();
    template <typename T>
    [[nodiscard]] const T* find_resource() const;
    template <typename T>
    void remove_resource() {
        remove_resource(component_id<T>);
    }

    // ---- observers (ecs/observer.h)
    // ---------------------------------------------------------------

    /// function(World&, std::span<const Entity>)
    template <typename T, typename F>
    void on_add(F function) {
        check_observer<T, F>();
        observe({ObserverEvent::Add, component_id<T>, ObserverFunction(std::move(function))});
    }
    template <typename T, typename F>
    void on_remove(F function) {
        check_observer<T, F>();
        observe({ObserverEvent::Remove, component_id<T>, ObserverFunction(std::move(function))});
    }

    // ---- without types
    // ----------------------------------------------------------------------------

    /// Ascending; table, sparse and tags.
    [[nodiscard]] std::vector<ComponentId> components_of(Entity entity) const;
    [[nodiscard]] bool has(Entity entity, ComponentId id) const;
    /// The value; nullptr if there is none. Of tags, not null and not to be read. Counts as a
    /// change if not const. Split components have no address, and shared ones only a const one: use
    /// read and write.
    [[nodiscard]] void* find(Entity entity, ComponentId id);
    [[nodiscard]] const void* find(Entity entity, ComponentId id) const;
    /// Copies the value to raw memory, where it is the caller's to destroy. False: there is none.
    /// Nothing is copied of a tag. For all kinds of storage.
    bool read(Entity entity, ComponentId id, void* raw) const;
    /// Replaces the value by moving from `value`. False: there is none to replace. For all kinds of
    /// storage.
    bool write(Entity entity, ComponentId id, void* value);
    /// Adds with the default value, or leaves the value there is. Returns it; nullptr of split and
    /// shared components, here and below.
    void* add(Entity entity, ComponentId id);
    /// Adds a copy of `value`, or replaces the value there is with one.
    void* add_copy(Entity entity, ComponentId id, const void* value);
    /// The same, moving from `value`.
    void* add_move(Entity entity, ComponentId id, void* value);
    bool remove(Entity entity, ComponentId id);
    /// The component must be of Storage::Toggle.
    bool set_enabled(Entity entity, ComponentId id, bool enabled);
    /// Of any component; those that cannot be disabled are enabled if they are there.
    [[nodiscard]] bool is_enabled(Entity entity, ComponentId id) const;

    void* insert_default_resource(ComponentId id);
    [[nodiscard]] void* find_resource(ComponentId id);
    [[nodiscard]] const void* find_resource(ComponentId id) const;
    void remove_resource(ComponentId id);
    /// The slot of a resource that must be there.
    [[nodiscard]] ResourceSlot& require_resource_slot(ComponentId id);
    /// When the resource, which must be there, was last taken for writing.
    [[nodiscard]] std::uint32_t resource_version(ComponentId id) const;
    /// In the order they were inserted.
    [[nodiscard]] std::span<const ComponentId> resources() const { return resource_order_; }

    // ---- storage: for snapshots, hashes, statistics
    // ------------------------------------------------

    [[nodiscard]] std::span<const std::unique_ptr<Archetype>> archetypes() const {
        return core_.archetypes;
    }
    /// Sets in use, in the order of their first use.
    [[nodiscard]] std::span<SparseSet* const> sparse_sets() const { return core_.sparse_list; }
    /// Calls function(Entity) for all, in the order of queries.
    template <typename F>
    void each_entity(F&& function) const;

    [[nodiscard]] EntityTableImage entity_image() const { return core_.entities.image(); }
    /// A snapshot is put back in four steps: begin, which destroys what there is and forgets the
    /// archetypes, so that they get the order of the calls that follow; then restore_rows for every
    /// archetype, an empty one too; then restore_sparse; then end, which calls on_add. `entities`
    /// must be alive in `image`, each once.
    void begin_restore(const EntityTableImage& image);
    /// Components are the caller's to write: those whose bytes are their value are raw memory,
    /// others have their default value.
    /// `shared` are the values of those of Storage::Shared, in the order of `components`.
    Archetype& restore_rows(
        std::span<const ComponentId> components, std::span<const Entity> entities,
        std::span<const void* const> shared = {});
    /// The entities have been placed by restore_rows.
    SparseSet& restore_sparse(ComponentId id, std::span<const Entity> entities);
    void end_restore();

    /// Those made by query(), by type; null where this world has not met the type.
    [[nodiscard]] std::span<const std::unique_ptr<QueryState>> queries() const { return queries_; }
    [[nodiscard]] WorldMemory memory() const;             ///< in ecs/world_stats.h
    [[nodiscard]] const FlushStats& flush_stats() const;  ///< in ecs/flush_stats.h
    [[nodiscard]] WorldCore& core() { return core_; }
    [[nodiscard]] const WorldCore& core() const { return core_; }
    /// Starts a run of `systems` systems: the version of what the first one writes; those of the
    /// others follow. Old versions are forgotten here.
    [[nodiscard]] std::uint32_t begin_run(std::uint32_t systems = 1);
    /// For tests of the wrap: all that happens from now on has versions from `version` on.
    void set_version(std::uint32_t version);

  private:
    friend class ChangeApplier;
    friend class ChangePlans;
    friend class CommandFlush;
    friend struct SystemCache;
    struct Internals;

    /// Where the components of a create() go.
    struct Bundle {
        Archetype* archetype = nullptr;       ///< with shared components, that of the last values
        std::vector<ComponentId> components;  ///< in the order of the call
        std::vector<ComponentId> table;       ///< those that are not sparse, ascending
        std::vector<int> columns;
        bool has_sparse = false;
    };

    [[nodiscard]] EntityPlace require(Entity entity) const {
        const EntityPlace place = core_.entities.find(entity);
        LIMN_CHECK_NOTE(place, "stale handle: the entity is gone");
        return place;
    }
    [[nodiscard]] Archetype& archetype(std::uint32_t index) const {
        return *core_.archetypes[index];
    }
    template <typename... Ts>
    Bundle& bundle_of();
    Bundle& make_bundle(std::uint32_t index, std::span<const ComponentId> components);
    /// The bundle of components with these values; chooses the archetype by those that are shared.
    template <typename... Ts>
    const Bundle& bundle_with(const Ts&... components);
    void choose_archetype(Bundle& bundle, std::span<const void* const> values);
    /// `shared` has the values of those that are shared, in the same order.
    [[nodiscard]] Archetype&
    archetype_of(std::span<const ComponentId> components, std::span<const SharedValue> shared = {});
    /// The archetype with this value of a shared component, which `from` may have or not.
    [[nodiscard]] Archetype&
    archetype_with_value(Archetype& from, const ComponentInfo& info, const void* value);
    [[nodiscard]] const RowPlan& plan_with(Archetype& from, ComponentId id);
    [[nodiscard]] const RowPlan& plan_without(Archetype& from, ComponentId id);
    /// Moves the entity's row, as Archetype::move_row; returns where it is then.
    std::uint32_t move_row(Entity entity, EntityPlace place, const RowPlan& plan);
    /// Room for a component the entity does not have yet: raw memory, nullptr for tags.
    void* make_room(Entity entity, EntityPlace place, ComponentId id);
    /// The same for a component that is not sparse. Not for use if it is split.
    void* make_room_in_row(Entity entity, EntityPlace place, ComponentId id);
    /// Adding enables what was there, disabled.
    void enable_present(Entity entity, ComponentId id);
    void check_not_iterating() const {
        LIMN_CHECK_NOTE(
            core_.iterations.load(std::memory_order_relaxed) == 0,
            "enabling or disabling while iterating or inside a system; use chunk.set_enabled of a "
            "written term, or Commands");
    }
    /// Of an archetype that was there before the snapshot that is being restored, if there is one.
    void reuse_memory(Archetype& rows);
    void destroy_now(Entity entity, EntityPlace place);
    /// Says where the row is that has filled a hole, if one has.
    void place_filler(const Archetype& rows, std::uint32_t hole) {
        if (hole < rows.size()) {
            core_.entities.place(rows.entities()[hole], rows.index(), hole);
        }
    }
    void remove_now(Entity entity, EntityPlace place, ComponentId id);
    [[nodiscard]] bool has_at(Entity entity, EntityPlace place, ComponentId id) const;
    template <typename T>
    [[nodiscard]] T* find_at(Entity entity, EntityPlace place);
    /// Adds or replaces a component without an address.
    void put_bytes(Entity entity, ComponentId id, const void* value);
    [[nodiscard]] SparseSet& use_sparse_set(ComponentId id);
    /// One command for many rows; `record` has the values for each of them.
    void change_rows(CommandKind kind, std::byte* record, std::vector<ArchetypeRows> rows);

    template <typename T, typename F>
    static constexpr void check_observer() {
        static_assert(
            detail::Component<T>, "components are values, not pointers, arrays or entities");
        static_assert(
            std::is_invocable_v<F&, World&, std::span<const Entity>>,
            "an observer is a function of (World&, std::span<const Entity>)");
    }
    void observe(Observer observer);
    void refresh_observer_flags();
    [[nodiscard]] bool observes(ComponentId id, ObserverEvent event) const {
        return id < observed_.size() && (observed_[id] & (1u << static_cast<unsigned>(event))) != 0;
    }
    void notify(
        ObserverEvent event, std::span<const ComponentId> components,
        std::span<const Entity> entities);
    void notify_all_removed();
    void drop_all_rows();

    using MakeTerms = std::vector<QueryTerm> (*)();
    QueryState& make_query_state(std::uint32_t index, MakeTerms terms) const;
    /// Up to date, for several threads at the same time.
    QueryState& shared_query_state(std::uint32_t index, MakeTerms terms) const;
    [[nodiscard]] ResourceSlot* resource_slot(ComponentId id) const {
        ResourceSlot* slot = id < resources_.size() ? resources_[id].get() : nullptr;
        return slot != nullptr && slot->value != nullptr ? slot : nullptr;
    }
    void* allocate_resource(ComponentId id);

    WorldCore core_;
    std::vector<std::unique_ptr<Bundle>> bundles_;
    mutable std::vector<std::unique_ptr<QueryState>> queries_;
    std::vector<std::unique_ptr<ResourceSlot>> resources_;
    std::vector<ComponentId> resource_order_;
    std::vector<std::uint8_t> observed_;  ///< by component, a bit an event
    std::uint32_t versions_forgotten_at_ = 0;
    std::unique_ptr<Internals> internals_;
};

}  // namespace limn

#include "ecs/world_impl.h"  // IWYU pragma: export
