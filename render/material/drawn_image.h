#pragma once

#include "render/graph/frame_graph.h"

namespace limn {

class ImagePool;
struct ImageLayer;

// Images of materials that passes draw before the views, such as combined or lit textures.

/// A target like the array that the image lies in, to draw level 0 of.
[[nodiscard]] TextureId
create_drawn_image(FrameGraph& graph, const ImagePool& images, ImageLayer place);

/// Adds a pass that makes the mip levels of `drawn` and copies it to the image: copied, since
/// materials may read other layers of the array by the same texture.
void place_drawn_image(
    FrameGraph& graph, const ImagePool& images, TextureId drawn, ImageLayer place);

}  // namespace limn
