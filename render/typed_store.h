#pragma once

#include "ecs/base/check.h"

#include <cstdint>
#include <vector>

namespace limn {

// At most one value of each type, found by its type. Effects publish what others may read:
//
//     LightList& lights = frame.data.publish<LightList>();    // the owner fills it, once a frame
//     const auto* sea = frame.data.find<WaterBodies>();       // a reader: null if nobody published
//
// Values live as long as the store and keep their memory; begin() only marks them as unpublished.
class TypedStore {
  public:
    TypedStore() = default;
    TypedStore(const TypedStore&) = delete;
    TypedStore& operator=(const TypedStore&) = delete;
    ~TypedStore() { clear(); }

    /// Destroys all values.
    void clear() {
        for (const Slot& slot : slots_) {
            slot.destroy(slot.value);
        }
        slots_.clear();
    }

    /// A new frame: nothing is published yet.
    void begin() { ++serial_; }

    /// The value of this type, which readers find from now on. It holds what its last owner left
    /// in it; the first time it is default-constructed.
    template <typename T>
    [[nodiscard]] T& publish() {
        Slot* slot = find_slot(&kKey<T>);
        if (slot == nullptr) {
            slots_.push_back(
                {&kKey<T>, new T(), [](void* value) { delete static_cast<T*>(value); }});
            slot = &slots_.back();
        }
        slot->published = serial_;
        return *static_cast<T*>(slot->value);
    }

    /// Null if it was not published in this frame.
    template <typename T>
    [[nodiscard]] const T* find() const {
        const Slot* slot = find_slot(&kKey<T>);
        return slot != nullptr && slot->published == serial_ ? static_cast<const T*>(slot->value)
                                                             : nullptr;
    }

    /// For what is always published.
    template <typename T>
    [[nodiscard]] const T& get() const {
        const T* value = find<T>();
        LIMN_CHECK_NOTE(value != nullptr, "nobody published this type in this frame");
        return *value;
    }

  private:
    struct Slot {
        const void* key;
        void* value;
        void (*destroy)(void*);
        std::uint64_t published = 0;
    };
    template <typename T>
    static constexpr char kKey = 0;

    [[nodiscard]] const Slot* find_slot(const void* key) const {
        for (const Slot& slot : slots_) {
            if (slot.key == key) {
                return &slot;
            }
        }
        return nullptr;
    }
    [[nodiscard]] Slot* find_slot(const void* key) {
        return const_cast<Slot*>(static_cast<const TypedStore*>(this)->find_slot(key));
    }

    std::vector<Slot> slots_;
    std::uint64_t serial_ = 1;
};

}  // namespace limn
