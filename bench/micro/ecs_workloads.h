#pragma once

#include "ecs/column.h"
#include "ecs/reflect.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

// The workloads of ecs_bench: the components of published ECS comparisons, the kernels that run
// over them, and the raw arrays as a baseline.

namespace limn::bench {

struct Position {
    float x = 0, y = 0, z = 0;
};
struct Velocity {
    float x = 0, y = 0, z = 0;
};
struct Rotation {
    float x = 0, y = 0, z = 0, w = 1;
};
struct Turn {
    float x = 0, y = 0, z = 0;
};
struct Tint {
    float r = 1, g = 1, b = 1, a = 1;
};
struct Life {
    float left = 0, total = 1;
};
struct Scale {
    float factor = 1;
};
/// What is added and removed.
struct Extra {
    float value[4] = {1, 2, 3, 4};
};
struct SparseExtra {
    float value[4] = {1, 2, 3, 4};
};
/// Splits the entities into archetypes.
template <int number>
struct Fragment {
    float value = 0;
};
static_assert(sizeof(Position) == 12 && sizeof(Velocity) == 12 && sizeof(Rotation) == 16);
static_assert(sizeof(Turn) == 12 && sizeof(Tint) == 16 && sizeof(Life) == 8 && sizeof(Scale) == 4);
static_assert(sizeof(Extra) == 16 && sizeof(SparseExtra) == 16);

// ---- start values: different for each row, so that mixed-up rows are detected

/// In -0.5 .. 0.5.
[[nodiscard]] inline float noise(std::size_t row, std::uint32_t lane) {
    const std::uint32_t bits = (static_cast<std::uint32_t>(row) + lane * 977u) * 2654435761u;
    return static_cast<float>(bits >> 8) * 0x1p-24f - 0.5f;
}

inline void start(Position& p, std::size_t row) {
    p = {noise(row, 0), noise(row, 1), noise(row, 2)};
}
inline void start(Velocity& v, std::size_t row) {
    v = {noise(row, 3), noise(row, 4), noise(row, 5)};
}
inline void start(Rotation& r, std::size_t row) {
    r = {noise(row, 6), 0, 0, 1};
}
inline void start(Turn& t, std::size_t row) {
    t = {noise(row, 7), noise(row, 8), noise(row, 9)};
}
inline void start(Tint& t, std::size_t row) {
    t = {noise(row, 10), 1, 1, 1};
}
inline void start(Life& l, std::size_t row) {
    l = {noise(row, 11), 2};
}
inline void start(Scale& s, std::size_t row) {
    s = {noise(row, 12)};
}

// ---- kernels

inline constexpr float kStep = 1.0f / 1024.0f;

struct Move {
    void operator()(const Velocity& v, Position& p) const {
        p.x += v.x * kStep;
        p.y += v.y * kStep;
        p.z += v.z * kStep;
    }
};

struct Shift {
    void operator()(Position& p) const {
        p.x += kStep;
        p.y += kStep;
        p.z += kStep;
    }
};

struct Grow {
    void operator()(Scale& s) const { s.factor += kStep; }
};

/// Reads three columns and writes four. The rotation is not normalized: this is about memory.
struct Animate {
    void operator()(
        const Velocity& v, const Turn& t, const Scale& s, Position& p, Rotation& r, Tint& c,
        Life& l) const {
        Move()(v, p);
        const Rotation q = r;
        const float half = 0.5f * kStep;
        r.x += half * (t.x * q.w + t.y * q.z - t.z * q.y);
        r.y += half * (t.y * q.w + t.z * q.x - t.x * q.z);
        r.z += half * (t.z * q.w + t.x * q.y - t.y * q.x);
        r.w -= half * (t.x * q.x + t.y * q.y + t.z * q.z);
        l.left += kStep;
        c.r += c.g * (s.factor * kStep);
        c.a = l.left * l.total;
    }
};

/// Some 100 dependent operations per row: compute-bound. Stays in 0 .. 1.
struct Compute {
    void operator()(Scale& s) const {
        float x = s.factor + 0.5f;
        for (int i = 0; i < 64; ++i) {
            x = 3.7f * x * (1.0f - x);
        }
        s.factor = x - 0.5f;
    }
};

// ---- raw arrays

/// An array in the same kind of memory as an archetype's columns (alignment, huge pages, skew), so
/// that the comparison does not depend on the allocator.
template <typename T>
class RawColumn {
  public:
    explicit RawColumn(std::size_t count, std::size_t position = 0)
        : range_(count * sizeof(T) + kSkew * (position + 1)),
          data_(reinterpret_cast<T*>(range_.data() + kSkew * (position + 1))) {
        range_.commit(count * sizeof(T) + kSkew * (position + 1));
    }
    [[nodiscard]] T* data() const { return data_; }

  private:
    static constexpr std::size_t kSkew = 64;
    VirtualRange range_;
    T* data_;
};

/// One array for each of the types.
template <typename... Ts>
class RawArrays {
  public:
    explicit RawArrays(std::size_t count)
        : RawArrays(count, std::make_index_sequence<sizeof...(Ts)>{}) {}

    template <typename Kernel>
    void each(const Kernel& kernel) const {
        std::apply(
            [&](const auto&... columns) { loop(count_, kernel, columns.data()...); }, columns_);
    }
    void start_all() const {
        each([row = std::size_t{0}](Ts&... values) mutable {
            (start(values, row), ...);
            ++row;
        });
    }
    [[nodiscard]] std::size_t size() const { return count_; }
    template <typename T>
    [[nodiscard]] T* column() const {
        return std::get<RawColumn<T>>(columns_).data();
    }

  private:
    template <std::size_t... Positions>
    RawArrays(std::size_t count, std::index_sequence<Positions...>)
        : count_(count), columns_(RawColumn<Ts>(count, Positions)...) {}

    template <typename Kernel>
    [[gnu::noinline]] static void loop(std::size_t count, Kernel kernel, Ts*... columns) {
        for (std::size_t i = 0; i < count; ++i) {
            kernel(columns[i]...);
        }
    }

    std::size_t count_;
    std::tuple<RawColumn<Ts>...> columns_;
};

// ---- checks

/// Checksum of a value's words.
template <typename T>
[[nodiscard]] std::uint64_t words_of(const T& value) {
    static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
    std::uint32_t words[sizeof(T) / sizeof(std::uint32_t)];
    std::memcpy(words, &value, sizeof(T));
    std::uint64_t sum = 0;
    for (const std::uint32_t word : words) {
        sum = sum * 31 + word;
    }
    return sum;
}

/// Order-independent sum of row checksums; detects components swapped between rows.
struct RowSum {
    std::uint64_t* sum;
    template <typename... Ts>
    void operator()(const Ts&... values) const {
        std::uint64_t row = 0x9e3779b97f4a7c15ull;
        ((row = (row ^ words_of(values)) * 0xff51afd7ed558ccdull), ...);
        *sum += row;
    }
};

// ---- time

/// Optimization barrier: the value counts as read and all memory as modified.
template <typename T>
void keep(const T& value) {
    asm volatile("" : : "r"(&value) : "memory");
}

/// [ns]
template <typename F>
[[nodiscard]] double time_of(F&& work) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    work();
    keep(begin);
    return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
}

/// 0 .. count - 1 in random order, the same in every run.
[[nodiscard]] inline std::vector<std::uint32_t> shuffled(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t other = random() % (i + 1);
        order[i] = order[other];
        order[other] = static_cast<std::uint32_t>(i);
    }
    return order;
}

}  // namespace limn::bench

template <>
struct limn::ComponentTraits<limn::bench::SparseExtra> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
