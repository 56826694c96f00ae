#pragma once

#include "ecs/change_list.h"
#include "ecs/change_plan.h"
#include "ecs/command_order.h"

#include <cstdint>
#include <span>

namespace limn {

class World;

/// Applies commands. A world keeps one, whose lists reach their final size after a few frames, so
/// that a sync point then allocates nothing.
class CommandFlush {
  public:
    explicit CommandFlush(World& world);

    void run(std::span<CommandBuffer* const> buffers);
    /// Applies one command to all the rows, which must ascend; they share the values in `record`.
    void run(CommandKind kind, std::byte* record, std::span<const ArchetypeRows> rows);

  private:
    World& world_;
    CommandOrder order_;
    ChangePlans plans_;
    ChangeList list_;
    ChangeApplier applier_;
};

}  // namespace limn
