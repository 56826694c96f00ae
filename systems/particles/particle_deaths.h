#pragma once

#include "ecs/components/particles.h"

#include <cstddef>

namespace limn {

// How pools lose their dead, those with age >= life or without a number there, and in which order
// the others are then. Two ways:
//
//     out of order   the last ones take the places of the dead: the cost is that of finding them
//     in order       those behind a dead one move up
//
// Which one follows from who looks at the order (keeps_order); nobody chooses it. Vectors (Highway,
// dispatched at run time) give the bits of the plain loops, `_scalar`.

/// What may tell an emitter's particles by their order; null: none.
struct OrderedBy {
    const ParticleLook* look = nullptr;    ///< draws the younger one over the older one
    const ParticleLight* light = nullptr;  ///< chooses the oldest
    bool window = false;                   ///< ParticlePopulation::Linear: first in, first out
    bool meshes = false;                   ///< finds each one's instance of the step before
    bool followed = false;                 ///< by a Trail or a ParticleSource, one after another
};
[[nodiscard]] bool keeps_order(const OrderedBy& by);

/// Removes the dead from `first` on. From the last of them to the first, the last particle of the
/// pool takes the place; the pool is then mixed. Returns how many are left.
std::size_t remove_dead(ParticlePool& pool, std::size_t first);
std::size_t remove_dead_scalar(ParticlePool& pool, std::size_t first);

/// The same, but the others keep their order.
std::size_t remove_dead_in_order(ParticlePool& pool, std::size_t first);
std::size_t remove_dead_in_order_scalar(ParticlePool& pool, std::size_t first);

/// Orders a mixed pool by age, oldest first, those of one age as they were.
void restore_order(ParticlePool& pool);

}  // namespace limn
