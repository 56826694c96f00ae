#pragma once

#include "ecs/archetype.h"

#include <cstdint>
#include <type_traits>

namespace limn {

/// Where a world keeps one of a kind.
struct ResourceSlot {
    void* value = nullptr;
    std::uint32_t version = 0;  ///< when it was last taken for writing
};

/// A resource as parameter of a system: Res<const FrameTime> reads, Res<Assets> writes. It must be
/// there when the system runs.
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
    /// Whether it was taken for writing since this system last ran.
    [[nodiscard]] bool changed() const { return is_newer(slot_->version, since_); }

  private:
    ResourceSlot* slot_;
    std::uint32_t version_;
    std::uint32_t since_;
};

}  // namespace limn
