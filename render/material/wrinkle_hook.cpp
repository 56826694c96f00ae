#include "render/material/wrinkle_hook.h"

#include "render/material/surface_features.h"

#include <algorithm>
#include <initializer_list>

namespace limn {
namespace {

constexpr HookPoint kWrinklePoints[] = {
    HookPoint::Position, HookPoint::Vertex, HookPoint::Color, HookPoint::Normal, HookPoint::Sample};

constexpr HookDefinition kWrinkleDefinitions[] = {
    {kWrinkleBlend, "WRINKLE_BLEND"},
    {kWrinkleFade, "WRINKLE_FADE"},
    {kWrinkleFlat, "WRINKLE_FLAT"},
    {kWrinkleView, "WRINKLE_VIEW"},
    {kWrinkleDisplaced, "WRINKLE_DISPLACED"},
    {kWrinkleColumns, "WRINKLE_COLUMNS"},
    {kWrinkleModel, "WRINKLE_MODEL"},
    {kWrinkleLayers, "WRINKLE_LAYERS"},
    {kWrinkleIndependent, "WRINKLE_INDEPENDENT"},
    {kWrinklePhoto, "WRINKLE_PHOTO"},
    {kWrinkleBounce, "WRINKLE_BOUNCE"},
    {kWrinkleShade, "WRINKLE_SHADE"},
};

/// Only skin that wrinkles reads its wrinkle map, unless the strain is visualized instead.
void add_wrinkles(SurfaceFeatures& features, std::uint16_t instance) {
    const bool shows_strain = (instance & kWrinkleView) != 0;
    if (instance == 0 || shows_strain) {
        features.maps.remove(layout::kWrinkleSlot);
    }
    if (shows_strain || features.maps.has(layout::kWrinkleSlot)) {
        features.hooks.set(kWrinkleHook, static_cast<std::uint16_t>(instance & ~kWrinkled));
    }
}

bool darkens(WrinkleMethod method) {
    return method == WrinkleMethod::Alpha || method == WrinkleMethod::Directional;
}

struct WrinkleBit {
    bool has;
    WrinkleFeature bit;
};
/// kWrinkled and those that the surface has.
std::uint16_t wrinkle_bits(std::initializer_list<WrinkleBit> bits) {
    std::uint16_t all = kWrinkled;
    for (const WrinkleBit& one : bits) {
        if (one.has) {
            all = static_cast<std::uint16_t>(all | one.bit);
        }
    }
    return all;
}

}  // namespace

const SurfaceHook kWrinkleHook = {
    .name = "wrinkle",
    .points = kWrinklePoints,
    .definitions = kWrinkleDefinitions,
    .moving = kWrinkleDisplaced,
    .position_file = "lib/wrinkle_position.glsl",
    .vertex_file = "lib/wrinkle_vertex.glsl",
    .surface_file = "lib/wrinkle_surface.glsl",
    .add = add_wrinkles,
};

std::uint16_t wrinkle_features(const WrinkleSurface& surface, bool shades) {
    const WrinkleMethod method = surface.method;
    if (method == WrinkleMethod::StrainView) {
        return wrinkle_bits({{true, kWrinkleView}});
    }
    const bool layers = has_layers(surface);
    return wrinkle_bits(
        {{method == WrinkleMethod::Blend, kWrinkleBlend},
         {method == WrinkleMethod::Isometric && surface.bounce, kWrinkleBounce},
         {method == WrinkleMethod::Model, kWrinkleModel},
         {method == WrinkleMethod::Photo, kWrinklePhoto},
         {darkens(method) || surface.shade_from > 0 || shades, kWrinkleShade},
         {layers, kWrinkleLayers},
         {layers && surface.combine == WrinkleCombine::Independent, kWrinkleIndependent},
         {surface.fade, kWrinkleFade},
         {!surface.interpolate, kWrinkleFlat}});
}

std::uint16_t
column_features(const WrinkleSurface& surface, const std::vector<WrinkleMethod>& columns) {
    const auto shown = [&](WrinkleMethod method) {
        return std::ranges::find(columns, method) != columns.end();
    };
    return wrinkle_bits(
        {{true, kWrinkleColumns},
         {shown(WrinkleMethod::Blend), kWrinkleBlend},
         {surface.bounce && shown(WrinkleMethod::Isometric), kWrinkleBounce},
         {shown(WrinkleMethod::Alpha) || shown(WrinkleMethod::Directional), kWrinkleShade},
         {surface.fade, kWrinkleFade},
         {!surface.interpolate, kWrinkleFlat}});
}

}  // namespace limn
