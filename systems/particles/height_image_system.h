#pragma once

#include "ecs/commands.h"
#include "ecs/components/height_field.h"
#include "ecs/components/height_image.h"
#include "ecs/components/surface.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Red of an image at texture coordinates 0 .. 1, bilinear between the centers of texels and
/// clamped beyond. 0 if the image is empty or not finite there.
[[nodiscard]] float sample_red(const ImageData& image, const Vec2& at);

/// Fills `field` from the image. Normals are from central differences between points, one-sided at
/// the edges.
void fill_height_image(const HeightImage& settings, const ImageData& image, HeightField& field);

/// Adds state and heights to new HeightImages.
void add_height_images(Query<const HeightImage, Without<HeightImageState>> bare, Commands commands);

/// Fills those whose settings or image have changed.
void update_height_images(
    Query<const HeightImage, HeightImageState, HeightField> images, Res<const Assets> assets);

}  // namespace limn
