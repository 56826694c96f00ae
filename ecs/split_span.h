#pragma once

#include "ecs/archetype.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace limn {

// A chunk of a split component: structure of arrays, one array per 4-byte scalar, suited to SIMD. A
// kernel picks the lanes it needs, by index or by member, and loops over plain spans; [i] and set()
// gather and scatter a whole value, for code that is not hot.
//
//     query.chunks([](ChunkView chunk, SplitSpan<const Sphere> spheres, SplitSpan<Spin> spins) {
//         const std::span<const float> radius = spheres.field<&Sphere::radius>();
//         const auto [x, y, z] = spheres.field<&Sphere::center>();   // a Vec3: three spans
//         for (std::uint32_t i = 0; i < chunk.size(); ++i) { ... radius[i] ... x[i] ... }
//     });
//
// Like every column, a lane starts at a multiple of 64 bytes in every chunk, and rows up to the
// next multiple of 16 may be read and written.

namespace detail {

/// Number of 4-byte scalars.
template <typename T>
inline constexpr std::size_t lane_count = sizeof(T) / kLaneBytes;

/// The scalar type of a member: itself, or the element of a vector or an array of scalars.
template <typename F>
struct LaneTypeOf {
    using Type = float;
};
template <typename F>
requires std::is_arithmetic_v<F> || std::is_enum_v<F>
struct LaneTypeOf<F> {
    using Type = F;
};
template <typename F>
requires requires {
    typename F::value_type;
}
struct LaneTypeOf<F> : LaneTypeOf<typename F::value_type> {};
template <typename F, std::size_t N>
struct LaneTypeOf<F[N]> : LaneTypeOf<F> {};

template <typename T>
struct MemberTraits;
template <typename C, typename F>
struct MemberTraits<F C::*> {
    using Class = C;
    using Type = F;
};

/// Index of a member's first lane.
template <typename T, auto member>
std::size_t lane_of() {
    alignas(T) static constexpr std::byte storage[sizeof(T)] = {};
    const T& object = reinterpret_cast<const T&>(storage);
    return static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&(object.*member)) - storage)
           / kLaneBytes;
}

/// Base pointers of the lanes of a T.
template <typename T>
class Lanes {
    using Value = std::remove_const_t<T>;

  public:
    Lanes() = default;
    Lanes(const Column* first, std::uint32_t row) {
        for (std::size_t lane = 0; lane < lane_count<Value>; ++lane) {
            bases_[lane] = reinterpret_cast<LaneScalar*>(first[lane].at(row));
        }
    }
    [[nodiscard]] bool is_empty() const { return bases_[0] == nullptr; }
    [[nodiscard]] LaneScalar* base(std::size_t lane) const { return bases_[lane]; }
    [[nodiscard]] Value load(std::size_t row) const {
        std::array<std::uint32_t, lane_count<Value>> scalars;
        for (std::size_t lane = 0; lane < scalars.size(); ++lane) {
            scalars[lane] = bases_[lane][row];
        }
        return std::bit_cast<Value>(scalars);
    }
    void store(std::size_t row, const Value& value) const {
        const auto scalars = std::bit_cast<std::array<std::uint32_t, lane_count<Value>>>(value);
        for (std::size_t lane = 0; lane < scalars.size(); ++lane) {
            bases_[lane][row] = scalars[lane];
        }
    }

  private:
    LaneScalar* bases_[lane_count<Value>] = {};
};

/// A row of a split component as each() passes it: a copy, written back at the end of the call if T
/// is not const.
template <typename T>
class SplitRow {
  public:
    SplitRow(const Lanes<T>& lanes, std::uint32_t row)
        : value_(lanes.load(row)), lanes_(lanes), row_(row) {}
    SplitRow(const SplitRow&) = delete;
    SplitRow& operator=(const SplitRow&) = delete;
    ~SplitRow() {
        if constexpr (!std::is_const_v<T>) {
            lanes_.store(row_, value_);
        }
    }
    [[nodiscard]] T& argument() { return value_; }

  private:
    std::remove_const_t<T> value_;
    const Lanes<T>& lanes_;
    std::uint32_t row_;
};

/// The same for an Optional component.
template <typename T>
class SplitOptionalRow {
  public:
    SplitOptionalRow(const Lanes<T>& lanes, std::uint32_t row) : lanes_(lanes), row_(row) {
        if (!lanes.is_empty()) {
            value_ = lanes.load(row);
        }
    }
    SplitOptionalRow(const SplitOptionalRow&) = delete;
    SplitOptionalRow& operator=(const SplitOptionalRow&) = delete;
    ~SplitOptionalRow() {
        if constexpr (!std::is_const_v<T>) {
            if (!lanes_.is_empty()) {
                lanes_.store(row_, value_);
            }
        }
    }
    [[nodiscard]] T* argument() { return lanes_.is_empty() ? nullptr : &value_; }

  private:
    std::remove_const_t<T> value_{};
    const Lanes<T>& lanes_;
    std::uint32_t row_;
};

template <typename A>
inline constexpr bool is_split_row = false;
template <typename T>
inline constexpr bool is_split_row<SplitRow<T>> = true;
template <typename T>
inline constexpr bool is_split_row<SplitOptionalRow<T>> = true;

/// Converts a term's access result to the argument of each()'s function; valid during the call.
template <typename Found>
constexpr decltype(auto) row_argument(Found&& found) {
    if constexpr (is_split_row<std::remove_cvref_t<Found>>) {
        return found.argument();
    } else {
        return std::forward<Found>(found);
    }
}

}  // namespace detail

/// The rows of a chunk; T is const if they are only read. Empty for a missing Optional.
template <typename T>
class SplitSpan {
  public:
    using Value = std::remove_const_t<T>;
    /// Number of lanes of a T.
    static constexpr std::size_t kLanes = detail::lane_count<Value>;

    SplitSpan() = default;
    /// `size` rows from `row` on of a component whose first lane is `first`.
    SplitSpan(const Column* first, std::uint32_t row, std::uint32_t size)
        : lanes_(first, row), size_(size) {}

    [[nodiscard]] std::uint32_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }

    /// Scalar number `lane` of all rows, in struct order; for types other than float:
    /// lane<std::int32_t>(3).
    template <typename Scalar = float>
    [[nodiscard]] auto lane(std::size_t lane) const {
        static_assert(sizeof(Scalar) == kLaneBytes, "lane: a lane holds 4-byte scalars");
        return lane_span<Scalar>(lane);
    }
    /// A member of all rows: a span if it is a scalar, an array of spans if it is a vector, an
    /// array of scalars or another struct, which must consist of floats.
    template <auto member>
    [[nodiscard]] auto field() const {
        using Traits = detail::MemberTraits<decltype(member)>;
        using Field = typename Traits::Type;
        static_assert(
            std::is_base_of_v<typename Traits::Class, Value>,
            "field: name a member of the component");
        using Scalar = typename detail::LaneTypeOf<Field>::Type;
        const std::size_t first = detail::lane_of<Value, member>();
        if constexpr (std::is_same_v<Scalar, Field>) {
            return lane_span<Scalar>(first);
        } else {
            std::array<decltype(lane_span<Scalar>(0)), detail::lane_count<Field>> spans;
            for (std::size_t i = 0; i < spans.size(); ++i) {
                spans[i] = lane_span<Scalar>(first + i);
            }
            return spans;
        }
    }
    /// Row `i`, gathered from its lanes.
    [[nodiscard]] Value operator[](std::size_t i) const { return lanes_.load(i); }
    /// Scatters a value to the lanes of row `i`.
    void set(std::size_t i, const Value& value) const {
        static_assert(!std::is_const_v<T>, "set: the term is const; ask for SplitSpan<T>");
        lanes_.store(i, value);
    }

  private:
    template <typename Scalar>
    [[nodiscard]] auto lane_span(std::size_t lane) const {
        using Element = std::conditional_t<std::is_const_v<T>, const Scalar, Scalar>;
        return std::span<Element>(reinterpret_cast<Element*>(lanes_.base(lane)), size_);
    }

    detail::Lanes<T> lanes_;
    std::uint32_t size_ = 0;
};

}  // namespace limn
