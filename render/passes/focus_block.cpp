#include "render/passes/focus_block.h"

#include "render/render_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {
namespace {

/// How `blades` sides share a turn: the place on the rim of the unit aperture at `turn` of it.
Vec2 rim(const LensView& lens, float turn) {
    if (lens.blades < 3) {
        return {std::cos(2 * kPi * turn), std::sin(2 * kPi * turn)};
    }
    return point_on_aperture(lens, {turn, 1});
}

/// Radius of the aperture that goes through `place`; 1 at the rim of the unit aperture.
float radius_of_aperture(const LensView& lens, const Vec2& place) {
    if (lens.blades < 3) {
        return length(place);
    }
    const float slice = 2 * kPi / static_cast<float>(lens.blades);
    const float angle = std::atan2(place.y, place.x) - lens.blade_rotation;
    const float from_middle = angle - (std::floor(angle / slice) + 0.5f) * slice;
    return length(place) * std::cos(from_middle) / std::cos(0.5f * slice);
}

/// A place of the grid, and the radius of the disc or aperture that goes through it.
struct GridPlace {
    IVec2 at;
    float radius = 0;
};

/// The nearest places first.
template <typename RadiusOf>
std::vector<GridPlace> places_around(int most, RadiusOf&& radius_of) {
    std::vector<GridPlace> places;
    for (int y = -most; y <= most; ++y) {
        for (int x = -most; x <= most; ++x) {
            places.push_back({{x, y}, radius_of(Vec2(x, y))});
        }
    }
    std::stable_sort(places.begin(), places.end(), [](const GridPlace& a, const GridPlace& b) {
        return a.radius < b.radius;
    });
    return places;
}

/// What a disc of `radius` with a rim of 1 covers of the grid, and its variance along an axis.
struct Coverage {
    float area = 0;
    float variance = 0;
};

Coverage coverage_of(const std::vector<GridPlace>& places, float radius) {
    float area = 0;
    Vec2 middle = Vec2(0);
    float square = 0;
    for (const GridPlace& place : places) {
        const float covered = std::clamp(radius + 0.5f - place.radius, 0.0f, 1.0f);
        const Vec2 at = Vec2(place.at);
        area += covered;
        middle += covered * at;
        square += covered * dot(at, at);
    }
    middle /= area;
    return {area, 0.5f * (square / area - dot(middle, middle))};
}

void fill_small_circles(layout::FocusBlock& block) {
    const std::vector<GridPlace> places =
        places_around(3, [](const Vec2& at) { return length(at); });
    for (int i = 0; i < layout::kSlightTaps; ++i) {
        block.pixel[i] = Vec4(places[i].at, places[i].radius, 0);
    }
    for (int i = 0; i < layout::kAreas; ++i) {
        const float radius = static_cast<float>(i) / static_cast<float>(layout::kSlightStep);
        block.area[i / 4][i % 4] = 1 / coverage_of(places, radius).area;
    }
}

/// Kernels in the half picture, whose discs together with what else blurs them are as wide as the
/// circles.
void fill_kernels(const LensView& lens, layout::FocusBlock& block) {
    constexpr float kTents = 1.5f;        // variance of splitting and showing [px^2]
    constexpr float kRim = 5.0f / 12;     // what a rim of 1 adds to the square of a radius
    constexpr float kFromLattice = 6.0f;  // circles [px] from which texels are as good as areas
    const float shape = block.aperture.w;
    const std::vector<GridPlace> places =
        places_around(5, [&](const Vec2& at) { return radius_of_aperture(lens, at); });
    for (int i = 0; i < layout::kFineTaps; ++i) {
        block.texel[i] = Vec4(places[i].at, places[i].radius, 0);
    }
    const float less = kRim + 0.25f * kTents / shape;
    const auto beyond = [&](float radius) {
        return std::sqrt(std::max(0.25f * radius * radius - less, 0.25f));
    };
    float kernel = 0.5f;
    for (int i = 0; i < layout::kKernels; ++i) {
        const float radius = static_cast<float>(i) / static_cast<float>(layout::kKernelStep);
        const float wanted = 0.25f * (shape * radius * radius - kTents);
        while (kernel < beyond(kFromLattice) && coverage_of(places, kernel).variance < wanted) {
            kernel += 1.0f / 64;
        }
        const float its = radius < kFromLattice ? kernel : beyond(radius);
        block.kernel[i / 2][2 * (i % 2)] = its;
        block.kernel[i / 2][2 * (i % 2) + 1] = 1 / coverage_of(places, its).area;
    }
}

}  // namespace

int widest_circle(const RenderView& view) {
    return static_cast<int>(view.lens.largest_blur * static_cast<float>(view.height));
}

layout::FocusBlock make_focus_block(const RenderView& view) {
    const LensView& lens = view.lens;
    const IVec2 size = {view.width, view.height};
    const IVec2 half = half_of(size);
    const float widest = static_cast<float>(widest_circle(view));
    layout::FocusBlock block{};
    block.lens = {
        circle_scale(lens, view.tangent.y, view.height), 1 / lens.focus_distance, 1 / view.near,
        widest};

    const bool round = lens.blades < 3;
    const float slice = 2 * kPi / static_cast<float>(round ? 3 : lens.blades);
    block.aperture = {
        static_cast<float>(lens.blades), lens.blade_rotation,
        round ? kPi : kPi / slice * std::sin(slice), round ? 0.25f : (2 + std::cos(slice)) / 12};

    const IVec2 tiles = (size + layout::kFocusTile - 1) / layout::kFocusTile;
    const float coarse = std::max(0.5f * widest / layout::kLevelRadius, 1.0f);
    block.tiles = {
        tiles.x, tiles.y,
        static_cast<int>(std::ceil(0.5f * widest / static_cast<float>(layout::kFocusTile))),
        std::max(static_cast<int>(std::ceil(std::log2(coarse))), 1)};
    block.size = Vec4(size, half);

    // A sunflower: equal areas, no rows.
    constexpr float kGolden = 0.61803399f;
    for (int i = 0; i < layout::kFocusTaps; ++i) {
        const float turn = static_cast<float>(i) * kGolden;
        block.tap[i] = Vec4(rim(lens, turn - std::floor(turn)), 0, 0);
    }
    fill_small_circles(block);
    fill_kernels(lens, block);
    return block;
}

}  // namespace limn
