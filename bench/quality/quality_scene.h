#pragma once

#include "bench/oracles/glow_oracle.h"
#include "bench/quality/quality.h"
#include "content/app/commands/stage.h"
#include "ecs/components/post.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/gpu/readback.h"
#include "render/graph/frame_graph.h"
#include "render/lens/tone_mapper.h"
#include "render/render_view.h"

#include <glm/vec3.hpp>

#include <memory>
#include <string>
#include <utility>

namespace limn {

// Shared by quality measurements: scenes, views, and conversions between the renderer's textures,
// the oracles' images in double precision and the images of a report.

/// A small world of a few surfaces and lights without an environment, to measure effects in.
class QualityScene {
  public:
    QualityScene();

    MeshId add(MeshData mesh);
    MaterialId add(Material material);
    ImageId add(ImageData image);
    SkinId add(SkinData skin);
    Entity place(MeshId mesh, MaterialId material, const Affine& pose);
    template <typename Light>
    Entity add_light(const Light& light, const Affine& pose) {
        return world.create(light, WorldTransform{pose}, PreviousWorldTransform{pose});
    }
    /// Linear radiance of a frame, RGB in the first three channels.
    [[nodiscard]] gpu::FloatImage render(HeadlessRenderer& headless, const RenderView& view) const;
    /// The mean of `samples` frames, shifted within a pixel.
    [[nodiscard]] gpu::FloatImage
    radiance(HeadlessRenderer& headless, const RenderView& view, int samples = 1) const;

    World world;
};

/// A pose without rotation.
[[nodiscard]] Affine placed_at(const Vec3& position, float scale = 1);
/// A square of side 2 in z = 0, facing +z.
[[nodiscard]] MeshData quality_square();
/// A blue sky and a warm sun.
void add_daylight(QualityScene& scene);

/// Populates the scene with the corner of a courtyard: columns in front of a wall with a pointed
/// gate at x = -0.6, z = -2.6, a ball in a ring on a block, a railing of thin bars. All meshes are
/// closed, as shadow volumes require, and cast shadows. No lights.
void populate_court(QualityScene& scene);
/// A view from the first toward the second point shows the whole courtyard.
inline constexpr Vec3 kCourtEye = {1.7f, 2.5f, 4.4f};
inline constexpr Vec3 kCourtTarget = {-0.25f, 0.75f, -0.6f};
[[nodiscard]] RenderView court_view(int width, int height);

/// A view from `eye` toward `target`.
[[nodiscard]] RenderView
quality_view(const Vec3& eye, const Vec3& target, int width, int height, float fov_y);
/// Largest difference of any of R, G and B, relative to the brightest of `expected`.
[[nodiscard]] double
largest_relative_error(const gpu::FloatImage& found, const gpu::FloatImage& expected);
/// The ray through the center of a pixel, rows from the top, one meter long along the view axis.
[[nodiscard]] glm::dvec3 pixel_ray(const RenderView& view, double x, double y);
[[nodiscard]] glm::dvec3 eye_of(const RenderView& view);

/// A level after its first second, with the view and exposure of its camera.
struct LevelView {
    std::unique_ptr<Stage> stage;
    RenderView view;
    Exposure exposure;
};
[[nodiscard]] Result<LevelView> open_level_view(const std::string& level, const IVec2& size);

/// Display encoding of linear light: clamped and sRGB-encoded.
[[nodiscard]] ColorImage displayed(const gpu::FloatImage& radiance);
[[nodiscard]] ColorImage color_image(const gpu::ByteImage& bytes);
[[nodiscard]] oracle::LightImage read_light_image(const gpu::Texture& texture);
[[nodiscard]] gpu::Texture upload_light(const oracle::LightImage& image);

/// Runs single passes on images, outside of a frame.
struct ImageBench {
    ImageBench(gpu::Device& device, ToneMapper made)
        : graph(device), tone_mapper(std::move(made)) {}

    /// `draw(graph, radiance)` adds the passes and returns the id of their result, which is valid
    /// until the next run.
    template <typename Draw>
    const gpu::Texture& run(const gpu::Texture& radiance, const Draw& draw) {
        graph.begin_frame();
        const TextureId drawn = draw(graph, graph.import("radiance", radiance));
        graph.keep(drawn);
        graph.execute();
        return *graph.texture(drawn);
    }
    template <typename Draw>
    oracle::LightImage run(const oracle::LightImage& radiance, const Draw& draw) {
        return read_light_image(run(upload_light(radiance), draw));
    }
    [[nodiscard]] gpu::ByteImage display(const gpu::Texture& radiance, const Exposure& exposure);
    [[nodiscard]] ColorImage display(const oracle::LightImage& radiance, const Exposure& exposure);

    FrameGraph graph;
    ToneMapper tone_mapper;
};

/// Difference of `found` from `exact`, relative to `exact` [%].
[[nodiscard]] double percent_error(double found, double exact);

}  // namespace limn
