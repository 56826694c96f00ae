#include "ecs/archetype.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cstring>

namespace limn {

namespace {

constexpr std::size_t round_up_to(std::size_t value, std::size_t step) {
    return (value + step - 1) / step * step;
}

constexpr std::uint32_t round_rows_down(std::size_t rows) {
    return static_cast<std::uint32_t>(
        std::min<std::size_t>(rows, kMaxRows) / kRowPadding * kRowPadding);
}

std::size_t alignment(const Column& column) {
    return std::max<std::size_t>(kColumnAlign, column.info->align);
}

void move_bytes(std::byte* destination, const std::byte* source, std::size_t count) {
    if (count > 0) {
        std::memcpy(destination, source, count);
    }
}

/// Calls function<size>() for common element sizes, so that copying one is a few instructions
/// instead of a call; function<0>() for others.
template <typename F>
void with_fixed_size(std::uint32_t size, const F& function) {
    switch (size) {
    case 4:
        return function.template operator()<4>();
    case 8:
        return function.template operator()<8>();
    case 12:
        return function.template operator()<12>();
    case 16:
        return function.template operator()<16>();
    case 20:
        return function.template operator()<20>();
    case 24:
        return function.template operator()<24>();
    case 32:
        return function.template operator()<32>();
    case 48:
        return function.template operator()<48>();
    case 64:
        return function.template operator()<64>();
    default:
        return function.template operator()<0>();
    }
}

/// Moves one element of the column to raw memory; `size` is the column's element size or 0.
template <std::uint32_t size>
void move_element(const Column& column, std::byte* destination, std::byte* source) {
    if constexpr (size != 0) {
        std::memcpy(destination, source, size);
    } else {
        relocate_elements(column, destination, source, 1);
    }
}

template <std::uint32_t size>
std::byte* element(const Column& column, std::uint32_t row) {
    return column.data + std::size_t{row} * (size != 0 ? size : column.size);
}

/// For with_fixed_size.
std::uint32_t fixed_size(const Column& column) {
    return column.info->trivially_relocatable ? column.size : 0;
}

}  // namespace

void relocate_values(
    const ComponentInfo& info, void* destination, void* source, std::size_t count) {
    if (info.trivially_relocatable) {
        move_bytes(
            static_cast<std::byte*>(destination), static_cast<std::byte*>(source),
            count * info.size);
    } else {
        info.ops.relocate(destination, source, count);
    }
}

void relocate_elements(const Column& column, void* destination, void* source, std::size_t count) {
    if (column.info->trivially_relocatable) {
        move_bytes(
            static_cast<std::byte*>(destination), static_cast<std::byte*>(source),
            count * column.size);
    } else {
        column.info->ops.relocate(destination, source, count);
    }
}

void gather_values(const Column* lanes, std::uint32_t row, std::size_t count, void* values) {
    const std::size_t size = lanes->info->size;
    for (std::size_t lane = 0; lane < size / kLaneBytes; ++lane) {
        const std::byte* source = lanes[lane].at(row);
        std::byte* target = static_cast<std::byte*>(values) + lane * kLaneBytes;
        for (std::size_t i = 0; i < count; ++i) {
            std::memcpy(target + i * size, source + i * kLaneBytes, kLaneBytes);
        }
    }
}

void scatter_values(Column* lanes, std::uint32_t row, std::size_t count, const void* values) {
    const std::size_t size = lanes->info->size;
    for (std::size_t lane = 0; lane < size / kLaneBytes; ++lane) {
        std::byte* target = lanes[lane].at(row);
        const std::byte* source = static_cast<const std::byte*>(values) + lane * kLaneBytes;
        for (std::size_t i = 0; i < count; ++i) {
            std::memcpy(target + i * kLaneBytes, source + i * size, kLaneBytes);
        }
    }
}

void fill_values(Column* lanes, std::uint32_t row, std::size_t count, const void* value) {
    for (std::size_t lane = 0; lane < lanes->info->size / kLaneBytes; ++lane) {
        std::uint32_t scalar = 0;
        std::memcpy(&scalar, static_cast<const std::byte*>(value) + lane * kLaneBytes, kLaneBytes);
        std::fill_n(reinterpret_cast<LaneScalar*>(lanes[lane].at(row)), count, scalar);
    }
}

Archetype::Archetype(
    std::uint32_t index, std::span<const ComponentId> components, BlockPool& blocks,
    std::span<const SharedValue> shared)
    : index_(index), components_(components.begin(), components.end()),
      shared_(shared.begin(), shared.end()), blocks_(blocks) {
    std::size_t shared_count = 0;
    column_of_.assign(components.empty() ? 0 : components.back() + 1, std::int16_t{kNoColumn});
    for (const ComponentId id : components) {
        const ComponentInfo& info = component_info(id);
        const int column_index = info.is_tag ? kTagColumn : static_cast<int>(columns_.size());
        if (info.storage == Storage::Toggle) {
            bits_.add_toggle(id, column_index);
            has_tracked_toggles_ = has_tracked_toggles_ || info.tracks_rows;
        }
        if (info.tracks_rows) {
            bits_.add_track(id, column_index);
        }
        if (info.is_tag) {
            column_of_[id] = kTagColumn;
            continue;
        }
        if (info.storage == Storage::Shared) {
            LIMN_CHECK_NOTE(
                shared_count < shared.size() && shared[shared_count].component == id,
                info.name.c_str());
            ++shared_count;
            column_of_[id] = kSharedColumn;
            continue;
        }
        LIMN_CHECK_NOTE(
            info.align <= 4096, "the alignment of a component must not exceed 4096 bytes");
        column_of_[id] = static_cast<std::int16_t>(columns_.size());
        const std::size_t lanes =
            info.storage == Storage::Split ? info.size / kLaneBytes : std::size_t{1};
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            Column column;
            column.info = &info;
            column.size = static_cast<std::uint32_t>(info.size / lanes);
            column.lane = static_cast<std::uint32_t>(lane);
            columns_.push_back(std::move(column));
        }
        is_trivial_ = is_trivial_ && info.trivially_destructible;
    }
    has_row_bits_ = !bits_.empty();
}

Archetype::~Archetype() {
    destroy_components(0, size_);
    leave_block();
}

std::size_t Archetype::committed() const {
    std::size_t bytes = block_bytes_ + entity_range_.committed();
    for (const Column& column : columns_) {
        bytes += column.range.committed();
    }
    return bytes;
}

// ---- growth
// --------------------------------------------------------------------------------------

void Archetype::grow(std::uint32_t rows) {
    if (!is_promoted()) {
        for (std::size_t bytes = BlockPool::kSmallest; bytes <= BlockPool::kLargest; bytes *= 2) {
            if (rows_in_block(bytes) >= rows) {
                move_to_block(bytes);
                return;
            }
        }
        promote(static_cast<std::uint32_t>(round_up_to(rows, kRowPadding)));
    }
    commit(rows);
}

std::uint32_t Archetype::rows_in_block(std::size_t bytes) const {
    std::size_t row_bytes = sizeof(Entity);
    for (const Column& column : columns_) {
        row_bytes += column.size;
    }
    // Alignment needs some space: reduce the rows until all columns fit.
    std::uint32_t rows = round_rows_down(std::min<std::size_t>(bytes / row_bytes, kChunkRows));
    for (; rows > 0; rows -= kRowPadding) {
        std::size_t end = rows * sizeof(Entity);
        for (const Column& column : columns_) {
            end = round_up_to(end, alignment(column)) + std::size_t{rows} * column.size;
        }
        if (end <= bytes) {
            break;
        }
    }
    return rows;
}

void Archetype::move_to_block(std::size_t bytes) {
    std::byte* block = blocks_.allocate(bytes);
    const std::uint32_t rows = rows_in_block(bytes);
    move_bytes(block, reinterpret_cast<const std::byte*>(entities_), size_ * sizeof(Entity));
    std::size_t end = rows * sizeof(Entity);
    for (Column& column : columns_) {
        const std::size_t start = round_up_to(end, alignment(column));
        relocate_elements(column, block + start, column.data, size_);
        column.data = block + start;
        end = start + std::size_t{rows} * column.size;
    }
    leave_block();
    block_ = block;
    block_bytes_ = bytes;
    entities_ = reinterpret_cast<Entity*>(block);
    capacity_ = rows;
}

void Archetype::promote(std::uint32_t rows) {
    entity_range_ = VirtualRange(kMaxRows * sizeof(Entity), 0, rows * sizeof(Entity));
    entity_range_.commit(std::size_t{rows} * sizeof(Entity));
    move_bytes(
        entity_range_.data(), reinterpret_cast<const std::byte*>(entities_),
        size_ * sizeof(Entity));
    entities_ = reinterpret_cast<Entity*>(entity_range_.data());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        Column& column = columns_[i];
        column.range = VirtualRange(
            std::size_t{kMaxRows} * column.size, skew_of(i + 1, alignment(column)),
            std::size_t{rows} * column.size);
        column.range.commit(std::size_t{rows} * column.size);
        relocate_elements(column, column.range.data(), column.data, size_);
        column.data = column.range.data();
    }
    leave_block();
    capacity_ = 0;
}

void Archetype::commit(std::uint32_t rows) {
    LIMN_CHECK_NOTE(rows <= kMaxRows, "more rows than an archetype can hold");
    const std::size_t padded = round_up_to(rows, kRowPadding);
    entity_range_.commit(padded * sizeof(Entity));
    for (Column& column : columns_) {
        column.range.commit(padded * column.size);
    }
    update_capacity();
}

void Archetype::update_capacity() {
    capacity_ = round_rows_down(entity_range_.usable() / sizeof(Entity));
    for (const Column& column : columns_) {
        capacity_ = std::min(capacity_, round_rows_down(column.range.usable() / column.size));
    }
}

void Archetype::shrink() {
    if (size_ == 0) {
        leave_block();
        entity_range_ = {};
        entities_ = nullptr;
        for (Column& column : columns_) {
            column.range = {};
            column.data = nullptr;
        }
        capacity_ = 0;
    } else if (is_promoted()) {
        const std::size_t padded = round_up_to(size_, kRowPadding);
        entity_range_.shrink(padded * sizeof(Entity));
        for (Column& column : columns_) {
            column.range.shrink(padded * column.size);
        }
        commit(size_);
    } else {
        std::size_t bytes = BlockPool::kSmallest;
        while (rows_in_block(bytes) < size_) {
            bytes *= 2;
        }
        if (bytes < block_bytes_) {
            move_to_block(bytes);
        }
    }
}

void Archetype::leave_block() {
    if (block_ != nullptr) {
        blocks_.free(block_, block_bytes_);
        block_ = nullptr;
        block_bytes_ = 0;
    }
}

void Archetype::add_chunk(std::uint32_t version) {
    structure_.push_back(version);
    for (Column& column : columns_) {
        if (column.lane == 0) {
            column.versions.push_back(version);
            column.newest = version;
        }
    }
    bits_.add_chunk(version);
}

// ---- rows
// ----------------------------------------------------------------------------------------

std::uint32_t Archetype::append(std::span<const Entity> entities, std::uint32_t version) {
    const std::uint32_t first = size_;
    const std::uint32_t count = static_cast<std::uint32_t>(entities.size());
    LIMN_CHECK_NOTE(entities.size() <= kMaxRows - size_, "more rows than an archetype can hold");
    if (count == 0) {
        return first;
    }
    reserve(first + count);
    std::copy(entities.begin(), entities.end(), entities_ + first);
    size_ += count;
    touch_structure({first, count}, version);
    bits_.rows_added(first, count);
    return first;
}

void Archetype::bits_of_hole(std::uint32_t row, std::uint32_t last) {
    if (row != last) {
        bits_.rows_moved(last, row, 1);
    }
    bits_.rows_removed(last, 1);
}

void Archetype::fill_hole(std::uint32_t row, std::uint32_t version) {
    const std::uint32_t last = --size_;
    stamp_structure(row, version);
    if (has_row_bits_) {
        bits_of_hole(row, last);
    }
    if (row == last) {
        return;
    }
    stamp_structure(last, version);
    for (const Column& column : columns_) {
        with_fixed_size(fixed_size(column), [&]<std::uint32_t size>() {
            move_element<size>(column, element<size>(column, row), element<size>(column, last));
        });
    }
    entities_[row] = entities_[last];
}

std::uint32_t Archetype::move_row(std::uint32_t row, const RowPlan& plan, std::uint32_t version) {
    const std::uint32_t new_row = plan.to->append(entities_[row], version);
    const std::uint32_t last = --size_;
    stamp_structure(row, version);
    stamp_structure(last, version);
    if (plan.to->has_row_bits_) {
        plan.to->bits_.receive(bits_, row, new_row, 1);
    }
    if (has_row_bits_) {
        bits_of_hole(row, last);
    }
    for (const RowPlan::Step& step : plan.steps) {
        with_fixed_size(step.fixed_size, [&]<std::uint32_t size>() {
            const Column& column = *step.source;
            std::byte* const hole = element<size>(column, row);
            if (step.target != nullptr) {
                move_element<size>(column, element<size>(*step.target, new_row), hole);
            } else if (size == 0 && !column.info->trivially_destructible) {
                column.info->ops.destroy(hole, 1);
            }
            if (row != last) {
                move_element<size>(column, hole, element<size>(column, last));
            }
        });
    }
    entities_[row] = entities_[last];
    ++plan.to->rows_moved_in;
    ++rows_moved_out;
    return new_row;
}

const RowPlan& Archetype::plan_to(Archetype& to) {
    for (const std::unique_ptr<RowPlan>& plan : plans_) {
        if (plan->to == &to) {
            return *plan;
        }
    }
    RowPlan plan;
    plan.to = &to;
    // Both lists of columns ascend by component: walk them together.
    Column* target = to.columns_.data();
    Column* const end = target + to.columns_.size();
    for (const Column& source : columns_) {
        while (target != end && target->info->id < source.info->id) {
            ++target;
        }
        const bool is_common = target != end && target->info == source.info;
        plan.steps.push_back({&source, is_common ? target++ : nullptr, fixed_size(source)});
    }
    return *plans_.emplace_back(std::make_unique<RowPlan>(std::move(plan)));
}

void Archetype::construct_default(std::uint32_t first, std::uint32_t count) {
    for (Column& column : columns_) {
        const ComponentInfo& info = *column.info;
        LIMN_CHECK_NOTE(info.ops.construct_default != nullptr, info.name.c_str());
        if (info.storage != Storage::Split) {
            info.ops.construct_default(column.at(first), count);
        } else if (column.lane == 0 && count > 0) {
            std::vector<std::uint32_t> value(info.size / kLaneBytes);
            info.ops.construct_default(value.data(), 1);
            fill_values(&column, first, count, value.data());
        }
    }
}

void Archetype::destroy_each(std::uint32_t first, std::uint32_t count) {
    for (Column& column : columns_) {
        if (!column.info->trivially_destructible) {
            column.info->ops.destroy(column.at(first), count);
        }
    }
}

void Archetype::clear(std::uint32_t version) {
    destroy_components(0, size_);
    for (std::uint32_t chunk = 0; chunk < chunk_count(); ++chunk) {
        touch_structure(chunk * kChunkRows, version);
    }
    bits_.rows_removed(0, size_);
    size_ = 0;
}

// ---- change versions
// -----------------------------------------------------------------------------

void Archetype::touch_structure(RowRange rows, std::uint32_t version) {
    for (std::uint32_t chunk = rows.first / kChunkRows; chunk < chunks_of(rows.first + rows.count);
         ++chunk) {
        touch_structure(chunk * kChunkRows, version);
    }
}

void Archetype::touch_column(int column, std::uint32_t version) {
    if (column < 0) {
        return;
    }
    Column& target = columns_[static_cast<std::size_t>(column)];
    std::fill_n(target.versions.begin(), chunk_count(), version);
    target.newest = version;
    if (TrackedRows* track = bits_.track_of_column(column); track != nullptr) {
        track->mark(0, size_);
    }
}

void Archetype::write_rows(int column, RowRange rows, std::uint32_t version) {
    const std::uint32_t end = rows.first + rows.count;
    for (std::uint32_t row = rows.first; row < end; row += kChunkRows - row % kChunkRows) {
        touch_row(column, row, version);
    }
    if (TrackedRows* track = bits_.track_of_column(column); track != nullptr) {
        track->mark(rows.first, rows.count);
    }
}

void Archetype::clamp_versions(std::uint32_t oldest) {
    const auto raise = [oldest](std::uint32_t& version) { version = newer_of(version, oldest); };
    std::for_each(structure_.begin(), structure_.end(), raise);
    raise(newest_structure_);
    for (Column& column : columns_) {
        std::for_each(column.versions.begin(), column.versions.end(), raise);
        raise(column.newest);
    }
    bits_.clamp_versions(oldest);
}

}  // namespace limn
