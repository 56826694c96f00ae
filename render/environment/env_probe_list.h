#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "render/gpu/texture.h"
#include "render/render_view.h"
#include "render/shaders/environment_gpu.h"

#include <array>

namespace limn {

class World;

// The environment probes of a scene (EnvProbe): which exist, what each has captured so far, and the
// records that lib/surroundings.glsl reads. Each keeps a layer of the reflection maps for as long
// as it lives; only the first layout::kMaxProbes of the world get one, the rest are ignored and
// reported once.

/// A probe that has a layer.
struct ProbeSlot {
    Entity entity;            ///< null: the slot is free
    bool alive = false;       ///< exists in this frame
    std::uint64_t due = 0;    ///< running number of faces due so far; number i is face i mod 6
    std::uint64_t drawn = 0;  ///< faces drawn so far
    int fresh = 0;            ///< of these, since the last reset
    bool ready = false;       ///< its layer holds all six faces
    Vec3 capture_position = {0, 0, 0};  ///< capture position of the faces
    float near = 0.05f;
    int resolution = 128;
    float size = 0;              ///< mean half side of its region; smaller ones have priority
    layout::ProbeRecord record;  ///< without capture_position
    gpu::Texture cube;           ///< RGBA16F or RGBA32F with a full mip chain
};

inline constexpr int kMaxProbeResolution = 1024;  ///< [px]

class EnvProbeList {
  public:
    /// Finds the probes at time `alpha` (RenderView), and which faces are due, of at most
    /// `max_resolution` >= 16 [px].
    void collect(const World& world, float alpha, int max_resolution);

    /// Marks every face for redrawing, whatever the probes' update policies say.
    void forget();

    [[nodiscard]] std::array<ProbeSlot, layout::kMaxProbes>& slots() { return slots_; }

    /// The probes that are ready, smallest first.
    [[nodiscard]] layout::ProbeBlock make_block() const;

  private:
    std::array<ProbeSlot, layout::kMaxProbes> slots_;
    bool reported_ = false;  ///< that there are too many probes
};

/// Reflection map layer of slot number `slot`; layer 0 is the sky's.
[[nodiscard]] constexpr int probe_layer(std::size_t slot) {
    return static_cast<int>(slot) + 1;
}

/// View from the probe through one face of its cube map; hides the probe's own entity.
[[nodiscard]] RenderView make_probe_view(const ProbeSlot& slot, int face, float alpha);

}  // namespace limn
