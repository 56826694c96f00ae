#include "systems/crowd/walker_kernels.h"

#include "ecs/base/check.h"
#include "systems/crowd/parting.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/crowd/walker_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Techniques: char.flock

#ifndef LIMN_WALKER_CONSTANTS
#define LIMN_WALKER_CONSTANTS
namespace limn::walkers {

// Neighbors are ordered by a key: the bits of the distance squared, which order as it does, with
// the lowest seven replaced by the number in a list, so that equally near ones are in the order of
// the grid.
inline constexpr std::uint32_t kIndexMask = 127;
inline constexpr std::uint32_t kMaxCandidates = kIndexMask + 1;
inline constexpr std::uint32_t kNobody = 0x7fffffffu;  ///< after all keys

/// Walkers near one, in the order of the grid; or, after keep_nearest(), the nearest of them first.
struct CandidateList {
    alignas(64) std::uint32_t keys[kMaxCandidates + kWalkerBatch];
    alignas(64) std::uint32_t slots[kMaxCandidates + kWalkerBatch];
    std::uint32_t count = 0;
    float limit2 = 0;  ///< distance squared below which others are near [m^2]
};

/// Makes room: whoever is as far as the tenth or farther is near no longer.
inline void keep_nearest(CandidateList& found) {
    std::array<std::uint32_t, kMaxNeighbors> slots;
    std::nth_element(found.keys, found.keys + kMaxNeighbors - 1, found.keys + found.count);
    std::sort(found.keys, found.keys + kMaxNeighbors);
    for (std::uint32_t i = 0; i < kMaxNeighbors; ++i) {
        slots[i] = found.slots[found.keys[i] & kIndexMask];
        found.keys[i] = (found.keys[i] & ~kIndexMask) | i;
    }
    std::copy(slots.begin(), slots.end(), found.slots);
    found.count = kMaxNeighbors;
    found.limit2 = std::bit_cast<float>(found.keys[kMaxNeighbors - 1] & ~kIndexMask);
}

/// How far to look for the neighbors of a walker, or for those that it may touch [m].
struct SearchReach {
    float contact = 0;
    bool is_dense = false;  ///< the nearest are probably in the cells around
};
inline SearchReach find_reach(const WalkerScene& scene, std::size_t slot) {
    const WalkerColumns& columns = scene.columns;
    SearchReach reach;
    reach.contact = columns.radius[slot] + scene.max_radius + scene.contact_reach;
    const float cell = scene.grid.cell;
    if (columns.range[slot] > cell && reach.contact <= cell) {
        std::uint32_t around = 0;
        each_run(scene.grid, {columns.x[slot], columns.y[slot]}, cell, [&](SlotRun run) {
            around += run.end - run.begin;
        });
        reach.is_dense = around > 2 * kMaxNeighbors;
    }
    return reach;
}

}  // namespace limn::walkers
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

// Returns the first unprocessed slot; the scalar version handles the remainder.

// No vectors, or scalable ones, which arrays cannot hold.
#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE

std::size_t avoid_neighbors_vector(
    const WalkerScene&, std::size_t begin, std::size_t, WalkerContacts&, WalkerPlanes&) {
    return begin;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kWalkerBatch>;
using Words = hn::RebindToUnsigned<Floats>;
using Integers = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
constexpr Floats d;
constexpr Words words;
constexpr Integers integers;
constexpr std::size_t kLanes = hn::MaxLanes(d);

// ---- one walker, a vector of others at a time ---------------------------------------------------

struct WalkerScan {
    const WalkerColumns& columns;
    std::uint32_t slot;
    V x;
    V y;
    V touch;  ///< its radius and the distance at which it may touch
};

HWY_INLINE void scan_run(
    const WalkerScan& scan, SlotRun run, walkers::CandidateList& found, WalkerContacts& contacts) {
    const auto self = hn::Set(words, scan.slot);
    const auto lane = hn::Iota(words, 0u);
    for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
        if (HWY_UNLIKELY(found.count > walkers::kMaxCandidates - kLanes)) {
            walkers::keep_nearest(found);
        }
        const auto slots = hn::Add(lane, hn::Set(words, i));
        const V dx = hn::Sub(hn::LoadU(d, scan.columns.x.data() + i), scan.x);
        const V dy = hn::Sub(hn::LoadU(d, scan.columns.y.data() + i), scan.y);
        const V distance2 = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
        const V touch = hn::Add(scan.touch, hn::LoadU(d, scan.columns.radius.data() + i));
        const auto used = hn::AndNot(
            hn::RebindMask(d, hn::Eq(slots, self)),
            hn::FirstN(d, std::min<std::size_t>(run.end - i, kLanes)));
        const auto near = hn::And(used, hn::Lt(distance2, hn::Set(d, found.limit2)));
        const auto touching = hn::And(used, hn::Lt(distance2, hn::Mul(touch, touch)));
        const auto key =
            hn::AndNot(hn::Set(words, walkers::kIndexMask), hn::BitCast(words, distance2));
        const auto near_words = hn::RebindMask(words, near);
        hn::StoreU(
            hn::Or(hn::Compress(key, near_words), hn::Add(lane, hn::Set(words, found.count))),
            words, found.keys + found.count);
        hn::StoreU(hn::Compress(slots, near_words), words, found.slots + found.count);
        found.count += static_cast<std::uint32_t>(hn::CountTrue(d, near));
        if (HWY_UNLIKELY(!hn::AllFalse(d, touching))) {
            HWY_ALIGN std::uint32_t others[kLanes];
            hn::Store(hn::Compress(slots, hn::RebindMask(words, touching)), words, others);
            contacts.others.insert(
                contacts.others.end(), others, others + hn::CountTrue(d, touching));
        }
    }
}

HWY_INLINE void scan_window(
    const WalkerScene& scene, const WalkerScan& scan, float reach, walkers::CandidateList& found,
    WalkerContacts& contacts) {
    const GridWindow window =
        find_window(scene.grid, {scan.columns.x[scan.slot], scan.columns.y[scan.slot]}, reach);
    for (std::uint32_t i = 0; i < window.rows; ++i) {
        scan_run(scan, window.run(scene.grid, i), found, contacts);
        if (HWY_UNLIKELY(window.straight < window.columns)) {
            scan_run(scan, window.wrapped_run(scene.grid, i), found, contacts);
        }
    }
}

HWY_INLINE void find_candidates(
    const WalkerScene& scene, std::uint32_t slot, walkers::CandidateList& found,
    WalkerContacts& contacts) {
    const WalkerColumns& columns = scene.columns;
    const WalkerScan scan = {
        columns, slot, hn::Set(d, columns.x[slot]), hn::Set(d, columns.y[slot]),
        hn::Set(d, columns.radius[slot] + scene.contact_reach)};
    const walkers::SearchReach reach = walkers::find_reach(scene, slot);
    const std::size_t first_contact = contacts.others.size();
    contacts.begins.push_back(static_cast<std::uint32_t>(first_contact));
    if (reach.is_dense) {
        found.count = 0;
        found.limit2 = square(scene.grid.cell);
        scan_window(scene, scan, scene.grid.cell, found, contacts);
        if (found.count >= kMaxNeighbors) {
            return;
        }
        contacts.others.resize(first_contact);
    }
    found.count = 0;
    found.limit2 = square(columns.range[slot]);
    scan_window(scene, scan, std::max(columns.range[slot], reach.contact), found, contacts);
}

// ---- a walker per lane --------------------------------------------------------------------------

/// The numbers of the walkers of the lanes, and what is the same for all their neighbors.
struct OwnLanes {
    V x;
    V y;
    V vx;
    V vy;
    V radius;
    V weight;
    V side;
    V horizon_rate;
    V contact_rate;
};

HWY_INLINE OwnLanes load_lanes(const WalkerScene& scene, std::size_t slot) {
    const WalkerColumns& columns = scene.columns;
    const V one = hn::Set(d, 1.0f);
    return {
        hn::LoadU(d, columns.x.data() + slot),
        hn::LoadU(d, columns.y.data() + slot),
        hn::LoadU(d, columns.vx.data() + slot),
        hn::LoadU(d, columns.vy.data() + slot),
        hn::Add(hn::LoadU(d, columns.radius.data() + slot), hn::Set(d, scene.personal)),
        hn::LoadU(d, columns.weight.data() + slot),
        hn::LoadU(d, columns.side.data() + slot),
        hn::Div(one, hn::LoadU(d, columns.horizon.data() + slot)),
        hn::Set(d, 1 / scene.contact_time)};
}

struct PlaneLanes {
    V x;
    V y;
    V offset;
};

/// Directions in which coincident walkers part, where `lanes` is set.
HWY_INLINE void set_apart(
    const WalkerScene& scene, std::size_t slot, hn::Mask<Floats> lanes, hn::Vec<Integers> neighbors,
    V& x, V& y) {
    HWY_ALIGN std::int32_t others[kLanes];
    HWY_ALIGN float set[kLanes];
    HWY_ALIGN float xs[kLanes];
    HWY_ALIGN float ys[kLanes];
    hn::Store(neighbors, integers, others);
    hn::Store(hn::IfThenElseZero(lanes, hn::Set(d, 1.0f)), d, set);
    hn::Store(x, d, xs);
    hn::Store(y, d, ys);
    for (std::size_t i = 0; i < kLanes; ++i) {
        if (set[i] != 0) {
            const Vec2 apart = parting_direction(
                scene.columns.keys[slot + i],
                scene.columns.keys[static_cast<std::size_t>(others[i])]);
            xs[i] = apart.x;
            ys[i] = apart.y;
        }
    }
    x = hn::Load(d, xs);
    y = hn::Load(d, ys);
}

/// avoid_walker() of orca.h, for a neighbor of each lane.
HWY_INLINE PlaneLanes avoid_lanes(
    const WalkerScene& scene, std::size_t slot, const OwnLanes& own, hn::Vec<Integers> neighbors,
    hn::Mask<Floats> is_used) {
    const WalkerColumns& columns = scene.columns;
    const auto gather = [&](const std::vector<float>& column)
                            HWY_ATTR { return hn::GatherIndex(d, column.data(), neighbors); };
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, 1.0f);
    const V ox = hn::Sub(gather(columns.x), own.x);
    const V oy = hn::Sub(gather(columns.y), own.y);
    const V rx = hn::Sub(own.vx, gather(columns.vx));
    const V ry = hn::Sub(own.vy, gather(columns.vy));
    const V reach = hn::Add(own.radius, gather(columns.radius));
    const V other_weight = gather(columns.weight);
    const V other_side = gather(columns.side);
    const V distance2 = hn::Add(hn::Mul(ox, ox), hn::Mul(oy, oy));
    const V reach2 = hn::Mul(reach, reach);
    const auto overlaps = hn::Le(distance2, reach2);
    const V rate = hn::IfThenElse(overlaps, own.contact_rate, own.horizon_rate);
    const V fx = hn::Sub(rx, hn::Mul(rate, ox));
    const V fy = hn::Sub(ry, hn::Mul(rate, oy));
    const V along = hn::Add(hn::Mul(fx, ox), hn::Mul(fy, oy));
    const V length2 = hn::Add(hn::Mul(fx, fx), hn::Mul(fy, fy));
    const auto on_disc = hn::Or(
        overlaps,
        hn::And(hn::Lt(along, zero), hn::Gt(hn::Mul(along, along), hn::Mul(reach2, length2))));
    // The length of the vector from the center of the disc, or of the leg of the cone.
    const V root = hn::Sqrt(hn::IfThenElse(on_disc, length2, hn::Sub(distance2, reach2)));
    const V side_there = hn::IfThenElseZero(hn::Eq(own.side, other_side), own.side);
    const V head_on =
        hn::Mul(hn::Mul(hn::Mul(hn::Mul(side_there, hn::Set(d, kHeadOnSpeed)), reach), rate), root);
    const V left = hn::Sub(hn::Mul(ox, ry), hn::Mul(oy, rx));
    const V side = hn::IfThenElse(hn::Gt(hn::Add(left, head_on), zero), one, hn::Set(d, -1.0f));
    const V leg_x = hn::Sub(hn::Mul(hn::Neg(ox), reach), hn::Mul(hn::Mul(side, oy), root));
    const V leg_y = hn::Sub(hn::Mul(hn::Mul(side, ox), root), hn::Mul(oy, reach));
    const V divisor = hn::IfThenElse(on_disc, root, distance2);
    V nx = hn::Div(hn::IfThenElse(on_disc, fx, leg_x), divisor);
    V ny = hn::Div(hn::IfThenElse(on_disc, fy, leg_y), divisor);
    const auto is_centered = hn::And(on_disc, hn::Not(hn::Gt(root, hn::Set(d, kCenteredSpeed))));
    if (HWY_UNLIKELY(!hn::AllFalse(d, hn::And(is_used, is_centered)))) {
        nx = hn::IfThenElse(is_centered, one, nx);
        ny = hn::IfThenElse(is_centered, zero, ny);
        set_apart(scene, slot, hn::And(is_used, hn::And(is_centered, overlaps)), neighbors, nx, ny);
    }
    const V change = hn::IfThenElse(
        on_disc, hn::Sub(hn::Mul(rate, reach), root),
        hn::Neg(hn::Add(hn::Mul(rx, nx), hn::Mul(ry, ny))));
    const V share = hn::Div(other_weight, hn::Add(own.weight, other_weight));
    const V offset =
        hn::Add(hn::Add(hn::Mul(nx, own.vx), hn::Mul(ny, own.vy)), hn::Mul(share, change));
    return {nx, ny, offset};
}

struct StartLanes {
    V x;
    V y;
};

/// The velocities that the walkers prefer, no faster than they can.
HWY_INLINE StartLanes start_lanes(const WalkerColumns& columns, std::size_t slot) {
    const V x = hn::LoadU(d, columns.preferred_x.data() + slot);
    const V y = hn::LoadU(d, columns.preferred_y.data() + slot);
    const V max_speed = hn::LoadU(d, columns.max_speed.data() + slot);
    const V speed2 = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
    const V factor = hn::Div(max_speed, hn::Sqrt(speed2));
    const auto is_fast = hn::Gt(speed2, hn::Mul(max_speed, max_speed));
    return {
        hn::IfThenElse(is_fast, hn::Mul(x, factor), x),
        hn::IfThenElse(is_fast, hn::Mul(y, factor), y)};
}

/// Candidates of the lanes, a lane each.
struct LaneKeys {
    HWY_ALIGN std::uint32_t of[walkers::kMaxCandidates * kLanes];
    std::uint32_t most = 0;
};

HWY_INLINE void transpose_keys(const walkers::CandidateList* found, LaneKeys& keys) {
    keys.most = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        keys.most = std::max(keys.most, found[lane].count);
    }
    for (std::size_t i = 0; i < keys.most; ++i) {
        hn::Store(hn::Set(words, walkers::kNobody), words, keys.of + i * kLanes);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        for (std::size_t i = 0; i < found[lane].count; ++i) {
            keys.of[i * kLanes + lane] = found[lane].keys[i];
        }
    }
}

/// The ten nearest of each lane by insertion without branches, and their half-planes.
HWY_INLINE void avoid_batch(
    const WalkerScene& scene, std::size_t slot, std::size_t lane,
    const walkers::CandidateList* found, WalkerPlanes& planes) {
    LaneKeys keys;
    transpose_keys(found, keys);
    const auto nobody = hn::Set(integers, static_cast<std::int32_t>(walkers::kNobody));
    hn::Vec<Integers> kept[kMaxNeighbors];
    for (auto& key : kept) {
        key = nobody;
    }
    for (std::size_t i = 0; i < keys.most; ++i) {
        auto moving = hn::BitCast(integers, hn::Load(words, keys.of + i * kLanes));
        for (auto& key : kept) {
            const auto least = hn::Min(key, moving);
            moving = hn::Max(key, moving);
            key = least;
        }
    }
    const OwnLanes own = load_lanes(scene, slot);
    const StartLanes start = start_lanes(scene.columns, slot);
    const auto* const slots = reinterpret_cast<const std::int32_t*>(found[0].slots);
    constexpr auto kStride =
        static_cast<std::int32_t>(sizeof(walkers::CandidateList) / sizeof(std::int32_t));
    const auto row = hn::Mul(hn::Iota(integers, 0), hn::Set(integers, kStride));
    auto is_met = hn::Eq(own.x, own.x);
    auto count = hn::Zero(integers);
    for (std::size_t k = 0; k < kMaxNeighbors; ++k) {
        const auto is_used = hn::Ne(kept[k], nobody);
        if (hn::AllFalse(integers, is_used)) {
            break;
        }
        const auto index = hn::IfThenElseZero(
            is_used,
            hn::Add(row, hn::And(kept[k], hn::Set(integers, std::int32_t{walkers::kIndexMask}))));
        const auto neighbors = hn::IfThenElseZero(is_used, hn::GatherIndex(integers, slots, index));
        const auto is_used_float = hn::RebindMask(d, is_used);
        const PlaneLanes plane = avoid_lanes(scene, slot, own, neighbors, is_used_float);
        const V along = hn::Add(hn::Mul(plane.x, start.x), hn::Mul(plane.y, start.y));
        is_met = hn::And(is_met, hn::Or(hn::Not(is_used_float), hn::Ge(along, plane.offset)));
        count = hn::Add(count, hn::IfThenElseZero(is_used, hn::Set(integers, 1)));
        hn::StoreU(plane.x, d, planes.normal_x[k] + lane);
        hn::StoreU(plane.y, d, planes.normal_y[k] + lane);
        hn::StoreU(plane.offset, d, planes.offset[k] + lane);
    }
    hn::StoreU(hn::BitCast(words, count), words, planes.count + lane);
    hn::StoreU(start.x, d, planes.start_x + lane);
    hn::StoreU(start.y, d, planes.start_y + lane);
    hn::StoreU(
        hn::IfThenElseZero(hn::RebindMask(words, is_met), hn::Set(words, 1u)), words,
        planes.is_met + lane);
}

std::size_t avoid_neighbors_vector(
    const WalkerScene& scene, std::size_t begin, std::size_t end, WalkerContacts& contacts,
    WalkerPlanes& planes) {
    walkers::CandidateList found[kLanes];
    for (std::size_t slot = begin; slot < end; slot += kLanes) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            if (slot + lane < end) {
                find_candidates(
                    scene, static_cast<std::uint32_t>(slot + lane), found[lane], contacts);
            } else {
                found[lane].count = 0;
            }
        }
        avoid_batch(scene, slot, slot - begin, found, planes);
    }
    return end;
}

#endif  // HWY_TARGET

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(avoid_neighbors_vector);

void WalkerColumns::resize(std::size_t count) {
    const std::size_t padded = (count + kWalkerBatch - 1) / kWalkerBatch * kWalkerBatch;
    for (std::vector<float>* column :
         {&x, &y, &vx, &vy, &radius, &weight, &side, &range, &preferred_x, &preferred_y, &max_speed,
          &horizon}) {
        // A vector may be read from any slot on.
        column->resize(padded + kWalkerBatch);
        std::fill(column->begin() + static_cast<std::ptrdiff_t>(count), column->end(), 0.0f);
    }
    keys.resize(padded);
}

namespace {

/// The neighbors of a walker, from the nearest on; adds its contacts.
std::vector<std::uint32_t>
list_neighbors(const WalkerScene& scene, std::uint32_t slot, WalkerContacts& contacts) {
    const WalkerColumns& columns = scene.columns;
    const walkers::SearchReach reach = walkers::find_reach(scene, slot);
    const Vec2 position = {columns.x[slot], columns.y[slot]};
    const std::size_t first_contact = contacts.others.size();
    contacts.begins.push_back(static_cast<std::uint32_t>(first_contact));
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    const auto search = [&](float limit, float window) {
        found.clear();
        contacts.others.resize(first_contact);
        each_run(scene.grid, position, window, [&](SlotRun run) {
            for (std::uint32_t i = run.begin; i < run.end; ++i) {
                const float distance2 =
                    square(columns.x[i] - position.x) + square(columns.y[i] - position.y);
                const float touch = columns.radius[slot] + scene.contact_reach + columns.radius[i];
                if (i != slot && distance2 < square(limit)) {
                    found.emplace_back(
                        std::bit_cast<std::uint32_t>(distance2) & ~walkers::kIndexMask, i);
                }
                if (i != slot && distance2 < square(touch)) {
                    contacts.others.push_back(i);
                }
            }
        });
        // Equally near ones stay in the order of the grid.
        std::ranges::stable_sort(found, {}, &std::pair<std::uint32_t, std::uint32_t>::first);
    };
    if (reach.is_dense) {
        search(scene.grid.cell, scene.grid.cell);
    }
    if (!reach.is_dense || found.size() < kMaxNeighbors) {
        search(columns.range[slot], std::max(columns.range[slot], reach.contact));
    }
    std::vector<std::uint32_t> slots;
    for (std::size_t i = 0; i < std::min(found.size(), kMaxNeighbors); ++i) {
        slots.push_back(found[i].second);
    }
    return slots;
}

VelocityPlane avoid_slot(const WalkerScene& scene, std::uint32_t slot, std::uint32_t other) {
    const WalkerColumns& columns = scene.columns;
    const auto disc = [&](std::uint32_t i, float personal) {
        return WalkerDisc{
            {columns.x[i], columns.y[i]},
            {columns.vx[i], columns.vy[i]},
            columns.radius[i] + personal};
    };
    const WalkerDisc own = disc(slot, scene.personal);
    const WalkerDisc there = disc(other, 0);
    const Vec2 offset = there.position - own.position;
    const bool overlaps = glm::dot(offset, offset) <= square(own.radius + there.radius);
    const float side = columns.side[slot];
    return avoid_walker(
        own, there,
        {.horizon = columns.horizon[slot],
         .contact_time = scene.contact_time,
         .share = columns.weight[other] / (columns.weight[slot] + columns.weight[other]),
         .side = side == columns.side[other] ? side : 0.0f,
         .apart =
             overlaps ? parting_direction(columns.keys[slot], columns.keys[other]) : Vec2(1, 0)});
}

}  // namespace

void avoid_neighbors_scalar(
    const WalkerScene& scene, std::size_t begin, std::size_t end, WalkerContacts& contacts,
    WalkerPlanes& planes) {
    const WalkerColumns& columns = scene.columns;
    for (std::size_t lane = 0; begin + lane < end; ++lane) {
        const auto slot = static_cast<std::uint32_t>(begin + lane);
        const Vec2 preferred = {columns.preferred_x[slot], columns.preferred_y[slot]};
        const float speed2 = glm::dot(preferred, preferred);
        const float max_speed = columns.max_speed[slot];
        const Vec2 start =
            speed2 > square(max_speed) ? preferred * (max_speed / std::sqrt(speed2)) : preferred;
        bool is_met = true;
        const std::vector<std::uint32_t> neighbors = list_neighbors(scene, slot, contacts);
        for (std::size_t k = 0; k < neighbors.size(); ++k) {
            const VelocityPlane plane = avoid_slot(scene, slot, neighbors[k]);
            planes.normal_x[k][lane] = plane.normal.x;
            planes.normal_y[k][lane] = plane.normal.y;
            planes.offset[k][lane] = plane.offset;
            is_met = is_met && glm::dot(plane.normal, start) >= plane.offset;
        }
        planes.count[lane] = static_cast<std::uint32_t>(neighbors.size());
        planes.start_x[lane] = start.x;
        planes.start_y[lane] = start.y;
        planes.is_met[lane] = is_met ? 1 : 0;
    }
}

void avoid_neighbors(
    const WalkerScene& scene, std::size_t begin, std::size_t end, WalkerContacts& contacts,
    WalkerPlanes& planes) {
    LIMN_CHECK(begin % kWalkerBatch == 0 && begin < end && end - begin <= kWalkerBatch);
    if (HWY_DYNAMIC_DISPATCH(avoid_neighbors_vector)(scene, begin, end, contacts, planes) < end) {
        avoid_neighbors_scalar(scene, begin, end, contacts, planes);
    }
}

}  // namespace limn
#endif  // HWY_ONCE
