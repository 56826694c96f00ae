#include "render/material/material_layers.h"

#include "render/variant.h"

// Techniques: shade.anisotropic-specular, shade.clear-coat, shade.dielectric-specular, shade.sheen,
//     shade.thin-film

namespace limn {
namespace {

constexpr float kGlassIndex = 1.5f;  // of dielectrics without layers

bool layer_has_image(const TextureSlot& slot) {
    return slot.image.index != kNoAsset;
}

/// Clear media have their index in another block.
bool has_specular(const Material& m) {
    return m.specular_weight != 1 || m.specular_tint != Vec3(1)
           || (m.transmission <= 0 && m.refractive_index != kGlassIndex)
           || layer_has_image(m.specular_weight_texture)
           || layer_has_image(m.specular_tint_texture);
}

}  // namespace

bool has_lean_normals(const Material& m) {
    return m.shading == ShadingModel::Pbr && m.normal_mips == NormalMips::Lean && m.anisotropy <= 0
           && layer_has_image(m.normal_texture) && m.detail != SurfaceDetail::ObjectNormal;
}

MaterialLayers layers_of(const Material& m) {
    if (m.shading != ShadingModel::Pbr) {
        return 0;
    }
    return (has_specular(m) ? kSpecularLayer : 0u) | (m.clearcoat > 0 ? kCoatLayer : 0u)
           | (m.sheen != Vec3(0) ? kSheenLayer : 0u)
           | (m.anisotropy > 0 || has_lean_normals(m) ? kAnisotropyLayer : 0u)
           | (m.iridescence > 0 ? kFilmLayer : 0u);
}

std::optional<layout::LayersBlock> make_layers_block(const Material& m) {
    if (layers_of(m) == 0) {
        return std::nullopt;
    }
    const float head_on = square((m.refractive_index - 1) / (m.refractive_index + 1));
    const bool has_range = layer_has_image(m.iridescence_thickness_texture);
    const Vec2& thickness = m.iridescence_thickness;
    return layout::LayersBlock{
        .specular = Vec4(head_on * m.specular_tint, m.specular_weight),
        .coat =
            {m.clearcoat, m.clearcoat_roughness, has_lean_normals(m) ? 1.0f : m.anisotropy,
             m.iridescence},
        .sheen = Vec4(m.sheen, m.sheen_roughness),
        .film =
            {m.iridescence_index, has_range ? thickness.x : thickness.y, thickness.y,
             m.anisotropy_rotation},
        .coat_normal = {m.clearcoat_normal_scale, 0, 0, 0}};
}

void add_layers(Variant& variant, MaterialLayers layers) {
    variant.add_if((layers & kCoatLayer) != 0, "COATED_MATERIALS");
    variant.add_if((layers & kSheenLayer) != 0, "SHEEN_MATERIALS");
    variant.add_if((layers & kAnisotropyLayer) != 0, "ANISOTROPIC_MATERIALS");
    variant.add_if((layers & kFilmLayer) != 0, "FILM_MATERIALS");
}

}  // namespace limn
