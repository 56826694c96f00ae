#pragma once

#include "ecs/query_state.h"
#include "ecs/reflect.h"

#include <type_traits>
#include <vector>

namespace limn {

// The terms of a query. Query<const A, B, Optional<const C>, With<D>, Without<E>, Changed<A>>
// visits the entities that have A, B and D, not E, and whose A may have changed since the system
// last ran; it reads A, writes B, and reads C if present.

/// Requires all of them, without accessing them.
template <typename... Ts>
struct With {};

/// Excludes entities that have any of them.
template <typename... Ts>
struct Without {};

/// Requires at least one of them; ChunkView::has<T>() tells which.
template <typename... Ts>
struct AnyOf {};

/// Passed as T*, null if the entity has none.
template <typename T>
struct Optional {};

/// Requires all of them, and at least one must have changed (enabling and disabling count); several
/// Changed terms must all hold. Conservative: something in the chunk of 1024 rows was accessed for
/// writing, added, removed or moved.
template <typename... Ts>
struct Changed {};

/// For components that track their rows (ComponentTraits<T>::tracks_rows): chunks() receives a
/// const RowMask& of the rows written since they were last fetched, and clears the marks. Added,
/// moved, enabled and disabled rows count as written; requires T, enabled or not. Only one consumer
/// can use the marks, since fetching clears them; so this counts as writing T.
template <typename T>
struct TakeRows {};

namespace detail {

template <typename... Ts>
struct TypeList {
    static constexpr std::size_t size = sizeof...(Ts);
};

template <typename T>
inline constexpr bool is_sparse =
    ComponentTraits<std::remove_const_t<T>>::storage == Storage::Sparse;
template <typename T>
inline constexpr bool is_toggle =
    ComponentTraits<std::remove_const_t<T>>::storage == Storage::Toggle;
template <typename T>
inline constexpr bool tracks_rows = ComponentTraits<std::remove_const_t<T>>::tracks_rows;

template <typename T>
inline constexpr bool is_split = ComponentTraits<std::remove_const_t<T>>::storage == Storage::Split;

template <typename T>
inline constexpr bool is_shared =
    ComponentTraits<std::remove_const_t<T>>::storage == Storage::Shared;

/// What World::add returns.
template <typename T>
using Added = std::conditional_t<is_split<T> || is_shared<T>, void, T&>;

/// A component type, not a pointer, a reference or another term.
template <typename T>
concept Component =
    std::is_object_v<T> && !std::is_pointer_v<
        T> && !std::is_array_v<T> && !std::is_volatile_v<T> && !std::is_same_v<std::remove_const_t<T>, Entity>;

template <typename T>
struct TermTraits {
    static_assert(
        Component<T>,
        "a query term is T, const T, Optional<T>, With<..>, Without<..>, AnyOf<..> or Changed<..>; "
        "an Entity parameter needs no term");
    static_assert(
        !is_shared<T> || std::is_const_v<T>,
        "a shared component is read as const T; world.set or commands.set gives an entity another");
    static constexpr bool is_data = true;
    static constexpr bool is_optional = false;
    static constexpr bool is_write = !std::is_const_v<T>;
    static constexpr bool needs_sparse = is_sparse<T>;
    static constexpr bool filters_rows = is_sparse<T>;
    static constexpr bool is_toggled = is_toggle<T>;
    static constexpr bool is_tracked = is_write && tracks_rows<T>;
    static constexpr bool is_changed = false;
    static constexpr bool is_take = false;
    using Value = T;

    template <typename Sink>
    static void add(Sink&& sink) {
        sink(is_write ? TermKind::Write : TermKind::Read, component_id<std::remove_const_t<T>>);
    }
};

template <typename T>
struct TermTraits<Optional<T>> {
    static_assert(Component<T>, "Optional takes one component type");
    static_assert(
        !is_shared<T> || std::is_const_v<T>,
        "a shared component is read as const T; world.set or commands.set gives an entity another");
    static constexpr bool is_data = true;
    static constexpr bool is_optional = true;
    static constexpr bool is_write = !std::is_const_v<T>;
    static constexpr bool needs_sparse = false;
    static constexpr bool filters_rows = false;
    static constexpr bool is_toggled = false;
    static constexpr bool is_tracked = is_write && tracks_rows<T>;
    static constexpr bool is_changed = false;
    static constexpr bool is_take = false;
    using Value = T;

    template <typename Sink>
    static void add(Sink&& sink) {
        sink(
            is_write ? TermKind::OptionalWrite : TermKind::OptionalRead,
            component_id<std::remove_const_t<T>>);
    }
};

template <typename T>
struct TermTraits<TakeRows<T>> {
    static_assert(
        tracks_rows<T>, "TakeRows takes a component whose ComponentTraits say tracks_rows = true");
    static constexpr bool is_data = true;
    static constexpr bool is_optional = false;
    static constexpr bool is_write = false;  // changes no values or versions; declared as a write
    static constexpr bool needs_sparse = false;
    static constexpr bool filters_rows = false;
    static constexpr bool is_toggled = false;
    static constexpr bool is_tracked = false;
    static constexpr bool is_changed = false;
    static constexpr bool is_take = true;
    using Value = TakeRows<T>;

    template <typename Sink>
    static void add(Sink&& sink) {
        sink(TermKind::TakeRows, component_id<std::remove_const_t<T>>);
    }
};

template <typename... Ts>
struct FilterTraits {
    static_assert((Component<Ts> && ...), "With, Without, AnyOf and Changed take component types");
    static constexpr bool is_data = false;
    static constexpr bool is_write = false;
    static constexpr bool filters_rows = (is_sparse<Ts> || ...);
    static constexpr bool is_toggled = (is_toggle<Ts> || ...);
    static constexpr bool is_tracked = false;
    static constexpr bool is_take = false;
};

template <typename... Ts>
struct TermTraits<With<Ts...>> : FilterTraits<Ts...> {
    static constexpr bool needs_sparse = (is_sparse<Ts> || ...);
    static constexpr bool is_changed = false;
    template <typename Sink>
    static void add(Sink&& sink) {
        (sink(TermKind::With, component_id<std::remove_const_t<Ts>>), ...);
    }
};

template <typename... Ts>
struct TermTraits<Without<Ts...>> : FilterTraits<Ts...> {
    static constexpr bool needs_sparse = false;
    static constexpr bool is_changed = false;
    template <typename Sink>
    static void add(Sink&& sink) {
        (sink(TermKind::Without, component_id<std::remove_const_t<Ts>>), ...);
    }
};

template <typename... Ts>
struct TermTraits<AnyOf<Ts...>> : FilterTraits<Ts...> {
    static_assert(sizeof...(Ts) > 0, "AnyOf takes one component type or more");
    static_assert(
        !(is_toggle<Ts> || ...),
        "AnyOf checks archetypes, not enable bits: use Optional<const T> instead");
    static constexpr bool needs_sparse = false;
    static constexpr bool is_changed = false;
    template <typename Sink>
    static void add(Sink&& sink) {
        (sink(TermKind::AnyOf, component_id<std::remove_const_t<Ts>>), ...);
    }
};

/// Added to the terms by Query::where; the values are in the query.
struct Keyed {};
template <>
struct TermTraits<Keyed> {
    static constexpr bool is_data = false;
    static constexpr bool is_toggled = false;
    static constexpr bool is_take = false;
    static constexpr bool is_write = false;
    static constexpr bool is_optional = false;
    static constexpr bool is_tracked = false;
    static constexpr bool needs_sparse = false;
    static constexpr bool filters_rows = false;
    static constexpr bool is_changed = false;
    template <typename Sink>
    static void add(Sink&&) {}
};

template <typename... Ts>
struct TermTraits<Changed<Ts...>> : FilterTraits<Ts...> {
    static constexpr bool needs_sparse = (is_sparse<Ts> || ...);
    static constexpr bool is_changed = true;
    template <typename Sink>
    static void add(Sink&& sink) {
        (sink(TermKind::Changed, component_id<std::remove_const_t<Ts>>), ...);
    }
};

/// Whether the term excludes T (without const).
template <typename T, typename Term>
inline constexpr bool term_excludes = false;
template <typename T, typename... Ts>
inline constexpr bool
    term_excludes<T, Without<Ts...>> = (std::is_same_v<T, std::remove_const_t<Ts>> || ...);
template <typename Term, typename... Terms>
inline constexpr bool term_is_excluded = (term_excludes<std::remove_const_t<Term>, Terms> || ...);
template <typename... Ts, typename... Terms>
inline constexpr bool
    term_is_excluded<With<Ts...>, Terms...> = (term_is_excluded<Ts, Terms...> || ...);
template <typename... Ts, typename... Terms>
inline constexpr bool
    term_is_excluded<Changed<Ts...>, Terms...> = (term_is_excluded<Ts, Terms...> || ...);

template <typename List>
inline constexpr bool has_each_once = true;
template <typename... Ts>
inline constexpr bool has_each_once<TypeList<Ts...>> =
    all_different<std::remove_const_t<typename TermTraits<Ts>::Value>...>;

/// The terms that are passed as arguments, in order.
template <typename Found, typename... Terms>
struct DataTermsOf {
    using Type = Found;
};
template <typename... Found, typename Term, typename... Rest>
struct DataTermsOf<TypeList<Found...>, Term, Rest...>
    : std::conditional_t<
          TermTraits<Term>::is_data, DataTermsOf<TypeList<Found..., Term>, Rest...>,
          DataTermsOf<TypeList<Found...>, Rest...>> {};
template <typename... Terms>
using DataTerms = typename DataTermsOf<TypeList<>, Terms...>::Type;

template <typename... Terms>
[[nodiscard]] std::vector<QueryTerm> query_terms() {
    std::vector<QueryTerm> terms;
    [[maybe_unused]] std::uint8_t group = 0;
    [[maybe_unused]] const auto one = [&]<typename Term>() {
        TermTraits<Term>::add([&](TermKind kind, ComponentId id) {
            terms.push_back({kind, id, group});
        });
        ++group;
    };
    (one.template operator()<Terms>(), ...);
    return terms;
}

}  // namespace detail

}  // namespace limn
