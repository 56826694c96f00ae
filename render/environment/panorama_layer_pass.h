#pragma once

#include "ecs/components/panorama_layer.h"
#include "render/effect.h"
#include "render/gpu/texture.h"

#include <map>
#include <vector>

namespace limn {

// Draws each PanoramaLayer over the sky where no surface is.
//
// Reads    depth; PanoramaLayer, WorldTransform, images
// Writes   radiance
// Order    after the sky, before all that lies over the background
// Shaders  panorama_layer.frag, lib/panorama.glsl

struct PanoramaLayerEffect {
    struct Layer {
        std::uint64_t entity = 0;
        PanoramaLayer settings;
        Mat3 layer_from_world = Mat3(1);
        const gpu::Texture* texture = nullptr;  ///< 2D, or a cube map of `faces`
    };
    /// A cube map of six images, mirrored as cube maps are: its +z is the front.
    struct Cube {
        std::vector<std::uint64_t> sources;  ///< serials and versions of the images
        gpu::Texture texture;
        bool used = false;  ///< in this frame
    };

    const gpu::Program* image_program = nullptr;
    const gpu::Program* faces_program = nullptr;
    gpu::Sampler sampler = {};  ///< of an image: clamped above and below
    std::map<std::vector<std::uint32_t>, Cube> cubes = {};  ///< by the images' indices
    std::vector<Layer> layers = {};                         ///< of the frame, the farthest first

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<PanoramaLayerEffect>
    create(gpu::Device& device, const RenderSettings&);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);

  private:
    /// Null, with a warning, if the images do not make a cube.
    const gpu::Texture* find_cube(const FrameData& frame, const std::vector<ImageId>& faces);
};

}  // namespace limn
