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

/// An instance's vertices as the GPU made them; empty if it is drawn at rest.
struct ReadSkin {
    std::vector<Vec3> positions;
    std::vector<Vec3> before;  ///< empty unless asked for
    std::vector<Vec3> normals;
    std::vector<Vec4> tangents;
};

/// Runs the deform pass alone, frame after frame, and reads back what it made.
class SkinReadback {
  public:
    /// `storage_bytes`: of a storage block at most; 0: what the device can.
    [[nodiscard]] static Result<SkinReadback>
    create(gpu::Device& device, std::size_t storage_bytes = 0);

    /// One frame in which `drawn` are drawn, `views` times each.
    std::vector<ReadSkin>
    run(const World& world, std::span<const Entity> drawn, float alpha = 1, float alpha_before = 0,
        bool before = true, int views = 1);

    /// Another world follows.
    void forget();

    /// What the list knows after the last frame.
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
