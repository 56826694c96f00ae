#pragma once

#include "ecs/query_terms.h"

#include <cstddef>
#include <cstdint>

namespace limn::detail {

/// Marks what a query of the data terms `List` writes: versions of chunks and, of components that
/// track them, rows.
template <typename List, bool kTracks, bool kFollowsSparse>
struct QueryMarks;
template <typename... Ts, bool kTracks, bool kFollowsSparse>
struct QueryMarks<TypeList<Ts...>, kTracks, kFollowsSparse> {
    /// Calls visit(column) for every column that is written.
    template <typename Visit>
    static void each_written(const QueryMatch& match, const Visit& visit) {
        std::size_t position = 0;
        [[maybe_unused]] const auto one = [&]<typename Term>() {
            if constexpr (TermTraits<Term>::is_write) {
                if (always_has_column<Term> || match.columns[position] >= 0) {
                    visit(match.archetype->column(match.columns[position]));
                }
            }
            ++position;
        };
        (one.template operator()<Ts>(), ...);
    }

    static void
    touch(const QueryMatch& match, std::uint32_t begin, std::uint32_t end, std::uint32_t version) {
        each_written(match, [&](Column& column) {
            std::uint32_t* const versions = column.versions.data();
            const std::uint32_t first = begin / kChunkRows;
            versions[first] = version;  // many archetypes have only one chunk: skip the loop
            for (std::uint32_t chunk = first + 1; chunk < chunks_of(end); ++chunk) {
                versions[chunk] = version;
            }
            store_version(column.newest, version);
        });
    }
    static void raise_newest(const QueryMatch& match, std::uint32_t version) {
        each_written(match, [&](Column& column) { store_version(column.newest, version); });
    }

    /// Calls mark(tracked rows, toggle bits or null) for every written term that tracks its rows;
    /// with toggle bits only enabled rows are passed to the function.
    template <typename Mark>
    static void each_tracked(const QueryMatch& match, const Mark& mark) {
        [[maybe_unused]] const auto one = [&]<typename Term>() {
            if constexpr (TermTraits<Term>::is_tracked) {
                using Value = typename TermTraits<Term>::Value;
                RowBits& bits = match.archetype->bits();
                if (TrackedRows* track = bits.track(component_id<Value>); track != nullptr) {
                    mark(
                        *track,
                        TermTraits<Term>::is_optional ? bits.toggle(component_id<Value>) : nullptr);
                }
            }
        };
        (one.template operator()<Ts>(), ...);
    }
    static void mark_range(const QueryMatch& match, std::uint32_t begin, std::uint32_t end) {
        if constexpr (kTracks) {
            each_tracked(match, [&](TrackedRows& track, const ToggleBits* toggle) {
                if (toggle == nullptr && !kFollowsSparse) {
                    track.mark(begin, end - begin);
                    return;
                }
                for (std::uint32_t row = begin; row < end; ++row) {
                    if (toggle == nullptr || toggle->is_enabled(row)) {
                        track.mark_shared(row);  // tasks over a sparse set share chunks
                    }
                }
            });
        }
    }
    static void mark_masked(const QueryMatch& match, std::uint32_t chunk, const RowMask& rows) {
        if constexpr (kTracks) {
            each_tracked(match, [&](TrackedRows& track, const ToggleBits* toggle) {
                RowMask marked = rows;
                if (toggle != nullptr) {
                    marked -= toggle->chunks[chunk].disabled;
                }
                track.written[chunk] |= marked;
            });
        }
    }
};

}  // namespace limn::detail
