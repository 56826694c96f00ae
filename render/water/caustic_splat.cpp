#include "render/water/caustic_splat.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/components/caustics.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr int kStripes = 4;          ///< of the grid, whatever the number of threads
constexpr float kWhole = 524288.0f;  ///< what a texel counts for the light of flat water
constexpr float kMost = 48;          ///< rays along a side of a cell
constexpr float kPerTexel = 2;       ///< rays along a texel
constexpr int kAside = 8;            ///< texels around a map that rays may land on

/// A map with texels around it, so that nobody asks whether a ray is in it.
struct Sheet {
    std::uint32_t* texels = nullptr;
    int stride = 0;
    float most = 0;  ///< of a ray's place, from the sheet's corner
};

void add(const Sheet& sheet, float x, float y, float amount) {
    const float u = std::clamp(x + (kAside - 0.5f), 0.0f, sheet.most);
    const float v = std::clamp(y + (kAside - 0.5f), 0.0f, sheet.most);
    const int column = static_cast<int>(u);
    const int row = static_cast<int>(v);
    const float s = u - static_cast<float>(column);
    const float t = v - static_cast<float>(row);
    std::uint32_t* const at = sheet.texels + row * sheet.stride + column;
    const float below = amount * (1 - t);
    const float above = amount * t;
    at[0] += static_cast<std::uint32_t>(static_cast<std::int32_t>(below * (1 - s) + 0.5f));
    at[1] += static_cast<std::uint32_t>(static_cast<std::int32_t>(below * s + 0.5f));
    at[sheet.stride] +=
        static_cast<std::uint32_t>(static_cast<std::int32_t>(above * (1 - s) + 0.5f));
    at[sheet.stride + 1] += static_cast<std::uint32_t>(static_cast<std::int32_t>(above * s + 0.5f));
}

/// The cell with rays a, b and, a row on, c, d.
void add_cell(
    const Sheet& sheet,
    const Vec4& a,
    const Vec4& b,
    const Vec4& c,
    const Vec4& d,
    float texels,
    bool by_area) {
    const auto reach = [](const Vec4& from, const Vec4& to) {
        return std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
    };
    const float longest =
        std::max(std::max(reach(a, b), reach(c, d)), std::max(reach(a, c), reach(b, d)));
    const int rows =
        static_cast<int>(std::clamp(std::ceil(kPerTexel * longest - 0.01f), 1.0f, kMost));
    const float part = 1 / static_cast<float>(rows);
    const float area = by_area
                           ? 0.5f * std::abs((d.x - a.x) * (c.y - b.y) - (d.y - a.y) * (c.x - b.x))
                           : texels * texels;
    const float whole = kWhole * area * part * part;
    for (int j = 0; j < rows; ++j) {
        const float v = (static_cast<float>(j) + 0.5f) * part;
        const Vec3 left = Vec3(a) + v * (Vec3(c) - Vec3(a));
        const Vec3 step = Vec3(b) + v * (Vec3(d) - Vec3(b)) - left;
        for (int i = 0; i < rows; ++i) {
            const Vec3 ray = left + (static_cast<float>(i) + 0.5f) * part * step;
            add(sheet, ray.x, ray.y, whole * ray.z);
        }
    }
}

}  // namespace

void splat_caustics(
    const layout::CausticRecord& record,
    std::span<const Vec4> rays,
    CausticSums& sums,
    std::span<float> map) {
    const int cells = static_cast<int>(record.grid.x);
    const int side = static_cast<int>(record.grid.y);
    LIMN_CHECK(
        rays.size() >= static_cast<std::size_t>(cells + 1) * static_cast<std::size_t>(cells + 1));
    LIMN_CHECK(map.size() == static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    const int stride = side + 2 * kAside;
    const auto sheet_size = static_cast<std::size_t>(stride) * static_cast<std::size_t>(stride);
    sums.parts.resize(kStripes * sheet_size);
    const float texels = record.grid.y / record.grid.x;
    const bool by_area = record.grid.w == static_cast<float>(CausticMethod::Pool);

    parallel_for(kStripes, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t stripe = begin; stripe < end; ++stripe) {
            const Sheet sheet = {
                sums.parts.data() + stripe * sheet_size,
                stride,
                static_cast<float>(stride) - 1.01f};
            std::fill_n(sheet.texels, sheet_size, 0u);
            const int first = cells * static_cast<int>(stripe) / kStripes;
            const int last = cells * static_cast<int>(stripe + 1) / kStripes;
            for (int z = first; z < last; ++z) {
                const Vec4* const row = rays.data() + z * (cells + 1);
                const Vec4* const next = row + cells + 1;
                for (int x = 0; x < cells; ++x) {
                    add_cell(sheet, row[x], row[x + 1], next[x], next[x + 1], texels, by_area);
                }
            }
        }
    });
    parallel_for(static_cast<std::size_t>(side), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) {
            const std::uint32_t* const from =
                sums.parts.data() + (z + kAside) * static_cast<std::size_t>(stride) + kAside;
            for (int x = 0; x < side; ++x) {
                std::uint32_t sum = 0;
                for (int stripe = 0; stripe < kStripes; ++stripe) {
                    sum += from
                        [static_cast<std::size_t>(stripe) * sheet_size
                         + static_cast<std::size_t>(x)];
                }
                map[z * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)] =
                    static_cast<float>(sum) * (1 / kWhole);
            }
        }
    });
}

}  // namespace limn
