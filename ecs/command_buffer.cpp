#include "ecs/command_buffer.h"

#include "ecs/base/check.h"
#include "ecs/commands.h"
#include "ecs/entity_table.h"

#include <algorithm>
#include <atomic>
#include <cstring>

namespace limn {

namespace {

constexpr std::uint32_t kStreamBits = 8;
constexpr std::uint32_t kTagMask = (kPlaceholderBit >> kStreamBits) - 1;
constexpr std::size_t kMaxStreams = std::size_t{1} << kStreamBits;

std::atomic<std::uint64_t> next_id = 1;
std::atomic<std::uint32_t> next_tag = 0;

std::uint64_t thread_id() {
    static std::atomic<std::uint64_t> next = 1;
    thread_local const std::uint64_t id = next.fetch_add(1, std::memory_order_relaxed);
    return id;
}

/// The stream this thread last recorded into.
struct StreamCache {
    std::uint64_t buffer = 0;
    CommandStream* stream = nullptr;
};
constinit thread_local StreamCache stream_cache;

void destroy_value(const Command& command) {
    if (command.value != nullptr) {
        component_info(command.component).ops.destroy(command.value, 1);
    }
}

}  // namespace

void* CommandArena::allocate(std::size_t size, std::size_t align) {
    for (; block_ < blocks_.size(); ++block_, used_ = 0) {
        const Block& block = blocks_[block_];
        const std::size_t address = reinterpret_cast<std::size_t>(block.data.get()) + used_;
        const std::size_t start = used_ + (align - address % align) % align;
        if (start + size <= block.size) {
            used_ = start + size;
            return block.data.get() + start;
        }
    }
    const std::size_t last = blocks_.empty() ? kFirstBlock / 2 : blocks_.back().size;
    const std::size_t bytes = std::max(2 * last, size + align);
    blocks_.push_back({std::make_unique_for_overwrite<std::byte[]>(bytes), bytes});
    used_ = 0;
    return allocate(size, align);
}

void CommandArena::reset() {
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

CommandBuffer::CommandBuffer()
    : id_(next_id.fetch_add(1, std::memory_order_relaxed)),
      tag_(next_tag.fetch_add(1, std::memory_order_relaxed) & kTagMask) {}

CommandBuffer::~CommandBuffer() {
    discard();
}

std::uint32_t CommandBuffer::placeholder_generation(const CommandStream& stream) const {
    return kPlaceholderBit | (tag_ << kStreamBits) | stream.number;
}

Entity CommandBuffer::create() {
    CommandStream& target = stream();
    const Entity entity{target.created++, placeholder_generation(target)};
    record(CommandOp::Create, entity, 0);
    return entity;
}

void* CommandBuffer::record(
    CommandOp op, Entity entity, ComponentId id, std::size_t size, std::size_t align) {
    CommandStream& target = stream();
    const TaskScope task = current_task;
    if (target.segments.empty() || target.segments.back().sequence != task.sequence
        || target.segments.back().chunk != task.chunk) {
        target.segments.push_back(
            {task.sequence, task.chunk, static_cast<std::uint32_t>(target.commands.size())});
    }
    void* value = size > 0 ? target.values.allocate(size, align) : nullptr;
    target.commands.push_back({entity, value, id, op});
    return value;
}

CommandStream& CommandBuffer::stream() {
    return stream_cache.buffer == id_ ? *stream_cache.stream : find_stream();
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
    LIMN_CHECK_NOTE(streams_.size() < kMaxStreams, "too many threads record commands");
    streams_.push_back(std::make_unique<CommandStream>());
    streams_.back()->thread = thread;
    streams_.back()->number = static_cast<std::uint32_t>(streams_.size() - 1);
    stream_cache = {id_, streams_.back().get()};
    return *streams_.back();
}

bool CommandBuffer::empty() const {
    return std::all_of(streams_.begin(), streams_.end(), [](const auto& stream) {
        return stream->commands.empty();
    });
}

void CommandBuffer::discard() {
    for (const auto& stream : streams_) {
        for (const Command& command : stream->commands) {
            destroy_value(command);
        }
    }
    reset();
}

void CommandBuffer::reset() {
    tag_ = next_tag.fetch_add(1, std::memory_order_relaxed) & kTagMask;
    if (streams_.size() > kMaxStreams / 2) {
        // Threads came and went; their streams are of no use to anybody.
        streams_.clear();
        id_ = next_id.fetch_add(1, std::memory_order_relaxed);
    }
    for (const auto& stream : streams_) {
        stream->created = 0;
        stream->commands.clear();
        stream->segments.clear();
        stream->values.reset();
    }
}

std::size_t CommandBuffer::bytes() const {
    std::size_t total = 0;
    for (const auto& stream : streams_) {
        total += stream->values.bytes() + stream->commands.capacity() * sizeof(Command);
    }
    return total;
}

void Commands::add_default(Entity entity, ComponentId id) const {
    const ComponentInfo& info = component_info(id);
    LIMN_CHECK_NOTE(info.ops.construct_default != nullptr, info.name.c_str());
    void* room = buffer_->record(CommandOp::Add, entity, id, info.size, info.align);
    if (room != nullptr) {
        info.ops.construct_default(room, 1);
    }
}

void Commands::add_copy(Entity entity, ComponentId id, const void* value) const {
    const ComponentInfo& info = component_info(id);
    LIMN_CHECK_NOTE(info.ops.construct_copy != nullptr, info.name.c_str());
    void* room = buffer_->record(CommandOp::Add, entity, id, info.size, info.align);
    if (room != nullptr) {
        info.ops.construct_copy(room, value, 1);
    }
}

}  // namespace limn
