#include "render/material/relief_hook.h"

#include "ecs/components/relief_box.h"
#include "render/gpu/device_caps.h"
#include "render/material/material_maps.h"
#include "render/material/surface_features.h"

#include <cstddef>
#include <iterator>

// Techniques: relief.compare, relief.permutations, relief.selection

namespace limn {
namespace {

constexpr HookPoint kReliefPoints[] = {
    HookPoint::Position, HookPoint::Vertex, HookPoint::Uv, HookPoint::Normal, HookPoint::Sample};

constexpr HookDefinition kReliefDefinitions[] = {
    {kReliefBump, "RELIEF_BUMP"},      {kReliefParallax, "RELIEF_PARALLAX"},
    {kReliefLinear, "RELIEF_LINEAR"},  {kReliefCones, "RELIEF_CONES"},
    {kReliefClosed, "RELIEF_CLOSED"},  {kReliefCurved, "RELIEF_CURVED"},
    {kReliefShifted, "SHIFTED_UV"},    {kReliefOffMesh, "OFF_MESH"},
    {kReliefObject, "OBJECT_NORMALS"}, {kReliefRays, "RELIEF_RAYS"},
    {kReliefBottom, "RELIEF_BOTTOM"},  {kReliefBoxed, "RELIEF_BOX"},
    {kReliefSliced, "RELIEF_SLICES"},  {kReliefDisplaced, "RELIEF_DISPLACED"},
    {kReliefOdd, "RELIEF_ODD"},
};

/// In the order of SurfaceDetail.
constexpr std::uint16_t kBelow = kReliefShifted | kReliefOffMesh;
constexpr std::uint16_t kReliefOfDetail[] = {
    0,
    kReliefFlat,
    kReliefBump,
    kReliefObject,
    kReliefParallax | kReliefShifted,
    kReliefLinear | kBelow,
    kBelow,
    kReliefCones | kBelow,
    kReliefClosed | kBelow,
    kReliefCurved | kBelow,
    kReliefOdd | kBelow,
    kReliefDisplaced,
};

/// Of parts of relief boxes, in the order of their details.
constexpr std::uint16_t kReliefOfBox[] = {
    kReliefBoxed | kBelow,
    kReliefBoxed | kReliefClosed | kBelow,
    kReliefBoxed | kReliefSliced | kReliefOffMesh,
    kReliefBoxed | kReliefSliced | kReliefClosed | kReliefOffMesh,
};

std::uint16_t relief_of_material(const Material& material) {
    const auto detail = static_cast<std::size_t>(material.detail);
    const std::size_t in_box = detail - static_cast<std::size_t>(kReliefBoxDetail);
    std::uint16_t bits = detail < std::size(kReliefOfDetail) ? kReliefOfDetail[detail]
                         : in_box < std::size(kReliefOfBox)  ? kReliefOfBox[in_box]
                                                             : std::uint16_t{0};
    // What two directions see of an ODD map agrees to a cell of it: too little to shadow itself.
    const bool odd = (bits & kReliefOdd) != 0;
    const bool other = material.relief_shadow != ReliefShadow::Map || odd;
    if ((bits & kReliefOffMesh) != 0 && (bits & kReliefBoxed) == 0 && other) {
        bits |= kReliefBottom;
        bits |= material.relief_shadow == ReliefShadow::Ray && !odd ? kReliefRays : 0;
    }
    return bits;
}

/// Leaves out the maps that the surface does not need, and what needs a map that it does not have.
void add_relief(SurfaceFeatures& features, std::uint16_t) {
    const std::uint16_t bits = features.hooks.of(kReliefHook);
    if (bits == kReliefObject && features.maps.has(layout::kNormalSlot)) {
        features.maps.remove(layout::kReliefSlot);
        return;
    }
    const bool has_relief =
        bits > kReliefFlat && bits != kReliefObject && features.maps.has(layout::kReliefSlot);
    if (has_relief || bits == kReliefFlat) {
        features.maps.remove(layout::kNormalSlot);
    }
    if (bits == kReliefFlat) {
        features.maps.remove(layout::kDetailSlot);
    }
    if (!has_relief) {
        features.maps.remove(layout::kReliefSlot);
        features.hooks.set(kReliefHook, 0);
    }
}

}  // namespace

float depth_below_mesh(const Material& material) {
    const bool below = (relief_of_material(material) & kReliefOffMesh) != 0
                       && material.relief_texture.image.index != kNoAsset;
    return below ? material.relief_depth : 0;
}

const SurfaceHook kReliefHook = {
    .name = "relief",
    .points = kReliefPoints,
    .definitions = kReliefDefinitions,
    .moving = kReliefDisplaced,
    .off_mesh = kReliefOffMesh,
    .maps = 1u << layout::kReliefSlot,
    .position_file = "lib/relief_position.glsl",
    .vertex_file = "lib/relief_vertex.glsl",
    .surface_file = "lib/relief_surface.glsl",
    .of_material = relief_of_material,
    .add = add_relief,
};

SurfaceDetail supported_detail(SurfaceDetail detail, const gpu::DeviceCaps& caps) {
    return detail == SurfaceDetail::Displaced && caps.max_evaluation_textures == 0
               ? SurfaceDetail::Silhouette
               : detail;
}

bool is_tessellated(const SurfaceFeatures& features) {
    return (features.hooks.of(kReliefHook) & kReliefDisplaced) != 0
           && features.maps.has(layout::kReliefSlot);
}

}  // namespace limn
