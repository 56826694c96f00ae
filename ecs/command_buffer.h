#pragma once

#include "ecs/entity.h"
#include "ecs/record_layout.h"
#include "ecs/task_scope.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace limn {

class World;

// Stores Commands until a sync point. Every recording thread has its own stream in the buffer. A
// stream is a list of runs: consecutive commands of one kind, their entities in one array, their
// values in another; recording a command appends to both. A stream is divided into segments, each
// tagged with the point in the system where it was recorded (task_scope.h). Sorted by that, the
// segments of all streams are what a single thread would have recorded.

enum class CommandOp : std::uint8_t { Create, Destroy, Add, Set, Remove, Enable, Disable };

/// What a command does, apart from the entity and the values.
struct CommandKind {
    const RecordLayout* layout;
    CommandOp op;
    bool operator==(const CommandKind&) const = default;
};

struct CommandRun {
    CommandKind kind;
    std::uint32_t count;
    Entity* entities;
    std::byte* records;  ///< layout->stride apart
};

/// Linear allocator, freed all at once. Grows by doubling; reset() merges several blocks into one.
class CommandArena {
  public:
    /// The contiguous free memory, at least `size` bytes, aligned to `align`.
    [[nodiscard]] std::span<std::byte> free_piece(std::size_t size, std::size_t align);
    /// Allocates the part of the free piece before `end`.
    void take_until(const std::byte* end);
    /// Frees everything, keeping the memory.
    void reset();
    [[nodiscard]] std::size_t bytes() const;

  private:
    static constexpr std::size_t kFirstBlock = 4096;
    struct Block {
        std::unique_ptr<std::byte[]> data;
        std::size_t size;
    };
    void add_block(std::size_t bytes);

    std::vector<Block> blocks_;
    std::size_t block_ = 0;
    std::size_t used_ = 0;  ///< of the current block
};

struct CommandSegment {
    TaskScope scope;
    std::uint32_t first_run;  ///< the segment ends where the next one begins
};

class CommandStream {
  public:
    CommandStream(std::uint64_t of_thread, std::uint32_t position)
        : thread(of_thread), number(position) {}

    /// Appends a command; returns memory for its values.
    std::byte* record(CommandKind kind, Entity entity) {
        const TaskScope task = current_task;
        if (kind != open_.kind || task.sequence != scope_.sequence || task.chunk != scope_.chunk
            || open_.count == limit_) {
            open_run(kind, task);
        }
        const std::uint32_t index = open_.count++;
        open_.entities[index] = entity;
        return open_.records + std::size_t{index} * kind.layout->stride;
    }
    /// Completes the list of runs.
    void close_run();
    void reset();
    [[nodiscard]] bool empty() const { return open_.count == 0 && runs.empty(); }
    /// Number of commands.
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] std::size_t bytes() const;

    const std::uint64_t thread;
    const std::uint32_t number;  ///< index in the buffer
    std::uint32_t created = 0;   ///< placeholders handed out
    std::vector<CommandRun> runs;
    std::vector<CommandSegment> segments;

  private:
    void open_run(CommandKind kind, TaskScope task);

    CommandRun open_ = {};
    std::uint32_t limit_ = 0;  ///< capacity of open_
    TaskScope scope_;          ///< of the last segment
    CommandArena entities_;
    CommandArena values_;
};

/// The stream that this thread last recorded into.
struct StreamCache {
    std::uint64_t buffer = 0;
    CommandStream* stream = nullptr;
};
inline constinit thread_local StreamCache stream_cache;

class CommandBuffer {
  public:
    CommandBuffer();
    CommandBuffer(const CommandBuffer&) = delete;
    CommandBuffer& operator=(const CommandBuffer&) = delete;
    ~CommandBuffer();

    /// Returns a placeholder for a future entity; sets `values` to the memory for its components.
    [[nodiscard]] Entity create(const RecordLayout& layout, std::byte*& values) {
        CommandStream& target = stream();
        const Entity entity{target.created++, placeholder_generation(target)};
        values = target.record({&layout, CommandOp::Create}, entity);
        return entity;
    }
    /// Returns the memory where the caller must construct the values of the layout.
    std::byte* record(CommandOp op, Entity entity, const RecordLayout& layout) {
        return stream().record({&layout, op}, entity);
    }

    [[nodiscard]] bool empty() const;
    /// Number of recorded commands.
    [[nodiscard]] std::size_t size() const;
    /// Drops all commands and destroys their values.
    void discard();
    [[nodiscard]] std::size_t bytes() const;

  private:
    friend class CommandFlush;
    friend class CommandOrder;

    static constexpr std::uint32_t kStreamBits = 8;
    static constexpr std::uint32_t kPlaceholder = 0x80000000u;

    [[nodiscard]] CommandStream& stream() {
        return stream_cache.buffer == id_ ? *stream_cache.stream : find_stream();
    }
    [[nodiscard]] CommandStream& find_stream();
    [[nodiscard]] std::uint32_t placeholder_generation(const CommandStream& stream) const {
        return kPlaceholder | (tag_ << kStreamBits) | stream.number;
    }
    /// The stream that created the placeholder; nullptr if it is from another recording.
    [[nodiscard]] const CommandStream* stream_of(Entity placeholder) const;
    void close_runs();
    /// The values must have been moved out or destroyed.
    void reset();

    std::uint64_t id_;   ///< unique, so that threads recognize the buffer they last recorded into
    std::uint32_t tag_;  ///< distinguishes placeholders of different recordings
    std::vector<std::unique_ptr<CommandStream>> streams_;
    std::mutex mutex_;  ///< protects streams_
};

/// Destroys the values of one record.
void destroy_record(const RecordLayout& layout, std::byte* record);

/// A sync point: applies all commands of the buffers, in order, and empties them.
void apply_commands(World& world, std::span<CommandBuffer* const> buffers);

}  // namespace limn
