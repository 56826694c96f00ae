#include "render/material/drawn_image.h"

#include "render/fullscreen.h"
#include "render/material/image_pool.h"

namespace limn {

TextureId create_drawn_image(FrameGraph& graph, const ImagePool& images, ImageLayer place) {
    const gpu::Texture& array = images.array(place.array);
    return create_target(
        graph, "drawn image", array.desc().format, {array.width(), array.height()},
        array.desc().levels);
}

void place_drawn_image(
    FrameGraph& graph, const ImagePool& images, TextureId drawn, ImageLayer place) {
    const TextureId array = graph.import("images", images.array(place.array));
    graph.add_pass(
        "place drawn image", {}, {image(drawn), image(array)},
        [drawn, place, &images](PassContext& context) {
            const gpu::Texture& texture = context.texture(drawn);
            glGenerateTextureMipmap(texture.id());
            texture.copy_to(images.array(place.array), static_cast<int>(place.layer));
        });
}

}  // namespace limn
