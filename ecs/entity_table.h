#pragma once

#include "ecs/column.h"
#include "ecs/entity.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace limn {

// Maps handles to rows and tracks which are alive. A slot is 10 bytes in memory that never moves:
// the generation, and archetype and row packed into the other six. Free slots wait in a FIFO, and
// none is reused before kReuseDistance others are free, so that stale handles meet a reused slot as
// late as possible. Even then the generation differs, so a stale handle is always detected.

inline constexpr std::uint32_t kNoArchetype = 0xffffffffu;
/// Set in the generation of Commands placeholders only.
inline constexpr std::uint32_t kPlaceholderBit = 0x80000000u;
/// Limits of what a slot can store.
inline constexpr std::uint32_t kMaxArchetypes = 0xffffu << 6;
inline constexpr std::uint32_t kMaxRowsOfSlot = 1u << 26;

/// Location of the row of an entity.
struct EntityLocation {
    std::uint32_t archetype = kNoArchetype;
    std::uint32_t row = 0;

    /// False if the handle was stale or null.
    [[nodiscard]] explicit operator bool() const { return archetype != kNoArchetype; }
};

/// What a snapshot needs to allocate the same handles later.
struct EntityTableImage {
    std::vector<std::uint32_t> generations;  ///< per slot
    std::vector<std::uint32_t> free_slots;   ///< in the order of reuse
};

class EntityTable {
  public:
    static constexpr std::uint32_t kMaxEntities = 1u << 28;
    static constexpr std::uint32_t kReuseDistance = 1024;
    /// How many entities ahead loops in random order prefetch slots.
    static constexpr std::size_t kPrefetch = 16;

    EntityTable();

    /// A new handle; find() fails until set_location() is called.
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
            // Generations exhausted: retire the slot. No handle has generation 0.
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
    /// Frees the entities in this order.
    void free(std::span<const Entity> entities);
    void set_location(Entity entity, std::uint32_t archetype, std::uint32_t row) {
        Slot slot = slot_at(entity.index);
        slot.set_low(archetype << kRowBits | row);
        slot.set_high(static_cast<std::uint16_t>(archetype >> (32 - kRowBits)));
    }

    /// Locates the entities in consecutive rows.
    void set_location(
        std::span<const Entity> entities, std::uint32_t archetype, std::uint32_t first_row);

    [[nodiscard]] EntityLocation find(Entity entity) const {
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

    /// Prefetches the slot for find().
    void prefetch(Entity entity) const {
        if (entity.index < slot_count_) {
            __builtin_prefetch(slots_ + std::size_t{entity.index} * kSlotBytes);
        }
    }

    [[nodiscard]] std::uint32_t slot_count() const { return slot_count_; }
    [[nodiscard]] std::uint32_t free_count() const { return free_count_; }
    [[nodiscard]] std::size_t committed() const { return range_.committed(); }

    [[nodiscard]] EntityTableImage image() const;
    /// Restores all slots from `image`, none of them with a row.
    void restore(const EntityTableImage& image);

  private:
    static constexpr std::uint32_t kEnd = 0xffffffffu;
    static constexpr int kRowBits = 26;
    static constexpr std::uint16_t kFree = 0xffff;  ///< high(): no row; low() is the next free slot
    static constexpr std::size_t kSlotBytes = 10;

    /// Each of the three fields is read and written with one access of the same width, so that
    /// store-to-load forwarding works.
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
