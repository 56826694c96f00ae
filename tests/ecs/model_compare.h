#pragma once

#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "tests/ecs/model_components.h"
#include "tests/ecs/model_reference.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

// Is a world what the reference says? Looked at from all sides: entity by entity, through queries
// of several shapes, each in every way of iterating, and by what has changed.

namespace limn::test::model {

/// A check that costs nothing while it holds: there are a hundred million of them.
inline void expect(bool holds, const char* what, int line = __builtin_LINE()) {
    if (!holds) {
        const std::string message = std::string(what) + ", line " + std::to_string(line);
        FAIL(message);
    }
}

/// What a query says of the components it names.
template <typename Term>
struct ShapeOf {
    static constexpr Mask required = bit(kind_of<std::remove_const_t<Term>>());
    static constexpr Mask excluded = 0;
};
template <typename T>
struct ShapeOf<Optional<T>> {
    static constexpr Mask required = 0;
    static constexpr Mask excluded = 0;
};
template <typename... Ts>
struct ShapeOf<With<Ts...>> {
    static constexpr Mask required = (Mask{0} | ... | bit(kind_of<Ts>()));
    static constexpr Mask excluded = 0;
};
template <typename... Ts>
struct ShapeOf<Without<Ts...>> {
    static constexpr Mask required = 0;
    static constexpr Mask excluded = (Mask{0} | ... | bit(kind_of<Ts>()));
};
template <typename... Ts>
struct ShapeOf<Changed<Ts...>> : ShapeOf<With<Ts...>> {};

/// Whether chunks() cannot tell which rows have it.
template <typename Term>
inline constexpr bool takes_rows = false;
template <typename T>
inline constexpr bool takes_rows<Optional<T>> = detail::is_sparse<T> || detail::is_toggle<T>;

class Comparison {
  public:
    Comparison(World& world, Reference& reference) : world_(world), reference_(reference) {}

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

    template <typename T>
    void expect_value(const T& found, const Record& record) {
        const Value& expected = record.value(kind_of<T>());
        expect(read(found) == expected.number, "a component has another value");
        if constexpr ((bit(kind_of<T>()) & kLinks) != 0) {
            expect_entity(entity_in(found), expected.entity);
        }
    }

    void expect_entity(Entity found, Id expected) {
        if (expected != kNoId && !reference_.is_bound(expected)) {
            // Created and destroyed at one sync point: it had a handle that nobody was told.
            expect(!found.is_null() && !world_.alive(found), "a handle is of nobody ever");
            static_cast<void>(reference_.bind(expected, found));
        }
        expect(found == reference_.handle(expected), "a component names another entity");
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

    // ---- queries
    // ------------------------------------------------------------------------------

    void compare_shape(unsigned round) {
        switch (round % 16) {
        case 0:
            compare_query<const ModelPlace, const ModelSpeed>();
            break;
        case 1:
            compare_query<const ModelTitle, Without<ModelBadge>>();
            break;
        case 2:
            compare_query<
                const ModelPlace,
                Optional<const ModelSpeed>,
                Optional<const ModelWarmth>>();
            break;
        case 3:
            compare_query<const ModelWarmth, const ModelPlace>();
            break;
        case 4:
            compare_query<const ModelMemo, Without<ModelChosen, ModelTitle>>();
            break;
        case 5:
            compare_query<const ModelTally, With<ModelChosen>>();
            break;
        case 6:
            compare_query<const ModelLink, With<ModelBadge>, Without<ModelTitle>>();
            break;
        case 7:
            compare_query<
                Optional<const ModelTally>,
                Optional<const ModelTitle>,
                With<ModelPlace>>();
            break;
        case 8:
            compare_query<const ModelSerial, Without<ModelSpeed, ModelWarmth>>();
            break;
        case 9:
            compare_query<const ModelPose, const ModelPlace>();
            break;
        case 10:
            compare_query<const ModelLamp, Optional<const ModelPose>>();
            break;
        case 11:
            compare_query<const ModelPlace, With<ModelAwake>>();
            break;
        case 12:
            compare_query<const ModelSpeed, Without<ModelLamp, ModelAwake>>();
            break;
        case 13:
            compare_query<const ModelWarmth, const ModelLamp>();
            break;
        case 14:
            compare_query<const ModelTitle, Optional<const ModelLamp>, Without<ModelAwake>>();
            break;
        default:
            compare_query<>();
        }
    }

    template <typename... Terms>
    void compare_query() {
        constexpr Mask kRequired = (Mask{0} | ... | ShapeOf<Terms>::required);
        constexpr Mask kExcluded = (Mask{0} | ... | ShapeOf<Terms>::excluded);
        const auto query = std::as_const(world_).query<Terms...>();

        std::map<Id, int> visits;
        std::uint64_t sum = 0;
        std::uint64_t sequence = 0;
        query.each([&](Entity entity, const auto&... components) {
            const Id id = reference_.id_of(entity);
            expect(id != kNoId, "a query visits an entity that is not there");
            const Record& record = reference_.at(id);
            expect(record.matches(kRequired, kExcluded), "a query visits what does not match");
            (expect_argument(components, record), ...);
            ++visits[id];
            sum += row_hash(entity, components...);
            sequence = mix(sequence, row_hash(entity, components...));
        });
        expect(visits.size() == reference_.count(kRequired, kExcluded), "a query leaves some out");
        for (const auto& [id, count] : visits) {
            expect(count == 1, "a query visits an entity twice");
        }
        expect(query.count() == visits.size(), "count differs from what each visits");

        compare_gather(query, visits);

        std::atomic<std::uint64_t> par_sum = 0;
        query.par_each([&](Entity entity, const auto&... components) {
            par_sum.fetch_add(row_hash(entity, components...), std::memory_order_relaxed);
        });
        expect(par_sum == sum, "par_each visits something else than each");

        if constexpr (
            !(detail::TermTraits<Terms>::filters_rows || ...) && !(takes_rows<Terms> || ...)) {
            compare_chunks(query, sum, sequence, detail::DataTerms<Terms...>{});
        }
    }

    /// A list in another order than the rows, with some twice and some that are gone.
    template <typename Query>
    void compare_gather(const Query& query, const std::map<Id, int>& visits) {
        std::vector<Entity> list;
        for (const Id id : reference_.living()) {
            list.push_back(reference_.handle(id));
            if (id % 7 == 0) {
                list.push_back(list.front());
                list.push_back({});
            }
        }
        for (const Id id : reference_.dead()) {
            list.push_back(reference_.handle(id));
        }
        std::size_t expected = 0;
        for (const Entity entity : list) {
            expected += visits.contains(reference_.id_of(entity)) ? 1 : 0;
        }
        std::size_t calls = 0;
        std::size_t last = 0;
        const std::size_t found =
            query.gather(list, [&](std::size_t index, const auto&... components) {
                expect(calls == 0 || index > last, "gather leaves the order of the list");
                const Id id = reference_.id_of(list[index]);
                expect(visits.contains(id), "gather finds what is not the query's");
                (expect_argument(components, reference_.at(id)), ...);
                last = index;
                ++calls;
            });
        expect(found == expected && calls == expected, "gather leaves some out");
    }

    template <typename Query, typename... Data>
    static void compare_chunks(
        const Query& query, std::uint64_t sum, std::uint64_t sequence, detail::TypeList<Data...>) {
        std::uint64_t chunk_sequence = 0;
        std::size_t offset = 0;
        query.chunks([&](ChunkView chunk, auto... spans) {
            expect(chunk.offset() >= offset, "a chunk comes before the one before it");
            offset = chunk.offset() + chunk.size();
            for (std::uint32_t row = 0; row < chunk.size(); ++row) {
                if (!chunk.enabled().test(row)) {
                    continue;
                }
                chunk_sequence = mix(
                    chunk_sequence, row_hash(chunk.entities()[row], argument<Data>(spans, row)...));
            }
        });
        expect(chunk_sequence == sequence, "chunks has other rows or another order than each");

        std::atomic<std::uint64_t> par_sum = 0;
        query.par_chunks([&](ChunkView chunk, auto... spans) {
            const RowMask enabled = chunk.enabled();
            for (std::uint32_t row = 0; row < chunk.size(); ++row) {
                par_sum += !enabled.test(row)
                               ? 0
                               : row_hash(chunk.entities()[row], argument<Data>(spans, row)...);
            }
        });
        expect(par_sum == sum, "par_chunks visits something else than each");
    }

    /// What each() would have been given.
    template <typename Term, typename T>
    static decltype(auto) argument(const std::span<T>& span, std::size_t row) {
        if constexpr (detail::TermTraits<Term>::is_optional) {
            return span.empty() ? nullptr : &span[row];
        } else {
            return static_cast<const T&>(span[row]);
        }
    }

    /// Of a split component there is no address, only a value.
    template <typename Term, typename T>
    static auto argument(const SplitSpan<T>& span, std::size_t row) {
        const std::uint32_t index = static_cast<std::uint32_t>(row);
        if constexpr (detail::TermTraits<Term>::is_optional) {
            return span.size() == 0 ? std::optional<ModelPose>() : span[index];
        } else {
            return span[index];
        }
    }

    template <typename T>
    void expect_argument(const T& component, const Record& record) {
        expect_value(component, record);
    }
    template <typename T>
    void expect_argument(const T* const& component, const Record& record) {
        expect(
            (component != nullptr) == record.is_enabled(kind_of<T>()),
            "an optional component is lost or extra");
        if (component != nullptr) {
            expect_value(*component, record);
        }
    }

    template <typename... Ts>
    static std::uint64_t row_hash(Entity entity, const Ts&... components) {
        std::uint64_t hash = entity.bits();
        ((hash = mix(hash, component_hash(components))), ...);
        return hash;
    }
    template <typename T>
    static std::uint64_t component_hash(const T& component) {
        if constexpr (requires { component.has_value(); }) {
            return component ? component_hash(*component) : ~std::uint64_t{0};
        } else if constexpr (std::is_pointer_v<T>) {
            return component != nullptr ? component_hash(*component) : ~std::uint64_t{0};
        } else {
            return mix(static_cast<std::uint64_t>(read(component)), entity_in(component).bits());
        }
    }

    // ---- changes
    // ------------------------------------------------------------------------------

    /// Everything written since the last comparison is reported.
    void compare_changed() {
        compare_changed_kind<ModelPlace>();
        compare_changed_kind<ModelTitle>();
        compare_changed_kind<ModelPose>();
        compare_changed_kind<ModelLamp>();
        compare_changed_kind<ModelWarmth>();
    }
    template <typename T>
    void compare_changed_kind() {
        std::map<Id, int> visits;
        std::as_const(world_)
            .query<const T, Changed<T>>()
            .since(changed_since_)
            .each([&](Entity entity, const T&) { ++visits[reference_.id_of(entity)]; });
        for (const auto& [id, record] : reference_.records()) {
            const bool changed =
                record.is_enabled(kind_of<T>()) && (record.changed & bit(kind_of<T>())) != 0;
            if (changed && !visits.contains(id)) {
                expect(false, ("a change is not reported of " + component_info<T>().name).c_str());
            }
        }
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

    World& world_;
    Reference& reference_;
    std::uint32_t changed_since_ = 0;
};

}  // namespace limn::test::model
