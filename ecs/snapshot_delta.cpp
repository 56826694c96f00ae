#include "ecs/base/hash.h"
#include "ecs/base/text.h"
#include "ecs/snapshot.h"
#include "ecs/snapshot_plan.h"

#include <algorithm>
#include <cstring>

namespace limn {

// A delta describes how to assemble the later snapshot from parts of the earlier one and from its
// own bytes:
//
//   header   "LIMNDELT", u32 version, u32 zero, u64 XXH64 of the rest
//   rest     u64 size and u64 checksum (of its directory) of the earlier snapshot, the same for the
//            later one, u64 steps; per step: u64 offset to copy from, or kOwnBytes, and u64 size;
//            then the delta's own bytes
//
// Every byte of the earlier snapshot is used at most once, so the later one cannot be larger than
// both together.

namespace {

constexpr char kDeltaMagic[8] = {'L', 'I', 'M', 'N', 'D', 'E', 'L', 'T'};
constexpr std::uint32_t kDeltaVersion = 1;
constexpr std::size_t kDeltaHeaderSize = 24;
constexpr std::uint64_t kOwnBytes = ~std::uint64_t{0};
/// Heads are compared in blocks of this size [bytes].
constexpr std::size_t kHeadBlock = 64;

struct DeltaStep {
    std::uint64_t from;
    std::uint64_t size;
};

/// Collects steps and own bytes; merges adjacent steps.
class DeltaWriter {
  public:
    void copy(std::uint64_t from, std::uint64_t size) {
        if (!steps_.empty() && steps_.back().from != kOwnBytes
            && steps_.back().from + steps_.back().size == from) {
            steps_.back().size += size;
        } else if (size > 0) {
            steps_.push_back({from, size});
        }
    }
    void own(const void* bytes, std::size_t size) {
        own_.bytes(bytes, size);
        if (!steps_.empty() && steps_.back().from == kOwnBytes) {
            steps_.back().size += size;
        } else if (size > 0) {
            steps_.push_back({kOwnBytes, size});
        }
    }
    void append(const DeltaWriter& other) {
        const std::byte* bytes = other.own_.data();
        for (const DeltaStep& step : other.steps_) {
            if (step.from == kOwnBytes) {
                own(bytes, step.size);
                bytes += step.size;
            } else {
                copy(step.from, step.size);
            }
        }
    }
    [[nodiscard]] const std::vector<DeltaStep>& steps() const { return steps_; }
    [[nodiscard]] const ByteWriter& own_bytes() const { return own_; }

  private:
    std::vector<DeltaStep> steps_;
    ByteWriter own_;
};

/// Writes the data of the later snapshot; fills pieces and offsets of its index.
void write_data(
    const SnapshotPlan& plan, const SnapshotIndex& base, SnapshotIndex& index, DeltaWriter& out) {
    ByteWriter scratch;
    std::uint64_t end = 0;
    for (std::size_t s = 0; s < plan.sections().size(); ++s) {
        const SnapshotSection& section = plan.sections()[s];
        for (std::uint32_t i = 0; i < pieces_of(section.rows); ++i) {
            const std::size_t earlier = plan.earlier_piece(s, i, base);
            const bool has_earlier = earlier != SnapshotPlan::kNoPiece;
            SnapshotPiece piece;
            bool is_same = has_earlier && plan.is_untouched(s, i, base);
            if (is_same) {
                piece = base.pieces[earlier];
            } else {
                scratch.clear();
                plan.write_piece(section, i, scratch);
                piece = {scratch.size(), hash_bytes(scratch.data(), scratch.size())};
                is_same = has_earlier && piece == base.pieces[earlier];  // same value written
            }
            if (is_same) {
                out.copy(base.data_offset(earlier), piece.size);
            } else {
                out.own(scratch.data(), scratch.size());
            }
            index.pieces.push_back(piece);
            index.offsets.push_back(end);
            end += piece.size;
        }
    }
    index.header.data_size = end;
}

void write_head_steps(const SnapshotIndex& base, const SnapshotIndex& index, DeltaWriter& out) {
    for (std::size_t at = 0; at < index.head.size(); at += kHeadBlock) {
        const std::size_t size = std::min(kHeadBlock, index.head.size() - at);
        if (at + size <= base.head.size()
            && std::memcmp(index.head.data() + at, base.head.data() + at, size) == 0) {
            out.copy(kSnapshotHeaderSize + at, size);
        } else {
            out.own(index.head.data() + at, size);
        }
    }
}

void write_table_steps(
    const SnapshotPlan& plan, const SnapshotIndex& base, const SnapshotIndex& index,
    DeltaWriter& out) {
    std::size_t piece = 0;
    for (std::size_t s = 0; s < plan.sections().size(); ++s) {
        for (std::uint32_t i = 0; i < pieces_of(plan.sections()[s].rows); ++i, ++piece) {
            const std::size_t earlier = plan.earlier_piece(s, i, base);
            if (earlier != SnapshotPlan::kNoPiece && base.pieces[earlier] == index.pieces[piece]) {
                out.copy(base.table_offset(earlier), sizeof(SnapshotPiece));
            } else {
                out.own(&index.pieces[piece], sizeof(SnapshotPiece));
            }
        }
    }
}

std::uint64_t checksum_of_directory(const SnapshotIndex& index) {
    ByteWriter directory;
    directory.reserve(index.header.directory_size());
    directory.bytes(index.head.data(), index.head.size());
    directory.bytes(index.pieces.data(), index.pieces.size() * sizeof(SnapshotPiece));
    return hash_bytes(directory.data(), directory.size());
}

std::vector<std::byte>
delta_bytes(const SnapshotHeader& base, const SnapshotHeader& later, const DeltaWriter& writer) {
    const std::size_t steps_size = writer.steps().size() * sizeof(DeltaStep);
    ByteWriter out;
    out.reserve(kDeltaHeaderSize + 40 + steps_size + writer.own_bytes().size());
    out.bytes(kDeltaMagic, sizeof kDeltaMagic);
    out.value(kDeltaVersion);
    out.value(std::uint32_t{0});
    out.value(std::uint64_t{0});  // checksum, patched at the end
    out.value(base.total_size());
    out.value(base.checksum);
    out.value(later.total_size());
    out.value(later.checksum);
    out.value(static_cast<std::uint64_t>(writer.steps().size()));
    out.bytes(writer.steps().data(), steps_size);
    out.bytes(writer.own_bytes().data(), writer.own_bytes().size());
    out.patch(16, hash_bytes(out.data() + kDeltaHeaderSize, out.size() - kDeltaHeaderSize));
    return out.take();
}

// ---- applying
// ------------------------------------------------------------------------------------

struct Delta {
    std::uint64_t base_size = 0;
    std::uint64_t base_checksum = 0;
    std::uint64_t size = 0;
    std::uint64_t checksum = 0;
    ByteReader steps{{}};
    std::span<const std::byte> own;
};

/// Checks everything except the steps.
Result<Delta> open_delta(std::span<const std::byte> bytes) {
    ByteReader in(bytes);
    const std::span<const std::byte> magic = in.bytes(sizeof kDeltaMagic);
    if (in.failed() || std::memcmp(magic.data(), kDeltaMagic, sizeof kDeltaMagic) != 0) {
        return fail("not a delta: it does not begin with LIMNDELT");
    }
    const auto version = in.value<std::uint32_t>();
    const auto zero = in.value<std::uint32_t>();
    const auto checksum = in.value<std::uint64_t>();
    if (!in.failed() && version != kDeltaVersion) {
        return fail("found version {}, expected {}", version, kDeltaVersion);
    }
    if (in.failed() || zero != 0 || hash_bytes(bytes.subspan(kDeltaHeaderSize)) != checksum) {
        return fail("corrupt: the checksum does not match");
    }
    Delta delta;
    delta.base_size = in.value<std::uint64_t>();
    delta.base_checksum = in.value<std::uint64_t>();
    delta.size = in.value<std::uint64_t>();
    delta.checksum = in.value<std::uint64_t>();
    const auto steps = in.value<std::uint64_t>();
    if (in.failed() || steps > in.left() / sizeof(DeltaStep)) {
        return fail("found {} bytes, expected more", bytes.size());
    }
    delta.steps = ByteReader(in.bytes(steps * sizeof(DeltaStep)));
    delta.own = in.bytes(in.left());
    return delta;
}

/// Whether the steps add up to the later snapshot and use every byte at most once.
bool steps_fit(const Delta& delta) {
    std::uint64_t copied = 0;
    std::uint64_t owned = 0;
    ByteReader steps = delta.steps;
    while (steps.left() > 0) {
        const auto from = steps.value<std::uint64_t>();
        const auto size = steps.value<std::uint64_t>();
        std::uint64_t& sum = from == kOwnBytes ? owned : copied;
        const std::uint64_t limit = from == kOwnBytes ? delta.own.size() : delta.base_size;
        if (size > limit - sum
            || (from != kOwnBytes && (from > delta.base_size || size > delta.base_size - from))) {
            return false;
        }
        sum += size;
    }
    return owned == delta.own.size() && copied + owned == delta.size;
}

Result<std::vector<std::byte>> apply(const Delta& delta, std::span<const std::byte> base) {
    std::vector<std::byte> bytes;
    bytes.reserve(delta.size);
    advise_huge_pages(bytes.data(), delta.size);
    ByteReader steps = delta.steps;
    std::size_t own = 0;
    while (steps.left() > 0) {
        const auto from = steps.value<std::uint64_t>();
        const auto size = steps.value<std::uint64_t>();
        const std::byte* first = from == kOwnBytes ? delta.own.data() + own : base.data() + from;
        bytes.insert(bytes.end(), first, first + size);
        own += from == kOwnBytes ? size : 0;
    }
    const Result<SnapshotParts> parts = open_snapshot(bytes);
    if (!parts) {
        return parts.error();
    }
    if (Status status = check_pieces(*parts); !status) {
        return status.error();
    }
    if (parts->header.checksum != delta.checksum) {
        return fail("the result does not match the delta's checksum");
    }
    return bytes;
}

}  // namespace

Result<std::vector<std::byte>>
save_delta(const World& world, const SnapshotMark& base, SnapshotMark* mark) {
    LIMN_CHECK_NOTE(base.index != nullptr, "a delta needs the mark of an earlier snapshot");
    LIMN_CHECK_NOTE(base.index->world == &world, "the mark belongs to a different world");
    Result<SnapshotPlan> plan = SnapshotPlan::make(world);
    if (!plan) {
        return plan.error();
    }
    plan->read_slots(base.index.get());

    SnapshotIndex index = plan->make_index(mark != nullptr ? world.version() : 0);
    ByteWriter head;
    plan->write_head(head);
    index.head = head.take();
    DeltaWriter data;
    write_data(*plan, *base.index, index, data);
    index.header.head_size = index.head.size();
    index.header.piece_count = index.pieces.size();
    index.header.checksum = checksum_of_directory(index);

    DeltaWriter all;
    ByteWriter header;
    write_header(index.header, header);
    all.own(header.data(), header.size());
    write_head_steps(*base.index, index, all);
    write_table_steps(*plan, *base.index, index, all);
    all.append(data);
    std::vector<std::byte> bytes = delta_bytes(base.index->header, index.header, all);
    if (mark != nullptr) {
        mark->index = std::make_shared<const SnapshotIndex>(std::move(index));
    }
    return bytes;
}

Result<std::vector<std::byte>>
apply_delta(std::span<const std::byte> base, std::span<const std::byte> delta) {
    const Result<Delta> opened = open_delta(delta);
    if (!opened) {
        return fail("delta: {}", opened.error().message);
    }
    const Result<SnapshotParts> parts = open_snapshot(base);
    if (!parts) {
        return fail("delta: the earlier snapshot: {}", parts.error().message);
    }
    if (base.size() != opened->base_size || parts->header.checksum != opened->base_checksum) {
        return fail("delta: belongs to a different snapshot");
    }
    if (!steps_fit(*opened)) {
        return fail("delta: its steps do not add up to {} bytes", opened->size);
    }
    Result<std::vector<std::byte>> bytes = apply(*opened, base);
    if (!bytes) {
        return fail("delta: {}", bytes.error().message);
    }
    return bytes;
}

}  // namespace limn
