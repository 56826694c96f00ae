#pragma once

#include "ecs/entity.h"
#include "ecs/reflect.h"
#include "ecs/task_scope.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace limn {

class World;

// Where Commands are kept until a sync point. Every thread that records has a stream of its own in
// the buffer; a stream is cut into segments, each with the place in the system where it was
// recorded (task_scope.h). Sorted by that, the segments of all streams are what a single thread
// would have recorded.

enum class CommandOp : std::uint8_t { Create, Destroy, Add, Set, Remove, Enable, Disable };

struct Command {
    Entity entity;
    void* value;  ///< of Add and Set; null for tags
    ComponentId component;
    CommandOp op;
};

/// Memory that is given out in pieces and taken back all at once. Grows by doubling.
class CommandArena {
  public:
    [[nodiscard]] void* allocate(std::size_t size, std::size_t align);
    /// All pieces are free again; the memory is kept.
    void reset();
    [[nodiscard]] std::size_t bytes() const;

  private:
    static constexpr std::size_t kFirstBlock = 4096;
    struct Block {
        std::unique_ptr<std::byte[]> data;
        std::size_t size;
    };
    std::vector<Block> blocks_;
    std::size_t block_ = 0;
    std::size_t used_ = 0;  ///< of the current block
};

struct CommandSegment {
    std::uint32_t sequence;
    std::uint32_t chunk;
    std::uint32_t begin;  ///< index of the first command; it ends where the next segment begins
};

struct CommandStream {
    std::uint64_t thread = 0;
    std::uint32_t number = 0;   ///< in the buffer
    std::uint32_t created = 0;  ///< placeholders given out
    std::vector<Command> commands;
    std::vector<CommandSegment> segments;
    CommandArena values;
};

class CommandBuffer {
  public:
    CommandBuffer();
    CommandBuffer(const CommandBuffer&) = delete;
    CommandBuffer& operator=(const CommandBuffer&) = delete;
    ~CommandBuffer();

    /// A placeholder for an entity to come.
    [[nodiscard]] Entity create();
    /// Room for the value, if it has a size: the caller constructs it.
    void* record(
        CommandOp op, Entity entity, ComponentId id, std::size_t size = 0, std::size_t align = 1);

    [[nodiscard]] bool empty() const;
    /// Forgets everything, values included.
    void discard();
    [[nodiscard]] std::size_t bytes() const;

  private:
    friend class CommandFlush;

    [[nodiscard]] CommandStream& stream();
    [[nodiscard]] CommandStream& find_stream();
    [[nodiscard]] std::uint32_t placeholder_generation(const CommandStream& stream) const;
    /// After the values have been moved away or destroyed.
    void reset();

    std::uint64_t id_;   ///< unique, so that threads recognize the buffer they last recorded into
    std::uint32_t tag_;  ///< tells placeholders of different recordings apart
    std::vector<std::unique_ptr<CommandStream>> streams_;
    std::mutex mutex_;  ///< of streams_
};

/// The sync point: applies everything recorded in the buffers, in their order, and empties them.
void apply_commands(World& world, std::span<CommandBuffer* const> buffers);

}  // namespace limn
