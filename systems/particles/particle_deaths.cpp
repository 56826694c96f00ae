#include "systems/particles/particle_deaths.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/particles/particle_deaths.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
// Techniques: particle.system

namespace limn::HWY_NAMESPACE {

// The first two return the number of particles in whole vectors.

#if HWY_TARGET == HWY_SCALAR  // no SIMD

std::size_t
find_dead_vector(const float*, const float*, std::size_t, std::uint32_t*, std::size_t&) {
    return 0;
}
std::size_t find_alive_vector(const float*, const float*, std::size_t, std::uint8_t*) {
    return 0;
}
std::size_t compact_vector(const std::uint32_t*, std::size_t, const std::uint8_t*, std::uint32_t*) {
    return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Words = hn::RebindToUnsigned<Floats>;
constexpr Floats d;
constexpr Words du;

/// Writes the indices of the dead to `dead`, which has room for another vector, and adds their
/// number to `found`.
std::size_t find_dead_vector(
    const float* age, const float* life, std::size_t count, std::uint32_t* dead,
    std::size_t& found) {
    const std::size_t n = hn::Lanes(d);
    auto index = hn::Iota(du, 0);
    std::size_t i = 0;
    for (; i + n <= count; i += n) {
        const auto lives = hn::Lt(hn::LoadU(d, age + i), hn::LoadU(d, life + i));
        const auto dies = hn::RebindMask(du, hn::Not(lives));
        hn::StoreU(hn::Compress(index, dies), du, dead + found);
        found += hn::CountTrue(du, dies);
        index = hn::Add(index, hn::Set(du, static_cast<std::uint32_t>(n)));
    }
    return i;
}

/// Writes a mask of the living for each whole vector to `alive`, each mask in whole bytes.
std::size_t
find_alive_vector(const float* age, const float* life, std::size_t count, std::uint8_t* alive) {
    const std::size_t n = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + n <= count; i += n) {
        const auto lives = hn::Lt(hn::LoadU(d, age + i), hn::LoadU(d, life + i));
        alive += hn::StoreMaskBits(d, lives, alive);
    }
    return i;
}

/// Compacts `count` values, whole vectors: moves those of the living to `to`, at or before `from`,
/// and returns their number. Compress and store, because CompressStore is ten times as slow on some
/// processors.
std::size_t compact_vector(
    const std::uint32_t* from, std::size_t count, const std::uint8_t* alive, std::uint32_t* to) {
    const std::size_t n = hn::Lanes(d);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; i += n) {
        const auto lives = hn::LoadMaskBits(d, alive);
        alive += (n + 7) / 8;
        const auto packed = hn::Compress(hn::BitCast(d, hn::LoadU(du, from + i)), lives);
        hn::StoreU(hn::BitCast(du, packed), du, to + kept);
        kept += hn::CountTrue(d, lives);
    }
    return kept;
}

#endif

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(find_dead_vector);
HWY_EXPORT(find_alive_vector);
HWY_EXPORT(compact_vector);

namespace {

/// Every column of a pool, as words.
struct Columns {
    std::array<std::uint32_t*, 10> begin = {};
    std::size_t count = 0;
};
Columns columns_of(ParticlePool& pool) {
    Columns all;
    for (auto* column :
         {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz, &pool.age, &pool.life}) {
        all.begin[all.count++] = reinterpret_cast<std::uint32_t*>(column->data());
    }
    all.begin[all.count++] = pool.look.data();
    if (pool.stuck.size() == pool.size()) {
        all.begin[all.count++] = pool.stuck.data();
    }
    return all;
}

void shrink(ParticlePool& pool, std::size_t size) {
    const bool sticks = pool.stuck.size() == pool.size();
    for (auto* column :
         {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz, &pool.age, &pool.life}) {
        column->resize(size);
    }
    pool.look.resize(size);
    pool.stuck.resize(sticks ? size : 0);
}

void copy_word(std::uint32_t* to, const std::uint32_t* from) {
    std::memcpy(to, from, sizeof(*to));  // most are floats
}

/// Particles per block: the dead of a block are found once, then its columns are compacted one
/// after another.
constexpr std::size_t kBlock = 16384;
constexpr std::size_t kMaxLanes = 64;  // of the widest vectors of words

bool is_dead(const ParticlePool& pool, std::size_t i) {
    return !(pool.age[i] < pool.life[i]);
}

}  // namespace

bool keeps_order(const OrderedBy& by) {
    return by.window || by.followed || by.meshes || by.light != nullptr
           || (by.look != nullptr && by.look->sort == ParticleSort::Births);
}

std::size_t remove_dead(ParticlePool& pool, std::size_t first) {
    const Columns columns = columns_of(pool);
    std::array<std::uint32_t, kBlock + kMaxLanes> dead;
    std::size_t size = pool.size();
    // From back to front, so that all behind a block live.
    for (std::size_t end = size; end > first;) {
        const std::size_t begin = first + (end - first - 1) / kBlock * kBlock;
        const std::size_t count = end - begin;
        std::size_t found = 0;
        const std::size_t whole = HWY_DYNAMIC_DISPATCH(find_dead_vector)(
            pool.age.data() + begin, pool.life.data() + begin, count, dead.data(), found);
        for (std::size_t i = whole; i < count; ++i) {
            dead[found] = static_cast<std::uint32_t>(i);
            found += is_dead(pool, begin + i) ? 1 : 0;
        }
        for (std::size_t c = 0; c < columns.count; ++c) {
            std::uint32_t* const column = columns.begin[c];
            const std::uint32_t* last = column + size;
            for (std::size_t k = found; k-- > 0;) {
                copy_word(column + begin + dead[k], --last);
            }
        }
        size -= found;
        end = begin;
    }
    pool.mixed = size > 0 && (pool.mixed || size < pool.size());
    shrink(pool, size);
    return size;
}

std::size_t remove_dead_scalar(ParticlePool& pool, std::size_t first) {
    const Columns columns = columns_of(pool);
    std::size_t size = pool.size();
    for (std::size_t i = size; i-- > first;) {
        if (is_dead(pool, i)) {
            --size;
            for (std::size_t c = 0; c < columns.count; ++c) {
                copy_word(columns.begin[c] + i, columns.begin[c] + size);
            }
        }
    }
    pool.mixed = size > 0 && (pool.mixed || size < pool.size());
    shrink(pool, size);
    return size;
}

std::size_t remove_dead_in_order(ParticlePool& pool, std::size_t first) {
    const Columns columns = columns_of(pool);
    std::array<std::uint8_t, kBlock + 8> masks;  // 8 more, which may be loaded and stored
    std::array<bool, kBlock> lives;              // of the remainder beyond whole vectors
    std::size_t kept = first;
    for (std::size_t begin = first; begin < pool.size(); begin += kBlock) {
        const std::size_t count = std::min(pool.size() - begin, kBlock);
        const float* const age = pool.age.data() + begin;
        const float* const life = pool.life.data() + begin;
        const std::size_t whole =
            HWY_DYNAMIC_DISPATCH(find_alive_vector)(age, life, count, masks.data());
        for (std::size_t i = whole; i < count; ++i) {
            lives[i] = !is_dead(pool, begin + i);
        }
        std::size_t alive = 0;
        for (std::size_t c = 0; c < columns.count; ++c) {
            const std::uint32_t* const from = columns.begin[c] + begin;
            std::uint32_t* const to = columns.begin[c] + kept;
            alive = HWY_DYNAMIC_DISPATCH(compact_vector)(from, whole, masks.data(), to);
            for (std::size_t i = whole; i < count; ++i) {
                copy_word(to + alive, from + i);
                alive += lives[i] ? 1 : 0;
            }
        }
        kept += alive;
    }
    shrink(pool, kept);
    return kept;
}

std::size_t remove_dead_in_order_scalar(ParticlePool& pool, std::size_t first) {
    const Columns columns = columns_of(pool);
    std::size_t kept = first;
    for (std::size_t i = first; i < pool.size(); ++i) {
        if (!is_dead(pool, i)) {
            for (std::size_t c = 0; c < columns.count; ++c) {
                copy_word(columns.begin[c] + kept, columns.begin[c] + i);
            }
            ++kept;
        }
    }
    shrink(pool, kept);
    return kept;
}

void restore_order(ParticlePool& pool) {
    std::vector<std::uint32_t> order(pool.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return pool.age[a] > pool.age[b];
    });
    const Columns columns = columns_of(pool);
    std::vector<std::uint32_t> sorted(pool.size());
    for (std::size_t c = 0; c < columns.count; ++c) {
        std::uint32_t* const column = columns.begin[c];
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            copy_word(&sorted[i], column + order[i]);
        }
        std::memcpy(column, sorted.data(), sorted.size() * sizeof(sorted[0]));
    }
    pool.mixed = false;
}

}  // namespace limn
#endif  // HWY_ONCE
