#pragma once

#include "systems/particles/birth_attributes.h"

#include <cstddef>
#include <cstdint>

namespace limn {

// Many births at once by SIMD (Highway, dispatched at run time): each lane is a birth, Philox
// included, with the operations of draw_birth in the same order.

/// Where the attributes of newborns are written.
struct BirthColumns {
    float* x;
    float* y;
    float* z;
    float* vx;
    float* vy;
    float* vz;
    float* age;
    float* life;
    std::uint32_t* look;
};

/// Writes the births first .. first + count - 1 of `run`, numbered from `number` on. Returns how
/// many it has written: it stops before a vector in which a position or life is not finite, or in
/// which some but not all radial births are exactly at the shape's center, and possibly before a
/// vector that is not full; draw_birth continues there.
std::size_t draw_births(
    const BirthDraw& draw, const BirthRun& run, std::uint32_t first, std::size_t count,
    std::uint64_t number, const BirthColumns& out);

}  // namespace limn
