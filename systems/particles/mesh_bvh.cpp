#include "systems/particles/mesh_bvh.h"

#include "ecs/base/check.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/particles/mesh_bvh.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

// Techniques: particle.collision-loop

#ifndef LIMN_MESH_BVH_RAY
#define LIMN_MESH_BVH_RAY
namespace limn::mesh_bvh {

using Dvec3 = glm::dvec3;

/// Enough for 7 siblings on each of kMaxDepth levels and as many halvings below.
inline constexpr int kMaxDepth = 32;
inline constexpr std::size_t kStack = 7 * 2 * kMaxDepth + 8;

/// Relative error of fractions and sheared coordinates.
inline constexpr float kRounding = 1e-6f;

/// A segment as the tests read it. Boxes are padded by what rounding may displace a triangle as
/// the watertight test sees it.
struct Ray {
    float from[3];
    int axis[3];         ///< permutes x, y, z: the last one is the longest of the direction
    float shear[2];      ///< turns the direction into the last axis
    float scale;         ///< to fractions
    int near_side[3];    ///< the side of a box that is met first: 0 minimum, 1 maximum
    float origin[2][3];  ///< for the near side, the far side
    float inverse[3];    ///< 1 / direction, finite
};

/// Whether the segment is finite and long enough to trace.
HWY_INLINE bool is_traceable(const Segment& segment) {
    const Vec3 from = glm::abs(segment.from);
    const Vec3 size = glm::abs(segment.to - segment.from);
    const float longest =
        size.x > size.y ? (size.x > size.z ? size.x : size.z) : (size.y > size.z ? size.y : size.z);
    return std::isfinite(from.x + from.y + from.z + (size.x + size.y + size.z))
           && longest >= 1e-30f;
}

HWY_INLINE float padding(const Segment& segment, float largest) {
    const Vec3 from = glm::abs(segment.from);
    return kRounding * (std::max(std::max(from.x, from.y), from.z) + largest);
}

/// Of a traceable segment.
inline Ray make_ray(const Segment& segment, float pad) {
    const Vec3 delta = segment.to - segment.from;
    const Vec3 size = glm::abs(delta);
    const int longest = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    Ray ray;
    ray.axis[0] = (longest + 1) % 3;
    ray.axis[1] = (longest + 2) % 3;
    ray.axis[2] = longest;
    ray.scale = 1.0f / delta[longest];
    ray.shear[0] = delta[ray.axis[0]] / delta[longest];
    ray.shear[1] = delta[ray.axis[1]] / delta[longest];
    for (int i = 0; i < 3; ++i) {
        const bool down = std::signbit(delta[i]);
        ray.from[i] = segment.from[i];
        ray.near_side[i] = down ? 1 : 0;
        ray.origin[0][i] = segment.from[i] + (down ? -pad : pad);
        ray.origin[1][i] = segment.from[i] + (down ? pad : -pad);
        ray.inverse[i] = 1.0f / (down ? std::min(delta[i], -1e-30f) : std::max(delta[i], 1e-30f));
    }
    return ray;
}

/// A segment that traverses the tree. Most segments are so short that overlap with their bounding
/// box already rejects nearly all nodes, so the ray is set up only when first needed.
struct Path {
    const Segment& segment;
    float pad;
    Vec3 low;   ///< of the segment's box, padded
    Vec3 high;  ///< likewise
    Ray its_ray;
    bool has_ray = false;

    Path(const Segment& its_segment, float largest)
        : segment(its_segment), pad(padding(its_segment, largest)),
          low(glm::min(segment.from, segment.to) - pad),
          high(glm::max(segment.from, segment.to) + pad) {}
    const Ray& ray() {
        if (!has_ray) {
            its_ray = make_ray(segment, pad);
            has_ray = true;
        }
        return its_ray;
    }
};

/// Tests triangle `lane` with exact signs (products of floats are exact in double), for rays that
/// in single precision pass through an edge. Returns the fraction, or NaN if it is not hit.
inline float exact_fraction(const MeshBvh::Leaf& leaf, std::size_t lane, const Ray& ray) {
    float p[3][3];
    for (int corner = 0; corner < 3; ++corner) {
        float* const q = p[corner];
        for (int i = 0; i < 3; ++i) {
            q[i] = leaf.corner[corner][ray.axis[i]][lane] - ray.from[ray.axis[i]];
        }
        q[0] -= ray.shear[0] * q[2];
        q[1] -= ray.shear[1] * q[2];
        q[2] *= ray.scale;
    }
    const auto edge = [&p](int a, int b) {
        return double{p[a][0]} * double{p[b][1]} - double{p[a][1]} * double{p[b][0]};
    };
    const double u = edge(2, 1);
    const double v = edge(0, 2);
    const double w = edge(1, 0);
    const double sum = u + v + w;
    if ((std::min({u, v, w}) < 0 && std::max({u, v, w}) > 0) || sum == 0) {
        return std::numeric_limits<float>::quiet_NaN();
    }
    return static_cast<float>(
        (u * double{p[0][2]} + v * double{p[1][2]} + w * double{p[2][2]}) / sum);
}

/// So that cache misses overlap.
template <typename T>
inline void prefetch(const T& object) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&object);
    for (std::size_t i = 0; i < sizeof(T); i += 64) {
        hwy::Prefetch(bytes + i);
    }
}

}  // namespace limn::mesh_bvh
#endif

HWY_BEFORE_NAMESPACE();
namespace limn::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using mesh_bvh::Ray;

/// Calls hit(lane, near) for each child whose box the path may intersect within `limit`.
template <typename Hit>
HWY_INLINE void meet_boxes(const MeshBvh::Node& node, mesh_bvh::Path& path, float limit, Hit hit) {
    const hn::CappedTag<float, MeshBvh::kChildren> d;
    for (std::size_t first = 0; first < MeshBvh::kChildren; first += hn::Lanes(d)) {
        const auto overlap = [&](int i) {
            return hn::And(
                hn::Le(hn::LoadU(d, node.bounds[0][i] + first), hn::Set(d, path.high[i])),
                hn::Ge(hn::LoadU(d, node.bounds[1][i] + first), hn::Set(d, path.low[i])));
        };
        const auto overlaps = hn::And(hn::And(overlap(0), overlap(1)), overlap(2));
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, overlaps, bits);
        if ((bits[0] & (bits[0] - 1)) == 0) {  // at most one: no need to order by distance
            if (bits[0] != 0) {
                hit(first + static_cast<std::size_t>(std::countr_zero(bits[0])), 0.0f);
            }
            continue;
        }
        const Ray& ray = path.ray();
        auto near = hn::Zero(d);
        auto far = hn::Set(d, limit * (1 + mesh_bvh::kRounding));
        for (int i = 0; i < 3; ++i) {
            const int side = ray.near_side[i];
            const auto inverse = hn::Set(d, ray.inverse[i]);
            const auto enter = hn::Mul(
                hn::Sub(hn::LoadU(d, node.bounds[side][i] + first), hn::Set(d, ray.origin[0][i])),
                inverse);
            const auto leave = hn::Mul(
                hn::Sub(
                    hn::LoadU(d, node.bounds[1 - side][i] + first), hn::Set(d, ray.origin[1][i])),
                inverse);
            near = hn::Max(near, enter);
            far = hn::Min(far, leave);
        }
        hn::StoreMaskBits(d, hn::Le(near, far), bits);
        if (bits[0] != 0) {
            HWY_ALIGN float nears[MeshBvh::kChildren];
            hn::StoreU(near, d, nears);
            for (unsigned left = bits[0]; left != 0; left &= left - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(left));
                hit(first + lane, nears[lane]);
            }
        }
    }
}

/// Calls hit(lane, fraction) for each triangle that the ray intersects.
template <typename Hit>
HWY_INLINE void meet_triangles(const MeshBvh::Leaf& leaf, const Ray& ray, Hit hit) {
    const hn::CappedTag<float, MeshBvh::kTriangles> d;
    using V = hn::Vec<decltype(d)>;
    const auto zero = hn::Zero(d);
    const auto rounding = hn::Set(d, mesh_bvh::kRounding);
    for (std::size_t first = 0; first < MeshBvh::kTriangles; first += hn::Lanes(d)) {
        const auto corner = [&](int index, V& x, V& y, V& z) {
            const auto relative = [&](int i) {
                const int axis = ray.axis[i];
                return hn::Sub(
                    hn::LoadU(d, leaf.corner[index][axis] + first), hn::Set(d, ray.from[axis]));
            };
            z = relative(2);
            x = hn::Sub(relative(0), hn::Mul(hn::Set(d, ray.shear[0]), z));
            y = hn::Sub(relative(1), hn::Mul(hn::Set(d, ray.shear[1]), z));
            z = hn::Mul(z, hn::Set(d, ray.scale));
        };
        V ax;
        V ay;
        V az;
        V bx;
        V by;
        V bz;
        V cx;
        V cy;
        V cz;
        corner(0, ax, ay, az);
        corner(1, bx, by, bz);
        corner(2, cx, cy, cz);
        const V u = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
        const V v = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
        const V w = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
        const auto inside = hn::Or(
            hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), hn::Ge(w, zero)),
            hn::And(hn::And(hn::Le(u, zero), hn::Le(v, zero)), hn::Le(w, zero)));
        if (hn::AllFalse(d, inside)) {
            continue;
        }
        const auto on_edge = hn::Or(hn::Or(hn::Eq(u, zero), hn::Eq(v, zero)), hn::Eq(w, zero));
        const V sum = hn::Add(hn::Add(u, v), w);
        const V scaled = hn::Add(hn::Add(hn::Mul(u, az), hn::Mul(v, bz)), hn::Mul(w, cz));
        const V farthest = hn::Max(hn::Max(hn::Abs(az), hn::Abs(bz)), hn::Abs(cz));
        HWY_ALIGN float fractions[MeshBvh::kTriangles];
        HWY_ALIGN float slack[MeshBvh::kTriangles];
        hn::StoreU(hn::Div(scaled, sum), d, fractions);
        hn::StoreU(hn::Mul(rounding, farthest), d, slack);
        std::uint8_t bits[8] = {};
        std::uint8_t edges[8] = {};
        hn::StoreMaskBits(d, inside, bits);
        hn::StoreMaskBits(d, on_edge, edges);
        for (unsigned left = bits[0]; left != 0; left &= left - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(left));
            const float fraction = ((edges[0] >> lane) & 1u) != 0
                                       ? mesh_bvh::exact_fraction(leaf, first + lane, ray)
                                       : fractions[lane];
            if (fraction >= -slack[lane] && fraction <= 1 + slack[lane]) {
                hit(first + lane, std::clamp(fraction, 0.0f, 1.0f));
            }
        }
    }
}

HWY_INLINE MeshHit trace(const MeshBvh& bvh, const Segment& segment) {
    struct Open {
        std::uint32_t child;
        float near;
    };
    if (bvh.nodes.empty() || !mesh_bvh::is_traceable(segment)) {
        return {};
    }
    mesh_bvh::Path path(segment, bvh.largest);
    MeshHit best = {.fraction = 1};
    const MeshBvh::Leaf* best_leaf = nullptr;
    std::size_t best_lane = 0;
    Open stack[mesh_bvh::kStack];
    stack[0] = {0, 0};
    std::size_t open = 1;
    while (open > 0) {
        const Open next = stack[--open];
        if (next.near > best.fraction * (1 + mesh_bvh::kRounding)) {
            continue;
        }
        if ((next.child & MeshBvh::kLeafBit) != 0) {
            const MeshBvh::Leaf& leaf = bvh.leaves[next.child & ~MeshBvh::kLeafBit];
            meet_triangles(leaf, path.ray(), [&](std::size_t lane, float fraction) {
                const std::uint32_t triangle = leaf.triangle[lane];
                if (fraction < best.fraction
                    || (fraction == best.fraction && triangle < best.triangle)) {
                    best = {.fraction = fraction, .triangle = triangle};
                    best_leaf = &leaf;
                    best_lane = lane;
                }
            });
            continue;
        }
        const MeshBvh::Node& node = bvh.nodes[next.child];
        const std::size_t begin = open;
        meet_boxes(node, path, best.fraction, [&](std::size_t lane, float near) {
            std::size_t at = open++;  // nearest last
            for (; at > begin && stack[at - 1].near < near; --at) {
                stack[at] = stack[at - 1];
            }
            const std::uint32_t child = node.child[lane];
            stack[at] = {child, near};
            if ((child & MeshBvh::kLeafBit) != 0) {
                mesh_bvh::prefetch(bvh.leaves[child & ~MeshBvh::kLeafBit]);
            } else {
                mesh_bvh::prefetch(bvh.nodes[child]);
            }
        });
    }
    if (best_leaf == nullptr) {
        return {};
    }
    const auto corner = [&](int index) {
        const auto& c = best_leaf->corner[index];
        return mesh_bvh::Dvec3(c[0][best_lane], c[1][best_lane], c[2][best_lane]);
    };
    best.normal = Vec3(glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0))));
    return best;
}

/// Fills hits[i] for all i in `order`, one after the other.
void trace_all(
    const MeshBvh& bvh, const Segment* segments, std::span<const std::uint32_t> order,
    MeshHit* hits) {
    constexpr std::size_t kAhead = 4;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i + kAhead < order.size()) {
            hwy::Prefetch(segments + order[i + kAhead]);
            hwy::Prefetch(hits + order[i + kAhead]);
        }
        hits[order[i]] = trace(bvh, segments[order[i]]);
    }
}

}  // namespace limn::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn {

HWY_EXPORT(trace_all);

namespace {

using mesh_bvh::Dvec3;

constexpr int kBins = 16;

struct Item {
    Bounds bounds;
    std::uint32_t triangle;
};

struct Range {
    std::span<Item> items;
    Bounds bounds;
};

struct Bin {
    Bounds bounds;
    std::size_t count = 0;
};

float half_area(const Bounds& b) {
    const Vec3 size = b.max - b.min;
    return is_empty(b) ? 0.0f : size.x * size.y + size.y * size.z + size.z * size.x;
}

Bounds bounds_of(std::span<const Item> items) {
    Bounds bounds;
    for (const Item& item : items) {
        grow(bounds, item.bounds);
    }
    return bounds;
}

/// SAH cost: the surface area times the number of leaves that the triangles fill.
float cost_of(const Bin& bin) {
    const std::size_t groups = (bin.count + MeshBvh::kTriangles - 1) / MeshBvh::kTriangles;
    return half_area(bin.bounds) * static_cast<float>(groups);
}

struct Cut {
    float cost = INFINITY;
    int axis = -1;
    int bin = 0;  ///< first of the second part
};

/// The bin of an item's center along an axis.
int bin_of(const Item& item, const Bounds& centers, int axis) {
    const float low = centers.min[axis];
    const float at = center(item.bounds)[axis] - low;
    return std::min(static_cast<int>(at / (centers.max[axis] - low) * kBins), kBins - 1);
}

Cut find_cut(std::span<const Item> items, const Bounds& centers) {
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
        const float extent = centers.max[axis] - centers.min[axis];
        if (!(extent > 0) || !std::isfinite(extent)) {
            continue;
        }
        Bin bins[kBins];
        for (const Item& item : items) {
            Bin& bin = bins[bin_of(item, centers, axis)];
            grow(bin.bounds, item.bounds);
            ++bin.count;
        }
        const auto add = [](Bin& sum, const Bin& bin) {
            grow(sum.bounds, bin.bounds);
            sum.count += bin.count;
        };
        float second[kBins];
        Bin sum;
        for (int i = kBins - 1; i > 0; --i) {
            add(sum, bins[i]);
            second[i] = cost_of(sum);
        }
        sum = {};
        for (int i = 1; i < kBins; ++i) {
            add(sum, bins[i - 1]);
            const float cost = cost_of(sum) + second[i];
            if (cost < best.cost && sum.count > 0 && sum.count < items.size()) {
                best = {cost, axis, i};
            }
        }
    }
    return best;
}

/// Splits where the SAH cost is least; in halves if all centers coincide, or below kMaxDepth, where
/// binning has cut off too little.
std::pair<Range, Range> split(const Range& range, int depth) {
    Bounds centers;
    for (const Item& item : range.items) {
        grow(centers, center(item.bounds));
    }
    std::size_t first = range.items.size() / 2;
    const Cut cut = depth < mesh_bvh::kMaxDepth ? find_cut(range.items, centers) : Cut{};
    if (cut.axis >= 0) {
        const auto median =
            std::partition(range.items.begin(), range.items.end(), [&](const Item& item) {
                return bin_of(item, centers, cut.axis) < cut.bin;
            });
        first = static_cast<std::size_t>(median - range.items.begin());
    }
    const std::span<Item> a = range.items.first(first);
    const std::span<Item> b = range.items.subspan(first);
    return {Range{a, bounds_of(a)}, Range{b, bounds_of(b)}};
}

std::uint32_t add_leaf(MeshBvh& bvh, std::span<const Item> items) {
    MeshBvh::Leaf& leaf = bvh.leaves.emplace_back();
    std::fill(std::begin(leaf.triangle), std::end(leaf.triangle), kNoTriangle);
    for (std::size_t i = 0; i < items.size(); ++i) {
        leaf.triangle[i] = items[i].triangle;
    }
    return static_cast<std::uint32_t>(bvh.leaves.size() - 1) | MeshBvh::kLeafBit;
}

/// Splits the child of the largest area until there are eight.
std::uint32_t add_node(MeshBvh& bvh, const Range& range, int depth) {
    const std::size_t index = bvh.nodes.size();
    bvh.nodes.emplace_back();
    Range children[MeshBvh::kChildren] = {range};
    std::size_t count = 1;
    while (count < MeshBvh::kChildren) {
        Range* largest = nullptr;
        for (Range& child : std::span(children).first(count)) {
            if (child.items.size() > MeshBvh::kTriangles
                && (largest == nullptr || half_area(child.bounds) > half_area(largest->bounds))) {
                largest = &child;
            }
        }
        if (largest == nullptr) {
            break;
        }
        std::tie(*largest, children[count++]) = split(*largest, depth);
    }
    for (std::size_t i = 0; i < MeshBvh::kChildren; ++i) {
        std::uint32_t child = MeshBvh::kNoChild;
        if (i < count) {
            child = children[i].items.size() > MeshBvh::kTriangles
                        ? add_node(bvh, children[i], depth + 1)
                        : add_leaf(bvh, children[i].items);
        }
        bvh.nodes[index].child[i] = child;
        for (int axis = 0; axis < 3; ++axis) {  // those of an empty child stay
            bvh.nodes[index].bounds[0][axis][i] = INFINITY;
            bvh.nodes[index].bounds[1][axis][i] = -INFINITY;
        }
    }
    return static_cast<std::uint32_t>(index);
}

/// Reads the corners again; returns their bounds.
Bounds load_leaf(
    MeshBvh::Leaf& leaf, std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
    Bounds bounds;
    for (std::size_t lane = 0; lane < MeshBvh::kTriangles; ++lane) {
        Vec3 corners[3] = {Vec3(NAN), Vec3(NAN), Vec3(NAN)};
        if (leaf.triangle[lane] != kNoTriangle) {
            for (std::size_t i = 0; i < 3; ++i) {
                corners[i] = positions[indices[3 * leaf.triangle[lane] + i]];
            }
        }
        const bool usable = is_finite(corners[0]) && is_finite(corners[1]) && is_finite(corners[2]);
        for (int i = 0; i < 3; ++i) {
            if (usable) {
                grow(bounds, corners[i]);
            }
            for (int axis = 0; axis < 3; ++axis) {
                leaf.corner[i][axis][lane] = usable ? corners[i][axis] : NAN;
            }
        }
    }
    return bounds;
}

Bounds bounds_of(const MeshBvh::Node& node) {
    Bounds bounds;
    for (std::size_t i = 0; i < MeshBvh::kChildren; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            bounds.min[axis] = std::min(bounds.min[axis], node.bounds[0][axis][i]);
            bounds.max[axis] = std::max(bounds.max[axis], node.bounds[1][axis][i]);
        }
    }
    return bounds;
}

/// 10 bits per axis of the position within `bounds`, interleaved.
std::uint32_t morton_code(const Vec3& p, const Bounds& bounds) {
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float fraction =
            (p[axis] - bounds.min[axis]) / (bounds.max[axis] - bounds.min[axis]) * 1024.0f;
        std::uint32_t bits =
            fraction >= 1 ? static_cast<std::uint32_t>(std::min(fraction, 1023.0f)) : 0;
        bits = (bits | bits << 16) & 0x030000ffu;
        bits = (bits | bits << 8) & 0x0300f00fu;
        bits = (bits | bits << 4) & 0x030c30c3u;
        bits = (bits | bits << 2) & 0x09249249u;
        code |= bits << axis;
    }
    return code;
}

}  // namespace

MeshBvh build_mesh_bvh(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
    LIMN_CHECK(indices.size() % 3 == 0 && indices.size() / 3 < MeshBvh::kLeafBit);
    std::vector<Item> items;
    items.reserve(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        Item item = {.bounds = {}, .triangle = static_cast<std::uint32_t>(i / 3)};
        if (std::max({indices[i], indices[i + 1], indices[i + 2]}) >= positions.size()) {
            continue;
        }
        Dvec3 corners[3];
        for (std::size_t k = 0; k < 3; ++k) {
            grow(item.bounds, positions[indices[i + k]]);
            corners[k] = Dvec3(positions[indices[i + k]]);
        }
        const Dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double area2 = glm::dot(normal, normal);
        if (area2 > 0 && std::isfinite(area2)) {
            items.push_back(item);
        }
    }
    MeshBvh bvh;
    if (!items.empty()) {
        add_node(bvh, {items, bounds_of(std::span<const Item>(items))}, 0);
        refit_mesh_bvh(bvh, positions, indices);
    }
    return bvh;
}

void refit_mesh_bvh(
    MeshBvh& bvh, std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
    for (std::size_t n = bvh.nodes.size(); n-- > 0;) {  // children first
        MeshBvh::Node& node = bvh.nodes[n];
        for (std::size_t i = 0; i < MeshBvh::kChildren; ++i) {
            const std::uint32_t child = node.child[i];
            if (child == MeshBvh::kNoChild) {
                continue;
            }
            const Bounds bounds =
                (child & MeshBvh::kLeafBit) == 0
                    ? bounds_of(bvh.nodes[child])
                    : load_leaf(bvh.leaves[child & ~MeshBvh::kLeafBit], positions, indices);
            for (int axis = 0; axis < 3; ++axis) {
                node.bounds[0][axis][i] = bounds.min[axis];
                node.bounds[1][axis][i] = bounds.max[axis];
            }
        }
    }
    if (!bvh.nodes.empty()) {
        const Bounds all = bounds_of(bvh.nodes[0]);
        const Vec3 size = glm::max(glm::abs(all.min), glm::abs(all.max));
        bvh.largest = is_empty(all) ? 0.0f : std::max({size.x, size.y, size.z});
    }
}

MeshHit first_hit(const MeshBvh& bvh, const Segment& segment) {
    static constexpr std::uint32_t kFirst[] = {0};
    MeshHit hit;
    HWY_DYNAMIC_DISPATCH(trace_all)(bvh, &segment, std::span(kFirst), &hit);
    return hit;
}

void first_hits(
    const MeshBvh& bvh, std::span<const Segment> segments, std::span<MeshHit> hits,
    SegmentBatch& batch) {
    LIMN_CHECK(segments.size() == hits.size());
    const Bounds bounds = bvh.nodes.empty() ? Bounds{} : bounds_of(bvh.nodes[0]);
    batch.keys.resize(segments.size());
    batch.order.resize(segments.size());
    std::iota(batch.order.begin(), batch.order.end(), 0u);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        batch.keys[i] = morton_code(0.5f * (segments[i].from + segments[i].to), bounds);
    }
    sort_by_depth(std::span<const std::uint32_t>(batch.keys), batch.order, batch.sort);
    HWY_DYNAMIC_DISPATCH(trace_all)(bvh, segments.data(), batch.order, hits.data());
}

}  // namespace limn
#endif  // HWY_ONCE
