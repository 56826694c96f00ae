#pragma once

#include "ecs/query_terms.h"
#include "ecs/split_span.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace limn::detail {

/// The value that tag terms refer to.
template <typename T>
inline std::remove_const_t<T> tag_value{};

// Maps a row to the argument of a term. Simple enough that a loop over rows with several of these
// compiles to a loop over arrays.

template <typename T>
struct TableAccess {
    T* base;
    T& operator[](std::uint32_t row) const { return base[row]; }
};
template <typename T>
struct OptionalAccess {
    T* base;
    T* operator[](std::uint32_t row) const { return base != nullptr ? base + row : nullptr; }
};
template <typename T>
struct TagAccess {
    T& operator[](std::uint32_t) const { return tag_value<T>; }
};
template <typename T>
struct OptionalTagAccess {
    bool present;
    T* operator[](std::uint32_t) const { return present ? &tag_value<T> : nullptr; }
};
template <typename T>
struct ToggleOptionalAccess {
    T* base;  ///< unused for tags
    const ToggleBits* bits;
    T* operator[](std::uint32_t row) const {
        if (bits == nullptr || !bits->is_enabled(row)) {
            return nullptr;
        }
        if constexpr (std::is_empty_v<T>) {
            return &tag_value<T>;
        } else {
            return base + row;
        }
    }
};
template <typename T>
struct SparseOptionalAccess {
    SparseSet* set;
    const Entity* entities;
    std::uint32_t version;

    T* operator[](std::uint32_t row) const {
        const std::uint32_t position =
            set != nullptr ? set->find(entities[row]) : SparseSet::kAbsent;
        if (position == SparseSet::kAbsent) {
            return nullptr;
        }
        if constexpr (std::is_empty_v<T>) {
            return &tag_value<T>;
        } else {
            if constexpr (!std::is_const_v<T>) {
                set->touch(position, version);
            }
            return reinterpret_cast<T*>(set->value(position));
        }
    }
};
template <typename T>
struct SparseAccess {
    SparseOptionalAccess<T> optional;
    T& operator[](std::uint32_t row) const { return *optional[row]; }
};

/// A shared component: one value for all rows.
template <typename T>
struct SharedAccess {
    T* value;
    T& operator[](std::uint32_t) const { return *value; }
};
template <typename T>
struct SharedOptionalAccess {
    T* value;
    T* operator[](std::uint32_t) const { return value; }
};
/// nullptr if the archetype has none.
template <typename T>
T* find_shared(const Archetype& archetype) {
    const SharedValue* found = archetype.shared_value(component_id<std::remove_const_t<T>>);
    return found != nullptr ? static_cast<T*>(found->value) : nullptr;
}

template <typename T>
struct SplitAccess {
    Lanes<T> lanes;
    SplitRow<T> operator[](std::uint32_t row) const { return {lanes, row}; }
};
template <typename T>
struct SplitOptionalAccess {
    Lanes<T> lanes;
    SplitOptionalRow<T> operator[](std::uint32_t row) const { return {lanes, row}; }
};

/// Whether every match has a column for the term, so that no check is needed.
template <typename Term>
inline constexpr bool always_has_column =
    !TermTraits<Term>::is_optional
    && !is_sparse<
        typename TermTraits<Term>::
            Value> && !is_shared<typename TermTraits<Term>::Value> && !std::is_empty_v<typename TermTraits<Term>::Value>;

template <typename Term>
auto access_term(
    const WorldCore& core, const QueryMatch& match, std::size_t position, std::uint32_t version) {
    using Traits = TermTraits<Term>;
    using T = typename Traits::Value;
    [[maybe_unused]] const int column = match.columns[position];
    if constexpr (is_sparse<T>) {
        const SparseOptionalAccess<T> access{
            core.sparse_set(component_id<std::remove_const_t<T>>),
            match.archetype->entities().data(), version};
        if constexpr (Traits::is_optional) {
            return access;
        } else {
            return SparseAccess<T>{access};
        }
    } else if constexpr (is_shared<T>) {
        if constexpr (Traits::is_optional) {
            return SharedOptionalAccess<T>{find_shared<T>(*match.archetype)};
        } else {
            return SharedAccess<T>{find_shared<T>(*match.archetype)};
        }
    } else if constexpr (is_split<T>) {
        if constexpr (Traits::is_optional) {
            return SplitOptionalAccess<T>{
                column < 0 ? Lanes<T>() : Lanes<T>(&match.archetype->column(column), 0)};
        } else {
            return SplitAccess<T>{Lanes<T>(&match.archetype->column(column), 0)};
        }
    } else if constexpr (is_toggle<T> && Traits::is_optional) {
        T* base = nullptr;
        if constexpr (!std::is_empty_v<T>) {
            base =
                column < 0 ? nullptr : reinterpret_cast<T*>(match.archetype->column(column).data);
        }
        return ToggleOptionalAccess<T>{
            base, match.archetype->bits().toggle(component_id<std::remove_const_t<T>>)};
    } else if constexpr (std::is_empty_v<T>) {
        if constexpr (Traits::is_optional) {
            return OptionalTagAccess<T>{column != kNoColumn};
        } else {
            return TagAccess<T>{};
        }
    } else if constexpr (Traits::is_optional) {
        return OptionalAccess<T>{
            column < 0 ? nullptr : reinterpret_cast<T*>(match.archetype->column(column).data)};
    } else {
        return TableAccess<T>{reinterpret_cast<T*>(match.archetype->column(column).data)};
    }
}

/// The argument of each()'s function for a term: const T&, T& or T*.
template <typename Term>
using RowArgument = std::conditional_t<
    TermTraits<Term>::is_optional, typename TermTraits<Term>::Value*,
    typename TermTraits<Term>::Value&>;

/// The argument of chunks()'s function for a term.
template <typename Term, typename T = typename TermTraits<Term>::Value>
struct ChunkArgumentOf {
    using Type = std::conditional_t<
        is_shared<T>, RowArgument<Term>,
        std::conditional_t<is_split<T>, SplitSpan<T>, std::span<T>>>;
};
template <typename T>
struct ChunkArgumentOf<TakeRows<T>> {
    using Type = const RowMask&;
};
template <typename Term>
using ChunkArgument = typename ChunkArgumentOf<Term>::Type;
/// The value behind it if the argument is a reference.
template <typename Term>
using ChunkValue = std::remove_cvref_t<ChunkArgument<Term>>;

/// Rows chunk * kChunkRows .. + size of a term's column, as chunks() passes them.
template <typename Term>
ChunkValue<Term> chunk_argument(
    const QueryMatch& match, std::size_t position, std::uint32_t chunk, std::uint32_t size) {
    using Traits = TermTraits<Term>;
    using T = typename Traits::Value;
    [[maybe_unused]] const int column = match.columns[position];
    [[maybe_unused]] const std::uint32_t begin = chunk * kChunkRows;
    if constexpr (Traits::is_take) {
        return match.archetype->bits().track_of_column(column)->take(chunk, size);
    } else if constexpr (std::is_empty_v<T>) {
        return {};
    } else if constexpr (is_shared<T>) {
        T* const value = find_shared<T>(*match.archetype);
        if constexpr (Traits::is_optional) {
            return value;
        } else {
            return *value;
        }
    } else if constexpr (is_split<T>) {
        return column < 0 ? SplitSpan<T>()
                          : SplitSpan<T>(&match.archetype->column(column), begin, size);
    } else {
        return always_has_column<Term> || column >= 0 ? std::span<T>(
                   reinterpret_cast<T*>(match.archetype->column(column).data) + begin, size)
                                                      : std::span<T>();
    }
}

}  // namespace limn::detail
