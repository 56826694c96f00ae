#pragma once

#include "ecs/reflect.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace limn {

// The components of a command and the offsets of their values in its record, which is laid out like
// a struct. There is one constant per combination of types, so that layouts can be compared by
// address.

struct RecordLayout {
    std::uint32_t size;             ///< number of components, including tags
    std::uint32_t stride;           ///< from one record to the next [bytes]; 0: no values
    std::uint32_t align;            ///< of a record [bytes]
    const ComponentId* const* ids;  ///< pointers, because ids are assigned before main
    const std::uint32_t* offsets;   ///< from the start of the record [bytes]

    [[nodiscard]] ComponentId id(std::uint32_t index) const { return *ids[index]; }
};

namespace detail {

template <bool has_values, typename... Ts>
struct RecordLayoutOf {
    static constexpr std::size_t kSize = sizeof...(Ts);
    struct Packing {
        std::uint32_t offsets[kSize + 1] = {};
        std::uint32_t stride = 0;
        std::uint32_t align = 1;
    };
    static constexpr Packing make_packing() {
        Packing packing;
        if (!has_values) {
            return packing;
        }
        std::size_t position = 0;
        std::uint32_t end = 0;
        [[maybe_unused]] const auto add = [&](bool empty, std::uint32_t bytes,
                                              std::uint32_t align) {
            if (!empty) {
                end = (end + align - 1) / align * align;
                packing.offsets[position] = end;
                end += bytes;
                packing.align = std::max(packing.align, align);
            }
            ++position;
        };
        (add(std::is_empty_v<Ts>, sizeof(Ts), alignof(Ts)), ...);
        packing.stride = (end + packing.align - 1) / packing.align * packing.align;
        return packing;
    }
    static constexpr Packing kPacking = make_packing();
    static constexpr const ComponentId* kIds[kSize + 1] = {&component_id<Ts>..., nullptr};
    static constexpr RecordLayout kLayout = {
        kSize, kPacking.stride, kPacking.align, kIds, kPacking.offsets};
};

}  // namespace detail

/// With a value of each component.
template <typename... Ts>
inline constexpr const RecordLayout& record_layout = detail::RecordLayoutOf<true, Ts...>::kLayout;
/// Without values, for removal.
template <typename... Ts>
inline constexpr const RecordLayout& key_layout = detail::RecordLayoutOf<false, Ts...>::kLayout;

/// Type-erased versions for one component; `id` must exist.
[[nodiscard]] const RecordLayout& record_layout_of(ComponentId id);
[[nodiscard]] const RecordLayout& key_layout_of(ComponentId id);

}  // namespace limn
