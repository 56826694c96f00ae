#include "ecs/row_bits.h"

#include "ecs/archetype.h"

#include <algorithm>
#include <atomic>

namespace limn {

namespace {

/// Whether any of the rows is disabled; fast for chunks without disabled rows.
bool any_disabled(const ToggleBits& toggle, std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t chunk = first / kChunkRows; chunk < chunks_of(first + count); ++chunk) {
        if (toggle.chunks[chunk].disabled_count > 0) {
            return true;
        }
    }
    return false;
}

/// Copies the bits from `from` on of `source` to `to` on of `target`, which may be the same.
void copy_bits(
    const ToggleBits& source, std::uint32_t from, ToggleBits& target, std::uint32_t to,
    std::uint32_t count) {
    if (any_disabled(source, from, count) || any_disabled(target, to, count)) {
        for (std::uint32_t i = 0; i < count; ++i) {
            target.set_enabled(to + i, source.is_enabled(from + i));
        }
    }
}

}  // namespace

std::uint32_t ToggleBits::disabled_count() const {
    std::uint32_t total = 0;
    for (const ToggleChunk& chunk : chunks) {
        total += chunk.disabled_count;
    }
    return total;
}

void TrackedRows::mark_shared(std::uint32_t row) {
    std::uint64_t& word =
        written[row / RowMask::kRows].words[row % RowMask::kRows / RowMask::kWordRows];
    std::atomic_ref<std::uint64_t>(word).fetch_or(
        std::uint64_t{1} << row % RowMask::kWordRows, std::memory_order_relaxed);
}

void TrackedRows::mark(std::uint32_t first, std::uint32_t count) {
    const std::uint32_t end = first + count;
    for (std::uint32_t row = first; row < end;) {
        const std::uint32_t chunk = row / kChunkRows;
        const std::uint32_t next = std::min(end, (chunk + 1) * kChunkRows);
        written[chunk].set(row - chunk * kChunkRows, next - chunk * kChunkRows);
        row = next;
    }
}

RowMask TrackedRows::take(std::uint32_t chunk, std::uint32_t rows) {
    RowMask taken = written[chunk];
    taken &= RowMask::first(rows);
    written[chunk] = {};
    return taken;
}

void RowBits::add_chunk(std::uint32_t version) {
    for (ToggleBits& toggle : toggles_) {
        toggle.chunks.push_back({RowMask{}, 0, version});
        toggle.newest = version;
    }
    for (TrackedRows& track : tracks_) {
        track.written.emplace_back();
    }
}

void RowBits::rows_added(std::uint32_t first, std::uint32_t count) {
    for (TrackedRows& track : tracks_) {
        track.mark(first, count);
    }
}

void RowBits::rows_moved(std::uint32_t from, std::uint32_t to, std::uint32_t count) {
    for (ToggleBits& toggle : toggles_) {
        copy_bits(toggle, from, toggle, to, count);
    }
    rows_added(to, count);
}

void RowBits::rows_removed(std::uint32_t first, std::uint32_t count) {
    for (ToggleBits& toggle : toggles_) {
        if (any_disabled(toggle, first, count)) {
            for (std::uint32_t row = first; row < first + count; ++row) {
                toggle.set_enabled(row, true);
            }
        }
    }
}

void RowBits::receive(
    const RowBits& source, std::uint32_t from, std::uint32_t to, std::uint32_t count) {
    for (ToggleBits& toggle : toggles_) {
        if (const ToggleBits* other = source.toggle(toggle.id); other != nullptr) {
            copy_bits(*other, from, toggle, to, count);
        }
    }
}

void RowBits::clamp_versions(std::uint32_t oldest) {
    for (ToggleBits& toggle : toggles_) {
        toggle.newest = newer_of(toggle.newest, oldest);
        for (ToggleChunk& chunk : toggle.chunks) {
            chunk.version = newer_of(chunk.version, oldest);
        }
    }
}

std::size_t RowBits::bytes() const {
    std::size_t total = 0;
    for (const ToggleBits& toggle : toggles_) {
        total += toggle.chunks.capacity() * sizeof(ToggleChunk);
    }
    for (const TrackedRows& track : tracks_) {
        total += track.written.capacity() * sizeof(RowMask);
    }
    return total;
}

}  // namespace limn
