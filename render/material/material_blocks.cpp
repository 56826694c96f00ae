#include "render/material/material_blocks.h"

#include "ecs/components/ink.h"
#include "ecs/components/surface.h"
#include "render/material/diffusion_profile.h"
#include "render/material/hair_lobes.h"
#include "render/material/material_layers.h"
#include "render/material/material_maps.h"
#include "render/material/skin_tone.h"
#include "render/shaders/material_blocks_gpu.h"
#include "render/shaders/material_classic_gpu.h"
#include "render/shaders/material_clear_gpu.h"
#include "render/shaders/material_dress_gpu.h"
#include "render/shaders/material_lafortune_gpu.h"
#include "render/shaders/material_skin_gpu.h"
#include "render/shaders/material_strand_gpu.h"
#include "render/shaders/material_subsurface_gpu.h"
#include "render/shaders/material_toon_gpu.h"
#include "render/shaders/relief_gpu.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>

// Techniques: shade.strand-banks, tex.toon-ramp

namespace limn {
namespace {

std::optional<layout::ClassicBlock> make_classic_block(const Material& m) {
    const bool classic = m.shading == ShadingModel::Blinn || m.shading == ShadingModel::Phong
                         || m.shading == ShadingModel::Skin || m.shading == ShadingModel::Toon
                         || m.shading == ShadingModel::Strand;
    const float shininess = std::max(m.shininess, 1e-3f);
    return classic ? std::optional(layout::ClassicBlock{
               .specular = Vec4(m.specular, has_wide_highlights(m) ? -shininess : shininess)})
                   : std::nullopt;
}

std::optional<layout::SkinBlock> make_skin_block(const Material& m) {
    return m.shading == ShadingModel::Skin ? std::optional(
               layout::SkinBlock{.rim = Vec4(m.skin_color, m.wide_rim ? 1.0f : 0.0f)})
                                           : std::nullopt;
}

/// Beer-Lambert: the transmittance is exp(-absorption * distance).
std::optional<layout::ClearBlock> make_clear_block(const Material& m) {
    if (m.transmission <= 0) {
        return std::nullopt;
    }
    const Vec3 left = glm::max(m.attenuation_color, Vec3(1e-6f));
    return layout::ClearBlock{
        .medium = {m.transmission, m.refractive_index, m.thickness, m.dispersion},
        .absorption = Vec4(-glm::log(left) / std::max(m.attenuation_distance, 1e-6f), 0)};
}

using LafortuneBlock = std::array<layout::LafortuneLobeRecord, kMaxLafortuneLobes>;

std::optional<LafortuneBlock> make_lafortune_block(const Material& m) {
    if (m.shading != ShadingModel::Lafortune) {
        return std::nullopt;
    }
    LafortuneBlock block = {};
    const std::size_t count = std::min(m.lobes.size(), block.size());
    for (std::size_t i = 0; i < count; ++i) {
        const LafortuneLobe& lobe = m.lobes[i];
        block[i] = {
            .across = Vec4(lobe.across, 0),
            .along = Vec4(lobe.along, 0),
            .exponent = Vec4(lobe.exponent, 0)};
    }
    block[0].across.w = static_cast<float>(count);
    return block;
}

std::optional<layout::HairBlock> make_block_of_hair(const Material& m) {
    return m.shading == ShadingModel::Hair ? std::optional(make_hair_block(m)) : std::nullopt;
}

std::optional<layout::ReliefBlock> make_relief_block(const Material& m) {
    const Vec4 search = {m.relief_depth, m.relief_steps, m.relief_refinements, m.tessellation};
    return is_used(m.relief_texture) ? std::optional(layout::ReliefBlock{.search = search})
                                     : std::nullopt;
}

static_assert(kMaxToonBands == layout::kMaxToonBands);

/// Of a material without a ramp: three tones that change at 0.3 and 0.7.
constexpr float kDefaultTones[] = {0.25f, 0.25f, 0.25f, 0.6f, 0.6f, 0.6f, 0.6f, 1.0f, 1.0f, 1.0f};

std::optional<layout::ToonBlock> make_toon_block(const Material& m) {
    if (m.shading != ShadingModel::Toon) {
        return std::nullopt;
    }
    layout::ToonBlock block = {};
    std::size_t count = std::min<std::size_t>(m.ramp.size(), layout::kMaxToonBands);
    for (std::size_t i = 0; i < count; ++i) {
        block.bands[i] = Vec4(m.ramp[i], 0);
    }
    if (count == 0) {
        count = std::size(kDefaultTones);
        for (std::size_t i = 0; i < count; ++i) {
            block.bands[i] = Vec4(Vec3(kDefaultTones[i]), 0);
        }
    }
    block.bands[0].w = static_cast<float>(count);
    return block;
}

std::optional<layout::StrandBlock> make_strand_block(const Material& m) {
    const float a = m.anisotropy_rotation;
    return m.shading == ShadingModel::Strand
               ? std::optional(layout::StrandBlock{.direction = {std::cos(a), std::sin(a), 0, 0}})
               : std::nullopt;
}

std::optional<layout::SubsurfaceBlock> make_subsurface_block(const Material& m) {
    if (m.shading != ShadingModel::Subsurface) {
        return std::nullopt;
    }
    const Vec3 d = diffusion_distance(Vec3(m.base_color) * skin_tone(m), m.scatter);
    layout::SubsurfaceBlock block{
        .specular = Vec4(m.specular, m.gloss),
        .diffusion = Vec4(d, m.gloss_roughness),
        .samples = {},
        .few_samples = {},
        .fewest_samples = {}};
    sample_diffusion(d, kDensityNear, block.samples);
    sample_diffusion(d, kDensityFar, block.few_samples);
    sample_diffusion(d, kDensityFarther, block.fewest_samples);
    return block;
}

static_assert(static_cast<int>(ClothPattern::Twill) == layout::kPatternTwill);
static_assert(static_cast<std::uint32_t>(DressedPart::Other) == layout::kPersonOther);

std::optional<layout::DressBlock> make_dress_block(const Material& m) {
    const Dress& dress = m.dress;
    if (dress == Dress{}) {
        return std::nullopt;
    }
    const auto factor = [](const DressPart& part) {
        return Vec4(part.color, std::max(part.repeat, 1e-3f));
    };
    const auto ink = [](const DressPart& part) {
        return Vec4(part.ink, static_cast<float>(part.pattern));
    };
    return layout::DressBlock{
        .factors =
            {Vec4(dress.hair, 1), Vec4(dress.skin, 1), factor(dress.shirt), factor(dress.legs)},
        .inks = {ink(dress.shirt), ink(dress.legs)}};
}

struct BlockKind {
    std::uint32_t number;
    std::uint32_t texels;  ///< maximum size
    bool is_last;          ///< of a shading model after whose block there is no other
    /// Appends the block of a material; false if it has none.
    bool (*append)(const Material&, std::vector<Vec4>&);
};

template <auto make>
constexpr BlockKind block_kind(std::uint32_t number, bool is_last) {
    using Block = typename decltype(make(Material()))::value_type;
    static_assert(sizeof(Block) % sizeof(Vec4) == 0);
    constexpr std::size_t kTexels = sizeof(Block) / sizeof(Vec4);
    return {
        number, static_cast<std::uint32_t>(kTexels), is_last,
        [](const Material& material, std::vector<Vec4>& blocks) {
            const std::optional<Block> block = make(material);
            if (block) {
                blocks.resize(blocks.size() + kTexels);
                std::memcpy(blocks.data() + blocks.size() - kTexels, &*block, sizeof(Block));
            }
            return block.has_value();
        }};
}

/// In the order in a material; the last ones may end beyond the range of offsets.
constexpr BlockKind kKinds[] = {
    {layout::kUvBlock, 2 * layout::kMaxMapSlots, false, append_uv_block},
    block_kind<make_clear_block>(layout::kClearBlock, false),
    block_kind<make_layers_block>(layout::kLayersBlock, false),
    block_kind<make_relief_block>(layout::kReliefBlock, false),
    block_kind<make_dress_block>(layout::kDressBlock, false),
    block_kind<make_classic_block>(layout::kClassicBlock, false),
    block_kind<make_skin_block>(layout::kSkinBlock, true),
    block_kind<make_lafortune_block>(layout::kLafortuneBlock, true),
    block_kind<make_toon_block>(layout::kToonBlock, true),
    block_kind<make_strand_block>(layout::kStrandBlock, true),
    block_kind<make_block_of_hair>(layout::kHairBlock, true),
    block_kind<make_subsurface_block>(layout::kSubsurfaceBlock, true),
};

/// Whether the offsets can hold a material with all blocks, and each kind has a number of its own.
constexpr bool kinds_fit() {
    std::uint32_t texels = 0;
    std::uint32_t numbers = 0;
    for (const BlockKind& kind : kKinds) {
        if (kind.number >= layout::kMaxBlockKinds || (numbers >> kind.number & 1u) != 0
            || texels >> layout::kBlockOffsetBits != 0) {
            return false;
        }
        numbers |= 1u << kind.number;
        texels += kind.is_last ? 0 : kind.texels;
    }
    return true;
}
static_assert(kinds_fit());

}  // namespace

bool has_wide_highlights(const Material& m) {
    return m.normal_mips != NormalMips::Plain && is_used(m.normal_texture)
           && (m.shading == ShadingModel::Blinn || m.shading == ShadingModel::Phong
               || m.shading == ShadingModel::Skin);
}

Vec4 append_blocks(const Material& material, std::vector<Vec4>& blocks) {
    const std::size_t first = blocks.size();
    std::uint32_t offsets[3] = {};
    for (const BlockKind& kind : kKinds) {
        const auto offset = static_cast<std::uint32_t>(blocks.size() - first);
        if (kind.append(material, blocks)) {
            const std::uint32_t shift =
                kind.number % layout::kBlocksPerFloat * layout::kBlockOffsetBits;
            offsets[kind.number / layout::kBlocksPerFloat] |= offset << shift;
        }
    }
    return {first, offsets[0], offsets[1], offsets[2]};
}

}  // namespace limn
