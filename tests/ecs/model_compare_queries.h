#pragma once

#include "ecs/world.h"
#include "tests/ecs/model_compare_values.h"

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

// Does a query visit what the reference says? Queries of several shapes, each in every way of
// iterating.

namespace limn::test::model {

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

class ComparedQueries : public ComparedValues {
  public:
    using ComparedValues::ComparedValues;

  protected:
    /// One query; `round` says of which shape.
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

  private:
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
};

}  // namespace limn::test::model
