#include "render/material/fur_hook.h"

#include "render/material/surface_features.h"

// Techniques: shade.fur

namespace limn {
namespace {

constexpr HookPoint kFurPoints[] = {
    HookPoint::Position, HookPoint::Vertex, HookPoint::Color, HookPoint::Sample};

constexpr HookDefinition kFurDefinitions[] = {{kFurShell, "FUR_SHELL"}, {kFurFin, "FUR_FIN"}};

}  // namespace

const SurfaceHook kFurHook = {
    .name = "fur",
    .points = kFurPoints,
    .definitions = kFurDefinitions,
    .moving = kFurShell | kFurFin,
    .position_file = "lib/fur_position.glsl",
    .vertex_file = "lib/fur_vertex.glsl",
    .surface_file = "lib/fur_surface.glsl",
    .add = [](SurfaceFeatures&, std::uint16_t) {},
};

bool is_fur(const SurfaceFeatures& features) {
    return features.hooks.of(kFurHook) != 0;
}

bool is_fin(const SurfaceFeatures& features) {
    return (features.hooks.of(kFurHook) & kFurFin) != 0;
}

}  // namespace limn
