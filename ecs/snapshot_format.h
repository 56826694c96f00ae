#pragma once

#include "ecs/base/bytes.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// How the bytes of a snapshot are laid out; all little-endian.
//
//   header  "LIMNSNAP", u32 version, u32 zero, u64 size of the head, u64 pieces, u64 size of the
//           data, u64 XXH64 of head and table
//   head    names      u32 count; each: text, u64 layout of its fields, u32 SavedStorage
//           resources  u32 count; each: text, u64 layout
//           slots      u32 count, u32 free, u32 first free
//           groups     u32 count; each: u32 components, their numbers (u32), the values of those
//           that
//                      are shared, u32 rows
//           sets       u32 count; each: u32 number of the component, u32 values
//   table   of each piece: u64 size, u64 XXH64
//   data    the pieces, one behind the other
//
// A group is what archetypes are when components that are not saved are left out. The head tells
// which sections the data has, in this order: each resource; the generations of all slots; their
// links (of a free slot, the next free one); of each group the entities, then of each component its
// values, unless it is a tag, and if it is toggled a bit a row, set where it is disabled (no bytes:
// none is); of each set entities and values. A resource is one piece; of the others each 1024
// elements are one.
//
// Who only wants to know whether a snapshot is whole, as apply_delta does, needs no more than this
// file; snapshot_plan.h is about the head.

inline constexpr std::uint32_t kSnapshotVersion = 2;
inline constexpr std::size_t kSnapshotHeaderSize = 48;
inline constexpr std::uint32_t kPieceRows = 1024;
/// Ends the list of free slots.
inline constexpr std::uint32_t kNoLink = 0xffffffffu;

struct SnapshotPiece {
    std::uint64_t size = 0;  ///< [bytes]
    std::uint64_t hash = 0;

    friend bool operator==(const SnapshotPiece&, const SnapshotPiece&) = default;
};
static_assert(sizeof(SnapshotPiece) == 16);

[[nodiscard]] constexpr std::uint32_t pieces_of(std::uint32_t rows) {
    return rows / kPieceRows + (rows % kPieceRows != 0 ? 1 : 0);
}
[[nodiscard]] constexpr std::uint32_t rows_of_piece(std::uint32_t rows, std::uint32_t piece) {
    const std::uint32_t left = rows - piece * kPieceRows;
    return left < kPieceRows ? left : kPieceRows;
}

/// Of a bit a row, in whole words [bytes].
[[nodiscard]] constexpr std::size_t disabled_size(std::uint32_t rows) {
    return (std::size_t{rows} + 63) / 64 * sizeof(std::uint64_t);
}

/// The header alone.
struct SnapshotHeader {
    std::uint64_t head_size = 0;
    std::uint64_t piece_count = 0;
    std::uint64_t data_size = 0;
    std::uint64_t checksum = 0;

    [[nodiscard]] std::uint64_t directory_size() const {
        return head_size + piece_count * sizeof(SnapshotPiece);
    }
    [[nodiscard]] std::uint64_t total_size() const {
        return kSnapshotHeaderSize + directory_size() + data_size;
    }
};

/// The header as it stands in front of a snapshot.
void write_header(const SnapshotHeader& header, ByteWriter& out);

struct SnapshotParts {
    SnapshotHeader header;
    std::span<const std::byte> head;
    std::vector<SnapshotPiece> pieces;
    std::span<const std::byte> data;
};

/// Fails if the header does not fit the bytes, head and table are altered, or the pieces do not
/// make up the data. Does not look at the data itself.
[[nodiscard]] Result<SnapshotParts> open_snapshot(std::span<const std::byte> bytes);

/// Fails if a piece of the data is altered.
[[nodiscard]] Status check_pieces(const SnapshotParts& parts);

}  // namespace limn
