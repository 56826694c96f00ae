#include "render/light/highlight_layers.h"

#include "ecs/components/surface.h"
#include "render/material/material_pool.h"

#include <algorithm>

// Techniques: fakephong.blinn-texture

namespace limn {

float highlight_exponent(const Material& material) {
    const float exponent = std::max(material.shininess, 1e-3f);
    switch (material.shading) {
    case ShadingModel::Blinn:
        return exponent;
    case ShadingModel::Phong:
        return 4 * exponent;
    default:
        return 0;
    }
}

HighlightLayers layers_by_exponent(std::span<const Material> materials) {
    std::vector<float> all;
    for (const Material& material : materials) {
        if (const float exponent = highlight_exponent(material); exponent > 0) {
            all.push_back(exponent);
        }
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());

    HighlightLayers layers = {.exponents = {1}, .of_record = {0, 0}};  // without a material
    const std::size_t kept = std::min(all.size(), kMaxHighlightLayers - 1);
    for (std::size_t i = 0; i < kept; ++i) {
        layers.exponents.push_back(all[kept == all.size() ? i : i * (all.size() - 1) / (kept - 1)]);
    }
    for (const Material& material : materials) {
        const float exponent = highlight_exponent(material);
        const auto found =
            std::lower_bound(layers.exponents.begin() + 1, layers.exponents.end(), exponent);
        layers.of_record.push_back(
            exponent > 0 ? static_cast<std::uint32_t>(found - layers.exponents.begin()) : 0);
    }
    return layers;
}

HighlightLayers layers_by_material(std::span<const Material> materials) {
    HighlightLayers layers = {.exponents = {1}, .of_record = {0, 0}};
    for (const Material& material : materials) {
        const float exponent = highlight_exponent(material);
        layers.of_record.push_back(
            exponent > 0 ? static_cast<std::uint32_t>(layers.exponents.size()) : 0);
        if (exponent > 0) {
            layers.exponents.push_back(exponent);
        }
    }
    return layers.exponents.size() <= kMaxHighlightLayers ? layers : layers_by_exponent(materials);
}

}  // namespace limn
