#include "ecs/entity_table.h"

#include "ecs/base/check.h"

namespace limn {

EntityTable::EntityTable() : range_(std::size_t{kMaxEntities} * sizeof(EntitySlot)) {
    slots_ = reinterpret_cast<EntitySlot*>(range_.data());
}

Entity EntityTable::allocate() {
    if (free_count_ > kReuseDistance) {
        const std::uint32_t index = first_free_;
        first_free_ = slots_[index].row;
        --free_count_;
        return {index, slots_[index].generation};
    }
    LIMN_CHECK_NOTE(slot_count_ < kMaxEntities, "too many entities");
    const std::uint32_t index = slot_count_++;
    range_.commit(std::size_t{slot_count_} * sizeof(EntitySlot));
    slots_[index] = {1, kNoArchetype, kEnd};
    return {index, 1};
}

void EntityTable::free(Entity entity) {
    EntitySlot& slot = slots_[entity.index];
    slot.archetype = kNoArchetype;
    if (++slot.generation == kPlaceholderBit) {
        slot.generation =
            0;  // worn out: no handle has generation 0, and the slot is not used again
        return;
    }
    slot.row = kEnd;
    if (free_count_++ == 0) {
        first_free_ = entity.index;
    } else {
        slots_[last_free_].row = entity.index;
    }
    last_free_ = entity.index;
}

EntityTableImage EntityTable::image() const {
    EntityTableImage image;
    image.generations.reserve(slot_count_);
    for (std::uint32_t i = 0; i < slot_count_; ++i) {
        image.generations.push_back(slots_[i].generation);
    }
    image.free_slots.reserve(free_count_);
    std::uint32_t index = first_free_;
    for (std::uint32_t i = 0; i < free_count_; ++i) {
        image.free_slots.push_back(index);
        index = slots_[index].row;
    }
    return image;
}

void EntityTable::restore(const EntityTableImage& image) {
    LIMN_CHECK(image.generations.size() <= kMaxEntities);
    LIMN_CHECK(image.free_slots.size() <= image.generations.size());
    slot_count_ = static_cast<std::uint32_t>(image.generations.size());
    range_.commit(std::size_t{slot_count_} * sizeof(EntitySlot));
    for (std::uint32_t i = 0; i < slot_count_; ++i) {
        slots_[i] = {image.generations[i], kNoArchetype, kEnd};
    }
    free_count_ = static_cast<std::uint32_t>(image.free_slots.size());
    first_free_ = free_count_ > 0 ? image.free_slots.front() : kEnd;
    last_free_ = free_count_ > 0 ? image.free_slots.back() : kEnd;
    for (std::uint32_t i = 0; i + 1 < free_count_; ++i) {
        LIMN_CHECK(image.free_slots[i] < slot_count_);
        slots_[image.free_slots[i]].row = image.free_slots[i + 1];
    }
    LIMN_CHECK(last_free_ == kEnd || last_free_ < slot_count_);
}

}  // namespace limn
