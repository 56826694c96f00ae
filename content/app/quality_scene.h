#pragma once

#include "bench/oracles/image_compare.h"
#include "content/app/headless.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/gpu/readback.h"
#include "render/render_view.h"

namespace limn {

/// A world of a few surfaces and lights with nothing around it, for effects to be measured in.
class QualityScene {
  public:
    QualityScene();

    MeshId add(MeshData mesh);
    MaterialId add(Material material);
    Entity place(MeshId mesh, MaterialId material, const Affine& pose);
    template <typename Light>
    Entity shine(const Light& light, const Affine& pose) {
        return world.create(light, WorldTransform{pose}, PreviousWorldTransform{pose});
    }
    /// Linear radiance, RGB in the first three channels.
    [[nodiscard]] gpu::FloatImage
    radiance(HeadlessRenderer& headless, const RenderView& view, int samples = 1);

    World world;
};

/// A pose without rotation.
[[nodiscard]] Affine placed_at(const Vec3& position, float scale = 1);
/// From `eye` at `target`.
[[nodiscard]] RenderView
quality_view(const Vec3& eye, const Vec3& target, int width, int height, float fov_y);
/// A square of side 2 in z = 0, facing +z.
[[nodiscard]] MeshData quality_square();
/// Linear light as a screen shows it: clamped, sRGB encoded.
[[nodiscard]] ColorImage displayed(const gpu::FloatImage& radiance);

}  // namespace limn
