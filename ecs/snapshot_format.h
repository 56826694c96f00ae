#pragma once

#include "ecs/base/bytes.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Binary layout of a snapshot; everything is little-endian.
//
//   header  "LIMNSNAP", u32 version, u32 zero, u64 size of the head, u64 pieces, u64 size of the
//           data, u64 XXH64 of head and table
//   head    names      u32 count; each: text, u64 hash of its field layout, u32 SavedStorage
//           resources  u32 count; each: text, u64 hash of its field layout
//           slots      u32 count, u32 free, u32 first free
//           groups     u32 count; each: u32 component count, component indices into names (u32),
//                      values of the shared components, u32 rows
//           sets       u32 count; each: u32 index of the component in names, u32 values
//   table   per piece: u64 size, u64 XXH64
//   data    the pieces, concatenated
//
// A group is a set of archetypes that are equal when components that are not saved are ignored. The
// head determines the sections of the data, in this order: each resource; the generations of all
// slots; their links (for a free slot, the next free one); per group the entities, then per
// component its values, unless it is a tag, and, if toggled, one bit per row, set if disabled (no
// bytes if none is); per set entities and values. A resource is one piece; other sections have one
// piece per 1024 elements.
//
// This file is all that is needed to verify the integrity of a snapshot, as apply_delta does;
// snapshot_plan.h interprets the head.

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

/// Size of one bit per row, in whole 64-bit words [bytes].
[[nodiscard]] constexpr std::size_t disabled_size(std::uint32_t rows) {
    return (std::size_t{rows} + 63) / 64 * sizeof(std::uint64_t);
}

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

/// Appends the header in file format.
void write_header(const SnapshotHeader& header, ByteWriter& out);

struct SnapshotParts {
    SnapshotHeader header;
    std::span<const std::byte> head;
    std::vector<SnapshotPiece> pieces;
    std::span<const std::byte> data;
};

/// Fails if the header does not match the size, head and table are corrupt, or the sizes of the
/// pieces do not add up. Does not check the data itself.
[[nodiscard]] Result<SnapshotParts> open_snapshot(std::span<const std::byte> bytes);

/// Fails if a piece of the data is corrupt.
[[nodiscard]] Status check_pieces(const SnapshotParts& parts);

}  // namespace limn
