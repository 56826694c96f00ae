#include "ecs/command_order.h"

#include "ecs/base/check.h"
#include "ecs/component_bytes.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace limn {

// ---- collect
// -------------------------------------------------------------------------------------

void CommandOrder::collect(std::span<CommandBuffer* const> buffers) {
    runs_.clear();
    created_.clear();
    pieces_.clear();
    is_sorted_ = true;
    end_ = 0;
    for (CommandBuffer* buffer : buffers) {
        collect(*buffer);
    }
}

void CommandOrder::collect(CommandBuffer& buffer) {
    buffer.close_runs();
    segments_.clear();
    for (const auto& stream : buffer.streams_) {
        for (std::size_t i = 0; i < stream->segments.size(); ++i) {
            const CommandSegment& segment = stream->segments[i];
            const std::uint32_t end = i + 1 < stream->segments.size()
                                          ? stream->segments[i + 1].first_run
                                          : static_cast<std::uint32_t>(stream->runs.size());
            segments_.push_back({segment.scope, stream.get(), segment.first_run, end});
        }
    }
    const auto before = [](const Segment& a, const Segment& b) {
        return a.scope.sequence != b.scope.sequence ? a.scope.sequence < b.scope.sequence
                                                    : a.scope.chunk < b.scope.chunk;
    };
    // Segments with equal scope were recorded by one thread, in the order of its runs.
    std::sort(segments_.begin(), segments_.end(), [&](const Segment& a, const Segment& b) {
        if (before(a, b) || before(b, a)) {
            return before(a, b);
        }
        return a.stream != b.stream ? a.stream->number < b.stream->number
                                    : a.first_run < b.first_run;
    });
    for (std::size_t i = 1; i < segments_.size(); ++i) {
        LIMN_CHECK_NOTE(
            segments_[i - 1].stream == segments_[i].stream
                || before(segments_[i - 1], segments_[i]),
            "several threads recorded commands outside par_chunks and par_each, so their order is "
            "undefined");
    }

    creations_.clear();
    const auto first_run = static_cast<std::uint32_t>(runs_.size());
    for (const Segment& segment : segments_) {
        for (std::uint32_t i = segment.first_run; i < segment.end_run; ++i) {
            const CommandRun& run = segment.stream->runs[i];
            const std::uint32_t key =
                runs_.empty() ? 0 : runs_.back().key + runs_.back().commands.count;
            const auto number = static_cast<std::uint32_t>(created_.size());
            runs_.push_back({run, key, number, &buffer});
            if (run.kind.op == CommandOp::Create) {
                creations_.push_back({segment.stream, run.entities[0].index, number});
                created_.resize(created_.size() + run.count);
                core_.entities.allocate(std::span<Entity>(created_).subspan(number));
            }
        }
    }
    std::sort(creations_.begin(), creations_.end(), [](const Creation& a, const Creation& b) {
        return a.stream != b.stream ? a.stream->number < b.stream->number
                                    : a.placeholder < b.placeholder;
    });
    for (auto run = first_run; run < runs_.size(); ++run) {
        resolve_fields(runs_[run]);
        locate(run);
    }
}

std::uint32_t CommandOrder::number_of(const CommandBuffer& buffer, Entity placeholder) const {
    const CommandStream* stream = buffer.stream_of(placeholder);
    if (stream == nullptr) {
        return kNone;
    }
    const auto after = std::upper_bound(
        creations_.begin(), creations_.end(), placeholder.index,
        [stream](std::uint32_t index, const Creation& creation) {
            return creation.stream != stream ? stream->number < creation.stream->number
                                             : index < creation.placeholder;
        });
    const Creation& creation = *(after - 1);
    return creation.number + (placeholder.index - creation.placeholder);
}

/// Replaces placeholders in the values by entities; those of another run or system become null.
void CommandOrder::resolve_fields(const Run& run) {
    const RecordLayout& layout = *run.commands.kind.layout;
    for (std::uint32_t i = 0; i < layout.size && layout.stride > 0; ++i) {
        const ComponentInfo& info = component_info(layout.id(i));
        if (!info.has_entities) {
            continue;
        }
        for (std::uint32_t k = 0; k < run.commands.count; ++k) {
            std::byte* record = run.commands.records + std::size_t{k} * layout.stride;
            for_each_entity(info.fields, record + layout.offsets[i], [&](Entity& entity) {
                if ((entity.generation & kPlaceholderBit) != 0) {
                    const std::uint32_t number = number_of(*run.buffer, entity);
                    entity = number != kNone ? created_[number] : Entity{};
                }
            });
        }
    }
}

// ---- locate
// --------------------------------------------------------------------------------------

void CommandOrder::locate(std::uint32_t run) {
    const Run& all = runs_[run];
    if (all.commands.kind.op == CommandOp::Create) {
        add_piece({kNoArchetype, all.created, all.commands.count, run, 0});
    } else {
        locate_entities(run);
    }
}

namespace {

/// Length of the common prefix, at most `count`.
std::uint32_t common_length(const Entity* a, const Entity* b, std::uint32_t count) {
    constexpr std::uint32_t kBlock = 64;
    std::uint32_t same = 0;
    while (same + kBlock <= count
           && std::memcmp(a + same, b + same, kBlock * sizeof(Entity)) == 0) {
        same += kBlock;
    }
    while (same < count && a[same] == b[same]) {
        ++same;
    }
    return same;
}

}  // namespace

void CommandOrder::locate_entities(std::uint32_t run) {
    const Run& all = runs_[run];
    const Entity* entities = all.commands.entities;
    const std::uint32_t count = all.commands.count;
    Piece open{0, 0, 0, run, 0};
    const auto close = [&] {
        if (open.count > 0) {
            add_piece(open);
            open.count = 0;
        }
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        if (i + EntityTable::kPrefetch < count) {
            core_.entities.prefetch(entities[i + EntityTable::kPrefetch]);
        }
        EntityLocation location = core_.entities.find(entities[i]);
        if (!location) {
            const bool is_placeholder = (entities[i].generation & kPlaceholderBit) != 0;
            const std::uint32_t number =
                is_placeholder ? number_of(*all.buffer, entities[i]) : kNone;
            if (number == kNone) {
                const RecordLayout& layout = *all.commands.kind.layout;
                destroy_record(layout, all.commands.records + std::size_t{i} * layout.stride);
                close();
                continue;
            }
            location = {kNoArchetype, number};
        }
        const bool continues = open.count > 0 && location.archetype == open.archetype
                               && location.row == open.row + open.count;
        if (!continues) {
            close();
            open = {location.archetype, location.row, 1, run, i};
            continue;
        }
        ++open.count;
        if (location.archetype != kNoArchetype) {
            // Two consecutive rows: there may be more, and comparing is faster than looking up.
            const Archetype& rows = *core_.archetypes[location.archetype];
            const std::uint32_t more = common_length(
                entities + i + 1, rows.entities().data() + location.row + 1,
                std::min(count - i - 1, rows.size() - location.row - 1));
            open.count += more;
            i += more;
        }
    }
    close();
}

void CommandOrder::add_piece(const Piece& piece) {
    is_sorted_ = is_sorted_ && (pieces_.empty() || piece.begin() >= end_);
    end_ = piece.end();
    pieces_.push_back(piece);
}

// ---- arrange
// -------------------------------------------------------------------------------------

namespace {

/// Stable sort by the upper 32 bits, which must not exceed `max`.
void radix_sort(
    std::vector<std::uint64_t>& values, std::vector<std::uint64_t>& scratch, std::uint32_t max) {
    constexpr int kBits = 11;
    constexpr std::size_t kBuckets = std::size_t{1} << kBits;
    scratch.resize(values.size());
    for (int shift = 0; shift < 32 && (max >> shift) > 0; shift += kBits) {
        std::array<std::uint32_t, kBuckets> next = {};
        const auto bucket = [shift](std::uint64_t value) {
            return (value >> (32 + shift)) % kBuckets;
        };
        for (std::size_t i = 0; i < values.size(); ++i) {
            ++next[bucket(values[i])];
            // Sequential prefetch is fast; the scattered stores would stall on each cache line.
            __builtin_prefetch(&scratch[i], 1);
        }
        std::uint32_t begin = 0;
        for (std::uint32_t& count : next) {
            const std::uint32_t size = count;
            count = begin;
            begin += size;
        }
        for (const std::uint64_t value : values) {
            scratch[next[bucket(value)]++] = value;
        }
        values.swap(scratch);
    }
}

}  // namespace

void CommandOrder::sort_pieces() {
    constexpr std::size_t kFew = 256;
    order_.clear();
    if (pieces_.size() < kFew) {
        for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
            order_.push_back(i);
        }
        std::sort(order_.begin(), order_.end(), [this](std::uint64_t a, std::uint64_t b) {
            return pieces_[a].begin() != pieces_[b].begin()
                       ? pieces_[a].begin() < pieces_[b].begin()
                       : a < b;
        });
        return;
    }
    // Global row indices over all archetypes fit into 32 bits; the entities to create come last.
    first_rows_.clear();
    std::uint32_t rows = 0;
    for (const auto& archetype : core_.archetypes) {
        first_rows_.push_back(rows);
        rows += archetype->size();
    }
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
        const Piece& piece = pieces_[i];
        const std::uint32_t base =
            piece.archetype == kNoArchetype ? rows : first_rows_[piece.archetype];
        order_.push_back(std::uint64_t{base + piece.row} << 32 | i);
    }
    radix_sort(order_, order_scratch_, rows + static_cast<std::uint32_t>(list_->created.size()));
}

void CommandOrder::arrange(ChangePlans& plans, ChangeList& list, FlushStats& stats) {
    plans_ = &plans;
    list_ = &list;
    stats.commands += runs_.empty() ? 0 : runs_.back().key + runs_.back().commands.count;
    list.created.swap(created_);
    if (!is_sorted_) {
        sort_pieces();
    }
    list.reserve(pieces_.size());
    constexpr std::size_t kAhead = 16;
    const ChangePlan* plan = nullptr;
    CommandKind kind{};
    std::uint32_t archetype = 0;
    for (std::size_t at = 0; at < pieces_.size();) {
        if (!is_sorted_ && at + kAhead < pieces_.size()) {
            __builtin_prefetch(&piece(at + kAhead));
        }
        const Piece& first = piece(at);
        if (!is_sorted_ && at + 1 < pieces_.size() && piece(at + 1).begin() < first.end()) {
            at = fold_overlap(at, stats);
            continue;
        }
        const Run& run = runs_[first.run];
        if (plan == nullptr || first.archetype != archetype || run.commands.kind != kind) {
            kind = run.commands.kind;
            archetype = first.archetype;
            plan = &plans.find(source_of(first), {&kind, 1});
        }
        std::byte* const record =
            run.commands.records + std::size_t{first.first} * kind.layout->stride;
        list.add(plans, *plan, {first.row, first.count}, {&record, 1}, run.key + first.first);
        ++at;
    }
}

Archetype* CommandOrder::source_of(const Piece& piece) const {
    return piece.archetype == kNoArchetype ? nullptr : core_.archetypes[piece.archetype].get();
}

/// Sweeps over the rows where a piece begins or ends: between two of these, all rows have the same
/// commands.
std::size_t CommandOrder::fold_overlap(std::size_t at, FlushStats& stats) {
    active_.clear();
    std::uint64_t begin = piece(at).begin();
    while (true) {
        while (at < pieces_.size() && piece(at).begin() == begin) {
            // Keep command order; pieces that begin at the same row already are.
            const auto index = static_cast<std::uint32_t>(&piece(at) - pieces_.data());
            active_.insert(std::upper_bound(active_.begin(), active_.end(), index), index);
            ++at;
        }
        if (active_.empty()) {
            return at;
        }
        std::uint64_t end = at < pieces_.size() ? piece(at).begin() : ~std::uint64_t{0};
        for (const std::uint32_t index : active_) {
            end = std::min(end, pieces_[index].end());
        }
        emit(begin, end);
        stats.entities_folded += active_.size() > 1 ? end - begin : 0;
        std::erase_if(active_, [&](std::uint32_t index) { return pieces_[index].end() == end; });
        begin = end;
    }
}

/// Emits the rows from `begin` to `end`, which have the commands of all active pieces.
void CommandOrder::emit(std::uint64_t begin, std::uint64_t end) {
    kinds_.clear();
    records_.clear();
    for (const std::uint32_t index : active_) {
        const Piece& piece = pieces_[index];
        const CommandRun& run = runs_[piece.run].commands;
        const std::uint64_t first = piece.first + (begin - piece.begin());
        kinds_.push_back(run.kind);
        records_.push_back(run.records + first * run.kind.layout->stride);
    }
    const Piece& first = pieces_[active_.front()];
    const std::uint32_t key =
        runs_[first.run].key + first.first + static_cast<std::uint32_t>(begin - first.begin());
    list_->add(
        *plans_, plans_->find(source_of(first), kinds_),
        {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)}, records_,
        key);
}

}  // namespace limn
