#include "ecs/entity_table.h"

#include "ecs/base/check.h"

// Techniques: engine.render-object

namespace limn {

EntityTable::EntityTable() : range_(std::size_t{kMaxEntities} * kSlotBytes, skew_of(99)) {
    slots_ = range_.data();
}

Entity EntityTable::allocate_new() {
    LIMN_CHECK_NOTE(slot_count_ < kMaxEntities, "too many entities");
    const std::uint32_t index = slot_count_++;
    range_.commit(std::size_t{slot_count_} * kSlotBytes);
    set_free(index, 1, kEnd);
    return {index, 1};
}

void EntityTable::allocate(std::span<Entity> entities) {
    for (Entity& entity : entities) {
        entity = allocate();
    }
}

void EntityTable::free(std::span<const Entity> entities) {
    for (std::size_t i = 0; i < entities.size(); ++i) {
        if (i + kPrefetch < entities.size()) {
            prefetch(entities[i + kPrefetch]);
        }
        free(entities[i]);
    }
}

void EntityTable::set_location(
    std::span<const Entity> entities, std::uint32_t archetype, std::uint32_t first_row) {
    for (std::size_t i = 0; i < entities.size(); ++i) {
        if (i + kPrefetch < entities.size()) {
            prefetch(entities[i + kPrefetch]);
        }
        set_location(entities[i], archetype, first_row + static_cast<std::uint32_t>(i));
    }
}

EntityTableImage EntityTable::image() const {
    EntityTableImage image;
    image.generations.reserve(slot_count_);
    for (std::uint32_t i = 0; i < slot_count_; ++i) {
        image.generations.push_back(slot_at(i).generation());
    }
    image.free_slots.reserve(free_count_);
    std::uint32_t index = first_free_;
    for (std::uint32_t i = 0; i < free_count_; ++i) {
        image.free_slots.push_back(index);
        index = slot_at(index).low();
    }
    return image;
}

void EntityTable::restore(const EntityTableImage& image) {
    LIMN_CHECK(image.generations.size() <= kMaxEntities);
    LIMN_CHECK(image.free_slots.size() <= image.generations.size());
    slot_count_ = static_cast<std::uint32_t>(image.generations.size());
    range_.commit(std::size_t{slot_count_} * kSlotBytes);
    for (std::uint32_t i = 0; i < slot_count_; ++i) {
        set_free(i, image.generations[i], kEnd);
    }
    free_count_ = static_cast<std::uint32_t>(image.free_slots.size());
    first_free_ = free_count_ > 0 ? image.free_slots.front() : kEnd;
    last_free_ = free_count_ > 0 ? image.free_slots.back() : kEnd;
    for (std::uint32_t i = 0; i + 1 < free_count_; ++i) {
        LIMN_CHECK(image.free_slots[i] < slot_count_);
        slot_at(image.free_slots[i]).set_low(image.free_slots[i + 1]);
    }
    LIMN_CHECK(last_free_ == kEnd || last_free_ < slot_count_);
}

}  // namespace limn
