#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "render/gpu/texture.h"
#include "render/render_view.h"
#include "render/shaders/environment_gpu.h"

#include <array>

namespace limn {

class World;

// The probes of a scene (EnvProbe): which there are, what each has seen so far, and what the shader
// must know of them (lib/surroundings.glsl). Each keeps a layer of the reflection maps for as long
// as it lives; the first layout::kMaxProbes of the world have one, the rest counts for nothing and
// is reported once.

/// A probe that has a layer.
struct ProbeSlot {
    Entity entity;               ///< null: the slot is free
    bool seen = false;           ///< in this frame
    std::uint64_t due = 0;       ///< faces that should have been drawn so far; i is face i mod 6
    std::uint64_t drawn = 0;     ///< faces that were
    int fresh = 0;               ///< of these, since it had to begin anew
    bool ready = false;          ///< its layer shows all six
    Vec3 seen_from = {0, 0, 0};  ///< where the faces were drawn from
    float near = 0.05f;
    int resolution = 128;
    float size = 0;              ///< mean half side of where it counts: the smaller comes first
    layout::ProbeRecord record;  ///< without seen_from
    gpu::Texture cube;           ///< RGBA16F or RGBA32F with all mip levels
};

class EnvProbeList {
  public:
    /// Which probes there are at the moment `alpha` (RenderView), and which faces are due.
    void collect(const World& world, float alpha);

    /// Everything must be drawn again, whatever the probes' policies say.
    void forget();

    [[nodiscard]] std::array<ProbeSlot, layout::kMaxProbes>& slots() { return slots_; }

    /// Those that are ready, the smallest first.
    [[nodiscard]] layout::ProbeBlock make_block() const;

  private:
    std::array<ProbeSlot, layout::kMaxProbes> slots_;
    bool told_ = false;  ///< that there are too many
};

/// Layer of the reflection maps of slot number `slot`; 0 is the sky's.
[[nodiscard]] constexpr int probe_layer(std::size_t slot) {
    return static_cast<int>(slot) + 1;
}

/// From the probe toward one face of its cube map, without its own entity.
[[nodiscard]] RenderView make_probe_view(const ProbeSlot& slot, int face, float alpha);

}  // namespace limn
