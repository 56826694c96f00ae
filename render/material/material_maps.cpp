#include "render/material/material_maps.h"

#include "render/material/surface_features.h"

#include <algorithm>
#include <cmath>
#include <iterator>

// Techniques: bump.normal-map, skin.detail

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
        if (is_used(m.*slot.texture)) {
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

void set_layer(Vec4& maps, std::uint32_t slot, std::uint32_t layer) {
    const std::uint32_t shift = layout::kLayerBits * (slot % layout::kLayersPerFloat);
    maps[static_cast<int>(slot / layout::kLayersPerFloat)] += static_cast<float>(layer << shift);
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
        if (is_used(m.*slot.texture) && !same_uv(m.*slot.texture, *first)) {
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
