#pragma once

#include "ecs/base/math.h"
#include "render/particles/particle_list.h"
#include "render/shadow/light_bounds.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

class GpuParticlePools;
struct FrameData;
struct GpuParticlePool;
struct ParticleScene;
struct ViewData;

// The particle draws of a view, as one list: layer by layer, and within a layer from back to front.
// Consecutive particles are one draw call if they share a program and texture arrays. Pools that
// the GPU moves come last in their layer, but for those that only add light: they come first, so
// that dust and smoke at full resolution dim them, also where those are behind them.

/// In the order in which they are drawn.
enum class SpriteLayer : std::uint8_t {
    Underwater,  ///< visible through a water surface: drawn before the water, and again after it
    Behind,      ///< at full resolution, farther than the median of Half
    Half,        ///< at half the resolution, as one image
    Splats,      ///< points on the GPU that only add light, by compute
    Front,       ///< at full resolution
    Weighted,    ///< blended without an order, as one image
};
inline constexpr std::size_t kSpriteLayers = 6;

/// The primitive of a draw. Discs of a few pixels whose light does not vary over them are drawn as
/// points, unless their draw also has particles that need a quad.
enum class SpriteShape : std::uint8_t { Quad, SmallDisc, Point };
inline constexpr std::size_t kSpriteShapes = 3;

struct SpriteDraw {
    SpriteLayer layer = SpriteLayer::Front;
    SpriteShape shape = SpriteShape::Quad;
    ParticleArrays arrays{};
    bool lit = false;        ///< some are lit at their corners
    bool magnified = false;  ///< none is smaller than a frame of its image
    int first = 0;           ///< of LayeredDraws::instances
    int count = 0;
    const GpuParticlePool* pool = nullptr;  ///< all of its particles; null: the CPU moves them
};

/// Keeps its memory from frame to frame.
struct LayeredDraws {
    std::vector<SpriteDraw> draws{};
    std::array<std::size_t, kSpriteLayers + 1> begin{};  ///< of each layer in `draws`; the end
    std::vector<ParticleInstance> instances{};           ///< in the order of the draws
    LightBounds half_window{};  ///< pixels of the view that may show the layer Half
    Bounds weighted_bounds{};   ///< of the positions in the layer Weighted

    std::vector<std::uint8_t> visible{};  ///< of ParticleScene::sorted
    /// Indices of ParticleScene::sorted by the layer, those of Underwater by that above water.
    std::array<std::vector<std::uint32_t>, kSpriteLayers> indices{};
    std::array<std::vector<std::uint32_t>, kSpriteLayers> underwater{};

    [[nodiscard]] std::span<const SpriteDraw> of(SpriteLayer layer) const {
        const auto i = static_cast<std::size_t>(layer);
        return std::span(draws).subspan(begin[i], begin[i + 1] - begin[i]);
    }
    /// All but Underwater.
    [[nodiscard]] std::span<const SpriteDraw> above_water() const {
        return std::span(draws).subspan(begin[1]);
    }
};

/// Lists the draws of what may be visible in the view.
void list_draws(
    const ParticleScene& scene, const GpuParticlePools& gpu, const FrameData& frame,
    const ViewData& view, LayeredDraws& list);

}  // namespace limn
