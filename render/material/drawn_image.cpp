#include "render/material/drawn_image.h"

#include "render/fullscreen.h"
#include "render/material/image_pool.h"

namespace limn {

ImageLayer find_drawn_image(const ImagePool& images, ImageId id) {
    const ImageLayer location = images.find(id);
    const GLenum format = images.array(location.array).desc().format;
    return gpu::format_info(format).pixel_format != GL_NONE ? location : ImageLayer{};
}

TextureId create_drawn_image(FrameGraph& graph, const ImagePool& images, ImageLayer location) {
    const gpu::Texture& array = images.array(location.array);
    return create_target(
        graph, "drawn image", array.desc().format, {array.width(), array.height()},
        array.desc().levels);
}

void store_drawn_image(
    FrameGraph& graph, const ImagePool& images, TextureId drawn, ImageLayer location) {
    const TextureId array = graph.import("images", images.array(location.array));
    graph.add_pass(
        "store drawn image", {}, {image(drawn), image(array)},
        [drawn, location, &images](PassContext& context) {
            const gpu::Texture& texture = context.texture(drawn);
            glGenerateTextureMipmap(texture.id());
            texture.copy_to(images.array(location.array), static_cast<int>(location.layer));
        });
}

}  // namespace limn
