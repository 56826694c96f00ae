#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"
#include "render/gpu/buffer_texture.h"
#include "render/particles/particle_packing.h"
#include "render/render_view.h"
#include "render/shaders/particle_gpu.h"
#include "render/variant.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Particles and their looks as shaders read them (particle_gpu.h).

static_assert(sizeof(ParticleInstance) == 4 * layout::kParticleWords);

/// The record of a look in particle_gpu.h.
using LookRecord = std::array<Vec4, layout::kLookTexels>;

/// Layers of the texture arrays that hold the images of a look; -1: none.
struct LookLayers {
    int image = -1;  ///< -1: a soft disc
    int motion = -1;
    int negative_light = -1;
};
[[nodiscard]] LookRecord make_look_record(const ParticleLook& look, const LookLayers& layers);

/// Whether it is drawn as points: discs that face the camera, of a size in pixels or of specks.
[[nodiscard]] bool is_point(const LookRecord& look);

/// Whether a look scatters light that is evaluated once per particle, or at the corners of quads.
[[nodiscard]] bool is_lit_at_center(const LookRecord& look);
[[nodiscard]] bool is_lit_at_corners(const LookRecord& look);

/// Whether pixels of a look may move with it: ParticleLook::velocity_cover.
[[nodiscard]] bool moves_pixels(const LookRecord& look);

/// Appends the particles as they are `back` seconds before the end of the step, without those not
/// born by then. Streaks show velocities relative to `observer` [m/s].
void append_particles(
    const ParticlePool& pool, std::uint32_t look, float back,
    std::vector<ParticleInstance>& instances, const Vec3& observer = {0, 0, 0});

/// Upper bound of the distance of its corners from its center [m], if its size is in meters and it
/// is no streak.
[[nodiscard]] float corner_radius(const ParticleInstance& instance, const LookRecord& look);

/// Lower bound of the diameter of its quad in the image [px]; 0 if it may be tilted.
[[nodiscard]] float
min_diameter(const ParticleInstance& instance, const LookRecord& look, const RenderView& view);

/// The texture arrays of ImagePool that hold the images of a look; 0: none.
struct ParticleArrays {
    std::uint32_t images = 0;
    std::uint32_t motions = 0;
    std::uint32_t negative_lights = 0;

    bool operator==(const ParticleArrays&) const = default;
};

/// Features that at least one look uses: definitions of lib/sprite.glsl.
struct SpriteFeatures {
    bool images = false;
    bool flipbooks = false;  ///< that blend from frame to frame
    bool motions = false;    ///< motion maps
    bool six_way = false;    ///< images of the light from six sides

    SpriteFeatures& operator|=(const SpriteFeatures& more) {
        images = images || more.images;
        flipbooks = flipbooks || more.flipbooks;
        motions = motions || more.motions;
        six_way = six_way || more.six_way;
        return *this;
    }

    void add_to(Variant& variant) const {
        variant.add_if(images, "IMAGES");
        variant.add_if(images && flipbooks, "FLIPBOOKS");
        variant.add_if(images && motions, "MOTION");
    }
};

class GpuParticlePools;
struct GpuParticleView;

/// All particles of a frame, for effects that draw them again, as shadows; published in collect(),
/// valid until the end of the frame.
struct ParticleSprites {
    std::span<const ParticleInstance> instances;  ///< without those that the GPU moves
    GpuParticlePools* gpu = nullptr;              ///< those: update() before they are read
    const GpuParticleView* gpu_view = nullptr;    ///< argument of update()
    std::span<const LookRecord> looks;
    std::span<const ParticleArrays> arrays;  ///< of each look
    SpriteFeatures features{};
    const BufferTexture* look_texels = nullptr;
};

}  // namespace limn
