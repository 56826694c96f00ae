#pragma once

#include "ecs/change_list.h"
#include "ecs/change_plan.h"
#include "ecs/command_order.h"

#include <cstdint>
#include <span>

namespace limn {

class World;

/// Applies commands. A world keeps one, whose lists have grown to their size after a few frames;
/// then a sync point allocates nothing.
class CommandFlush {
  public:
    explicit CommandFlush(World& world);

    void run(std::span<CommandBuffer* const> buffers);
    /// One command for all the rows, which ascend; `record` has the values for all of them.
    void run(CommandKind kind, std::byte* record, std::span<const ArchetypeRows> rows);

  private:
    World& world_;
    CommandOrder order_;
    ChangePlans plans_;
    ChangeList list_;
    ChangeApplier applier_;
};

}  // namespace limn
