#include "render/environment/panorama_layer_pass.h"

#include "ecs/base/log.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/environment/cube_map.h"
#include "render/fullscreen.h"
#include "render/light/lighting.h"
#include "render/material/image_pool.h"
#include "render/material/material_pool.h"
#include "render/settings.h"
#include "render/shaders/panorama_layer_gpu.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <utility>

// Techniques: engine.panorama

namespace limn {
namespace {

/// Without the scale; the identity where an axis has no length.
Mat3 rotation_from(const Affine& world) {
    Mat3 rotation(1);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit(0);
        unit[axis] = 1;
        const Vec3 column = transform_vector(world, unit);
        const float length = glm::length(column);
        if (!(length > 0) || !is_finite(column)) {
            return Mat3(1);
        }
        rotation[axis] = column / length;
    }
    return rotation;
}

/// Empty, or why the images are no cube.
const char* cube_error(const std::vector<const gpu::Texture*>& faces) {
    if (faces.size() != static_cast<std::size_t>(kCubeFaces)) {
        return "expected six faces";
    }
    for (const gpu::Texture* const face : faces) {
        if (face == nullptr) {
            return "found a face without an image";
        }
        if (face->width() != face->height()) {
            return "expected square faces";
        }
        if (face->desc() != faces[0]->desc()) {
            return "expected faces of one size, format and number of mip levels";
        }
    }
    return "";
}

}  // namespace

bool PanoramaLayerEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const PanoramaLayer>().empty();
}

Result<PanoramaLayerEffect>
PanoramaLayerEffect::create(gpu::Device& device, const RenderSettings&) {
    return PanoramaLayerEffect{
        .image_program = LIMN_TRY(load_fullscreen(device, "panorama_layer.frag")),
        .faces_program =
            LIMN_TRY(load_fullscreen(device, "panorama_layer.frag", {{"PANORAMA_FACES", "1"}})),
        .sampler = gpu::Sampler("panorama layer", {.wrap = GL_REPEAT, .wrap_v = GL_CLAMP_TO_EDGE})};
}

const gpu::Texture*
PanoramaLayerEffect::find_cube(const FrameData& frame, const std::vector<ImageId>& faces) {
    std::vector<std::uint32_t> images;
    std::vector<const gpu::Texture*> textures;
    std::vector<std::uint64_t> sources;
    for (const ImageId face : faces) {
        images.push_back(face.index);
        const gpu::Texture* const texture = frame.materials->images().find_texture(face);
        textures.push_back(texture);
        sources.push_back(texture != nullptr ? texture->serial() : 0);
        sources.push_back(texture != nullptr ? frame.assets->images[face.index].version : 0);
    }
    Cube& cube = cubes[images];
    cube.used = true;
    if (cube.sources == sources) {
        return cube.texture ? &cube.texture : nullptr;
    }
    cube = {.sources = sources, .texture = {}, .used = true};
    if (const char* const error = cube_error(textures); *error != '\0') {
        log_warn("panorama_layer: {}; the layer is not drawn", error);
        return nullptr;
    }
    gpu::TextureDesc desc = textures[0]->desc();
    desc.target = GL_TEXTURE_CUBE_MAP;
    desc.depth = 1;
    cube.texture = gpu::Texture("panorama faces", desc);
    for (std::size_t face = 0; face < textures.size(); ++face) {
        textures[face]->copy_to(cube.texture, static_cast<int>(face));
    }
    return &cube.texture;
}

void PanoramaLayerEffect::collect(FrameData& frame) {
    layers.clear();
    if (frame.assets_replaced) {
        cubes.clear();
    }
    for (auto& [images, cube] : cubes) {
        cube.used = false;
    }
    frame.world->query<const PanoramaLayer, Optional<const WorldTransform>>().each(
        [&](Entity entity, const PanoramaLayer& layer, const WorldTransform* transform) {
            const PanoramaLayer settings = within_ranges(layer);
            const gpu::Texture* const texture =
                settings.faces.empty() ? frame.materials->images().find_texture(settings.image)
                                       : find_cube(frame, settings.faces);
            if (texture != nullptr && settings.opacity > 0) {
                const Mat3 rotation =
                    transform != nullptr ? rotation_from(transform->world) : Mat3(1);
                layers.push_back({entity.index, settings, glm::transpose(rotation), texture});
            }
        });
    std::ranges::sort(layers, {}, &Layer::entity);
    std::erase_if(cubes, [](const auto& entry) { return !entry.second.used; });
}

void PanoramaLayerEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    if (layers.empty()) {
        return;
    }
    graph.add_pass(
        "panorama layers", {depth_tested(view.gbuffer.depth)}, {view.radiance},
        [this, &view](PassContext& context) {
            gpu::PipelineState state = kWhereBackground;
            state.blend = gpu::kBlendAlpha;
            for (const Layer& layer : layers) {
                const bool cube = !layer.settings.faces.empty();
                const gpu::Program& program = cube ? *faces_program : *image_program;
                context.device().use(gpu::Pipeline{&program, state});
                bind_view(context, view);
                context.device().bind_texture(
                    layout::kPanoramaLayerUnit, *layer.texture, cube ? nullptr : &sampler);
                program.set("layer_from_world", layer.layer_from_world);
                if (!cube) {
                    program.set("mapping", static_cast<int>(layer.settings.mapping));
                    program.set("half_angle", layer.settings.half_angle);
                    program.set("repeat", static_cast<float>(layer.settings.repeat));
                }
                program.set("color", Vec4(layer.settings.color, layer.settings.opacity));
                context.device().draw_fullscreen();
            }
        });
}

}  // namespace limn
