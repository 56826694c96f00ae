#pragma once

#include "ecs/base/hash.h"
#include "ecs/snapshot_format.h"

#include <cstring>
#include <vector>

namespace limn::test {

/// Makes the checksums of an altered snapshot fit again, as far as its header makes sense, so that
/// what reads it gets to see the alteration.
inline void seal_snapshot(std::vector<std::byte>& bytes) {
    if (bytes.size() < kSnapshotHeaderSize) {
        return;
    }
    SnapshotHeader header;
    std::memcpy(&header, bytes.data() + 16, sizeof header);
    const std::size_t left = bytes.size() - kSnapshotHeaderSize;
    if (header.head_size > left
        || header.piece_count > (left - header.head_size) / sizeof(SnapshotPiece)) {
        return;
    }
    header.data_size = left - header.directory_size();
    std::byte* table = bytes.data() + kSnapshotHeaderSize + header.head_size;
    const std::byte* data = bytes.data() + kSnapshotHeaderSize + header.directory_size();
    std::uint64_t end = 0;
    for (std::uint64_t i = 0; i < header.piece_count; ++i) {
        SnapshotPiece piece;
        std::memcpy(&piece, table + i * sizeof piece, sizeof piece);
        if (piece.size > header.data_size - end) {
            break;
        }
        piece.hash = hash_bytes(data + end, piece.size);
        std::memcpy(table + i * sizeof piece, &piece, sizeof piece);
        end += piece.size;
    }
    header.checksum = hash_bytes(bytes.data() + kSnapshotHeaderSize, header.directory_size());
    std::memcpy(bytes.data() + 16, &header, sizeof header);
}

/// The same of a delta.
inline void seal_delta(std::vector<std::byte>& bytes) {
    constexpr std::size_t kHeader = 24;
    if (bytes.size() >= kHeader) {
        const std::uint64_t checksum = hash_bytes(bytes.data() + kHeader, bytes.size() - kHeader);
        std::memcpy(bytes.data() + 16, &checksum, sizeof checksum);
    }
}

}  // namespace limn::test
