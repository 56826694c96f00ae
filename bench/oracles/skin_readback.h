#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"
#include "render/gpu/device.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {
class DeformedList;
class World;
}  // namespace limn

namespace limn::oracle {

/// An instance's vertices as deformed by the GPU; empty if it is drawn at rest.
struct SkinReadbackVertices {
    std::vector<Vec3> positions;
    std::vector<Vec3> before;  ///< empty unless requested
    std::vector<Vec3> normals;
    std::vector<Vec4> tangents;
    std::vector<Vec4> wrinkles;  ///< wrinkle strengths, see lib/material.glsl; empty: no wrinkles
    std::vector<float> folds;    ///< fold displacement along the normals [m]; empty: none
};

/// Runs only the passes that deform and measure skin, frame by frame, and reads back their results.
class SkinReadback {
  public:
    /// `storage_bytes`: limit of a storage block; 0: the device's.
    [[nodiscard]] static Result<SkinReadback>
    create(gpu::Device& device, std::size_t storage_bytes = 0);

    /// Runs one frame in which the entities `drawn` are drawn, `views` times each.
    std::vector<SkinReadbackVertices>
    run(const World& world, std::span<const Entity> drawn, float alpha = 1,
        float previous_alpha = 0, bool before = true, int views = 1);

    /// Call before the next run of a different world.
    void forget();

    /// The list's state after the last frame.
    [[nodiscard]] const DeformedList& shapes() const;

  private:
    struct Machine;
    struct Deleter {
        void operator()(Machine* machine) const;
    };
    explicit SkinReadback(std::unique_ptr<Machine, Deleter> machine);
    std::unique_ptr<Machine, Deleter> machine_;
};

}  // namespace limn::oracle
