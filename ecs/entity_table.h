#pragma once

#include "ecs/column.h"
#include "ecs/entity.h"

#include <cstdint>
#include <vector>

namespace limn {

// Which handle is alive, and where its row is. A slot is 12 bytes in memory that never moves. Free
// slots wait in a queue, first freed first used, and none is used again before kReuseDistance
// others are free: a stale handle that somebody kept meets its successor as late as possible.
// Generations differ all the same, so that such a handle is found out, never mistaken.

inline constexpr std::uint32_t kNoArchetype = 0xffffffffu;
/// Generations stay below this bit; handles above it are placeholders of Commands.
inline constexpr std::uint32_t kPlaceholderBit = 0x80000000u;

struct EntitySlot {
    std::uint32_t generation;
    std::uint32_t archetype;  ///< index of the archetype, or kNoArchetype: the slot is free
    std::uint32_t row;        ///< in the archetype; of a free slot, the next free slot
};
static_assert(sizeof(EntitySlot) == 12);

/// Everything a snapshot needs to give out the same handles later.
struct EntityTableImage {
    std::vector<std::uint32_t> generations;  ///< of every slot
    std::vector<std::uint32_t> free_slots;   ///< in the order of reuse
};

class EntityTable {
  public:
    static constexpr std::uint32_t kMaxEntities = 1u << 28;
    static constexpr std::uint32_t kReuseDistance = 1024;

    EntityTable();

    /// A new handle. Its slot says kNoArchetype until place().
    [[nodiscard]] Entity allocate();
    void free(Entity entity);
    void place(Entity entity, std::uint32_t archetype, std::uint32_t row) {
        EntitySlot& slot = slots_[entity.index];
        slot.archetype = archetype;
        slot.row = row;
    }

    /// nullptr: the handle is stale or null.
    [[nodiscard]] const EntitySlot* find(Entity entity) const {
        if (entity.index >= slot_count_) {
            return nullptr;
        }
        const EntitySlot& slot = slots_[entity.index];
        return slot.generation == entity.generation && slot.archetype != kNoArchetype ? &slot
                                                                                      : nullptr;
    }

    [[nodiscard]] std::uint32_t slot_count() const { return slot_count_; }
    [[nodiscard]] std::uint32_t free_count() const { return free_count_; }
    [[nodiscard]] const EntitySlot& slot(std::uint32_t index) const { return slots_[index]; }
    [[nodiscard]] std::size_t committed() const { return range_.committed(); }

    [[nodiscard]] EntityTableImage image() const;
    /// All slots as in `image`, none of them placed.
    void restore(const EntityTableImage& image);

  private:
    static constexpr std::uint32_t kEnd = 0xffffffffu;

    EntitySlot* slots_ = nullptr;
    std::uint32_t slot_count_ = 0;
    std::uint32_t free_count_ = 0;
    std::uint32_t first_free_ = kEnd;
    std::uint32_t last_free_ = kEnd;
    VirtualRange range_;
};

}  // namespace limn
