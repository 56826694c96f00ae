#include "render/water/caustic_splat.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

// Techniques: caustic.projected-vertices

namespace limn {
namespace {

constexpr int kMaxStripes = 4;               ///< per grid, independent of the thread count
constexpr int kStripe = 64;                  ///< minimum cells across a stripe
constexpr float kFixedPointOne = 524288.0f;  ///< fixed-point value of the light under flat water
constexpr float kMaxRays = 48;               ///< maximum rays along a side of a cell
constexpr float kRaysPerTexel = 2;           ///< rays along a texel
constexpr float kMaxRaysMirrored = 12;       ///< the same above the water
constexpr float kRaysPerTexelMirrored = 1;
constexpr float kWireLight = 4;  ///< of wires, relative to that under flat water
constexpr int kSplatBorder = 8;  ///< texels around a map for rays that land outside

/// A map with a border, so that rays need no bounds test.
struct Sheet {
    std::uint32_t* texels = nullptr;
    int stride = 0;
    float limit = 0;  ///< maximum coordinate of a ray, from the sheet's corner
};

/// How a map's cells are subdivided into rays.
struct Cut {
    float texels = 1;  ///< spacing of the grid's rays
    bool by_area = false;
    float per_texel = kRaysPerTexel;
    float max_rays = kMaxRays;
};

/// Adds to two texels at once; neither sum overflows 32 bits.
void add_pair(std::uint32_t* texels, float left, float right) {
    std::uint64_t both = 0;
    std::memcpy(&both, texels, sizeof(both));
    both += static_cast<std::uint64_t>(
                static_cast<std::uint32_t>(static_cast<std::int32_t>(left + 0.5f)))
            + (static_cast<std::uint64_t>(
                   static_cast<std::uint32_t>(static_cast<std::int32_t>(right + 0.5f)))
               << 32);
    std::memcpy(texels, &both, sizeof(both));
}

void add(const Sheet& sheet, float x, float y, float amount) {
    // NaN lands in the corner, too.
    const float u = std::min(std::max(0.0f, x + (kSplatBorder - 0.5f)), sheet.limit);
    const float v = std::min(std::max(0.0f, y + (kSplatBorder - 0.5f)), sheet.limit);
    const int column = static_cast<int>(u);
    const int row = static_cast<int>(v);
    const float s = u - static_cast<float>(column);
    const float t = v - static_cast<float>(row);
    std::uint32_t* const at = sheet.texels + row * sheet.stride + column;
    const float above = amount * t;
    const float below = amount - above;
    add_pair(at, below - below * s, below * s);
    add_pair(at + sheet.stride, above - above * s, above * s);
}

/// Splats the cell with rays a, b and, in the next row, c, d.
void add_cell(
    const Sheet& sheet, const Vec4& a, const Vec4& b, const Vec4& c, const Vec4& d,
    const Cut& cut) {
    const auto rays_along = [&cut](
                                const Vec4& one_end, const Vec4& one, const Vec4& other_end,
                                const Vec4& other) {
        const Vec2 longest =
            glm::max(glm::abs(Vec2(one) - Vec2(one_end)), glm::abs(Vec2(other) - Vec2(other_end)));
        return static_cast<int>(std::clamp(
            std::ceil(cut.per_texel * std::max(longest.x, longest.y) - 0.01f), 1.0f, cut.max_rays));
    };
    const int columns = rays_along(a, b, c, d);
    const int rows = rays_along(a, c, b, d);
    const float across = 1 / static_cast<float>(columns);
    const float down = 1 / static_cast<float>(rows);
    const float area = cut.by_area
                           ? 0.5f * std::abs((d.x - a.x) * (c.y - b.y) - (d.y - a.y) * (c.x - b.x))
                           : cut.texels * cut.texels;
    const float whole = kFixedPointOne * area * across * down;
    for (int j = 0; j < rows; ++j) {
        const float v = (static_cast<float>(j) + 0.5f) * down;
        const Vec3 left = Vec3(a) + v * (Vec3(c) - Vec3(a));
        const Vec3 step = Vec3(b) + v * (Vec3(d) - Vec3(b)) - left;
        for (int i = 0; i < columns; ++i) {
            const Vec3 ray = left + (static_cast<float>(i) + 0.5f) * across * step;
            add(sheet, ray.x, ray.y, whole * ray.z);
        }
    }
}

/// A line about a texel wide.
void add_wire(const Sheet& sheet, const Vec4& a, const Vec4& b) {
    const float length = glm::distance(Vec2(a), Vec2(b));
    if (!std::isfinite(length)) {
        return;
    }
    const int points =
        static_cast<int>(std::clamp(std::ceil(kRaysPerTexel * length), 1.0f, kMaxRays));
    const float amount =
        kFixedPointOne * kWireLight * std::min(length, kMaxRays) / static_cast<float>(points);
    for (int i = 0; i < points; ++i) {
        const float at = (static_cast<float>(i) + 0.5f) / static_cast<float>(points);
        add(sheet, glm::mix(a.x, b.x, at), glm::mix(a.y, b.y, at), amount);
    }
}

/// A range of rows of a map's ray grid, and the buffer of its sums.
struct Stripe {
    std::size_t map = 0;
    int first = 0;  ///< row of cells
    int last = 0;
    std::size_t sums = 0;  ///< offset in CausticSums::parts
};

int side_of(const layout::CausticRecord& record) {
    return static_cast<int>(record.grid.y);
}
int stripes_of(const layout::CausticRecord& record) {
    return std::clamp(static_cast<int>(record.grid.x) / kStripe, 1, kMaxStripes);
}
std::size_t sheet_size(const layout::CausticRecord& record) {
    const auto stride = static_cast<std::size_t>(side_of(record) + 2 * kSplatBorder);
    return stride * stride;
}

void sum_stripe(
    const layout::CausticRecord& record, std::span<const Vec4> rays, const Stripe& stripe,
    std::uint32_t* texels) {
    const int cells = static_cast<int>(record.grid.x);
    const int stride = side_of(record) + 2 * kSplatBorder;
    const Sheet sheet = {texels, stride, static_cast<float>(stride) - 1.01f};
    std::fill_n(texels, sheet_size(record), 0u);
    const bool mirrored = record.grid.w == layout::kCausticsMirrored;
    const int wires = static_cast<int>(record.wires.x);
    const Cut cut = {
        record.grid.y / record.grid.x, record.grid.w == layout::kCausticsPool,
        mirrored ? kRaysPerTexelMirrored : kRaysPerTexel, mirrored ? kMaxRaysMirrored : kMaxRays};
    for (int z = stripe.first; z < stripe.last; ++z) {
        const Vec4* const row = rays.data() + z * (cells + 1);
        const Vec4* const next = row + cells + 1;
        for (int x = 0; x < cells; ++x) {
            add_cell(sheet, row[x], row[x + 1], next[x], next[x + 1], cut);
            if (wires > 0 && z % wires == 0 && row[x].z > 0 && row[x + 1].z > 0) {
                add_wire(sheet, row[x], row[x + 1]);
            }
            if (wires > 0 && x % wires == 0 && row[x].z > 0 && next[x].z > 0) {
                add_wire(sheet, row[x], next[x]);
            }
        }
    }
}

/// Writes a row of a map by adding the sums of its stripes, which start at `parts`.
void write_row(
    const layout::CausticRecord& record, const std::uint32_t* parts, int row, float* texels) {
    const int side = side_of(record);
    const int stripes = stripes_of(record);
    const std::size_t apart = sheet_size(record);
    const std::uint32_t* const from =
        parts + (row + kSplatBorder) * (side + 2 * kSplatBorder) + kSplatBorder;
    for (int x = 0; x < side; ++x) {
        std::uint32_t sum = 0;
        for (int stripe = 0; stripe < stripes; ++stripe) {
            sum += from[static_cast<std::size_t>(stripe) * apart + static_cast<std::size_t>(x)];
        }
        texels[x] = static_cast<float>(sum) * (1 / kFixedPointOne);
    }
}

}  // namespace

void splat_caustics(
    std::span<const layout::CausticRecord> records, std::span<const Vec4> rays, int width,
    CausticSums& sums, std::span<float> atlas) {
    std::vector<Stripe> stripes;
    std::vector<std::size_t> first_sum;
    std::size_t size = 0;
    for (std::size_t map = 0; map < records.size(); ++map) {
        const int cells = static_cast<int>(records[map].grid.x);
        const int count = stripes_of(records[map]);
        first_sum.push_back(size);
        for (int i = 0; i < count; ++i) {
            stripes.push_back({map, cells * i / count, cells * (i + 1) / count, size});
            size += sheet_size(records[map]);
        }
    }
    sums.parts.resize(size);

    parallel_for(stripes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const layout::CausticRecord& record = records[stripes[i].map];
            const auto points = static_cast<std::size_t>(record.grid.x) + 1;
            const auto first = static_cast<std::size_t>(record.target.z);
            LIMN_CHECK(rays.size() >= first + points * points);
            const std::span own = rays.subspan(first, points * points);
            sum_stripe(record, own, stripes[i], sums.parts.data() + stripes[i].sums);
        }
    });
    parallel_for(stripes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Stripe& stripe = stripes[i];
            const layout::CausticRecord& record = records[stripe.map];
            const int side = side_of(record);
            const int cells = static_cast<int>(record.grid.x);
            const auto x = static_cast<std::size_t>(record.target.x);
            const auto y = static_cast<std::size_t>(record.target.y);
            const auto stride = static_cast<std::size_t>(width);
            for (int row = side * stripe.first / cells; row < side * stripe.last / cells; ++row) {
                const std::size_t at = (y + static_cast<std::size_t>(row)) * stride + x;
                LIMN_CHECK(at + static_cast<std::size_t>(side) <= atlas.size());
                const std::uint32_t* const parts = sums.parts.data() + first_sum[stripe.map];
                write_row(record, parts, row, atlas.data() + at);
            }
        }
    });
}

}  // namespace limn
