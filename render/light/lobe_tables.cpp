#include "render/light/lobe_tables.h"

#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/material/material_pool.h"
#include "render/shaders/lobe_tables_gpu.h"

#include <algorithm>
#include <cmath>

// Techniques: shade.factorise, shade.phong-lut

namespace limn {
namespace {

LobeSource source_of(const FrameData& frame) {
    const auto* rendering = frame.world->find_resource<Rendering>();
    return rendering != nullptr ? rendering->lobes : LobeSource::Computed;
}

float exponent_of(const Material& material) {
    switch (material.shading) {
    case ShadingModel::Blinn:
    case ShadingModel::Phong:
    case ShadingModel::Skin:
    case ShadingModel::Strand:
        return std::max(material.shininess, 1.0f);
    default:
        return 0;
    }
}

gpu::Texture make_tables(const char* label, GLenum format, int height, std::size_t layers) {
    return gpu::Texture(
        label, {.format = format,
                .width = kLobeTableSize,
                .height = height,
                .depth = static_cast<int>(layers),
                .target = GL_TEXTURE_2D_ARRAY});
}

gpu::Texture bake_tables(std::span<const float> exponents) {
    gpu::Texture texture = make_tables("lobe tables", GL_RG32F, kLobeTableSize, exponents.size());
    std::vector<Vec2> all;
    for (const float n : exponents) {
        const std::vector<Vec2> table = bake_lobe_table(n, kLobeTableSize);
        all.insert(all.end(), table.begin(), table.end());
    }
    texture.upload<Vec2>(all, GL_RG, GL_FLOAT);
    return texture;
}

/// Layer 0 is the factor of strands.
gpu::Texture bake_factors(std::span<const float> exponents) {
    gpu::Texture texture = make_tables("lobe factors", GL_R32F, 1, exponents.size() + 1);
    std::vector<float> all = bake_factor(
        [](float x) { return std::sqrt(std::max(1 - x * x, 0.0f)); }, -1, kLobeTableSize);
    for (const float n : exponents) {
        const std::vector<float> factor =
            bake_factor([n](float x) { return std::pow(x, n); }, 0, kLobeTableSize);
        all.insert(all.end(), factor.begin(), factor.end());
    }
    texture.upload<float>(all, GL_RED, GL_FLOAT);
    return texture;
}

void bind_tables(PassContext& context, const LobeTableEffect& effect) {
    context.device().bind_texture(layout::kLobeTablesUnit, *effect.tables);
    effect.layer_of_material.bind(context.device(), layout::kLobeLayersUnit);
}

}  // namespace

LobeExponents lobe_exponents(std::span<const Material> materials) {
    std::vector<float> all;
    for (const Material& material : materials) {
        if (const float exponent = exponent_of(material); exponent > 0) {
            all.push_back(exponent);
        }
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    LobeExponents lobes;
    const std::size_t kept = std::min(all.size(), kMaxLobeExponents);
    for (std::size_t i = 0; i < kept; ++i) {
        lobes.exponents.push_back(all[kept == all.size() ? i : i * (all.size() - 1) / (kept - 1)]);
    }
    for (const Material& material : materials) {
        const float exponent = exponent_of(material);
        const auto next =
            std::lower_bound(lobes.exponents.begin(), lobes.exponents.end(), exponent);
        lobes.of_material.push_back(
            exponent > 0 ? static_cast<std::uint32_t>(next - lobes.exponents.begin()) : 0);
    }
    return lobes;
}

std::vector<Vec2> bake_lobe_table(float exponent, int size) {
    std::vector<Vec2> table;
    const auto at = [size](int i) { return static_cast<float>(i) / static_cast<float>(size - 1); };
    for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; ++i) {
            table.emplace_back(at(i), i > 0 ? std::pow(at(j), exponent) : 0.0f);
        }
    }
    return table;
}

std::vector<float> bake_factor(const std::function<float(float)>& f, float begin, int size) {
    std::vector<float> values;
    for (int i = 0; i < size; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(size - 1);
        values.push_back(f(begin + t * (1 - begin)));
    }
    return values;
}

bool LobeTableEffect::is_used(const FrameData& frame) {
    return source_of(frame) != LobeSource::Computed;
}

void LobeTableEffect::collect(FrameData& frame) {
    LobeExponents lobes = lobe_exponents(frame.assets->materials);
    if (lobes.exponents.empty()) {
        lobes.exponents.push_back(1);
    }
    std::vector<std::uint32_t> of_record = {0, 0};  // without a material, and with a missing one
    of_record.insert(of_record.end(), lobes.of_material.begin(), lobes.of_material.end());
    frame.materials->append_plain(of_record);
    layer_of_material.upload(*frame.ring, of_record);
    const LobeSource wanted = source_of(frame);
    if (!tables || source != wanted || baked != lobes.exponents) {
        tables = wanted == LobeSource::Factors ? bake_factors(lobes.exponents)
                                               : bake_tables(lobes.exponents);
        source = wanted;
        baked = lobes.exponents;
    }
}

bool LobeTableEffect::prepare(const FrameData&, ViewData& view) {
    view.lighting.variant.add(source == LobeSource::Factors ? "LOBE_FACTORS" : "LOBE_TABLE");
    view.lighting.add_binding<bind_tables>(*this);
    return true;
}

}  // namespace limn
