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
class AnyComponent;
class ChangeApplier;
class ChangePlans;
class CommandBuffer;
class CommandFlush;

// A container of entities with their components, and of resources. Entities with the same
// components are rows of one Archetype (ecs/archetype.h has the layout); sparse components are in
// separate sets.
//
//     World world;
//     const Entity lamp = world.create(Transform{}, PointLight{});
//     world.get<PointLight>(lamp).intensity = 40;
//     world.insert_resource(FrameTime{});
//     world.run(update_lights);
//
// Using a stale handle or requesting a missing component stops the program with a message, and so
// does a structural change (create, destroy, add, remove) while a query iterates or systems run.
// Not thread-safe, except for concurrent reads. The functions that take a ComponentId are for
// type-erased code: level files, the inspector, snapshots.

class World {
  public:
    World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    ~World();

    // ---- entities
    // ---------------------------------------------------------------------------------

    /// A new entity with these components. By value, for they may be those of another entity, whose
    /// rows move.
    template <typename... Ts>
    Entity create(Ts... components);
    /// `count` entities with copies of these components, in consecutive rows.
    template <typename... Ts>
    std::vector<Entity> create_many(std::size_t count, const Ts&... components);
    /// The same, filling `entities`.
    template <typename... Ts>
    void create_many(std::span<Entity> entities, Ts... components);
    void destroy(Entity entity);
    [[nodiscard]] bool alive(Entity entity) const {
        return static_cast<bool>(core_.entities.find(entity));
    }
    [[nodiscard]] std::size_t entity_count() const;
    /// Destroys all entities; resources, observers and memory stay.
    void clear();
    /// Releases unused memory, except that of handles. A structural change: rows may move in
    /// memory.
    void shrink();

    // ---- components
    // -------------------------------------------------------------------------------

    /// Adds the component or replaces its value. Returns a reference that is valid until the next
    /// structural change; void for a split or shared component. Changing the value of a shared
    /// component moves the entity.
    template <typename T>
    detail::Added<T> add(Entity entity, T component = T{});
    /// Returns whether the entity had the component.
    template <typename T>
    bool remove(Entity entity) {
        return remove(entity, component_id<T>);
    }
    template <typename T>
    [[nodiscard]] bool has(Entity entity) const {
        return has(entity, component_id<T>);
    }
    /// The component, which must exist; get<T> counts as a change, get<const T> does not.
    template <typename T>
    [[nodiscard]] T& get(Entity entity);
    template <typename T>
    [[nodiscard]] const T& get(Entity entity) const;
    /// nullptr if the entity is destroyed or does not have the component.
    template <typename T>
    [[nodiscard]] T* find(Entity entity);
    template <typename T>
    [[nodiscard]] const T* find(Entity entity) const;

    /// A copy of the component, which must exist. For all kinds of storage.
    template <typename T>
    [[nodiscard]] T value(Entity entity) const;
    /// Replaces the component, which must exist. For all kinds of storage; a structural change for
    /// a shared component.
    template <typename T>
    void set(Entity entity, T component);

    // ---- enabling and disabling (Storage::Toggle)
    // -------------------------------------------------

    /// Queries treat a disabled component as missing; has, get and find still find it. Not a
    /// structural change: no row moves and no observer is called. The entity must have the
    /// component, and no query may iterate (see ChunkView::set_enabled and Commands). add()
    /// enables. Returns whether the state changed.
    template <typename T>
    bool enable(Entity entity) {
        return set_enabled<T>(entity, true);
    }
    template <typename T>
    bool disable(Entity entity) {
        return set_enabled<T>(entity, false);
    }
    /// Returns whether the state changed, which counts as a change of T.
    template <typename T>
    bool set_enabled(Entity entity, bool enabled);
    /// Whether the entity has the component and it is not disabled.
    template <typename T>
    [[nodiscard]] bool is_enabled(Entity entity) const {
        return is_enabled(entity, component_id<T>);
    }

    // ---- queries and systems
    // ----------------------------------------------------------------------

    /// Cheap: matching archetypes are cached per query type. Changed matches everything unless
    /// since() is used.
    template <typename... Terms>
    [[nodiscard]] Query<Terms...> query();
    template <typename... Terms>
    [[nodiscard]] Query<Terms...> query() const;
    /// Applies to all entities that the query would visit now, whole archetypes at once where
    /// possible. Observers are called once, in the order of archetypes and rows.
    template <typename... Terms>
    void destroy_all(const Query<Terms...>& query);
    /// Adds a copy of the component or replaces the existing value.
    template <typename T, typename... Terms>
    void add_all(const Query<Terms...>& query, const T& component = T{});
    template <typename T, typename... Terms>
    void remove_all(const Query<Terms...>& query);
    /// Runs one system with parameters from this world, then applies its commands.
    template <typename F>
    void run(F&& system);

    /// Applies all commands of the buffers, in order, and empties them.
    void apply(std::span<CommandBuffer* const> buffers);

    /// The current version, for Query::since: all later changes are newer.
    [[nodiscard]] std::uint32_t version() const {
        return core_.version.fetch_add(1, std::memory_order_relaxed);
    }

    // ---- resources
    // --------------------------------------------------------------------------------

    /// Adds or replaces the resource, whose address is stable until it is removed.
    template <typename T>
    T& insert_resource(T resource);
    /// The resource, which must exist; resource<T> counts as a change, resource<const T> does not.
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

    // ---- type-erased
    // ------------------------------------------------------------------------------

    /// Ascending; includes sparse components and tags.
    [[nodiscard]] std::vector<ComponentId> components_of(Entity entity) const;
    [[nodiscard]] bool has(Entity entity, ComponentId id) const;
    /// The value; nullptr if there is none; for tags a non-null pointer that must not be
    /// dereferenced. Counts as a change if not const. Split components have no address, and shared
    /// ones only a const one: use read and write.
    [[nodiscard]] void* find(Entity entity, ComponentId id);
    [[nodiscard]] const void* find(Entity entity, ComponentId id) const;
    /// Copy-constructs the value in raw memory; the caller must destroy it. Returns false if there
    /// is none. Copies nothing for a tag. For all kinds of storage.
    bool read(Entity entity, ComponentId id, void* raw) const;
    /// Replaces the value by moving from `value`. Returns false if there is none. For all kinds of
    /// storage.
    bool write(Entity entity, ComponentId id, void* value);
    /// Adds the component with its default value or keeps the existing one. Returns the value;
    /// nullptr for split and shared components, here and below.
    void* add(Entity entity, ComponentId id);
    /// Adds a copy of `value` or replaces the existing value. `value` may be a component of this
    /// world.
    void* add_copy(Entity entity, ComponentId id, const void* value);
    /// The same, moving from `value`.
    void* add_move(Entity entity, ComponentId id, void* value);
    bool remove(Entity entity, ComponentId id);
    /// The component must be of Storage::Toggle.
    bool set_enabled(Entity entity, ComponentId id, bool enabled);
    /// For any component; those that cannot be disabled are enabled if present.
    [[nodiscard]] bool is_enabled(Entity entity, ComponentId id) const;

    void* insert_default_resource(ComponentId id);
    [[nodiscard]] void* find_resource(ComponentId id);
    [[nodiscard]] const void* find_resource(ComponentId id) const;
    void remove_resource(ComponentId id);
    /// The slot of a resource; nullptr if it does not exist.
    [[nodiscard]] ResourceSlot* resource_slot(ComponentId id) const {
        ResourceSlot* slot = id < resources_.size() ? resources_[id].get() : nullptr;
        return slot != nullptr && slot->value != nullptr ? slot : nullptr;
    }
    /// When the resource, which must exist, was last accessed for writing.
    [[nodiscard]] std::uint32_t resource_version(ComponentId id) const;
    /// In insertion order.
    [[nodiscard]] std::span<const ComponentId> resources() const { return resource_order_; }

    // ---- storage: for snapshots, hashes, statistics
    // ------------------------------------------------

    [[nodiscard]] std::span<const std::unique_ptr<Archetype>> archetypes() const {
        return core_.archetypes;
    }
    /// Sets in use, in the order of first use.
    [[nodiscard]] std::span<SparseSet* const> sparse_sets() const { return core_.sparse_list; }
    /// Calls function(Entity) for all entities, in query order.
    template <typename F>
    void each_entity(F&& function) const;

    [[nodiscard]] EntityTableImage entity_image() const { return core_.entities.image(); }
    /// A snapshot is restored in four steps: begin_restore, which destroys all entities and
    /// archetypes, so that the archetypes get the order of the following calls; restore_rows for
    /// every archetype, including empty ones; restore_sparse; end_restore, which calls on_add.
    /// `entities` must be alive in `image`, each once.
    void begin_restore(const EntityTableImage& image);
    /// The caller must write the components: those without padding are raw memory, others have
    /// their default value. `shared` has the values of Storage::Shared components, in the order of
    /// `components`.
    Archetype& restore_rows(
        std::span<const ComponentId> components, std::span<const Entity> entities,
        std::span<const void* const> shared = {});
    /// The entities must have been restored by restore_rows.
    SparseSet& restore_sparse(ComponentId id, std::span<const Entity> entities);
    void end_restore();

    /// The states of query(), by type index; null if this world has not used the type.
    [[nodiscard]] std::span<const std::unique_ptr<QueryState>> queries() const { return queries_; }
    [[nodiscard]] WorldMemory memory() const;             ///< in ecs/world_stats.h
    [[nodiscard]] const FlushStats& flush_stats() const;  ///< in ecs/flush_stats.h
    [[nodiscard]] WorldCore& core() { return core_; }
    [[nodiscard]] const WorldCore& core() const { return core_; }
    /// Starts a run of `systems` systems: returns the version of the first one's writes; the others
    /// have consecutive versions. Clamps old versions.
    [[nodiscard]] std::uint32_t begin_run(std::uint32_t systems = 1);
    /// For tests of version wraparound: sets the version counter.
    void set_version(std::uint32_t version);

  private:
    friend class ChangeApplier;
    friend class ChangePlans;
    friend class CommandFlush;
    friend struct SystemCache;
    struct Internals;

    /// Cached target of create() for a combination of component types.
    struct Bundle {
        Archetype* archetype = nullptr;       ///< with shared components, for the last values
        std::vector<ComponentId> components;  ///< in the order of the call
        std::vector<ComponentId> table;       ///< non-sparse components, ascending
        std::vector<int> columns;
        bool has_sparse = false;
    };

    [[nodiscard]] EntityLocation require(Entity entity) const {
        const EntityLocation location = core_.entities.find(entity);
        LIMN_CHECK_NOTE(location, "stale handle: the entity no longer exists");
        return location;
    }
    [[nodiscard]] Archetype& archetype(std::uint32_t index) const {
        return *core_.archetypes[index];
    }
    template <typename... Ts>
    Bundle& bundle_of();
    Bundle& make_bundle(std::uint32_t index, std::span<const ComponentId> components);
    /// The bundle for these components, with the archetype for their shared values.
    template <typename... Ts>
    const Bundle& bundle_with(const Ts&... components);
    void choose_archetype(Bundle& bundle, std::span<const void* const> values);
    /// `shared` has the values of the shared components, in the same order.
    [[nodiscard]] Archetype&
    archetype_of(std::span<const ComponentId> components, std::span<const SharedValue> shared = {});
    /// The archetype like `from` with this value of a shared component, replaced or added.
    [[nodiscard]] Archetype&
    archetype_with_value(Archetype& from, const ComponentInfo& info, const void* value);
    [[nodiscard]] const RowPlan& plan_with(Archetype& from, ComponentId id);
    [[nodiscard]] const RowPlan& plan_without(Archetype& from, ComponentId id);
    /// Moves the entity's row like Archetype::move_row; returns the new row.
    std::uint32_t move_row(Entity entity, EntityLocation location, const RowPlan& plan);
    /// Raw memory for a component the entity does not have yet; nullptr for tags.
    void* make_room(Entity entity, EntityLocation location, ComponentId id);
    /// The same for a component that is not sparse. The result is unusable if it is split.
    void* make_room_in_row(Entity entity, EntityLocation location, ComponentId id);
    /// Enables a component that is added again.
    void enable_present(Entity entity, ComponentId id);
    void check_not_iterating() const {
        LIMN_CHECK_NOTE(
            core_.iterations.load(std::memory_order_relaxed) == 0,
            "enabling or disabling while iterating or inside a system; use chunk.set_enabled of a "
            "written term, or Commands");
    }
    /// Takes the memory of an equal archetype from before the restore, if there is one.
    void reuse_memory(Archetype& rows);
    void destroy_now(Entity entity, EntityLocation location);
    /// Updates the location of the entity whose row filled the hole, if any.
    void update_filler(const Archetype& rows, std::uint32_t hole) {
        if (hole < rows.size()) {
            core_.entities.set_location(rows.entities()[hole], rows.index(), hole);
        }
    }
    void remove_now(Entity entity, EntityLocation location, ComponentId id);
    [[nodiscard]] bool has_at(Entity entity, EntityLocation location, ComponentId id) const;
    template <typename T>
    [[nodiscard]] T* find_at(Entity entity, EntityLocation location);
    /// Adds or replaces a split or shared component.
    void* put_value(Entity entity, AnyComponent value);
    void put_bytes(Entity entity, ComponentId id, const void* value);
    [[nodiscard]] SparseSet& use_sparse_set(ComponentId id);
    /// Applies one command to many rows, which share the values in `record`.
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
    /// The up-to-date state; thread-safe.
    QueryState& shared_query_state(std::uint32_t index, MakeTerms terms) const;
    void* allocate_resource(ComponentId id);

    WorldCore core_;
    std::vector<std::unique_ptr<Bundle>> bundles_;
    mutable std::vector<std::unique_ptr<QueryState>> queries_;
    std::vector<std::unique_ptr<ResourceSlot>> resources_;
    std::vector<ComponentId> resource_order_;
    std::vector<std::uint8_t> observed_;  ///< by component, one bit per event
    std::uint32_t versions_clamped_at_ = 0;
    std::unique_ptr<Internals> internals_;
};

}  // namespace limn

#include "ecs/world_impl.h"  // IWYU pragma: export
