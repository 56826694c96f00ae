#pragma once

#include "ecs/chunk_view.h"
#include "ecs/par_tasks.h"
#include "ecs/query_access.h"
#include "ecs/query_checks.h"
#include "ecs/query_marks.h"
#include "ecs/query_state.h"
#include "ecs/resource.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace limn {

// Iterates over entities by their components. A query is a parameter of a system, or
// world.query<const A, B>().
//
//     query.each([](const A& a, B& b) { ... });                    one entity at a time
//     query.each([](Entity entity, const A& a, B& b) { ... });
//     query.chunks([](ChunkView chunk, std::span<const A> a, std::span<B> b) { ... });
//     query.par_chunks(...), query.par_each(...)                   the same on several threads
//     query.gather(entities, [](std::size_t i, const A& a, B& b) { ... });    a list of entities
//
// The terms are in ecs/query_terms.h. The order is that of the archetypes' creation, then rows, for
// any number of threads; archetypes with equal values of the shared components that the query reads
// are adjacent. With a required sparse component, the order is that of the values of the first one.
// The loop of each() runs over arrays, without a call or look-up per row, unless a sparse component
// is involved.
//
// While a query iterates, nothing may be created, destroyed, added or removed: use Commands to
// defer that. The tasks of par_chunks may write only their own arguments.

template <typename... Terms>
class Query {
    static constexpr bool kChanged = (detail::TermTraits<Terms>::is_changed || ...);
    /// A sparse component is required: the iteration follows its set.
    static constexpr bool kFollowsSparse = (detail::TermTraits<Terms>::needs_sparse || ...);
    static constexpr bool kKeyed = (std::is_same_v<Terms, detail::Keyed> || ...);
    static constexpr bool kFiltersRows = (detail::TermTraits<Terms>::filters_rows || ...);
    /// Rows are filtered by their enable bits.
    static constexpr bool kToggles = (detail::TermTraits<Terms>::is_toggled || ...);
    /// A component that tracks its rows is written.
    static constexpr bool kTracks = (detail::TermTraits<Terms>::is_tracked || ...);
    static constexpr bool kTakes = (detail::TermTraits<Terms>::is_take || ...);
    using Data = detail::DataTerms<Terms...>;
    using Marks = detail::QueryMarks<Data, kTracks, kFollowsSparse>;
    static_assert(Data::size <= kMaxQueryColumns, "too many components in one query");
    static_assert(detail::has_each_once<Data>, "a query must list each component only once");
    static_assert(
        !(detail::term_is_excluded<Terms, Terms...> || ...),
        "a query that both requires and excludes a component matches no entities");

  public:
    static constexpr bool kReadOnly = !(detail::TermTraits<Terms>::is_write || ...) && !kTakes;

    Query(WorldCore& core, QueryState& state, IterationLock lock)
        : core_(&core), state_(&state), lock_(lock) {}

    /// For systems: writes are stamped with `version`; Changed means later than `since`.
    Query(WorldCore& core, QueryState& state, std::uint32_t version, std::uint32_t since)
        : core_(&core), state_(&state), version_(version), since_(since), has_since_(true),
          lock_(IterationLock::System) {}

    /// The same query with Changed meaning later than `version`, a result of World::version().
    [[nodiscard]] Query since(std::uint32_t version) const {
        Query copy = *this;
        copy.since_ = version;
        copy.has_since_ = true;
        return copy;
    }

    /// The same query restricted to entities whose shared component T equals `key` bytewise. T need
    /// not be a term. Visits only archetypes with that value.
    template <typename T>
    [[nodiscard]] auto where(const T& key) const {
        static_assert(detail::is_shared<T>, "where: T must be a component of Storage::Shared");
        using Result = std::conditional_t<kKeyed, Query, Query<Terms..., detail::Keyed>>;
        Result copy(*this);
        copy.keys_.add(core_->shared.find(component_info<T>(), &key));
        return copy;
    }

    template <typename F>
    void each(F&& function) const {
        detail::check_row_function<F, kTakes>(Data{});
        const IterationGuard guard(*core_, lock_);
        state_->begin_call(*core_);
        const std::uint32_t version = write_version();
        if constexpr (kFollowsSparse) {
            each_following(0, leading_size(), version, function);
        } else if constexpr (kToggles) {
            each_chunk([&](const ChunkTask& task) { run_enabled(task, version, function); });
        } else {
            each_range([&](const QueryMatch& match, std::uint32_t begin, std::uint32_t end) {
                Marks::touch(match, begin, end, version);
                run_rows(match, begin, end, version, function, Data{}, Indices{});
            });
        }
    }

    /// each() on several threads, one task per chunk. With a required sparse component, a chunk is
    /// 1024 of its values.
    template <typename F>
    void par_each(F&& function) const {
        detail::check_row_function<F, kTakes>(Data{});
        const IterationGuard guard(*core_, lock_);
        state_->begin_call(*core_);
        const std::uint32_t version = write_version();
        if constexpr (kFollowsSparse) {
            const std::uint32_t size = leading_size();
            detail::par_tasks(chunks_of(size), [&](std::size_t task) {
                const std::uint32_t begin = static_cast<std::uint32_t>(task) * kChunkRows;
                each_following(begin, chunk_end(begin, size), version, function);
            });
        } else {
            const ChunkTasks tasks(*this, version);
            detail::par_tasks(tasks.list.size(), [&](std::size_t task) {
                run_enabled(tasks.list[task], version, function);
            });
        }
    }

    template <typename F>
    void chunks(F&& function) const {
        detail::check_chunk_function<F, kFiltersRows>(Data{});
        const IterationGuard guard(*core_, lock_);
        state_->begin_call(*core_);
        const std::uint32_t version = write_version();
        each_chunk([&](const ChunkTask& task) {
            run_chunk<std::remove_reference_t<F>>(task, version, function, Data{}, Indices{});
        });
    }

    template <typename F>
    void par_chunks(F&& function) const {
        detail::check_chunk_function<F, kFiltersRows>(Data{});
        const IterationGuard guard(*core_, lock_);
        state_->begin_call(*core_);
        const std::uint32_t version = write_version();
        const ChunkTasks tasks(*this, version);
        detail::par_tasks(tasks.list.size(), [&](std::size_t task) {
            run_chunk<std::remove_reference_t<F>>(
                tasks.list[task], version, function, Data{}, Indices{});
        });
    }

    /// Calls function(index, arguments as in each()...) for the entities that are alive and match
    /// the query, in list order; returns how many. For many entities in random order faster than
    /// find(): the next ones are prefetched while the function runs.
    template <typename F>
    std::size_t gather(std::span<const Entity> entities, F&& function) const {
        detail::check_gather_function<F, kChanged>(Data{});
        const IterationGuard guard(*core_, lock_);
        state_->begin_call(*core_);
        const std::uint32_t version = write_version();
        // Rows are prefetched one batch at a time, slots one batch ahead. Among 16 .. 128 this is
        // the smallest size that hides most of the latency.
        constexpr std::size_t kBatch = 64;
        std::size_t found = 0;
        for (std::size_t first = 0; first < entities.size(); first += kBatch) {
            const std::span<const Entity> ahead = entities.subspan(first);
            const std::size_t size = std::min(kBatch, ahead.size());
            for (std::size_t i = kBatch; i < std::min(2 * kBatch, ahead.size()); ++i) {
                core_->entities.prefetch(ahead[i]);
            }
            Location locations[kBatch];
            for (std::size_t i = 0; i < size; ++i) {
                locations[i] = location_of(ahead[i]);
                prefetch_row(locations[i], Data{});
            }
            for (std::size_t i = 0; i < size; ++i) {
                if (locations[i].match == nullptr) {
                    continue;
                }
                ++found;
                const auto call = [&]<typename... Args>(Args&&... arguments) {
                    function(first + i, std::forward<Args>(arguments)...);
                };
                run_row(*locations[i].match, locations[i].row, version, call);
            }
        }
        return found;
    }

    /// How many entities each() would visit.
    [[nodiscard]] std::size_t count() const {
        std::size_t total = 0;
        state_->update(*core_);
        if constexpr (kFollowsSparse) {
            visit_following(0, leading_size(), [&](const QueryMatch&, std::uint32_t) { ++total; });
        } else if constexpr (kToggles && !kFiltersRows) {
            each_chunk([&](const ChunkTask& task) {
                RowMask rows;
                switch (enabled_rows(task, rows)) {
                case EnabledRows::None:
                    break;
                case EnabledRows::Some:
                    total += rows.count();
                    break;
                case EnabledRows::All:
                    total += task_end(task) - task.chunk * kChunkRows;
                    break;
                }
            });
        } else if constexpr (kToggles) {
            each_enabled_row([&](const QueryMatch&, std::uint32_t) { ++total; });
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

    /// Calls visit(archetype, first_row, count) for the rows that each() would visit: in ranges, or
    /// one by one if a sparse or toggled component must be checked per row.
    template <typename Visit>
    void ranges(const Visit& visit) const {
        state_->update(*core_);
        if constexpr (kFollowsSparse) {
            visit_following(0, leading_size(), [&](const QueryMatch& match, std::uint32_t row) {
                visit(std::as_const(*match.archetype), row, std::uint32_t{1});
            });
        } else if constexpr (kToggles) {
            each_enabled_row([&](const QueryMatch& match, std::uint32_t row) {
                visit(std::as_const(*match.archetype), row, std::uint32_t{1});
            });
        } else {
            each_range([&](const QueryMatch& match, std::uint32_t begin, std::uint32_t end) {
                if constexpr (kFiltersRows) {
                    for (std::uint32_t row = begin; row < end; ++row) {
                        if (passes(match, row)) {
                            visit(std::as_const(*match.archetype), row, std::uint32_t{1});
                        }
                    }
                } else {
                    visit(std::as_const(*match.archetype), begin, end - begin);
                }
            });
        }
    }

    /// Exclusive upper bound of ChunkView::index().
    [[nodiscard]] std::uint32_t chunk_count() const {
        state_->update(*core_);
        std::uint32_t total = 0;
        each_match([&](const QueryMatch& match) { total += match.archetype->chunk_count(); });
        return total;
    }

    /// The components of the only matching entity; there must be exactly one.
    [[nodiscard]] auto single() const { return single(Data{}, Indices{}); }
    [[nodiscard]] Entity single_entity() const {
        const Location location = find_single();
        return location.match->archetype->entities()[location.row];
    }

    /// Whether the entity is alive and matches the query, ignoring Changed.
    [[nodiscard]] bool contains(Entity entity) const { return locate(entity).match != nullptr; }

    /// The component of any entity, nullptr if it does not match the query. T is a term as written
    /// in the query: find<const A>, find<B>; B is marked as changed.
    template <typename T>
    [[nodiscard]] T* find(Entity entity) const {
        static_assert(
            (std::is_same_v<typename ValueOf<Terms>::Type, T> || ...),
            "find: T must be a term of the query, const if the term is const");
        static_assert(
            !detail::is_split<T>,
            "find: a split component has no address; use value<T>(entity) and set(entity, value)");
        const Location location = locate(entity);
        return location.match == nullptr ? nullptr : find_in<T>(location, Data{}, Indices{});
    }

    /// A copy of the split component of an entity, which must match the query and have it.
    template <typename T>
    [[nodiscard]] T value(Entity entity) const {
        static_assert(
            detail::is_split<T>,
            "value: only for split components; use find<const T>() for others");
        const Location location = locate(entity);
        return detail::Lanes<const T>(split_column<T>(location), 0).load(location.row);
    }
    /// Replaces the value; T is a non-const term.
    template <typename T>
    void set(Entity entity, const T& value) const {
        static_assert(
            detail::is_split<T> && (std::is_same_v<typename ValueOf<Terms>::Type, T> || ...),
            "set: only for split components that are non-const terms; use find<T>() for others");
        const Location location = locate(entity);
        detail::Lanes<T>(split_column<T>(location), 0).store(location.row, value);
        location.match->archetype->touch_row(
            location.match->archetype->column_of(component_id<T>), location.row, write_version());
        if constexpr (detail::tracks_rows<T>) {
            location.match->archetype->bits().track(component_id<T>)->mark_shared(location.row);
        }
    }

  private:
    template <typename... Others>
    friend class Query;
    template <typename... Others>
    explicit Query(const Query<Others...>& other)
        : core_(other.core_), state_(other.state_), version_(other.version_), since_(other.since_),
          has_since_(other.has_since_), lock_(other.lock_) {}

    using Indices = std::make_index_sequence<Data::size>;

    template <typename Term, bool = detail::TermTraits<Term>::is_data>
    struct ValueOf {
        using Type = void;
    };
    template <typename Term>
    struct ValueOf<Term, true> {
        using Type = typename detail::TermTraits<Term>::Value;
    };
    template <typename T>
    struct ValueOf<TakeRows<T>, true> {
        using Type = void;
    };

    struct ChunkTask {
        const QueryMatch* match;
        std::uint32_t chunk;
        std::uint32_t index;
        std::uint32_t offset;
    };
    /// The chunks of a parallel loop, in memory that the thread reuses for its next one. A nested
    /// loop allocates its own.
    struct ChunkTasks {
        ChunkTasks(const Query& query, std::uint32_t version) : list(std::move(kept)) {
            list.clear();
            query.list_chunks(version, list);
        }
        ChunkTasks(const ChunkTasks&) = delete;
        ChunkTasks& operator=(const ChunkTasks&) = delete;
        ~ChunkTasks() { kept = std::move(list); }
        std::vector<ChunkTask> list;
        static inline thread_local std::vector<ChunkTask> kept;
    };
    struct Location {
        const QueryMatch* match = nullptr;
        std::uint32_t row = 0;
    };

    [[nodiscard]] static constexpr std::uint32_t
    chunk_end(std::uint32_t begin, std::uint32_t size) {
        return size - begin < kChunkRows ? size : begin + kChunkRows;
    }

    // ---- ranges of rows

    [[nodiscard]] std::uint32_t write_version() const {
        return lock_ == IterationLock::System ? version_ : core_->now();
    }
    [[nodiscard]] std::uint32_t since_version() const {
        return has_since_ ? since_ : core_->now() - kNeverRan;
    }

    /// Whether the archetype has the values given to where().
    [[nodiscard]] bool has_keys([[maybe_unused]] const QueryMatch& match) const {
        if constexpr (kKeyed) {
            return keys_.are_in(*match.archetype);
        }
        return true;
    }

    template <typename Visit>
    void each_match(const Visit& visit) const {
        if constexpr (kKeyed) {
            // Use the list of archetypes with this value: there may be a thousand other values.
            for (const std::uint32_t archetype : keys_.archetypes(core_->shared)) {
                const QueryMatch* match = state_->match_of(archetype);
                if (match != nullptr && has_keys(*match)) {
                    visit(*match);
                }
            }
        } else {
            for (const QueryMatch& match : state_->matches()) {
                visit(match);
            }
        }
    }

    /// Calls visit(match, begin, end) for whole archetypes or, with Changed, for changed chunks.
    template <typename Visit>
    void each_range(const Visit& visit) const {
        if constexpr (kChanged) {
            each_chunk([&](const ChunkTask& task) {
                const std::uint32_t begin = task.chunk * kChunkRows;
                visit(*task.match, begin, chunk_end(begin, task.match->archetype->size()));
            });
        } else {
            each_match([&](const QueryMatch& match) {
                if (match.archetype->size() > 0) {
                    visit(match, std::uint32_t{0}, match.archetype->size());
                }
            });
        }
    }

    template <typename Visit>
    void each_chunk(const Visit& visit) const {
        [[maybe_unused]] const std::uint32_t since = since_version();
        ChunkTask task{nullptr, 0, 0, 0};
        each_match([&](const QueryMatch& match) {
            task.match = &match;
            const std::uint32_t chunk_count = match.archetype->chunk_count();
            if constexpr (kChanged) {
                if (!state_->archetype_changed(*match.archetype, since)) {
                    task.index += chunk_count;
                    task.offset += match.archetype->size();
                    return;
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
        });
    }

    [[nodiscard]] static std::uint32_t task_end(const ChunkTask& task) {
        return chunk_end(task.chunk * kChunkRows, task.match->archetype->size());
    }

    // ---- toggled components

    [[nodiscard]] EnabledRows enabled_rows(const ChunkTask& task, RowMask& rows) const {
        return state_->enabled_rows(*task.match->archetype, task.chunk, rows);
    }

    /// Calls visit(match, row) for the rows that pass all filters, in order.
    template <typename Visit>
    void each_enabled_row(const Visit& visit) const {
        each_chunk([&](const ChunkTask& task) {
            const std::uint32_t begin = task.chunk * kChunkRows;
            RowMask rows;
            const EnabledRows found = enabled_rows(task, rows);
            if (found == EnabledRows::All) {
                rows = RowMask::first(task_end(task) - begin);
            }
            if (found != EnabledRows::None) {
                rows.for_each([&](std::uint32_t row) {
                    if (!kFiltersRows || passes(*task.match, begin + row)) {
                        visit(*task.match, begin + row);
                    }
                });
            }
        });
    }

    /// Calls the function for each enabled row of the chunk; a plain loop if all are.
    template <typename F>
    void run_enabled(const ChunkTask& task, std::uint32_t version, F& function) const {
        const QueryMatch& match = *task.match;
        const std::uint32_t begin = task.chunk * kChunkRows;
        const std::uint32_t end = task_end(task);
        if constexpr (kToggles) {
            RowMask rows;
            const EnabledRows found = enabled_rows(task, rows);
            if (found == EnabledRows::None) {
                return;
            }
            if (found == EnabledRows::Some) {
                Marks::touch(match, begin, end, version);
                run_masked(match, begin, rows, version, function, Data{}, Indices{});
                return;
            }
        }
        Marks::touch(match, begin, end, version);
        run_rows(match, begin, end, version, function, Data{}, Indices{});
    }

    /// Lists the chunks to visit and raises the `newest` of their columns, which tasks must not
    /// share.
    void list_chunks(std::uint32_t version, std::vector<ChunkTask>& tasks) const {
        each_chunk([&](const ChunkTask& task) {
            if constexpr (kToggles) {
                RowMask rows;
                if (enabled_rows(task, rows) == EnabledRows::None) {
                    return;
                }
            }
            Marks::raise_newest(*task.match, version);
            tasks.push_back(task);
        });
    }

    // ---- calls

    template <typename F, typename... Ts, std::size_t... Positions>
    void run_rows(
        const QueryMatch& match, std::uint32_t begin, std::uint32_t end,
        [[maybe_unused]] std::uint32_t version, F& function, detail::TypeList<Ts...>,
        std::index_sequence<Positions...>) const {
        const Entity* entities = match.archetype->entities().data();
        constexpr bool kFiltersHere = kFiltersRows && !kFollowsSparse;
        if constexpr (!kFiltersHere) {
            Marks::mark_range(match, begin, end);
        }
        const auto loop = [&](auto... access) {
            for (std::uint32_t row = begin; row < end; ++row) {
                if constexpr (kFiltersHere) {
                    if (!passes(match, row)) {
                        continue;
                    }
                    Marks::mark_range(match, row, row + 1);
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

    /// Calls the function for the rows in `rows` of the chunk at `begin`.
    template <typename F, typename... Ts, std::size_t... Positions>
    void run_masked(
        const QueryMatch& match, std::uint32_t begin, const RowMask& rows,
        [[maybe_unused]] std::uint32_t version, F& function, detail::TypeList<Ts...>,
        std::index_sequence<Positions...>) const {
        const Entity* entities = match.archetype->entities().data();
        if constexpr (!kFiltersRows) {
            Marks::mark_masked(match, begin / kChunkRows, rows);
        }
        const auto loop = [&](auto... access) {
            rows.for_each([&](std::uint32_t offset) {
                const std::uint32_t row = begin + offset;
                if constexpr (kFiltersRows) {
                    if (!passes(match, row)) {
                        return;
                    }
                    Marks::mark_range(match, row, row + 1);
                }
                if constexpr (std::is_invocable_v<F&, detail::RowArgument<Ts>...>) {
                    function(detail::row_argument(access[row])...);
                } else {
                    function(entities[row], detail::row_argument(access[row])...);
                }
            });
        };
        loop(detail::access_term<Ts>(*core_, match, Positions, version)...);
    }

    /// A small function without mutable state is passed by value: the compiler then knows that
    /// nothing aliases it, and its captures stay in registers.
    template <typename F, typename... Ts>
    static constexpr bool is_passed_by_value(detail::TypeList<Ts...>) {
        return std::is_trivially_copyable_v<F> && sizeof(F) <= 64
               && std::is_invocable_v<const F&, ChunkView, detail::ChunkArgument<Ts>...>;
    }
    template <typename F>
    using PassedFunction =
        std::conditional_t<is_passed_by_value<F>(Data{}), const std::remove_const_t<F>, F&>;

    /// Not inlined: the function's loop would compete for registers with the loops here.
    template <typename F, typename... Ts, std::size_t... Positions>
    [[gnu::noinline]] void run_chunk(
        const ChunkTask& task, std::uint32_t version, PassedFunction<F> function,
        detail::TypeList<Ts...>, std::index_sequence<Positions...>) const {
        const QueryMatch& match = *task.match;
        const std::uint32_t begin = task.chunk * kChunkRows;
        const std::uint32_t size = chunk_end(begin, match.archetype->size()) - begin;
        RowMask enabled;  // filled lazily by ChunkView::enabled() if all rows are enabled
        bool all_enabled = true;
        if constexpr (kToggles) {
            const EnabledRows found = enabled_rows(task, enabled);
            if (found == EnabledRows::None) {
                return;
            }
            all_enabled = found == EnabledRows::All;
        }
        std::uint32_t previous[Data::size + 1] = {};
        [[maybe_unused]] const auto save = [&]<typename Term>(std::size_t position) {
            const int column = match.columns[position];
            if (detail::always_has_column<Term> || column >= 0) {
                previous[position] = match.archetype->column(column).versions[task.chunk];
            }
        };
        (save.template operator()<Ts>(Positions), ...);
        Marks::touch(match, begin, begin + size, version);
        [[maybe_unused]] std::array<RowMask, kTracks ? Data::size : 1> previous_written;
        if constexpr (kTracks) {
            std::size_t position = 0;
            const auto mark_all = [&]<typename Term>() {
                if constexpr (detail::TermTraits<Term>::is_tracked) {
                    using Value = typename detail::TermTraits<Term>::Value;
                    TrackedRows* track = match.archetype->bits().track(component_id<Value>);
                    if (track != nullptr) {
                        previous_written[position] = track->written[task.chunk];
                        track->mark(begin, size);
                    }
                }
                ++position;
            };
            (mark_all.template operator()<Ts>(), ...);
        }

        ChunkView view;
        view.archetype_ = match.archetype;
        view.columns_ = match.columns.data();
        view.previous_ = previous;
        view.chunk_ = task.chunk;
        view.size_ = size;
        view.index_ = task.index;
        view.offset_ = task.offset;
        view.version_ = version;
        view.state_ = state_;
        view.enabled_ = &enabled;
        view.all_enabled_ = all_enabled;
        if constexpr (kTracks) {
            view.previous_written_ = previous_written.data();
        }
        function(view, detail::chunk_argument<Ts>(match, Positions, task.chunk, size)...);
    }

    // ---- sparse components

    /// Whether the row passes the per-row filters.
    [[nodiscard]] bool passes(const QueryMatch& match, std::uint32_t row) const {
        if (!state_->row_matches(*core_, *match.archetype, match.archetype->entities()[row])) {
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
            const EntityLocation location = core_->entities.find(set->entities()[i]);
            const QueryMatch* match = state_->match_of(location.archetype);
            if (match == nullptr || !has_keys(*match) || !passes(*match, location.row)) {
                continue;
            }
            if constexpr (kToggles) {
                if (!state_->row_enabled(*match->archetype, location.row)) {
                    continue;
                }
            }
            if constexpr (kChanged) {
                if (!state_->chunk_changed(
                        *match->archetype, location.row / kChunkRows, since_version())) {
                    continue;
                }
            }
            visit(*match, location.row);
        }
    }

    template <typename F>
    void each_following(
        std::uint32_t begin, std::uint32_t end, std::uint32_t version, F& function) const {
        visit_following(begin, end, [&](const QueryMatch& match, std::uint32_t row) {
            run_row(match, row, version, function);
        });
    }

    template <typename F>
    void
    run_row(const QueryMatch& match, std::uint32_t row, std::uint32_t version, F& function) const {
        Marks::each_written(match, [&](Column& column) {
            store_version(column.versions[row / kChunkRows], version);
            store_version(column.newest, version);
        });
        run_rows(match, row, row + 1, version, function, Data{}, Indices{});
    }

    // ---- one entity

    [[nodiscard]] Location locate(Entity entity) const {
        state_->update(*core_);
        return location_of(entity);
    }

    template <typename... Ts>
    static void prefetch_row(const Location& location, detail::TypeList<Ts...>) {
        for (std::size_t term = 0; location.match != nullptr && term < sizeof...(Ts); ++term) {
            if (const int column = location.match->columns[term]; column >= 0) {
                __builtin_prefetch(location.match->archetype->column(column).at(location.row));
            }
        }
    }

    /// state_ must be up to date.
    [[nodiscard]] Location location_of(Entity entity) const {
        const EntityLocation location = core_->entities.find(entity);
        if (!location) {
            return {};
        }
        const QueryMatch* match = state_->match_of(location.archetype);
        if (match == nullptr || !has_keys(*match)
            || (kFiltersRows && !state_->row_matches(*core_, *match->archetype, entity))) {
            return {};
        }
        if constexpr (kToggles) {
            if (!state_->row_enabled(*match->archetype, location.row)) {
                return {};
            }
        }
        return {match, location.row};
    }

    template <typename T>
    [[nodiscard]] Column* split_column(const Location& location) const {
        static_assert(
            (std::is_same_v<std::remove_const_t<typename ValueOf<Terms>::Type>, T> || ...),
            "value, set: T must be a term of the query");
        const int column = location.match != nullptr
                               ? location.match->archetype->column_of(component_id<T>)
                               : kNoColumn;
        LIMN_CHECK_NOTE(column >= 0, component_info<T>().name.c_str());
        return &location.match->archetype->column(column);
    }

    template <typename T, typename... Ts, std::size_t... Positions>
    T* find_in(const Location& location, detail::TypeList<Ts...>, std::index_sequence<Positions...>)
        const {
        T* found = nullptr;
        [[maybe_unused]] const auto one = [&]<typename Term>(std::size_t position) {
            if constexpr (std::is_same_v<typename detail::TermTraits<Term>::Value, T>) {
                if constexpr (!std::is_const_v<T>) {
                    location.match->archetype->touch_row(
                        location.match->columns[position], location.row, write_version());
                }
                auto access =
                    detail::access_term<Term>(*core_, *location.match, position, write_version());
                if constexpr (detail::TermTraits<Term>::is_optional) {
                    found = access[location.row];
                } else {
                    found = &access[location.row];
                }
                if constexpr (detail::TermTraits<Term>::is_tracked) {
                    if (found != nullptr) {
                        location.match->archetype->bits()
                            .track(component_id<std::remove_const_t<T>>)
                            ->mark_shared(location.row);
                    }
                }
            }
        };
        (one.template operator()<Ts>(Positions), ...);
        return found;
    }

    [[nodiscard]] Location find_single() const {
        Location location;
        std::size_t total = 0;
        state_->update(*core_);
        const auto visit = [&](const QueryMatch& match, std::uint32_t row) {
            location = {&match, row};
            ++total;
        };
        if constexpr (kFollowsSparse) {
            visit_following(0, leading_size(), visit);
        } else if constexpr (kToggles) {
            each_enabled_row(visit);
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
        return location;
    }

    template <typename... Ts, std::size_t... Positions>
    std::tuple<detail::RowArgument<Ts>...>
    single(detail::TypeList<Ts...>, std::index_sequence<Positions...>) const {
        static_assert(
            !(detail::is_split<typename detail::TermTraits<Ts>::Value> || ...),
            "single: a split component has no address; use value<T>(single_entity())");
        const Location location = find_single();
        const std::uint32_t version = write_version();
        Marks::touch(*location.match, location.row, location.row + 1, version);
        Marks::mark_range(*location.match, location.row, location.row + 1);
        return {
            detail::access_term<Ts>(*core_, *location.match, Positions, version)[location.row]...};
    }

    WorldCore* core_;
    QueryState* state_;
    std::uint32_t version_ = 0;
    std::uint32_t since_ = 0;
    bool has_since_ = false;
    IterationLock lock_;
    [[no_unique_address]] std::conditional_t<kKeyed, detail::SharedKeys, detail::NoKeys> keys_;
};

}  // namespace limn
