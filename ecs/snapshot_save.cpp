#include "ecs/base/hash.h"
#include "ecs/snapshot.h"
#include "ecs/snapshot_plan.h"

namespace limn {

Result<std::vector<std::byte>> save_snapshot(const World& world, SnapshotMark* mark) {
    Result<SnapshotPlan> made = SnapshotPlan::make(world);
    if (!made) {
        return made.error();
    }
    SnapshotPlan& plan = *made;
    plan.read_slots(nullptr);

    SnapshotHeader header;
    header.piece_count = plan.piece_count();
    ByteWriter head;
    plan.write_head(head);
    header.head_size = head.size();
    header.data_size = plan.min_data_size();  // estimate, corrected below
    ByteWriter out;
    out.reserve(header.total_size());
    advise_huge_pages(out.data(), header.total_size());
    write_header(header, out);  // overwritten below, like the table
    out.bytes(head.data(), head.size());
    std::vector<SnapshotPiece> pieces(header.piece_count);
    out.bytes(pieces.data(), pieces.size() * sizeof(SnapshotPiece));
    const std::size_t data = out.size();

    std::vector<std::uint64_t> offsets(pieces.size());
    std::size_t piece = 0;
    for (const SnapshotSection& section : plan.sections()) {
        for (std::uint32_t i = 0; i < pieces_of(section.rows); ++i, ++piece) {
            const std::size_t start = out.size();
            plan.write_piece(section, i, out);
            // Hash while the piece is still in the cache.
            const std::size_t size = out.size() - start;
            pieces[piece] = {size, hash_bytes(out.data() + start, size)};
            offsets[piece] = start - data;
        }
    }
    header.data_size = out.size() - data;
    out.overwrite(
        data - pieces.size() * sizeof(SnapshotPiece), pieces.data(),
        pieces.size() * sizeof(SnapshotPiece));
    header.checksum = hash_bytes(out.data() + kSnapshotHeaderSize, header.directory_size());
    ByteWriter front;
    write_header(header, front);
    out.overwrite(0, front.data(), front.size());

    if (mark != nullptr) {
        SnapshotIndex index = plan.make_index(world.version());
        index.header = header;
        index.head = head.take();
        index.pieces = std::move(pieces);
        index.offsets = std::move(offsets);
        mark->index = std::make_shared<const SnapshotIndex>(std::move(index));
    }
    return out.take();
}

}  // namespace limn
