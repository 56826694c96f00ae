#include "render/material/shading_fields.h"

#include <algorithm>
#include <iterator>

namespace limn {
namespace {

constexpr unsigned bit(ShadingModel model) {
    return 1u << static_cast<unsigned>(model);
}
constexpr unsigned kMirrors = bit(ShadingModel::Pbr) | bit(ShadingModel::Unlit);
constexpr unsigned kClassic = bit(ShadingModel::Blinn) | bit(ShadingModel::Phong)
                              | bit(ShadingModel::Skin) | bit(ShadingModel::Toon)
                              | bit(ShadingModel::Strand);
constexpr unsigned kHair = bit(ShadingModel::Hair);
constexpr unsigned kLayers = bit(ShadingModel::Pbr);  // material_layers.h
constexpr unsigned kStrand = bit(ShadingModel::Strand);

/// A field that only some models read, and those models.
struct FieldReaders {
    std::string_view field;
    unsigned models;  ///< one bit per model
};
constexpr FieldReaders kFieldReaders[] = {
    {"metalness", kMirrors},
    {"roughness", kMirrors | bit(ShadingModel::Subsurface) | kHair},
    {"metal_rough_texture", kMirrors | bit(ShadingModel::Subsurface) | kHair},
    {"emission", ~(kHair | kStrand)},
    {"emission_texture", ~(kHair | kStrand)},
    {"specular", kClassic | bit(ShadingModel::Subsurface)},
    {"shininess", kClassic},
    {"skin_color", bit(ShadingModel::Skin)},
    {"wide_rim", bit(ShadingModel::Skin)},
    {"lobes", bit(ShadingModel::Lafortune)},
    {"scatter", bit(ShadingModel::Subsurface)},
    {"gloss", bit(ShadingModel::Subsurface)},
    {"gloss_roughness", bit(ShadingModel::Subsurface)},
    {"roughness_across", kHair},
    {"scale_tilt", kHair},
    {"hair_scatter", kHair},
    {"clearcoat", kLayers},
    {"clearcoat_roughness", kLayers},
    {"clearcoat_normal_scale", kLayers},
    {"clearcoat_texture", kLayers},
    {"clearcoat_roughness_texture", kLayers},
    {"clearcoat_normal_texture", kLayers},
    {"sheen", kLayers},
    {"sheen_roughness", kLayers},
    {"sheen_texture", kLayers},
    {"sheen_roughness_texture", kLayers},
    {"specular_weight", kLayers},
    {"specular_tint", kLayers},
    {"specular_weight_texture", kLayers},
    {"specular_tint_texture", kLayers},
    {"anisotropy", kLayers},
    {"anisotropy_rotation", kLayers | kStrand},
    {"anisotropy_texture", kLayers | kStrand},
    {"iridescence", kLayers},
    {"iridescence_index", kLayers},
    {"iridescence_thickness", kLayers},
    {"iridescence_texture", kLayers},
    {"iridescence_thickness_texture", kLayers},
    {"ramp", bit(ShadingModel::Toon)},
};

}  // namespace

bool reads_field(ShadingModel model, std::string_view field) {
    const auto* const row = std::find_if(
        std::begin(kFieldReaders), std::end(kFieldReaders),
        [field](const FieldReaders& readers) { return readers.field == field; });
    return row == std::end(kFieldReaders) || (row->models & bit(model)) != 0;
}

}  // namespace limn
