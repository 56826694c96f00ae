#include "ecs/archetype.h"
#include "ecs/base/check.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace limn {

// Bulk additions, removals and moves of rows. Columns are processed one after the other, so that
// each is read and written as a stream; work common to all columns is done in blocks of ranges that
// stay in the L1 cache.

namespace {

constexpr std::size_t kBlockRanges = 512;

std::uint32_t rows_of(std::span<const RowRange> ranges) {
    std::uint32_t rows = 0;
    for (const RowRange& range : ranges) {
        rows += range.count;
    }
    return rows;
}

/// Copies rows of kSize bytes; inlines single rows, which may be most ranges.
template <std::size_t kSize>
std::byte* copy_rows_of(std::byte* to, const std::byte* from, std::span<const RowRange> ranges) {
    for (const RowRange& range : ranges) {
        const std::byte* source = from + std::size_t{range.first} * kSize;
        if (range.count == 1) {
            std::memcpy(to, source, kSize);
        } else {
            std::memcpy(to, source, range.count * kSize);
        }
        to += range.count * kSize;
    }
    return to;
}

/// Returns the end of the copies.
std::byte* copy_rows(
    std::byte* to, const std::byte* from, std::size_t size, std::span<const RowRange> ranges) {
    switch (size) {
    case 4:
        return copy_rows_of<4>(to, from, ranges);
    case 8:
        return copy_rows_of<8>(to, from, ranges);
    case 12:
        return copy_rows_of<12>(to, from, ranges);
    case 16:
        return copy_rows_of<16>(to, from, ranges);
    case 24:
        return copy_rows_of<24>(to, from, ranges);
    case 32:
        return copy_rows_of<32>(to, from, ranges);
    case 48:
        return copy_rows_of<48>(to, from, ranges);
    case 64:
        return copy_rows_of<64>(to, from, ranges);
    default:
        for (const RowRange& range : ranges) {
            std::memcpy(to, from + range.first * size, range.count * size);
            to += range.count * size;
        }
        return to;
    }
}

void relocate_rows(
    Column& to, std::uint32_t row, const Column& from, std::span<const RowRange> ranges) {
    if (from.info->trivially_relocatable) {
        copy_rows(to.at(row), from.data, from.size, ranges);
        return;
    }
    for (const RowRange& range : ranges) {
        from.info->ops.relocate(to.at(row), from.at(range.first), range.count);
        row += range.count;
    }
}

template <std::size_t kSize>
void move_rows_of(std::byte* data, std::span<const RowMove> moves) {
    for (const RowMove& move : moves) {
        std::byte* to = data + std::size_t{move.to} * kSize;
        const std::byte* from = data + std::size_t{move.from} * kSize;
        if (move.count == 1) {
            std::memcpy(to, from, kSize);
        } else {
            std::memcpy(to, from, move.count * kSize);
        }
    }
}

void move_rows(std::byte* data, std::size_t size, std::span<const RowMove> moves) {
    switch (size) {
    case 4:
        return move_rows_of<4>(data, moves);
    case 8:
        return move_rows_of<8>(data, moves);
    case 12:
        return move_rows_of<12>(data, moves);
    case 16:
        return move_rows_of<16>(data, moves);
    default:
        for (const RowMove& move : moves) {
            std::memcpy(data + move.to * size, data + move.from * size, move.count * size);
        }
    }
}

/// Calls both(source, target) for the columns that the archetypes share and only(source) for those
/// that `to` lacks. Both lists ascend by component; one component may have several columns.
template <typename Both, typename Only>
void match_columns(Archetype& from, Archetype& to, const Both& both, const Only& only) {
    const std::span<Column> targets = to.columns();
    std::size_t target = 0;
    for (Column& source : from.columns()) {
        while (target < targets.size() && targets[target].info->id < source.info->id) {
            ++target;
        }
        if (target < targets.size() && targets[target].info == source.info) {
            both(source, targets[target++]);
        } else {
            only(source);
        }
    }
}

}  // namespace

std::uint32_t
Archetype::append_from(Archetype& from, std::span<const RowRange> ranges, std::uint32_t version) {
    const std::uint32_t first = size_;
    const std::uint32_t count = rows_of(ranges);
    LIMN_CHECK_NOTE(count <= kMaxRows - size_, "more rows than an archetype can hold");
    if (count == 0) {
        return first;
    }
    reserve(first + count);
    size_ += count;
    touch_structure({first, count}, version);
    rows_moved_in += count;
    from.rows_moved_out += count;

    std::uint32_t row = first;
    while (!ranges.empty()) {
        const auto block = ranges.first(std::min(ranges.size(), kBlockRanges));
        copy_rows(
            reinterpret_cast<std::byte*>(entities_ + row),
            reinterpret_cast<const std::byte*>(from.entities_), sizeof(Entity), block);
        match_columns(
            from, *this,
            [&](Column& source, Column& target) { relocate_rows(target, row, source, block); },
            [&](Column& source) {
                if (!source.info->trivially_destructible) {
                    for (const RowRange& range : block) {
                        source.info->ops.destroy(source.at(range.first), range.count);
                    }
                }
            });
        if (has_row_bits_) {
            receive_bits(from, row, block);
        }
        row += rows_of(block);
        ranges = ranges.subspan(block.size());
    }
    return first;
}

void Archetype::receive_bits(
    const Archetype& from, std::uint32_t row, std::span<const RowRange> ranges) {
    for (const RowRange& range : ranges) {
        bits_.rows_added(row, range.count);
        bits_.receive(from.bits_, range.first, row, range.count);
        row += range.count;
    }
}

bool Archetype::adopt_rows(Archetype& from, std::uint32_t version) {
    if (size_ > 0 || !from.is_promoted() || from.size_ < kChunkRows) {
        return false;
    }
    if (!is_promoted()) {
        promote(from.size_);
    }
    const RowRange all = {0, from.size_};
    std::swap(entities_, from.entities_);
    std::swap(entity_range_, from.entity_range_);
    match_columns(
        from, *this,
        [&](Column& source, Column& target) {
            std::swap(source.data, target.data);
            std::swap(source.range, target.range);
        },
        [&](Column& source) {
            if (!source.info->trivially_destructible) {
                source.info->ops.destroy(source.data, all.count);
            }
        });
    size_ = all.count;
    from.size_ = 0;
    rows_moved_in += all.count;
    from.rows_moved_out += all.count;
    commit(size_);
    from.update_capacity();
    touch_structure(all, version);
    from.touch_structure(all, version);
    receive_bits(from, 0, {&all, 1});
    from.bits_.rows_removed(0, all.count);
    return true;
}

void Archetype::take_memory(Archetype& from) {
    LIMN_CHECK(size_ == 0 && from.size_ == 0 && columns_.size() == from.columns_.size());
    leave_block();
    std::swap(entities_, from.entities_);
    std::swap(entity_range_, from.entity_range_);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        std::swap(columns_[i].data, from.columns_[i].data);
        std::swap(columns_[i].range, from.columns_[i].range);
    }
    update_capacity();
    from.update_capacity();
}

void Archetype::close_gaps(
    std::span<const RowRange> gaps, std::uint32_t version, std::vector<RowMove>& moves) {
    moves.clear();
    const std::uint32_t end = size_;
    size_ -= rows_of(gaps);
    for (const RowRange& gap : gaps) {
        touch_structure(gap, version);
    }
    touch_structure({size_, end - size_}, version);

    // `last` walks over the gaps that reach beyond the new end; between them are the rows to move.
    std::size_t last = static_cast<std::size_t>(
        std::partition_point(
            gaps.begin(), gaps.end(),
            [&](const RowRange& gap) { return gap.first + gap.count <= size_; })
        - gaps.begin());
    std::uint32_t from = size_;
    const auto skip_gaps = [&] {
        while (last < gaps.size() && gaps[last].first <= from) {
            from = std::max(from, gaps[last].first + gaps[last].count);
            ++last;
        }
    };
    for (const RowRange& gap : gaps) {
        if (gap.first >= size_) {
            break;
        }
        std::uint32_t to = gap.first;
        const std::uint32_t gap_end = std::min(gap.first + gap.count, size_);
        while (to < gap_end) {
            skip_gaps();
            const std::uint32_t next_gap = last < gaps.size() ? gaps[last].first : end;
            const std::uint32_t count = std::min(gap_end - to, next_gap - from);
            moves.push_back({from, to, count});
            from += count;
            to += count;
        }
    }

    if (has_row_bits_) {
        for (const RowMove& move : moves) {
            bits_.rows_moved(move.from, move.to, move.count);
        }
        bits_.rows_removed(size_, end - size_);
    }
    move_rows(reinterpret_cast<std::byte*>(entities_), sizeof(Entity), moves);
    for (Column& column : columns_) {
        if (column.info->trivially_relocatable) {
            move_rows(column.data, column.size, moves);
            continue;
        }
        for (const RowMove& move : moves) {
            column.info->ops.relocate(column.at(move.to), column.at(move.from), move.count);
        }
    }
}

}  // namespace limn
