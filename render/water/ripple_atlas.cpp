#include "render/water/ripple_atlas.h"

#include <algorithm>
#include <numeric>

namespace limn {

namespace {

constexpr int kBorder = 1;

/// One row of texels, border included.
void fill_row(const RippleState& state, int z, Vec4* texels) {
    const int row = std::clamp(z, 0, state.cells.y - 1);
    const float* const here = state.height.data() + state.at(0, row);
    const float* const before = state.previous.data() + state.at(0, row);
    const float* const above = state.height.data() + state.at(0, std::max(row - 1, 0));
    const float* const below =
        state.height.data() + state.at(0, std::min(row + 1, state.cells.y - 1));
    const float per_cell = 0.5f / state.cell;
    const float per_second = state.substep > 0 ? 1.0f / state.substep : 0.0f;
    const int last = state.cells.x - 1;
    for (int x = 0; x <= last; ++x) {
        const float slope_x = here[std::min(x + 1, last)] - here[std::max(x - 1, 0)];
        texels[x + kBorder] = {
            here[x], (here[x] - before[x]) * per_second, slope_x * per_cell,
            (below[x] - above[x]) * per_cell};
    }
    texels[0] = texels[kBorder];
    texels[state.cells.x + kBorder] = texels[last + kBorder];
}

}  // namespace

int pack_shelves(std::span<const IVec2> sizes, int width, std::span<IVec2> corners) {
    std::vector<std::size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return sizes[a].y > sizes[b].y;
    });
    IVec2 next(0);
    int shelf = 0;  // height of the current shelf
    for (const std::size_t i : order) {
        if (next.x + sizes[i].x > width) {
            next = {0, next.y + shelf};
            shelf = 0;
        }
        corners[i] = next;
        next.x += sizes[i].x;
        shelf = std::max(shelf, sizes[i].y);
    }
    return next.y + shelf;
}

void RippleAtlas::update(std::span<const RippleState* const> states, int max_side) {
    tiles_.assign(states.size(), {});
    std::vector<IVec2> sizes;
    int widest = 0;
    std::int64_t area = 0;
    for (const RippleState* state : states) {
        const bool any = state != nullptr && state->cells.x > 0;
        IVec2 size = any ? state->cells + 2 * kBorder : IVec2(0);
        if (size.x > max_side || size.y > max_side) {
            size = IVec2(0);
        }
        sizes.push_back(size);
        widest = std::max(widest, size.x);
        area += static_cast<std::int64_t>(size.x) * size.y;
    }
    if (area == 0) {
        if (!texture_) {
            texture_ = gpu::Texture("ripples", {.format = GL_RGBA32F});
        }
        return;
    }
    const int square = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(area))));
    const int width = std::min(std::max(widest, square), max_side);
    std::vector<IVec2> corners(sizes.size());
    const int height = std::min(pack_shelves(sizes, width, corners), max_side);
    texels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (std::size_t i = 0; i < states.size(); ++i) {
        const bool fits = sizes[i].x > 0 && corners[i].y + sizes[i].y <= height;
        tiles_[i] = {corners[i] + kBorder, fits};
        for (int row = 0; fits && row < sizes[i].y; ++row) {
            const auto first =
                static_cast<std::size_t>(corners[i].y + row) * static_cast<std::size_t>(width)
                + static_cast<std::size_t>(corners[i].x);
            fill_row(*states[i], row - kBorder, texels_.data() + first);
        }
    }
    if (!texture_ || texture_.width() != width || texture_.height() != height) {
        texture_ =
            gpu::Texture("ripples", {.format = GL_RGBA32F, .width = width, .height = height});
    }
    texture_.upload<Vec4>(texels_, GL_RGBA, GL_FLOAT);
}

}  // namespace limn
