#pragma once

#include "ecs/components/water.h"
#include "ecs/components/water_frame.h"
#include "ecs/entity.h"
#include "render/particles/billboard_list.h"
#include "render/particles/frame_insets.h"
#include "render/particles/particle_culling.h"
#include "render/particles/particle_list.h"
#include "render/particles/ribbon_list.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace limn {

class GpuParticlePools;
class World;
struct FrameData;

// All that is drawn as particles: ParticlePool, Trail, Beam and Billboard with their ParticleLook,
// collected once per frame for all views (layered_draws.h).

/// The target that the particles of a look are drawn into.
enum class LookLayer : std::uint8_t { Full, Half, Weighted };
inline constexpr std::size_t kLookLayers = 3;

struct DrawnWater {
    const Water* water = nullptr;
    WaterFrame frame{};
};

/// Keeps its memory from frame to frame.
struct ParticleScene {
    std::vector<LookRecord> looks = {};
    std::vector<ParticleArrays> arrays = {};          ///< of each look
    std::vector<LookLayer> layers = {};               ///< of each look
    std::vector<LookExtent> extents = {};             ///< of each look
    std::vector<std::optional<Vec3>> positions = {};  ///< of each look, for order_by_distance()
    RibbonList ribbons = {};
    BillboardList billboards = {};
    std::vector<ParticleInstance> weighted = {};   ///< not sorted
    std::vector<ParticleInstance> instances = {};  ///< those that are sorted, then `weighted`
    std::vector<ParticleInstance> sorted = {};     ///< the same from back to front, then `weighted`
    DistanceOrder order = {};
    std::vector<DrawnWater> waters = {};
    FrameInsetTable insets = {};                                  ///< kept from frame to frame
    SpriteFeatures features = {};                                 ///< of all looks
    std::array<SpriteFeatures, kLookLayers> layer_features = {};  ///< of those of a LookLayer
    bool lit_at_center = false;
    bool soft = false;     ///< some fade where they meet a surface
    bool moving = false;   ///< some look may cover enough to move pixels
    bool focused = false;  ///< some look may cover enough for the lens to focus on
    bool has_ribbons = false;
    bool has_billboards = false;
    bool has_halves = false;
    bool has_weighted = false;
};

/// Collects and sorts particles for the camera of the frame. Those that the GPU moves are added to
/// `gpu`, which begins a frame; their looks are in `scene.looks`.
void collect_particles(FrameData& frame, GpuParticlePools& gpu, ParticleScene& scene);

/// Length of a step [s].
[[nodiscard]] float particle_step(const FrameData& frame);
/// Time of the frame before the end of the last step [s].
[[nodiscard]] float particle_lag(const FrameData& frame);

/// Velocity of an entity in the last step [m/s]; 0 if it jumped.
[[nodiscard]] Vec3 entity_velocity(const World& world, Entity entity, float step);

}  // namespace limn
