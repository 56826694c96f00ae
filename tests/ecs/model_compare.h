#pragma once

#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "tests/ecs/model_compare_queries.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

// Is a world what the reference says? Looked at from all sides: entity by entity, through queries
// of several shapes, with every kind of iteration, and by what has changed.

namespace limn::test::model {

class Comparison : public ComparedQueries {
  public:
    using ComparedQueries::ComparedQueries;

    /// Compares everything; of the shapes of queries, `round` says which.
    void run(unsigned round) {
        compare_changed();
        const std::uint32_t before_reading = world_.version();
        compare_entities();
        compare_shape(round);
        compare_hierarchy();
        compare_gone();
        expect_nothing_changed(before_reading);
        reference_.forget_changes();
        changed_since_ = world_.version();
    }

  private:
    // ---- entity by entity
    // ---------------------------------------------------------------------

    void compare_entities() {
        const World& world = world_;
        expect(world.entity_count() == reference_.records().size(), "entities are lost or extra");
        std::size_t number = 0;
        for (const auto& [id, record] : reference_.records()) {
            const Entity entity = reference_.handle(id);
            expect(world.alive(entity), "an entity is gone");
            const Record& expected = record;
            for_each_kind([&]<typename T>() {
                expect(
                    world.has<T>(entity) == expected.has(kind_of<T>()),
                    "a component is lost or extra");
                if (expected.has(kind_of<T>())) {
                    expect_value(read_from(world, entity, std::type_identity<T>{}), expected);
                    expect(
                        world.is_enabled<T>(entity) == expected.is_enabled(kind_of<T>()),
                        "a component is enabled or disabled");
                }
            });
            if (++number % 16 == 0) {
                expect(world.components_of(entity) == ids_of(record.mask), "components_of differs");
            }
        }
    }

    template <typename T>
    static decltype(auto) read_from(const World& world, Entity entity, std::type_identity<T>) {
        if constexpr (has_address<T>) {
            return world.get<T>(entity);
        } else {
            return world.value<T>(entity);
        }
    }

    static std::vector<ComponentId> ids_of(Mask mask) {
        std::vector<ComponentId> ids;
        for_each_kind([&]<typename T>() {
            if ((mask & bit(kind_of<T>())) != 0) {
                ids.push_back(component_id<T>);
            }
        });
        std::sort(ids.begin(), ids.end());
        return ids;
    }

    // ---- changes
    // ------------------------------------------------------------------------------

    /// Everything written since the last comparison is reported.
    void compare_changed() {
        std::unordered_map<Id, Mask> reported;
        const Mask watched =
            collect_changed<ModelPlace, ModelTitle, ModelPose, ModelLamp, ModelWarmth, ModelTeam>(
                reported);
        for (const auto& [id, record] : reference_.records()) {
            const Mask changed = record.changed_and_seen() & watched;
            if (changed != 0) {
                expect((changed & ~reported[id]) == 0, "a change is not reported");
            }
        }
        compare_changed_in(1, reported);
    }
    template <typename... Ts>
    Mask collect_changed(std::unordered_map<Id, Mask>& reported) const {
        const auto collect = [&]<typename T>(std::type_identity<T>) {
            std::as_const(world_)
                .query<const T, Changed<T>>()
                .since(changed_since_)
                .each([&](Entity entity, const T&) {
                    reported[reference_.id_of(entity)] |= bit(kind_of<T>());
                });
        };
        (collect(std::type_identity<Ts>{}), ...);
        return (bit(kind_of<Ts>()) | ...);
    }
    /// Of one team the same are reported.
    void compare_changed_in(std::int64_t team, std::unordered_map<Id, Mask>& reported) const {
        std::size_t expected = 0;
        for (const auto& [id, mask] : reported) {
            const bool is_place = (mask & bit(Kind::Place)) != 0;
            expected += is_place && reference_.at(id).team() == team ? 1 : 0;
        }
        std::size_t found = 0;
        std::as_const(world_)
            .query<const ModelPlace, Changed<ModelPlace>>()
            .where(make<ModelTeam>(team, {}))
            .since(changed_since_)
            .each([&](Entity entity, const ModelPlace&) {
                const Id id = reference_.id_of(entity);
                expect(reference_.at(id).team() == team, "a change is reported of another team");
                found += (reported[id] & bit(Kind::Place)) != 0 ? 1 : 0;
            });
        expect(found == expected, "a change in a team is not reported");
    }

    /// Reading is no change.
    void expect_nothing_changed(std::uint32_t since) const {
        for_each_kind([&]<typename T>() {
            if constexpr (!std::is_empty_v<T>) {
                expect(
                    std::as_const(world_).query<const T, Changed<T>>().since(since).empty(),
                    "reading counts as a change");
            }
        });
    }

    // ---- the rest
    // -----------------------------------------------------------------------------

    void compare_hierarchy() {
        const Hierarchy& links = hierarchy(world_);
        std::size_t nodes = 0;
        for (const auto& [parent, children] : reference_.children()) {
            const std::span<const Entity> found = links.children_of(reference_.handle(parent));
            expect(found.size() == children.size(), "a parent has other children");
            for (std::size_t i = 0; i < children.size(); ++i) {
                expect(found[i] == reference_.handle(children[i]), "children are in another order");
            }
            nodes += children.size();
        }
        expect(links.nodes().size() == nodes, "the hierarchy has other links");
        for (const HierarchyNode& node : links.nodes()) {
            const bool is_root = node.parent_node == HierarchyNode::kRoot;
            expect(
                node.depth == (is_root ? 1 : links.nodes()[node.parent_node].depth + 1),
                "a node is at another depth");
        }
    }

    void compare_gone() const {
        for (const Id id : reference_.dead()) {
            expect(!world_.alive(reference_.handle(id)), "a stale handle is alive");
        }
    }

    std::uint32_t changed_since_ = 0;
};

}  // namespace limn::test::model
