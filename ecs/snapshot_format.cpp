#include "ecs/snapshot_format.h"

#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/base/text.h"

#include <atomic>
#include <cstring>

namespace limn {

namespace {

constexpr char kMagic[8] = {'L', 'I', 'M', 'N', 'S', 'N', 'A', 'P'};
constexpr std::size_t kPiecesPerTask = 16;

}  // namespace

void write_header(const SnapshotHeader& header, ByteWriter& out) {
    out.bytes(kMagic, sizeof kMagic);
    out.value(kSnapshotVersion);
    out.value(std::uint32_t{0});
    out.value(header.head_size);
    out.value(header.piece_count);
    out.value(header.data_size);
    out.value(header.checksum);
}

Result<SnapshotParts> open_snapshot(std::span<const std::byte> bytes) {
    ByteReader in(bytes);
    const std::span<const std::byte> magic = in.bytes(sizeof kMagic);
    if (in.failed() || std::memcmp(magic.data(), kMagic, sizeof kMagic) != 0) {
        return fail("not a snapshot: it does not begin with LIMNSNAP");
    }
    if (const auto version = in.value<std::uint32_t>();
        !in.failed() && version != kSnapshotVersion) {
        return fail("found version {}, expected {}", version, kSnapshotVersion);
    }
    const auto zero = in.value<std::uint32_t>();
    SnapshotParts parts;
    SnapshotHeader& header = parts.header;
    header.head_size = in.value<std::uint64_t>();
    header.piece_count = in.value<std::uint64_t>();
    header.data_size = in.value<std::uint64_t>();
    header.checksum = in.value<std::uint64_t>();
    // Check each term first, because the sum could overflow.
    const std::uint64_t left = in.left();
    if (in.failed() || zero != 0 || header.head_size > left || header.data_size > left
        || header.piece_count > left / sizeof(SnapshotPiece)
        || header.total_size() != bytes.size()) {
        return fail(
            "found {} bytes, expected {} plus the sizes in the header", bytes.size(),
            kSnapshotHeaderSize);
    }
    const std::span<const std::byte> directory =
        bytes.subspan(kSnapshotHeaderSize, header.directory_size());
    if (hash_bytes(directory) != header.checksum) {
        return fail("corrupt: the checksum of the head does not match");
    }
    parts.head = in.bytes(header.head_size);
    parts.pieces.resize(header.piece_count);
    in.copy(parts.pieces.data(), header.piece_count * sizeof(SnapshotPiece));
    parts.data = in.bytes(header.data_size);
    std::uint64_t end = 0;
    for (const SnapshotPiece& piece : parts.pieces) {
        if (piece.size > header.data_size - end) {
            return fail("the pieces are larger than the {} bytes of data", header.data_size);
        }
        end += piece.size;
    }
    if (end != header.data_size) {
        return fail("found {} bytes of data, expected the {} of the pieces", header.data_size, end);
    }
    return parts;
}

Status check_pieces(const SnapshotParts& parts) {
    // Precompute where each task begins, so that tasks are independent.
    std::vector<std::uint64_t> starts;
    std::uint64_t end = 0;
    for (std::size_t i = 0; i < parts.pieces.size(); ++i) {
        if (i % kPiecesPerTask == 0) {
            starts.push_back(end);
        }
        end += parts.pieces[i].size;
    }
    std::atomic<bool> is_corrupt = false;
    parallel_for(parts.pieces.size(), kPiecesPerTask, [&](std::size_t first, std::size_t last) {
        std::uint64_t at = starts[first / kPiecesPerTask];
        for (std::size_t i = first; i < last; ++i) {
            const SnapshotPiece& piece = parts.pieces[i];
            if (hash_bytes(parts.data.subspan(at, piece.size)) != piece.hash) {
                is_corrupt.store(true, std::memory_order_relaxed);
            }
            at += piece.size;
        }
    });
    if (is_corrupt.load()) {
        return fail("corrupt: the checksum of the data does not match");
    }
    return Done{};
}

}  // namespace limn
