#include "ecs/command_buffer.h"

#include "ecs/base/check.h"
#include "ecs/commands.h"
#include "ecs/entity_table.h"

#include <algorithm>
#include <atomic>

namespace limn {

namespace {

constexpr std::uint32_t kMaxRunLength = 1u << 30;

std::atomic<std::uint64_t> next_id = 1;
std::atomic<std::uint32_t> next_tag = 0;

std::uint64_t thread_id() {
    static std::atomic<std::uint64_t> next = 1;
    thread_local const std::uint64_t id = next.fetch_add(1, std::memory_order_relaxed);
    return id;
}

}  // namespace

// ---- arena
// ---------------------------------------------------------------------------------------

std::span<std::byte> CommandArena::free_piece(std::size_t size, std::size_t align) {
    for (; block_ < blocks_.size(); ++block_, used_ = 0) {
        const Block& block = blocks_[block_];
        const std::size_t address = reinterpret_cast<std::size_t>(block.data.get()) + used_;
        const std::size_t start = used_ + (align - address % align) % align;
        if (start + size <= block.size) {
            return {block.data.get() + start, block.size - start};
        }
    }
    const std::size_t last = blocks_.empty() ? kFirstBlock / 2 : blocks_.back().size;
    add_block(std::max(2 * last, size + align));
    return free_piece(size, align);
}

void CommandArena::take_until(const std::byte* end) {
    used_ = static_cast<std::size_t>(end - blocks_[block_].data.get());
}

void CommandArena::add_block(std::size_t bytes) {
    blocks_.push_back({std::make_unique_for_overwrite<std::byte[]>(bytes), bytes});
}

void CommandArena::reset() {
    if (block_ > 0) {
        const std::size_t total = bytes();
        blocks_.clear();
        add_block(total);
    }
    block_ = 0;
    used_ = 0;
}

std::size_t CommandArena::bytes() const {
    std::size_t total = 0;
    for (const Block& block : blocks_) {
        total += block.size;
    }
    return total;
}

// ---- stream
// --------------------------------------------------------------------------------------

void CommandStream::open_run(CommandKind kind, TaskScope task) {
    close_run();
    if (segments.empty() || task.sequence != scope_.sequence || task.chunk != scope_.chunk) {
        segments.push_back({task, static_cast<std::uint32_t>(runs.size())});
        scope_ = task;
    }
    const std::span<std::byte> room = entities_.free_piece(sizeof(Entity), alignof(Entity));
    std::size_t limit = std::min<std::size_t>(room.size() / sizeof(Entity), kMaxRunLength);
    open_ = {kind, 0, reinterpret_cast<Entity*>(room.data()), nullptr};
    if (const std::size_t stride = kind.layout->stride; stride > 0) {
        const std::span<std::byte> values = values_.free_piece(stride, kind.layout->align);
        open_.records = values.data();
        limit = std::min(limit, values.size() / stride);
    }
    limit_ = static_cast<std::uint32_t>(limit);
}

void CommandStream::close_run() {
    if (open_.count > 0) {
        entities_.take_until(reinterpret_cast<const std::byte*>(open_.entities + open_.count));
        if (const std::size_t stride = open_.kind.layout->stride; stride > 0) {
            values_.take_until(open_.records + open_.count * stride);
        }
        runs.push_back(open_);
    }
    open_ = {};
    limit_ = 0;
}

void CommandStream::reset() {
    open_ = {};
    limit_ = 0;
    scope_ = {};
    created = 0;
    runs.clear();
    segments.clear();
    entities_.reset();
    values_.reset();
}

std::size_t CommandStream::size() const {
    std::size_t total = open_.count;
    for (const CommandRun& run : runs) {
        total += run.count;
    }
    return total;
}

std::size_t CommandStream::bytes() const {
    return entities_.bytes() + values_.bytes() + runs.capacity() * sizeof(CommandRun)
           + segments.capacity() * sizeof(CommandSegment);
}

void destroy_record(const RecordLayout& layout, std::byte* record) {
    if (layout.stride == 0) {
        return;
    }
    for (std::uint32_t i = 0; i < layout.size; ++i) {
        const ComponentInfo& info = component_info(layout.id(i));
        if (!info.is_tag && !info.trivially_destructible) {
            info.ops.destroy(record + layout.offsets[i], 1);
        }
    }
}

// ---- buffer
// --------------------------------------------------------------------------------------

CommandBuffer::CommandBuffer()
    : id_(next_id.fetch_add(1, std::memory_order_relaxed)),
      tag_(next_tag.fetch_add(1, std::memory_order_relaxed) % (kPlaceholder >> kStreamBits)) {
    static_assert(kPlaceholder == kPlaceholderBit);
}

CommandBuffer::~CommandBuffer() {
    discard();
}

CommandStream& CommandBuffer::find_stream() {
    const std::uint64_t thread = thread_id();
    const std::lock_guard lock(mutex_);
    for (const auto& stream : streams_) {
        if (stream->thread == thread) {
            stream_cache = {id_, stream.get()};
            return *stream;
        }
    }
    LIMN_CHECK_NOTE(
        streams_.size() < std::size_t{1} << kStreamBits, "too many threads record commands");
    streams_.push_back(
        std::make_unique<CommandStream>(thread, static_cast<std::uint32_t>(streams_.size())));
    stream_cache = {id_, streams_.back().get()};
    return *streams_.back();
}

const CommandStream* CommandBuffer::stream_of(Entity placeholder) const {
    const std::uint32_t number = placeholder.generation & ((1u << kStreamBits) - 1);
    if (number >= streams_.size()) {
        return nullptr;
    }
    const CommandStream& stream = *streams_[number];
    return placeholder.generation == placeholder_generation(stream)
                   && placeholder.index < stream.created
               ? &stream
               : nullptr;
}

bool CommandBuffer::empty() const {
    return std::all_of(
        streams_.begin(), streams_.end(), [](const auto& stream) { return stream->empty(); });
}

std::size_t CommandBuffer::size() const {
    std::size_t total = 0;
    for (const auto& stream : streams_) {
        total += stream->size();
    }
    return total;
}

void CommandBuffer::close_runs() {
    for (const auto& stream : streams_) {
        stream->close_run();
    }
}

void CommandBuffer::discard() {
    close_runs();
    for (const auto& stream : streams_) {
        for (const CommandRun& run : stream->runs) {
            for (std::uint32_t i = 0; i < run.count; ++i) {
                destroy_record(
                    *run.kind.layout, run.records + std::size_t{i} * run.kind.layout->stride);
            }
        }
    }
    reset();
}

void CommandBuffer::reset() {
    tag_ = next_tag.fetch_add(1, std::memory_order_relaxed) % (kPlaceholder >> kStreamBits);
    if (streams_.size() > (std::size_t{1} << kStreamBits) / 2) {
        // Many threads have come and gone: drop all streams, most of which are dead.
        streams_.clear();
        id_ = next_id.fetch_add(1, std::memory_order_relaxed);
    }
    for (const auto& stream : streams_) {
        stream->reset();
    }
}

std::size_t CommandBuffer::bytes() const {
    std::size_t total = 0;
    for (const auto& stream : streams_) {
        total += stream->bytes();
    }
    return total;
}

// ---- without types
// -------------------------------------------------------------------------------

void Commands::add_default(Entity entity, ComponentId id) const {
    const ComponentInfo& info = component_info(id);
    LIMN_CHECK_NOTE(info.ops.construct_default != nullptr, info.name.c_str());
    std::byte* room = buffer_->record(CommandOp::Add, entity, record_layout_of(id));
    if (!info.is_tag) {
        info.ops.construct_default(room, 1);
    }
}

void Commands::add_copy(Entity entity, ComponentId id, const void* value) const {
    const ComponentInfo& info = component_info(id);
    LIMN_CHECK_NOTE(info.ops.construct_copy != nullptr, info.name.c_str());
    std::byte* room = buffer_->record(CommandOp::Add, entity, record_layout_of(id));
    if (!info.is_tag) {
        info.ops.construct_copy(room, value, 1);
    }
}

void Commands::remove(Entity entity, ComponentId id) const {
    buffer_->record(CommandOp::Remove, entity, key_layout_of(id));
}

void Commands::set_enabled(Entity entity, ComponentId id, bool enabled) const {
    buffer_->record(enabled ? CommandOp::Enable : CommandOp::Disable, entity, key_layout_of(id));
}

}  // namespace limn
