#pragma once

#include "systems/particles/birth_attributes.h"

#include <cstddef>
#include <cstdint>

namespace limn {

// Many births at once (Highway, dispatched at run time): every lane draws the numbers of another
// birth, Philox included, with the operations of draw_birth in the same order.

/// Where the attributes of newborns go.
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
/// many: fewer where the next one's position or life is not finite or, of those that fly away from
/// a shape's center, just there, and where no vector is full; draw_birth continues.
std::size_t draw_births(
    const BirthDraw& draw, const BirthRun& run, std::uint32_t first, std::size_t count,
    std::uint64_t number, const BirthColumns& out);

}  // namespace limn
