#pragma once

#include "ecs/column.h"
#include "ecs/entity.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace limn {

// Which handle is alive, and where its row is. A slot is 10 bytes in memory that never moves: the
// generation, and archetype and row packed into the other six. Free slots wait in a queue, first
// freed first used, and none is used again before kReuseDistance others are free: a stale handle
// that somebody kept meets its successor as late as possible. Generations differ all the same, so
// that such a handle is found out, never mistaken.

inline constexpr std::uint32_t kNoArchetype = 0xffffffffu;
/// Generations stay below this bit; handles above it are placeholders of Commands.
inline constexpr std::uint32_t kPlaceholderBit = 0x80000000u;
/// What a slot has room for.
inline constexpr std::uint32_t kMaxArchetypes = 0xffffu << 6;
inline constexpr std::uint32_t kMaxRowsOfSlot = 1u << 26;

/// Where the row of an entity is.
struct EntityPlace {
    std::uint32_t archetype = kNoArchetype;
    std::uint32_t row = 0;

    /// False: the handle was stale or null.
    [[nodiscard]] explicit operator bool() const { return archetype != kNoArchetype; }
};

/// Everything a snapshot needs to give out the same handles later.
struct EntityTableImage {
    std::vector<std::uint32_t> generations;  ///< of every slot
    std::vector<std::uint32_t> free_slots;   ///< in the order of reuse
};

class EntityTable {
  public:
    static constexpr std::uint32_t kMaxEntities = 1u << 28;
    static constexpr std::uint32_t kReuseDistance = 1024;
    /// How far ahead loops over entities in any order prefetch their slots.
    static constexpr std::size_t kPrefetch = 16;

    EntityTable();

    /// A new handle, which find() does not know before place().
    [[nodiscard]] Entity allocate() {
        if (free_count_ <= kReuseDistance) {
            return allocate_new();
        }
        const std::uint32_t index = first_free_;
        const Slot slot = slot_at(index);
        first_free_ = slot.low();
        --free_count_;
        return {index, slot.generation()};
    }
    void free(Entity entity) {
        const std::uint32_t generation = entity.generation + 1;
        if (generation == kPlaceholderBit) {
            // Worn out: no handle has generation 0, and the slot is not used again.
            set_free(entity.index, 0, kEnd);
            return;
        }
        set_free(entity.index, generation, kEnd);
        if (free_count_++ == 0) {
            first_free_ = entity.index;
        } else {
            slot_at(last_free_).set_low(entity.index);
        }
        last_free_ = entity.index;
    }
    void allocate(std::span<Entity> entities);
    /// In this order.
    void free(std::span<const Entity> entities);
    void place(Entity entity, std::uint32_t archetype, std::uint32_t row) {
        Slot slot = slot_at(entity.index);
        slot.set_low(archetype << kRowBits | row);
        slot.set_high(static_cast<std::uint16_t>(archetype >> (32 - kRowBits)));
    }

    /// In neighboring rows.
    void place(std::span<const Entity> entities, std::uint32_t archetype, std::uint32_t first_row);

    [[nodiscard]] EntityPlace find(Entity entity) const {
        if (entity.index >= slot_count_) {
            return {};
        }
        const Slot slot = slot_at(entity.index);
        if (slot.generation() != entity.generation || slot.high() == kFree) {
            return {};
        }
        const std::uint32_t low = slot.low();
        return {
            std::uint32_t{slot.high()} << (32 - kRowBits) | low >> kRowBits,
            low & (kMaxRowsOfSlot - 1)};
    }

    /// Says that find() will follow soon.
    void prefetch(Entity entity) const {
        if (entity.index < slot_count_) {
            __builtin_prefetch(slots_ + std::size_t{entity.index} * kSlotBytes);
        }
    }

    [[nodiscard]] std::uint32_t slot_count() const { return slot_count_; }
    [[nodiscard]] std::uint32_t free_count() const { return free_count_; }
    [[nodiscard]] std::size_t committed() const { return range_.committed(); }

    [[nodiscard]] EntityTableImage image() const;
    /// All slots as in `image`, none of them placed.
    void restore(const EntityTableImage& image);

  private:
    static constexpr std::uint32_t kEnd = 0xffffffffu;
    static constexpr int kRowBits = 26;
    static constexpr std::uint16_t kFree = 0xffff;  ///< as high part: no row; low is the next slot
    static constexpr std::size_t kSlotBytes = 10;

    /// Three fields read and written each in one piece, so that a read soon after a write need not
    /// wait for the cache.
    class Slot {
      public:
        explicit Slot(std::byte* bytes) : bytes_(bytes) {}
        [[nodiscard]] std::uint32_t generation() const { return load<std::uint32_t>(0); }
        /// The row, and above it the low bits of the archetype.
        [[nodiscard]] std::uint32_t low() const { return load<std::uint32_t>(4); }
        /// The high bits of the archetype.
        [[nodiscard]] std::uint16_t high() const { return load<std::uint16_t>(8); }
        void set_generation(std::uint32_t value) { std::memcpy(bytes_, &value, sizeof(value)); }
        void set_low(std::uint32_t value) { std::memcpy(bytes_ + 4, &value, sizeof(value)); }
        void set_high(std::uint16_t value) { std::memcpy(bytes_ + 8, &value, sizeof(value)); }

      private:
        template <typename T>
        [[nodiscard]] T load(std::size_t offset) const {
            T value;
            std::memcpy(&value, bytes_ + offset, sizeof(value));
            return value;
        }
        std::byte* bytes_;
    };
    [[nodiscard]] Slot slot_at(std::uint32_t index) const {
        return Slot(slots_ + std::size_t{index} * kSlotBytes);
    }
    void set_free(std::uint32_t index, std::uint32_t generation, std::uint32_t next) {
        Slot slot = slot_at(index);
        slot.set_generation(generation);
        slot.set_low(next);
        slot.set_high(kFree);
    }
    [[nodiscard]] Entity allocate_new();

    std::byte* slots_ = nullptr;
    std::uint32_t slot_count_ = 0;
    std::uint32_t free_count_ = 0;
    std::uint32_t first_free_ = kEnd;
    std::uint32_t last_free_ = kEnd;
    VirtualRange range_;
};

}  // namespace limn
