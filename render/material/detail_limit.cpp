#include "render/material/detail_limit.h"

#include "ecs/components/relief_box.h"

#include <cstddef>

// Techniques: engine.lod-shader, relief.selection

namespace limn {
namespace {

/// In the order of SurfaceDetail: the first limit, of those from dear to cheap, that it exceeds.
constexpr DetailLimit kExceeded[] = {
    DetailLimit::Flat,           // Normal
    DetailLimit{kDetailLimits},  // Flat: none
    DetailLimit::Flat,           // Bump
    DetailLimit::Flat,           // ObjectNormal
    DetailLimit::Normal,         // Parallax
    DetailLimit::Parallax,       // Occlusion
    DetailLimit::Occlusion,      // Relief
    DetailLimit::Occlusion,      // Cone
    DetailLimit::Relief,         // DoubleDepth
    DetailLimit::Relief,         // Silhouette
    DetailLimit::Occlusion,      // Odd
    DetailLimit::Relief,         // Displaced
};

/// In the order of DetailLimit; that of Full is never used.
constexpr SurfaceDetail kFallsTo[kDetailLimits] = {
    SurfaceDetail::Silhouette, SurfaceDetail::Relief, SurfaceDetail::Occlusion,
    SurfaceDetail::Parallax,   SurfaceDetail::Normal, SurfaceDetail::Flat,
};

}  // namespace

SurfaceDetail limited_detail(SurfaceDetail detail, DetailLimit limit) {
    if (detail >= kReliefBoxDetail) {
        return detail;  // without a search nothing would be left of it but its box
    }
    return limit >= kExceeded[static_cast<std::size_t>(detail)]
               ? kFallsTo[static_cast<std::size_t>(limit)]
               : detail;
}

bool has_fine_detail(const Material& material) {
    const auto is_used = [](const TextureSlot& slot) { return slot.image.index != kNoAsset; };
    const bool is_shape = material.detail == SurfaceDetail::ObjectNormal
                          || material.detail == SurfaceDetail::DoubleDepth
                          || material.detail >= kReliefBoxDetail;
    return !is_shape && material.normal_mips == NormalMips::Plain
           && (is_used(material.normal_texture) || is_used(material.relief_texture)
               || is_used(material.clearcoat_normal_texture));
}

Material without_fine_detail(Material material) {
    material.detail = SurfaceDetail::Flat;
    material.bump_shadow = BumpShadow::None;
    material.normal_texture.image = {};
    material.relief_texture.image = {};
    material.clearcoat_normal_texture.image = {};
    return material;
}

}  // namespace limn
