#pragma once

#include "ecs/components/surface.h"
#include "render/shaders/material_layers_gpu.h"

#include <cstdint>
#include <optional>

namespace limn {

class Variant;

// The extensions of metal-rough materials: a specular reflection with a weight, tint or index of
// its own, a clear coat, sheen, stretched highlights and thin films, as KHR_materials_specular,
// _ior, _clearcoat, _sheen, _anisotropy and _iridescence define them. Materials with one of them
// are stored as a shading model of their own (shade_layered.glsl), so that all others keep their
// programs; the values of their maps are in a target of the G-buffer that exists only where some
// material has layers (shaders/lib/surface_layers.glsl).

enum MaterialLayer : std::uint32_t {
    kSpecularLayer = 1u << 0,
    kCoatLayer = 1u << 1,
    kSheenLayer = 1u << 2,
    kAnisotropyLayer = 1u << 3,
    kFilmLayer = 1u << 4,
};
/// A set of MaterialLayer.
using MaterialLayers = std::uint32_t;

/// Whether its highlights stretch as the bumps that mip levels of its normal map average
/// (normal_mips.h): of Pbr without an anisotropy of its own. Others only widen.
[[nodiscard]] bool has_lean_normals(const Material& material);

/// Those with any effect.
[[nodiscard]] MaterialLayers layers_of(const Material& material);

/// Of a material with layers.
[[nodiscard]] std::optional<layout::LayersBlock> make_layers_block(const Material& material);

/// Adds the definitions of lit programs for the layers that some material has.
void add_layers(Variant& variant, MaterialLayers layers);

}  // namespace limn
