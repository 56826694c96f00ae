#pragma once

#include "bench/oracles/glow_oracle.h"
#include "bench/oracles/image_compare.h"
#include "content/app/stage.h"
#include "ecs/components/post.h"
#include "render/develop.h"
#include "render/graph/frame_graph.h"
#include "render/render_view.h"

#include <memory>
#include <string>

namespace limn {

// Pictures of light between the renderer and oracles that reckon in double precision.

[[nodiscard]] oracle::LightPicture light_picture(const gpu::Texture& texture);
[[nodiscard]] gpu::Texture upload_light(const oracle::LightPicture& picture);

/// A pixel's worth of light at `place` [px from the left and the top], spread over the pixels that
/// it covers; dark otherwise.
[[nodiscard]] oracle::LightPicture
make_dot(const IVec2& size, const glm::dvec2& place, double light);

/// As a screen shows it, without dither.
[[nodiscard]] ColorImage develop_light(
    FrameGraph& graph, Developer& developer, const oracle::LightPicture& picture,
    const Exposure& exposure = {});

/// A level after its first step.
struct LevelView {
    std::unique_ptr<Stage> stage;
    RenderView view;
    Exposure exposure;
};
[[nodiscard]] Result<LevelView> open_level_view(const std::string& level, const IVec2& size);

/// How far `found` is from `exact`, of that [%].
[[nodiscard]] double percent_off(double found, double exact);

}  // namespace limn
