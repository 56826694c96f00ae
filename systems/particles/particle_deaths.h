#pragma once

#include "ecs/components/particles.h"

#include <cstddef>

namespace limn {

// Removes the dead from pools: particles with age >= life, or with NaN there. There are two
// methods:
//
//     out of order   the last particles fill the slots of the dead: cheap when few die
//     in order       all particles behind a dead one move up
//
// Which one is used follows from whether anything depends on the order (keeps_order). SIMD versions
// (Highway, dispatched at run time) give the same bits as the plain loops, `_scalar`.

/// What may depend on the order of an emitter's particles; null: none.
struct OrderedBy {
    const ParticleLook* look = nullptr;    ///< draws the younger one over the older one
    const ParticleLight* light = nullptr;  ///< chooses the oldest
    bool window = false;                   ///< ParticlePopulation::Linear: first in, first out
    bool meshes = false;                   ///< finds each one's instance of the step before
    bool followed = false;                 ///< by a Trail or a ParticleSource, in order
};
[[nodiscard]] bool keeps_order(const OrderedBy& by);

/// Removes the dead from `first` on: from the last of them to the first, the last particle of the
/// pool fills the slot, which leaves the pool mixed. Returns the new size.
std::size_t remove_dead(ParticlePool& pool, std::size_t first);
std::size_t remove_dead_scalar(ParticlePool& pool, std::size_t first);

/// The same, but the living keep their order.
std::size_t remove_dead_in_order(ParticlePool& pool, std::size_t first);
std::size_t remove_dead_in_order_scalar(ParticlePool& pool, std::size_t first);

/// Sorts a mixed pool by age, oldest first; a stable sort.
void restore_order(ParticlePool& pool);

}  // namespace limn
