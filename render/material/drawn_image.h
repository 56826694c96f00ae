#pragma once

#include "render/graph/frame_graph.h"

namespace limn {

class ImagePool;
struct ImageId;
struct ImageLayer;

// Material images that passes draw before the views, such as combined or lit textures.

/// The location of an image that a pass draws on; array 0 if there is none, or it is in blocks,
/// which cannot be drawn on.
[[nodiscard]] ImageLayer find_drawn_image(const ImagePool& images, ImageId id);

/// A render target with the format and size of the image, for its level 0.
[[nodiscard]] TextureId
create_drawn_image(FrameGraph& graph, const ImagePool& images, ImageLayer location);

/// Adds a pass that generates the mip levels of `drawn` and copies them to the image. It is not
/// drawn there directly, since materials may be reading other layers of the same texture array.
void store_drawn_image(
    FrameGraph& graph, const ImagePool& images, TextureId drawn, ImageLayer location);

}  // namespace limn
