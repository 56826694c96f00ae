#pragma once

#include "ecs/chunk_view.h"
#include "ecs/query_access.h"

#include <cstddef>
#include <type_traits>

namespace limn::detail {

// One-line errors for functions that a query cannot call.

/// A toggled tag is allowed, to enable and disable it; its array is empty.
template <typename Term>
inline constexpr bool is_plain_tag =
    std::is_empty_v<typename TermTraits<Term>::Value> && !TermTraits<Term>::is_take
    && !is_toggle<typename TermTraits<Term>::Value>;

template <typename F, bool kTakes, typename... Ts>
constexpr void check_row_function(TypeList<Ts...>) {
    static_assert(!kTakes, "each: TakeRows is per chunk; use chunks or par_chunks");
    static_assert(
        std::is_invocable_v<
            F&, RowArgument<Ts>...> || std::is_invocable_v<F&, Entity, RowArgument<Ts>...>,
        "each: the function takes the query's components in order (const A&, B&, Optional as "
        "C*), "
        "optionally preceded by an Entity");
}
template <typename F, bool kChanged, typename... Ts>
constexpr void check_gather_function(TypeList<Ts...>) {
    static_assert(!kChanged, "gather: ignores versions; use a query without Changed");
    static_assert(
        std::is_invocable_v<F&, std::size_t, RowArgument<Ts>...>,
        "gather: the function takes the index in the list, a std::size_t, and then the query's "
        "components in order (const A&, B&, Optional as C*)");
}
template <typename F, bool kFiltersRows, typename... Ts>
constexpr void check_chunk_function(TypeList<Ts...>) {
    static_assert(
        !kFiltersRows, "chunks: sparse components are not in chunks; use each or par_each");
    static_assert(!(is_plain_tag<Ts> || ...), "chunks: tags have no array; use With<Tag>");
    static_assert(
        std::is_invocable_v<F&, ChunkView, ChunkArgument<Ts>...>,
        "chunks: the function takes a ChunkView and one std::span per component, in order: "
        "std::span<const A>, std::span<B>; for a split component, SplitSpan<const C>; for a "
        "shared one, const D&; for TakeRows, const RowMask&");
}

}  // namespace limn::detail
