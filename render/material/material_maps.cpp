#include "render/material/material_maps.h"

#include "render/material/surface_features.h"

#include <algorithm>
#include <cmath>
#include <iterator>

// Techniques: bump.normal-map, shade.anisotropy-map, skin.detail, tex.colour-map

namespace limn {
namespace {

constexpr MapSlot kSlots[] = {
    {layout::kBaseColorSlot, "BASE_COLOR_MAP", &Material::base_color_texture, true},
    {layout::kMetalRoughSlot, "METAL_ROUGH_MAP", &Material::metal_rough_texture, false},
    {layout::kNormalSlot, "NORMAL_MAP", &Material::normal_texture, false},
    {layout::kOcclusionSlot, "OCCLUSION_MAP", &Material::occlusion_texture, false},
    {layout::kEmissionSlot, "EMISSION_MAP", &Material::emission_texture, false},
    {layout::kWrinkleSlot, "WRINKLE_MAP", &Material::wrinkle_texture, false},
    {layout::kDetailSlot, "DETAIL_MAP", &Material::detail_texture, false},
    {layout::kThicknessSlot, "THICKNESS_MAP", &Material::thickness_texture, false},
    {layout::kReliefSlot, "RELIEF_MAP", &Material::relief_texture, true},
    {layout::kClearcoatSlot, "CLEARCOAT_MAP", &Material::clearcoat_texture, false, kCoatLayer},
    {layout::kClearcoatRoughnessSlot, "CLEARCOAT_ROUGHNESS_MAP",
     &Material::clearcoat_roughness_texture, false, kCoatLayer},
    {layout::kClearcoatNormalSlot, "CLEARCOAT_NORMAL_MAP", &Material::clearcoat_normal_texture,
     false, kCoatLayer},
    {layout::kSheenSlot, "SHEEN_MAP", &Material::sheen_texture, false, kSheenLayer},
    {layout::kSheenRoughnessSlot, "SHEEN_ROUGHNESS_MAP", &Material::sheen_roughness_texture, false,
     kSheenLayer},
    {layout::kSpecularWeightSlot, "SPECULAR_WEIGHT_MAP", &Material::specular_weight_texture, false,
     kSpecularLayer},
    {layout::kSpecularTintSlot, "SPECULAR_TINT_MAP", &Material::specular_tint_texture, false,
     kSpecularLayer},
    {layout::kAnisotropySlot, "ANISOTROPY_MAP", &Material::anisotropy_texture, false,
     kAnisotropyLayer},
    {layout::kIridescenceSlot, "IRIDESCENCE_MAP", &Material::iridescence_texture, false,
     kFilmLayer},
    {layout::kIridescenceThicknessSlot, "IRIDESCENCE_THICKNESS_MAP",
     &Material::iridescence_thickness_texture, false, kFilmLayer},
    {layout::kNormalSpreadSlot, "NORMAL_SPREAD_MAP", &Material::normal_texture, false},
    {layout::kTransmissionSlot, "TRANSMISSION_MAP", &Material::transmission_texture, false},
    {layout::kLightMapSlot, "LIGHT_MAP", &Material::light_map_texture, false},
};

constexpr bool numbers_fit() {
    for (std::size_t i = 0; i < std::size(kSlots); ++i) {
        if (kSlots[i].number != i) {
            return false;
        }
    }
    return std::size(kSlots) <= layout::kMaxMapSlots;
}
static_assert(numbers_fit());

const TextureSlot* first_used(const Material& m) {
    for (const MapSlot& slot : kSlots) {
        if (has_map(m, slot)) {
            return &(m.*slot.texture);
        }
    }
    return nullptr;
}

void append_uv_map(const TextureSlot& slot, std::vector<Vec4>& blocks) {
    // Counter-clockwise, as in the Khronos glTF viewer; v runs down the image.
    const float c = std::cos(slot.rotation);
    const float s = std::sin(slot.rotation);
    blocks.emplace_back(c * slot.scale.x, s * slot.scale.y, -s * slot.scale.x, c * slot.scale.y);
    blocks.emplace_back(slot.offset.x, slot.offset.y, slot.uv_set, 0);
}

}  // namespace

std::span<const MapSlot> map_slots() {
    return kSlots;
}

NormalMips normal_mips_of(const Material& m) {
    const bool has_slopes = m.detail != SurfaceDetail::ObjectNormal;
    return has_slopes ? m.normal_mips : std::min(m.normal_mips, NormalMips::Toksvig);
}

bool has_map(const Material& material, const MapSlot& slot) {
    if (slot.number == layout::kNormalSpreadSlot && material.normal_mips == NormalMips::Plain) {
        return false;
    }
    const bool is_of_strands =
        slot.number == layout::kAnisotropySlot && material.shading == ShadingModel::Strand;
    return is_used(material.*slot.texture)
           && (slot.layer == 0 || (layers_of(material) & slot.layer) != 0 || is_of_strands);
}

std::optional<std::uint32_t> MapBindings::add(const MapBinding& map) {
    const auto end = bindings_.begin() + count_;
    const auto found = std::find(bindings_.begin(), end, map);
    if (found == end) {
        if (count_ == bindings_.size()) {
            return std::nullopt;
        }
        bindings_[count_++] = map;
    }
    return static_cast<std::uint32_t>(found - bindings_.begin());
}

void set_layer(std::span<Vec4> maps, std::uint32_t slot, std::uint32_t layer) {
    const std::uint32_t shift = layout::kLayerBits * (slot % layout::kLayersPerFloat);
    const std::uint32_t component = slot % layout::kLayersPerTexel / layout::kLayersPerFloat;
    maps[slot / layout::kLayersPerTexel][static_cast<int>(component)] +=
        static_cast<float>(layer << shift);
}

bool same_uv(const TextureSlot& a, const TextureSlot& b) {
    return a.uv_set == b.uv_set && a.offset == b.offset && a.scale == b.scale
           && a.rotation == b.rotation;
}

std::uint32_t uv_feature(const Material& m) {
    const TextureSlot* first = first_used(m);
    if (first == nullptr) {
        return 0;
    }
    for (const MapSlot& slot : kSlots) {
        if (has_map(m, slot) && !same_uv(m.*slot.texture, *first)) {
            return kUvMaps;
        }
    }
    return same_uv(*first, TextureSlot{}) ? 0u : kUvMap;
}

bool append_uv_block(const Material& m, std::vector<Vec4>& blocks) {
    const std::uint32_t feature = uv_feature(m);
    if (feature == kUvMap) {
        append_uv_map(*first_used(m), blocks);
    } else if (feature == kUvMaps) {
        for (const MapSlot& slot : kSlots) {
            append_uv_map(m.*slot.texture, blocks);
        }
    }
    return feature != 0;
}

}  // namespace limn
