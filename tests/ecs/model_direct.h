#pragma once

#include "ecs/hierarchy.h"
#include "tests/ecs/model_sweep.h"

#include <cstdint>
#include <utility>
#include <vector>

// Operations on single entities of the world itself: what happens, happens at once.

namespace limn::test::model {

class ModelDirect : public ModelSweep {
  public:
    using ModelSweep::ModelSweep;

  protected:
    // ---- entities and components
    void change_population() {
        const std::size_t size = reference_.living().size();
        if (size + 200 < goal_) {
            create_many(100);
        } else if (size > 0 && chance(size > goal_ ? 70 : 40)) {
            destroy();
        } else if (chance(10)) {
            create_many(roll(12));
        } else {
            create();
        }
    }

    void create() {
        count("create");
        const Value value{static_cast<std::int64_t>(next_serial_++), any_link()};
        switch (roll(6)) {
        case 0:
            create_one<>(value);
            break;
        case 1:
            create_one<ModelSpeed, ModelPlace>(value);
            break;
        case 2:
            create_one<ModelTitle, ModelWarmth, ModelAwake, ModelPlace, ModelBadge>(value);
            break;
        case 3:
            create_one<ModelChosen, ModelTally, ModelLink, ModelSerial>(value);
            break;
        case 4:
            create_one<ModelPlace, ModelTeam, ModelSpeed, ModelMemo>(value);
            break;
        default:
            create_one<ModelSerial, Parent, ModelPlace, ModelPose, ModelLamp>(value);
        }
    }

    void create_many(std::size_t size) {
        count("create_many");
        const Value value{roll(1'000'000), kNoId};
        switch (roll(3)) {
        case 0:
            create_alike<ModelPlace, ModelSpeed>(size, value);
            break;
        case 1:
            create_alike<ModelTally, ModelMemo, ModelTitle>(size, value);
            break;
        default:
            create_alike<ModelWarmth, ModelBadge, ModelLamp, ModelTeam, ModelPose>(size, value);
        }
    }

    void destroy() {
        count("destroy");
        const Id id = any_living();
        world_.destroy(reference_.handle(id));
        reference_.destroy(id);
    }

    void add() {
        if (reference_.living().empty()) {
            return;
        }
        count("add");
        const Id id = any_living();
        const Kind kind = any_kind();
        const Value value = any_value(kind, id);
        const Entity entity = reference_.handle(id);
        with_kind(kind, [&]<typename T>() {
            T component = make<T>(value.number, reference_.handle(value.entity));
            switch (roll(5)) {
            case 0:
                world_.add_copy(entity, component_id<T>, &component);
                break;
            case 1:
                world_.add_move(entity, component_id<T>, &component);
                break;
            case 2:
                if (kind != Kind::Serial) {
                    world_.add(entity, component_id<T>);
                    if (reference_.has(id, kind)) {
                        reference_.set_enabled(id, kind, true);
                    } else {
                        reference_.add(id, kind, {});
                    }
                    return;
                }
                [[fallthrough]];
            default:
                if constexpr (is_written_in_place<T>) {
                    T& added = world_.add(entity, std::move(component));
                    expect(read(added) == value.number, "add returns something else");
                } else {
                    world_.add(entity, component);
                }
            }
            reference_.add(id, kind, value);
        });
    }

    void remove() {
        if (reference_.living().empty()) {
            return;
        }
        count("remove");
        const Id id = any_living();
        const Kind kind = any_kind();
        const Entity entity = reference_.handle(id);
        with_kind(kind, [&]<typename T>() {
            const bool was_there =
                chance(70) ? world_.remove<T>(entity) : world_.remove(entity, component_id<T>);
            expect(was_there == reference_.remove(id, kind), "remove says something else");
        });
    }

    /// Writes a component where it is.
    void write() {
        if (reference_.living().empty()) {
            return;
        }
        count("write");
        const Id id = any_living();
        const Kind kind = any_kind();
        const Value value = any_value(kind, id);
        const Entity entity = reference_.handle(id);
        with_kind(kind, [&]<typename T>() {
            const T component = make<T>(value.number, reference_.handle(value.entity));
            const std::uint32_t way = roll(7);
            bool is_there = reference_.has(id, kind);
            if (way == 0) {
                T copy = component;
                is_there = world_.write(entity, component_id<T>, &copy);
            } else if (way == 1 || !is_written_in_place<T>) {
                if (is_there) {
                    world_.set<T>(entity, component);
                }
            } else {
                is_there = write_in_place(entity, kind, component, way);
            }
            expect(is_there == reference_.has(id, kind), "a component is lost or extra");
        });
        reference_.set(id, kind, value);
    }

    /// Whether it was there; to a query it is there if it is enabled.
    template <typename T>
    bool write_in_place(Entity entity, Kind kind, const T& component, std::uint32_t way) {
        if constexpr (is_written_in_place<T>) {
            T* place = nullptr;
            if (way == 2) {
                place = static_cast<T*>(world_.find(entity, component_id<T>));
            } else if (way == 3) {
                place = world_.query<T>().template find<T>(entity);
                const Record& record = reference_.at(reference_.id_of(entity));
                expect(
                    (place != nullptr) == record.is_enabled(kind), "a query finds other entities");
                place = world_.find<T>(entity);
            } else if (way == 4 && world_.has<T>(entity)) {
                place = &world_.get<T>(entity);
            } else {
                place = world_.find<T>(entity);
            }
            if (place != nullptr && !std::is_empty_v<T>) {
                *place = component;
            }
            return place != nullptr;
        }
        return false;
    }

    void toggle() {
        if (reference_.living().empty()) {
            return;
        }
        count("enable or disable");
        const Id id = any_living();
        const Kind kind = chance(50) ? Kind::Lamp : Kind::Awake;
        if (!reference_.has(id, kind)) {
            return;
        }
        const bool enabled = chance(50);
        const Entity entity = reference_.handle(id);
        const bool was_otherwise =
            kind == Kind::Lamp ? world_.set_enabled<ModelLamp>(entity, enabled)
                               : world_.set_enabled(entity, component_id<ModelAwake>, enabled);
        expect(
            was_otherwise == reference_.set_enabled(id, kind, enabled),
            "set_enabled says something else");
    }

    void use_stale_handle() {
        const Id id = any_dead();
        if (id == kNoId) {
            return;
        }
        count("stale handle");
        const Entity entity = reference_.handle(id);
        expect(!world_.alive(entity), "a stale handle is alive");
        with_kind(any_kind(), [&]<typename T>() {
            expect(!world_.has<T>(entity), "a stale handle has a component");
            if constexpr (has_address<T>) {
                expect(world_.find<const T>(entity) == nullptr, "a stale handle has a component");
                expect(
                    world_.query<const T>().template find<const T>(entity) == nullptr,
                    "a query finds a stale handle");
            }
            expect(!world_.is_enabled<T>(entity), "a stale handle has a component");
            alignas(T) std::byte raw[sizeof(T)];
            expect(!world_.read(entity, component_id<T>, raw), "a stale handle has a component");
            expect(!world_.query<const T>().contains(entity), "a query contains a stale handle");
        });
        expect(children_of(world_, entity).empty(), "a stale handle has children");
        if (!reference_.living().empty()) {
            const Entity living = reference_.handle(any_living());
            expect(!set_parent(world_, entity, living).ok(), "a stale handle gets a parent");
            expect(!set_parent(world_, living, entity).ok(), "a stale handle gets a child");
        }
    }

    // ---- the hierarchy

    void reparent() {
        if (reference_.living().empty()) {
            return;
        }
        count("reparent");
        Id child = any_living();
        Id parent = any_link();
        if (chance(15)) {
            parent = child;
            while (chance(60) && reference_.parent_of(child) != kNoId) {
                child = reference_.parent_of(child);  // it is to be below its own child: a cycle
            }
        }
        const bool is_root = parent == kNoId;
        const bool possible =
            is_root || (reference_.alive(parent) && !reference_.is_below(parent, child));
        const bool done =
            set_parent(world_, reference_.handle(child), reference_.handle(parent)).ok();
        expect(done == possible, "set_parent accepts or refuses something else");
        if (is_root) {
            reference_.remove(child, Kind::Parent);
        } else if (possible) {
            reference_.add(child, Kind::Parent, {reference_.next_order++, parent});
        }
    }

    void destroy_a_tree() {
        if (reference_.living().empty()) {
            return;
        }
        count("destroy_tree");
        const Id root = any_living();
        destroy_tree(world_, reference_.handle(root));
        for (const Id id : reference_.subtree(root)) {
            reference_.destroy(id);
        }
    }
};

}  // namespace limn::test::model
