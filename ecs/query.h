#pragma once

#include "ecs/base/jobs.h"
#include "ecs/chunk_view.h"
#include "ecs/query_state.h"
#include "ecs/query_terms.h"
#include "ecs/resource.h"
#include "ecs/task_scope.h"

#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace limn {

// Entities by what they are made of. A query is a parameter of a system, or world.query<const A,
// B>().
//
//     query.each([](const A& a, B& b) { ... });                    one entity at a time
//     query.each([](Entity entity, const A& a, B& b) { ... });
//     query.chunks([](ChunkView chunk, std::span<const A> a, std::span<B> b) { ... });
//     query.par_chunks(...), query.par_each(...)                   the same on several threads
//
// The terms are in ecs/query_terms.h. The order is that of the archetypes' creation, then rows, for
// any number of threads; with a required sparse component, the order of the values of the first
// such component. The loop of each() runs over arrays, without a call or a look-up a row, unless a
// sparse component is involved.
//
// While a query iterates, nothing may be created, destroyed, added or removed: Commands record that
// for later. The tasks of par_chunks may write what they are given and nothing else.

template <typename... Terms>
class Query {
    static constexpr bool kChanged = (detail::TermTraits<Terms>::is_changed || ...);
    /// A sparse component is required: the iteration follows its set.
    static constexpr bool kFollowsSparse = (detail::TermTraits<Terms>::needs_sparse || ...);
    static constexpr bool kFiltersRows = (detail::TermTraits<Terms>::filters_rows || ...);
    using Data = detail::DataTerms<Terms...>;
    static_assert(Data::size <= kMaxQueryColumns, "too many components in one query");

  public:
    static constexpr bool kReadOnly = !(detail::TermTraits<Terms>::is_write || ...);

    Query(WorldCore& core, QueryState& state, IterationLock lock)
        : core_(&core), state_(&state), lock_(lock) {}

    /// For systems: what is written gets `version`; Changed means later than `since`.
    Query(WorldCore& core, QueryState& state, std::uint32_t version, std::uint32_t since)
        : core_(&core), state_(&state), version_(version), since_(since), has_since_(true),
          lock_(IterationLock::System) {}

    /// The same query with Changed meaning later than `version`, of World::version().
    [[nodiscard]] Query since(std::uint32_t version) const {
        Query copy = *this;
        copy.since_ = version;
        copy.has_since_ = true;
        return copy;
    }

    template <typename F>
    void each(F&& function) const {
        check_row_function<F>(Data{});
        const IterationGuard guard(*core_, lock_);
        state_->update(*core_);
        const std::uint32_t version = write_version();
        if constexpr (kFollowsSparse) {
            each_following(0, leading_size(), version, function);
        } else {
            each_range([&](const QueryMatch& match, std::uint32_t begin, std::uint32_t end) {
                touch(match, begin, end, version, Data{});
                run_rows(match, begin, end, version, function, Data{}, Indices{});
            });
        }
    }

    /// each() on several threads, a chunk a task. With a required sparse component, a chunk is 1024
    /// of its values.
    template <typename F>
    void par_each(F&& function) const {
        check_row_function<F>(Data{});
        const IterationGuard guard(*core_, lock_);
        state_->update(*core_);
        const std::uint32_t version = write_version();
        if constexpr (kFollowsSparse) {
            const std::uint32_t size = leading_size();
            par_tasks(chunks_of(size), [&](std::size_t task) {
                const std::uint32_t begin = static_cast<std::uint32_t>(task) * kChunkRows;
                each_following(begin, chunk_end(begin, size), version, function);
            });
        } else {
            const std::vector<ChunkTask> tasks = chunk_tasks(version);
            par_tasks(tasks.size(), [&](std::size_t task) {
                const QueryMatch& match = *tasks[task].match;
                const std::uint32_t begin = tasks[task].chunk * kChunkRows;
                const std::uint32_t end = chunk_end(begin, match.archetype->size());
                touch(match, begin, end, version, Data{});
                run_rows(match, begin, end, version, function, Data{}, Indices{});
            });
        }
    }

    template <typename F>
    void chunks(F&& function) const {
        check_chunk_function<F>(Data{});
        const IterationGuard guard(*core_, lock_);
        state_->update(*core_);
        const std::uint32_t version = write_version();
        each_chunk(
            [&](const ChunkTask& task) { run_chunk(task, version, function, Data{}, Indices{}); });
    }

    template <typename F>
    void par_chunks(F&& function) const {
        check_chunk_function<F>(Data{});
        const IterationGuard guard(*core_, lock_);
        state_->update(*core_);
        const std::uint32_t version = write_version();
        const std::vector<ChunkTask> tasks = chunk_tasks(version);
        par_tasks(tasks.size(), [&](std::size_t task) {
            run_chunk(tasks[task], version, function, Data{}, Indices{});
        });
    }

    /// How many entities each() would visit.
    [[nodiscard]] std::size_t count() const {
        std::size_t total = 0;
        state_->update(*core_);
        if constexpr (kFollowsSparse) {
            visit_following(0, leading_size(), [&](const QueryMatch&, std::uint32_t) { ++total; });
        } else {
            each_range([&](const QueryMatch& match, std::uint32_t begin, std::uint32_t end) {
                if constexpr (kFiltersRows) {
                    for (std::uint32_t row = begin; row < end; ++row) {
                        total += passes(match, row) ? 1 : 0;
                    }
                } else {
                    total += end - begin;
                }
            });
        }
        return total;
    }
    [[nodiscard]] bool empty() const { return count() == 0; }

    /// Bound of ChunkView::index().
    [[nodiscard]] std::uint32_t chunk_count() const {
        state_->update(*core_);
        std::uint32_t total = 0;
        for (const QueryMatch& match : state_->matches()) {
            total += match.archetype->chunk_count();
        }
        return total;
    }

    /// The arguments of the only entity; there must be exactly one.
    [[nodiscard]] auto single() const { return single(Data{}, Indices{}); }
    [[nodiscard]] Entity single_entity() const {
        const Place place = find_single();
        return place.match->archetype->entities()[place.row];
    }

    /// Whether the entity is alive and one of the query's; Changed is not looked at.
    [[nodiscard]] bool contains(Entity entity) const { return locate(entity).match != nullptr; }

    /// The component of another entity of the query, nullptr if it is none. T is a term as it was
    /// written: find<const A>, find<B>, and B is marked as changed.
    template <typename T>
    [[nodiscard]] T* find(Entity entity) const {
        static_assert(
            (std::is_same_v<typename ValueOf<Terms>::Type, T> || ...),
            "find: T must be a term of the query, const if it is const there");
        static_assert(
            !detail::is_split<T>,
            "find: a split component has no address; use value<T>(entity) and set(entity, value)");
        const Place place = locate(entity);
        return place.match == nullptr ? nullptr : find_in<T>(place, Data{}, Indices{});
    }

    /// A copy of the split component of another entity, which must be one of the query and have it.
    template <typename T>
    [[nodiscard]] T value(Entity entity) const {
        static_assert(
            detail::is_split<T>,
            "value: for split components; find<const T>() gives others in place");
        const Place place = locate(entity);
        return detail::Lanes<const T>(split_column<T>(place), 0).load(place.row);
    }
    /// Replaces it; T is a term that is not const.
    template <typename T>
    void set(Entity entity, const T& value) const {
        static_assert(
            detail::is_split<T> && (std::is_same_v<typename ValueOf<Terms>::Type, T> || ...),
            "set: for split components that are terms and not const; find<T>() gives others in "
            "place");
        const Place place = locate(entity);
        detail::Lanes<T>(split_column<T>(place), 0).store(place.row, value);
        place.match->archetype->touch_row(
            place.match->archetype->column_of(component_id<T>), place.row, write_version());
    }

  private:
    using Indices = std::make_index_sequence<Data::size>;

    template <typename Term, bool = detail::TermTraits<Term>::is_data>
    struct ValueOf {
        using Type = void;
    };
    template <typename Term>
    struct ValueOf<Term, true> {
        using Type = typename detail::TermTraits<Term>::Value;
    };

    struct ChunkTask {
        const QueryMatch* match;
        std::uint32_t chunk;
        std::uint32_t index;
        std::uint32_t offset;
    };
    struct Place {
        const QueryMatch* match = nullptr;
        std::uint32_t row = 0;
    };

    // ---- what can be wrong with the function, in one line
    // ----------------------------------------

    template <typename F, typename... Ts>
    static constexpr void check_row_function(detail::TypeList<Ts...>) {
        static_assert(
            std::is_invocable_v<
                F&,
                detail::RowArgument<
                    Ts>...> || std::is_invocable_v<F&, Entity, detail::RowArgument<Ts>...>,
            "each: the function takes the query's components in order (const A&, B&, Optional as "
            "C*), "
            "before them an Entity if it wants one");
    }
    template <typename F, typename... Ts>
    static constexpr void check_chunk_function(detail::TypeList<Ts...>) {
        static_assert(
            !kFiltersRows, "chunks: sparse components come row by row; use each or par_each");
        static_assert(
            !(std::is_empty_v<typename detail::TermTraits<Ts>::Value> || ...),
            "chunks: tags have no array; use With<Tag>");
        static_assert(
            std::is_invocable_v<F&, ChunkView, detail::ChunkArgument<Ts>...>,
            "chunks: the function takes a ChunkView and one std::span a component, in order: "
            "std::span<const A>, std::span<B>; of a split component, SplitSpan<const C>");
    }

    [[nodiscard]] static constexpr std::uint32_t
    chunk_end(std::uint32_t begin, std::uint32_t size) {
        return size - begin < kChunkRows ? size : begin + kChunkRows;
    }

    // ---- ranges of rows
    // ---------------------------------------------------------------------------

    [[nodiscard]] std::uint32_t write_version() const {
        return lock_ == IterationLock::System ? version_ : core_->now();
    }
    [[nodiscard]] std::uint32_t since_version() const {
        return has_since_ ? since_ : core_->now() - kNeverRan;
    }

    /// visit(match, begin, end): whole archetypes or, with Changed, their changed chunks.
    template <typename Visit>
    void each_range(const Visit& visit) const {
        if constexpr (kChanged) {
            each_chunk([&](const ChunkTask& task) {
                const std::uint32_t begin = task.chunk * kChunkRows;
                visit(*task.match, begin, chunk_end(begin, task.match->archetype->size()));
            });
        } else {
            for (const QueryMatch& match : state_->matches()) {
                if (match.archetype->size() > 0) {
                    visit(match, std::uint32_t{0}, match.archetype->size());
                }
            }
        }
    }

    template <typename Visit>
    void each_chunk(const Visit& visit) const {
        [[maybe_unused]] const std::uint32_t since = since_version();
        ChunkTask task{nullptr, 0, 0, 0};
        for (const QueryMatch& match : state_->matches()) {
            task.match = &match;
            const std::uint32_t chunk_count = match.archetype->chunk_count();
            if constexpr (kChanged) {
                if (!state_->archetype_changed(*match.archetype, since)) {
                    task.index += chunk_count;
                    task.offset += match.archetype->size();
                    continue;
                }
            }
            const std::uint32_t end = task.offset + match.archetype->size();
            for (task.chunk = 0; task.chunk < chunk_count; ++task.chunk) {
                if constexpr (kChanged) {
                    if (!state_->chunk_changed(*match.archetype, task.chunk, since)) {
                        ++task.index;
                        task.offset += kChunkRows;
                        continue;
                    }
                }
                visit(std::as_const(task));
                ++task.index;
                task.offset += kChunkRows;
            }
            task.offset = end;
        }
    }

    /// The chunks to visit; their columns' upper bounds are raised already, since tasks must not
    /// share them.
    [[nodiscard]] std::vector<ChunkTask> chunk_tasks(std::uint32_t version) const {
        std::vector<ChunkTask> tasks;
        each_chunk([&](const ChunkTask& task) {
            raise_newest(*task.match, version, Data{});
            tasks.push_back(task);
        });
        return tasks;
    }

    template <typename Work>
    static void par_tasks(std::size_t count, const Work& work) {
        if (current_task.chunk != 0) {
            for (std::size_t i = 0; i < count; ++i) {
                work(i);  // a loop within a task: its commands belong to the task, in order
            }
            return;
        }
        const std::uint32_t sequence = ++current_task.sequence;
        parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const TaskScopeGuard scope({sequence, static_cast<std::uint32_t>(i) + 1});
                work(i);
            }
        });
        ++current_task.sequence;
    }

    // ---- versions
    // ---------------------------------------------------------------------------------

    template <typename Visit, typename... Ts>
    static void each_written(const QueryMatch& match, const Visit& visit, detail::TypeList<Ts...>) {
        std::size_t position = 0;
        [[maybe_unused]] const auto one = [&]<typename Term>() {
            if constexpr (detail::TermTraits<Term>::is_write) {
                if (match.columns[position] >= 0) {
                    visit(match.archetype->column(match.columns[position]));
                }
            }
            ++position;
        };
        (one.template operator()<Ts>(), ...);
    }

    template <typename List>
    static void touch(
        const QueryMatch& match,
        std::uint32_t begin,
        std::uint32_t end,
        std::uint32_t version,
        List list) {
        each_written(
            match,
            [&](Column& column) {
                for (std::uint32_t chunk = begin / kChunkRows; chunk < chunks_of(end); ++chunk) {
                    column.versions[chunk] = version;
                }
                store_version(column.newest, version);
            },
            list);
    }
    template <typename List>
    static void raise_newest(const QueryMatch& match, std::uint32_t version, List list) {
        each_written(
            match, [&](Column& column) { store_version(column.newest, version); }, list);
    }

    // ---- calls
    // ------------------------------------------------------------------------------------

    template <typename F, typename... Ts, std::size_t... Positions>
    void run_rows(
        const QueryMatch& match,
        std::uint32_t begin,
        std::uint32_t end,
        [[maybe_unused]] std::uint32_t version,
        F& function,
        detail::TypeList<Ts...>,
        std::index_sequence<Positions...>) const {
        const Entity* entities = match.archetype->entities().data();
        const auto loop = [&](auto... access) {
            for (std::uint32_t row = begin; row < end; ++row) {
                if constexpr (kFiltersRows && !kFollowsSparse) {
                    if (!passes(match, row)) {
                        continue;
                    }
                }
                if constexpr (std::is_invocable_v<F&, detail::RowArgument<Ts>...>) {
                    function(detail::row_argument(access[row])...);
                } else {
                    function(entities[row], detail::row_argument(access[row])...);
                }
            }
        };
        loop(detail::access_term<Ts>(*core_, match, Positions, version)...);
    }

    template <typename F, typename... Ts, std::size_t... Positions>
    void run_chunk(
        const ChunkTask& task,
        std::uint32_t version,
        F& function,
        detail::TypeList<Ts...> list,
        std::index_sequence<Positions...>) const {
        const QueryMatch& match = *task.match;
        const std::uint32_t begin = task.chunk * kChunkRows;
        const std::uint32_t size = chunk_end(begin, match.archetype->size()) - begin;
        std::uint32_t previous[Data::size + 1] = {};
        [[maybe_unused]] const auto save = [&](std::size_t position) {
            const int column = match.columns[position];
            if (column >= 0) {
                previous[position] = match.archetype->column(column).versions[task.chunk];
            }
        };
        (save(Positions), ...);
        touch(match, begin, begin + size, version, list);

        ChunkView view;
        view.archetype_ = match.archetype;
        view.columns_ = match.columns.data();
        view.previous_ = previous;
        view.chunk_ = task.chunk;
        view.size_ = size;
        view.index_ = task.index;
        view.offset_ = task.offset;
        function(view, span_of<Ts>(match, Positions, begin, size)...);
    }

    template <typename Term>
    static detail::ChunkArgument<Term> span_of(
        const QueryMatch& match, std::size_t position, std::uint32_t begin, std::uint32_t size) {
        using T = typename detail::TermTraits<Term>::Value;
        const int column = match.columns[position];
        if constexpr (detail::is_split<T>) {
            return column < 0 ? SplitSpan<T>()
                              : SplitSpan<T>(&match.archetype->column(column), begin, size);
        } else {
            return column < 0
                       ? std::span<T>()
                       : std::span<T>(
                           reinterpret_cast<T*>(match.archetype->column(column).data) + begin,
                           size);
        }
    }

    // ---- sparse components
    // ------------------------------------------------------------------------

    /// Whether the row passes the filters that need a look at each row.
    [[nodiscard]] bool passes(const QueryMatch& match, std::uint32_t row) const {
        if (!state_->row_matches(*core_, match.archetype->entities()[row])) {
            return false;
        }
        if constexpr (kChanged) {
            return state_->row_changed(*core_, *match.archetype, row, since_version());
        }
        return true;
    }

    [[nodiscard]] std::uint32_t leading_size() const {
        const SparseSet* set = state_->leading_set(*core_);
        return set != nullptr ? set->size() : 0;
    }

    template <typename Visit>
    void visit_following(std::uint32_t begin, std::uint32_t end, const Visit& visit) const {
        const SparseSet* set = state_->leading_set(*core_);
        for (std::uint32_t i = begin; i < end; ++i) {
            const EntityPlace place = core_->entities.find(set->entities()[i]);
            const QueryMatch* match = state_->match_of(place.archetype);
            if (match == nullptr || !passes(*match, place.row)) {
                continue;
            }
            if constexpr (kChanged) {
                if (!state_->chunk_changed(
                        *match->archetype, place.row / kChunkRows, since_version())) {
                    continue;
                }
            }
            visit(*match, place.row);
        }
    }

    template <typename F>
    void each_following(
        std::uint32_t begin, std::uint32_t end, std::uint32_t version, F& function) const {
        visit_following(begin, end, [&](const QueryMatch& match, std::uint32_t row) {
            each_written(
                match,
                [&](Column& column) {
                    store_version(column.versions[row / kChunkRows], version);
                    store_version(column.newest, version);
                },
                Data{});
            run_rows(match, row, row + 1, version, function, Data{}, Indices{});
        });
    }

    // ---- one entity
    // -------------------------------------------------------------------------------

    [[nodiscard]] Place locate(Entity entity) const {
        state_->update(*core_);
        const EntityPlace place = core_->entities.find(entity);
        if (!place) {
            return {};
        }
        const QueryMatch* match = state_->match_of(place.archetype);
        if (match == nullptr || (kFiltersRows && !state_->row_matches(*core_, entity))) {
            return {};
        }
        return {match, place.row};
    }

    template <typename T>
    [[nodiscard]] Column* split_column(const Place& place) const {
        static_assert(
            (std::is_same_v<std::remove_const_t<typename ValueOf<Terms>::Type>, T> || ...),
            "value, set: T must be a term of the query");
        const int column =
            place.match != nullptr ? place.match->archetype->column_of(component_id<T>) : kNoColumn;
        LIMN_CHECK_NOTE(column >= 0, component_info<T>().name.c_str());
        return &place.match->archetype->column(column);
    }

    template <typename T, typename... Ts, std::size_t... Positions>
    T*
    find_in(const Place& place, detail::TypeList<Ts...>, std::index_sequence<Positions...>) const {
        T* found = nullptr;
        [[maybe_unused]] const auto one = [&]<typename Term>(std::size_t position) {
            if constexpr (std::is_same_v<typename detail::TermTraits<Term>::Value, T>) {
                if constexpr (!std::is_const_v<T>) {
                    place.match->archetype->touch_row(
                        place.match->columns[position], place.row, write_version());
                }
                auto access =
                    detail::access_term<Term>(*core_, *place.match, position, write_version());
                if constexpr (detail::TermTraits<Term>::is_optional) {
                    found = access[place.row];
                } else {
                    found = &access[place.row];
                }
            }
        };
        (one.template operator()<Ts>(Positions), ...);
        return found;
    }

    [[nodiscard]] Place find_single() const {
        Place place;
        std::size_t total = 0;
        state_->update(*core_);
        const auto visit = [&](const QueryMatch& match, std::uint32_t row) {
            place = {&match, row};
            ++total;
        };
        if constexpr (kFollowsSparse) {
            visit_following(0, leading_size(), visit);
        } else {
            each_range([&](const QueryMatch& match, std::uint32_t begin, std::uint32_t end) {
                for (std::uint32_t row = begin; row < end && total < 2; ++row) {
                    if (!kFiltersRows || passes(match, row)) {
                        visit(match, row);
                    }
                }
            });
        }
        LIMN_CHECK_NOTE(total == 1, "single: the query must have exactly one entity");
        return place;
    }

    template <typename... Ts, std::size_t... Positions>
    std::tuple<detail::RowArgument<Ts>...>
    single(detail::TypeList<Ts...>, std::index_sequence<Positions...>) const {
        static_assert(
            !(detail::is_split<typename detail::TermTraits<Ts>::Value> || ...),
            "single: a split component has no address; use value<T>(single_entity())");
        const Place place = find_single();
        const std::uint32_t version = write_version();
        touch(*place.match, place.row, place.row + 1, version, Data{});
        return {detail::access_term<Ts>(*core_, *place.match, Positions, version)[place.row]...};
    }

    WorldCore* core_;
    QueryState* state_;
    std::uint32_t version_ = 0;
    std::uint32_t since_ = 0;
    bool has_since_ = false;
    IterationLock lock_;
};

}  // namespace limn
