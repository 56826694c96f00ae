#include "render/material_uv.h"

#include "render/surface_features.h"

#include <cmath>

namespace limn {
namespace {

const TextureSlot* first_used(const Material& m) {
    for (int i = 0; i < kMaterialTextures; ++i) {
        if (texture_slot(m, i).image.index != kNoAsset) {
            return &texture_slot(m, i);
        }
    }
    return nullptr;
}

}  // namespace

const TextureSlot& texture_slot(const Material& m, int i) {
    const TextureSlot* slots[kMaterialTextures] = {
        &m.base_color_texture, &m.metal_rough_texture, &m.normal_texture, &m.occlusion_texture,
        &m.emission_texture};
    return *slots[i];
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
    for (int i = 0; i < kMaterialTextures; ++i) {
        const TextureSlot& slot = texture_slot(m, i);
        if (slot.image.index != kNoAsset && !same_uv(slot, *first)) {
            return kUvMaps;
        }
    }
    return same_uv(*first, TextureSlot{}) ? 0u : kUvMap;
}

std::optional<layout::UvBlock> make_uv_block(const Material& m) {
    const std::uint32_t feature = uv_feature(m);
    if (feature == 0) {
        return std::nullopt;
    }
    layout::UvBlock block;
    for (int i = 0; i < kMaterialTextures; ++i) {
        const TextureSlot& slot = feature == kUvMap ? *first_used(m) : texture_slot(m, i);
        // Counter-clockwise, as in the Khronos glTF viewer; v runs down the image.
        const float c = std::cos(slot.rotation);
        const float s = std::sin(slot.rotation);
        block.map[2 * i] = {
            c * slot.scale.x, s * slot.scale.y, -s * slot.scale.x, c * slot.scale.y};
        block.map[2 * i + 1] = {slot.offset.x, slot.offset.y, slot.uv_set, 0};
    }
    return block;
}

}  // namespace limn
