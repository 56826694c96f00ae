#pragma once

#include "ecs/world.h"
#include "tests/ecs/model_compare_values.h"
#include "tests/ecs/model_shape.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

// Does a query visit what the reference says? Queries of several shapes, with every kind of
// iterating.

namespace limn::test::model {

/// Whether chunks() cannot tell which rows have it.
template <typename Term>
inline constexpr bool takes_rows = false;
template <typename T>
inline constexpr bool takes_rows<Optional<T>> = detail::is_sparse<T> || detail::is_toggle<T>;

class ComparedQueries : public ComparedValues {
  public:
    using ComparedValues::ComparedValues;

  protected:
    /// One query; `round` says of which shape.
    void compare_shape(unsigned round) {
        switch (round % 24) {
        case 0:
            compare_query<const ModelPlace, const ModelSpeed>();
            break;
        case 1:
            compare_query<const ModelTitle, Without<ModelBadge>>();
            break;
        case 2:
            compare_query<
                const ModelPlace, Optional<const ModelSpeed>, Optional<const ModelWarmth>>();
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
                Optional<const ModelTally>, Optional<const ModelTitle>, With<ModelPlace>>();
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
        case 15:
            compare_query<>();
            break;
        default:
            compare_team_shape(round % 24, round / 24 % (kTeams + 1));
        }
    }

  private:
    /// With the shared component, of all teams or of one; kTeams was never used.
    void compare_team_shape(unsigned shape, std::int64_t team) {
        switch (shape) {
        case 16:
            compare_query<const ModelTeam, const ModelPlace>();
            compare_batches();
            break;
        case 17:
            compare_query<const ModelSpeed, Optional<const ModelTeam>, Without<ModelTitle>>();
            break;
        case 18:
            compare_query_in<const ModelTeam, const ModelPlace>(team);
            break;
        case 19:
            compare_query_in<const ModelTitle, Optional<const ModelSpeed>>(team);
            break;
        case 20:
            compare_query_in<const ModelWarmth, const ModelTeam>(team);
            break;
        case 21:
            compare_query_in<const ModelLamp, AnyOf<ModelPose, ModelSpeed>>(team);
            break;
        case 22:
            compare_query<const ModelPlace, AnyOf<ModelTeam, ModelBadge>>();
            break;
        default:
            compare_query<AnyOf<ModelMemo, ModelTeam>, AnyOf<ModelPose, ModelTitle>>();
        }
    }

    template <typename... Terms>
    void compare_query() {
        compare_query(std::as_const(world_).query<Terms...>(), shape_of<Terms...>());
    }
    template <typename... Terms>
    void compare_query_in(std::int64_t team) {
        const ModelTeam key{static_cast<std::uint32_t>(team)};
        compare_query(std::as_const(world_).query<Terms...>().where(key), shape_of<Terms...>(team));
    }

    template <typename... Terms>
    void compare_query(const Query<Terms...>& query, const Shape& shape) {
        std::unordered_map<Id, int> visits;
        std::uint64_t sum = 0;
        std::uint64_t sequence = 0;
        query.each([&](Entity entity, const auto&... components) {
            const Id id = reference_.id_of(entity);
            expect(id != kNoId, "a query visits an entity that is not there");
            const Record& record = reference_.at(id);
            expect(shape.matches(record), "a query visits what does not match");
            (expect_argument(components, record), ...);
            ++visits[id];
            sum += row_hash(entity, components...);
            sequence = mix(sequence, row_hash(entity, components...));
        });
        expect(
            visits.size()
                == reference_.count([&](const Record& record) { return shape.matches(record); }),
            "a query leaves some out");
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

    /// Those of a team follow each other.
    void compare_batches() {
        std::vector<std::int64_t> teams;
        std::as_const(world_).query<const ModelTeam>().chunks(
            [&](ChunkView, const ModelTeam& team) {
                if (teams.empty() || teams.back() != read(team)) {
                    teams.push_back(read(team));
                }
            });
        expect(teams.size() <= std::size_t{kTeams}, "a team is in several batches");
    }

    /// A list in another order than the rows, with some twice and some that are gone.
    template <typename Query>
    void compare_gather(const Query& query, const std::unordered_map<Id, int>& visits) {
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
            const bool is_visited = visits.contains(reference_.id_of(entity));
            expect(query.contains(entity) == is_visited, "contains says something else than each");
            expected += is_visited ? 1 : 0;
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

    /// All rows get the same value of a shared component.
    template <typename Term>
    static const ModelTeam& argument(const ModelTeam& team, std::size_t) {
        return team;
    }
    template <typename Term>
    static const ModelTeam* argument(const ModelTeam* team, std::size_t) {
        return team;
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
};

}  // namespace limn::test::model
