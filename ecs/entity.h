#pragma once

#include <cstdint>
#include <functional>

namespace limn {

/// Handle of an entity: slot index and generation. A handle that outlives its entity is stale,
/// which every use detects; it never refers to another entity.
struct Entity {
    static constexpr std::uint32_t kNullIndex = 0xffffffffu;

    std::uint32_t index = kNullIndex;
    std::uint32_t generation = 0;

    [[nodiscard]] constexpr bool is_null() const { return index == kNullIndex; }
    /// Index and generation packed into one number, unique per entity.
    [[nodiscard]] constexpr std::uint64_t bits() const {
        return (static_cast<std::uint64_t>(generation) << 32) | index;
    }
    bool operator==(const Entity&) const = default;
    auto operator<=>(const Entity&) const = default;
};

}  // namespace limn

template <>
struct std::hash<limn::Entity> {
    std::size_t operator()(const limn::Entity& entity) const noexcept {
        return std::hash<std::uint64_t>{}(
            (static_cast<std::uint64_t>(entity.generation) << 32) | entity.index);
    }
};
