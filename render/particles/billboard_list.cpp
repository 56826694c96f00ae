#include "render/particles/billboard_list.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: engine.billboard, engine.billboard-composite, engine.periodic

namespace limn {

void append_billboard(
    const Billboard& billboard, const ParticleLook& look, const Affine& world, double time,
    std::uint32_t random, BillboardList& list) {
    const float half_height =
        0.5f * look.size * std::max(evaluate(billboard.size_function, time), 0.0f);
    const float half_width = half_height * billboard.aspect;
    const Vec3 right = half_width * transform_vector(world, {1, 0, 0});
    const Vec3 up = half_height * transform_vector(world, {0, 1, 0});
    BillboardShading shading;
    shading.position = transform_point(world, Vec3(0));
    shading.color_at = evaluate_share(look.color_function, time);
    shading.opacity = evaluate_share(billboard.opacity_function, time);
    const float extent = glm::length(right) * glm::length(up);
    if (!(half_height > 0 && extent > 0)
        || !std::isfinite(extent + glm::dot(shading.position, Vec3(1)))) {
        return;
    }
    const bool is_composite = billboard.alignment == BillboardAlignment::Composite;
    const BillboardAlignment alignment =
        is_composite ? BillboardAlignment::Axis : billboard.alignment;
    const std::uint32_t frames = std::max(look.columns, 1u) * std::max(look.rows, 1u);
    const std::uint32_t first = look.frames == ParticleFrames::Play ? 0 : (random >> 8) % frames;
    const float rate = look.frames == ParticleFrames::Pick ? 0 : look.frame_rate;
    const std::uint32_t frame = (first + billboard_frame(rate, frames, time)) % frames;
    list.quads.push_back(
        {.right = right,
         .alignment = static_cast<float>(alignment),
         .up = up,
         .frame = static_cast<float>(frame)});
    list.shadings.push_back(shading);
    if (is_composite) {
        const Vec3 across = half_width * transform_vector(world, {0, 0, -1});
        list.quads.push_back(
            {.right = right,
             .alignment = static_cast<float>(BillboardAlignment::None),
             .up = across});
        shading.is_section = true;
        list.shadings.push_back(shading);
    }
}

}  // namespace limn
