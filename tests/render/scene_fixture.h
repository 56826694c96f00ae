#pragma once

#include "ecs/components/camera.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/post.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/gpu/readback.h"
#include "render/render_frame.h"
#include "tests/render/render_fixture.h"

#include <string>

namespace limn::test {

// A world small enough to be computed by hand, and the renderer that draws it.

/// One renderer for all tests of the program, on the shared device.
Renderer& shared_renderer();

/// A square of side 2 in the plane z = 0, facing +z; u runs along x, v down.
MeshData make_square();

/// A unit ball about the origin, `rings` from pole to pole.
MeshData make_ball(int rings = 48);

Affine at(const Vec3& position);

/// A world with Assets and, unless told otherwise, nothing around it.
class Scene : public RenderTest {
  public:
    Scene();
    ~Scene();

    MeshId add(MeshData mesh);
    MaterialId add(Material material);
    ImageId add(ImageData image);
    Entity place(MeshId mesh, MaterialId material, const Affine& now);
    template <typename Light>
    Entity shine(const Light& light, const Affine& now) {
        return world.create(light, WorldTransform{now});
    }

    /// A view from `eye`; the square of side 2 in z = 0 fills the image from (0, 0, 1).
    [[nodiscard]] RenderView
    look(const Vec3& eye, const Vec3& target, int width = 64, int height = 64) const;

    FrameOutput draw(const RenderView& view, const FrameRequest& request = {});
    gpu::FloatImage radiance(const RenderView& view);
    gpu::FloatImage aov(const RenderView& view, const std::string& name);

    World world;
};

Vec3 rgb_at(const gpu::FloatImage& image, int x, int y);

/// Largest difference of the two images in any channel.
float largest_difference(const gpu::FloatImage& a, const gpu::FloatImage& b);

}  // namespace limn::test
