#pragma once

#include "ecs/archetype.h"

#include <cstdint>
#include <type_traits>

namespace limn {

/// Storage of one resource of a world.
struct ResourceSlot {
    void* value = nullptr;
    std::uint32_t version = 0;  ///< last access for writing
};

/// A resource as a system parameter: Res<const FrameTime> reads, Res<Assets> writes. It must exist
/// when the system runs.
template <typename T>
class Res {
  public:
    Res(ResourceSlot& slot, std::uint32_t version, std::uint32_t since)
        : slot_(&slot), version_(version), since_(since) {}

    [[nodiscard]] T& operator*() const { return get(); }
    [[nodiscard]] T* operator->() const { return &get(); }
    [[nodiscard]] T& get() const {
        if constexpr (!std::is_const_v<T>) {
            store_version(slot_->version, version_);
        }
        return *static_cast<T*>(slot_->value);
    }
    /// Whether it was accessed for writing since this system last ran.
    [[nodiscard]] bool changed() const { return is_newer(slot_->version, since_); }

  private:
    ResourceSlot* slot_;
    std::uint32_t version_;
    std::uint32_t since_;
};

/// The same for a resource that may be missing: then it is false, and get() is nullptr.
template <typename T>
class OptionalRes {
  public:
    OptionalRes(ResourceSlot* slot, std::uint32_t version) : slot_(slot), version_(version) {}

    [[nodiscard]] explicit operator bool() const { return slot_ != nullptr; }
    [[nodiscard]] T& operator*() const { return *get(); }
    [[nodiscard]] T* operator->() const { return get(); }
    [[nodiscard]] T* get() const {
        if (slot_ == nullptr) {
            return nullptr;
        }
        if constexpr (!std::is_const_v<T>) {
            store_version(slot_->version, version_);
        }
        return static_cast<T*>(slot_->value);
    }

  private:
    ResourceSlot* slot_;
    std::uint32_t version_;
};

}  // namespace limn
