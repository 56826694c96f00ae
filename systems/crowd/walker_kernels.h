#pragma once

#include "ecs/base/math.h"
#include "systems/crowd/agent_grid.h"
#include "systems/crowd/orca.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// The inner loop of crowds: of each walker the ten nearest others, from a grid, and the half-planes
// that they forbid. A SIMD version for the machine's widest vectors (Highway, dispatched at run
// time), which scans a walker's cells a vector at a time and then takes a walker per lane, and a
// plain C++ one, `_scalar`. Both round alike: the results are bit-identical on every machine.

inline constexpr std::size_t kMaxNeighbors = 10;  ///< that a walker avoids: the nearest
inline constexpr std::size_t kWalkerBatch = 16;   ///< walkers per call

/// Walkers in the order of a grid, an array per number.
struct WalkerColumns {
    std::vector<float> x{};  ///< position [m]
    std::vector<float> y{};
    std::vector<float> vx{};  ///< velocity [m/s]
    std::vector<float> vy{};
    std::vector<float> radius{};       ///< [m]
    std::vector<float> weight{};       ///< > 0: of two, the one with more evades less
    std::vector<float> side{};         ///< to which they pass: 1 counterclockwise, -1 clockwise
    std::vector<float> range{};        ///< within which they see others, from center to center [m]
    std::vector<float> preferred_x{};  ///< velocity without others [m/s]
    std::vector<float> preferred_y{};
    std::vector<float> max_speed{};
    std::vector<float> horizon{};  ///< how far ahead they avoid others [s], > 0
    std::vector<std::uint64_t> keys{};

    /// Whose numbers may be read up to a multiple of kWalkerBatch; those are 0.
    void resize(std::size_t count);
};

/// A step of them.
struct WalkerScene {
    const AgentGrid& grid;
    const WalkerColumns& columns;
    float contact_time = 0;   ///< in which avoidance separates overlapping walkers [s]
    float personal = 0;       ///< added to the sum of radii in avoidance [m]
    float contact_reach = 0;  ///< distance of rims below which walkers may touch [m]
    float max_radius = 0;     ///< of all
};

/// For each of a range of slots the others that may touch it: those of slot i of the range are
/// others[begins[i]] .. others[begins[i + 1] - 1].
struct WalkerContacts {
    std::vector<std::uint32_t> begins{};
    std::vector<std::uint32_t> others{};
};

/// The half-planes of up to kWalkerBatch walkers, from the nearest neighbor on.
struct WalkerPlanes {
    float normal_x[kMaxNeighbors][kWalkerBatch];
    float normal_y[kMaxNeighbors][kWalkerBatch];
    float offset[kMaxNeighbors][kWalkerBatch];
    std::uint32_t count[kWalkerBatch];   ///< of each walker
    float start_x[kWalkerBatch];         ///< preferred velocity, no faster than max_speed
    float start_y[kWalkerBatch];         ///< likewise
    std::uint32_t is_met[kWalkerBatch];  ///< whether that meets all half-planes: 0 or 1
};

/// For the slots begin .. end - 1, at most kWalkerBatch, from a multiple of it on; adds their
/// contacts, but the end of the last one's: contacts.begins has then one number a slot.
void avoid_neighbors(
    const WalkerScene& scene, std::size_t begin, std::size_t end, WalkerContacts& contacts,
    WalkerPlanes& planes);
void avoid_neighbors_scalar(
    const WalkerScene& scene, std::size_t begin, std::size_t end, WalkerContacts& contacts,
    WalkerPlanes& planes);

}  // namespace limn
