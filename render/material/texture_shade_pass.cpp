#include "render/material/texture_shade_pass.h"

#include "ecs/components/texture_shade.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/geometry/surface_draws.h"
#include "render/material/drawn_image.h"
#include "render/material/material_pool.h"
#include "render/shaders/texture_shade_gpu.h"

// Techniques: wrinkle.furrow.texture-space-shading

namespace limn {
namespace {

/// Rotates normals of the entity, which should be scaled uniformly, into camera space.
Mat3 camera_from_mesh(const Affine& world_from_camera, const Affine& world_from_mesh) {
    const Mat3 camera(to_mat4(world_from_camera));
    const Mat3 mesh(to_mat4(world_from_mesh));
    return glm::transpose(camera) * mesh;  // the camera is only rotated
}

}  // namespace

Result<TextureShadeEffect> TextureShadeEffect::create(gpu::Device& device, const RenderSettings&) {
    return TextureShadeEffect{
        LIMN_TRY(load_fullscreen(device, "texture_shade.frag")),
        gpu::Sampler("texels", {.minify = GL_NEAREST, .magnify = GL_NEAREST})};
}

bool TextureShadeEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const TextureShade>().empty();
}

void TextureShadeEffect::collect(FrameData& frame) {
    const ImagePool& images = frame.materials->images();
    auto& shaded = frame.data.publish<ShadedImages>();
    shaded.arrays.clear();
    frame.world->query<const TextureShade>().each([&](const TextureShade& shade) {
        shaded.arrays.push_back(&images.array(find_drawn_image(images, shade.target).array));
    });
}

void TextureShadeEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    const ImagePool& images = frame.materials->images();
    const auto draw = [&](const TextureShade& shade, const WorldTransform& transform) {
        const gpu::Texture* normals = images.find_texture(shade.normals);
        const gpu::Texture* color = images.find_texture(shade.color);
        const ImageLayer target = find_drawn_image(images, shade.target);
        if (normals == nullptr || color == nullptr || target.array == 0
            || shade.target == shade.normals || shade.target == shade.color) {
            return;
        }
        const auto array_of = [&](ImageId image) {
            return graph.import("images", images.array(images.find(image).array));
        };
        const gpu::Texture& array = images.array(target.array);
        const TextureId shaded = create_drawn_image(graph, images, target);
        const Mat3 rotation = camera_from_mesh(frame.camera.world_from_camera, transform.world);
        add_fullscreen_pass(
            graph, "shade texture",
            {array_of(shade.normals), array_of(shade.color),
             sampled(
                 graph.import("normals of shaded image", *normals), layout::kShadedNormalsUnit,
                 &texels),
             sampled(
                 graph.import("color of shaded image", *color), layout::kShadedColorUnit, &texels)},
            {target_level(discarded(shaded), 0)}, program,
            [&array, rotation, shade](PassContext&, const gpu::Program& shader) {
                shader.set("size", Vec2(array.width(), array.height()));
                shader.set("camera_from_mesh", rotation);
                shader.set("to_light", normalize_or(shade.to_light, {0, 0, 1}));
                shader.set("strengths", Vec3(shade.ambient, shade.light, shade.specular));
                shader.set("shininess", shade.shininess);
                shader.set("unrolled", shade.unrolled ? 1 : 0);
                shader.set("encoded", array.desc().format == GL_SRGB8_ALPHA8 ? 1 : 0);
            });
        store_drawn_image(graph, images, shaded, target);
    };
    frame.world->query<const TextureShade, const WorldTransform>().each(draw);
}

}  // namespace limn
