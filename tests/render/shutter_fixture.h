#pragma once

#include "ecs/components/motion_blur.h"
#include "tests/render/scene_fixture.h"

#include <vector>

namespace limn::test {

/// Flat colors in the plane of the image, so that all of it can be computed.
class Shutter : public Scene {
  public:
    static constexpr int kSize = 64;
    static constexpr float kPerMeter = 32;  ///< pixels in the plane z = 0, viewed from (0, 0, 1)

    MaterialId unlit(const Vec3& color) {
        return add(Material{.shading = ShadingModel::Unlit, .base_color = {color, 1}});
    }
    /// From `begin` to `end` [px] across the image, and moving by `way` [px] per frame.
    Entity bar(MaterialId material, float begin, float end, float way, float z = 0) {
        const float center = (0.5f * (begin + end) - 0.5f * kSize) / kPerMeter;
        const float half = 0.5f * (end - begin) / kPerMeter;
        const float scale = 1 - z;  // covers the same pixels from farther away
        const auto pose = [&](float x) {
            return affine_from({x * scale, 0, z}, {1, 0, 0, 0}, {half * scale, 2 * scale, 1});
        };
        const Entity entity = place(square, material, pose(center));
        world.get<PreviousWorldTransform>(entity).world = pose(center - way / kPerMeter);
        return entity;
    }
    void open(float shutter, int samples = 64, float longest = 1) {
        world.insert_resource(
            MotionBlur{.shutter = shutter, .samples = samples, .max_length = longest});
    }
    [[nodiscard]] RenderView front(int width = kSize, int height = kSize) const {
        return look({0, 0, 1}, {0, 0, 0}, width, height);
    }
    gpu::FloatImage picture() { return radiance(front()); }
    /// Without motion blur.
    gpu::FloatImage sharp(const RenderView& view) {
        const MotionBlur kept = world.resource<MotionBlur>();
        world.remove_resource<MotionBlur>();
        gpu::FloatImage image = radiance(view);
        world.insert_resource(kept);
        return image;
    }
    gpu::FloatImage sharp() { return sharp(front()); }

    MeshId square = add(make_square());
};

inline std::vector<double> row_of(const gpu::FloatImage& image, int y, int channel) {
    std::vector<double> row;
    for (int x = 0; x < image.width; ++x) {
        row.push_back(image.at(x, y, channel));
    }
    return row;
}

inline double sum_of(const gpu::FloatImage& image, int channel) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        for (const double value : row_of(image, y, channel)) {
            sum += value;
        }
    }
    return sum;
}

}  // namespace limn::test
