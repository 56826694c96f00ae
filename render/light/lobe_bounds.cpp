#include "render/light/lobe_bounds.h"

#include "render/geometry/render_items.h"
#include "render/material/material_pool.h"
#include "render/render_view.h"

#include <glm/common.hpp>

// Techniques: deferred.light-pass

namespace limn {
namespace {

PixelBounds all_pixels(const RenderView& view) {
    return {{0, 0}, {view.width, view.height}};
}

PixelBounds pixels_of(const RenderView& view, const Bounds& box) {
    Vec2 low(INFINITY);
    Vec2 high(-INFINITY);
    int ahead = 0;  // corners in front of the camera; NaN counts as neither
    int behind = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p = {
            (corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
            (corner & 4) != 0 ? box.max.z : box.min.z};
        const Vec4 clip = view.clip_from_world * Vec4(p, 1);
        ahead += clip.w > 1e-6f ? 1 : 0;
        behind += clip.w <= 1e-6f ? 1 : 0;
        low = glm::min(low, Vec2(clip) / clip.w);
        high = glm::max(high, Vec2(clip) / clip.w);
    }
    if (ahead < 8) {
        return behind == 8 ? PixelBounds{} : all_pixels(view);
    }
    const Vec2 size = {view.width, view.height};
    const auto pixel = [&](const Vec2& ndc) {
        return glm::clamp((0.5f * ndc + 0.5f) * size, Vec2(0), size);
    };
    return {IVec2(glm::floor(pixel(low))), IVec2(glm::ceil(pixel(high)))};
}

void grow_pixels(PixelBounds& bounds, const PixelBounds& more) {
    if (is_empty(bounds)) {
        bounds = more;
    } else if (!is_empty(more)) {
        bounds = {glm::min(bounds.low, more.low), glm::max(bounds.high, more.high)};
    }
}

}  // namespace

bool is_empty(const PixelBounds& bounds) {
    return bounds.low.x >= bounds.high.x || bounds.low.y >= bounds.high.y;
}

LobeBounds find_lobe_bounds(const RenderItems& items, const RenderView& view) {
    constexpr std::uint32_t kBase = lobe_number(ShadingModel::Pbr);
    const MaterialPool& materials = items.materials();
    LobeBounds all{};
    for (std::size_t b = 0; b < items.block_count(); ++b) {
        const RenderItemBlock& block = items.block(b);
        for (std::size_t i = 0; i < block.size(); ++i) {
            if (!block.is_drawable(i)) {
                continue;
            }
            const std::uint32_t model =
                materials.model_of(materials.record_of(block.surfaces[i].material));
            const std::uint32_t lobe = lobe_number(static_cast<ShadingModel>(model - 1));
            grow_pixels(
                all[lobe], lobe == kBase ? all_pixels(view) : pixels_of(view, block.box(i)));
        }
    }
    return all;
}

}  // namespace limn
