#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/pipeline_state.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

namespace gpu {
class Device;
}
class FrameGraph;
struct HudStyle;
struct FrameOutput;
struct FrameRequest;

// F4: the intermediate pictures of the frame. The one that is chosen is kept past its last use by
// the frame graph, mapped to what a screen can show, and drawn large; the pixel under the pointer
// is read back as numbers. While the panel is closed none of this happens.

class BufferViewer {
  public:
    /// Fails with the shader compiler's message.
    [[nodiscard]] static Result<BufferViewer> create(gpu::Device& device);

    /// Before render_frame: asks for the chosen texture.
    void before_frame(FrameGraph& graph, FrameRequest& request);
    /// After render_frame: draws the chosen texture into the viewer's own.
    void after_frame(gpu::Device& device, const FrameGraph& graph, const FrameOutput& frame);
    /// The panel.
    void draw(const HudStyle& style, const FrameGraph& graph);

    /// Shows the texture of that name.
    void choose(std::string name);

    bool open = false;

  private:
    explicit BufferViewer(gpu::Pipeline pipeline) : pipeline_(pipeline) {}
    void fit_range(const gpu::Texture& texture);
    void draw_list(const HudStyle& style, const FrameGraph& graph);
    void draw_mapping(const HudStyle& style);
    void draw_picture(const HudStyle& style);

    gpu::Pipeline pipeline_;
    gpu::Texture view_;
    const gpu::Texture* source_ = nullptr;  // the chosen texture of this frame, or null
    std::string chosen_ = "normal";
    std::string kept_;         // what the graph was asked to keep
    const char* cannot_ = "";  // why the chosen texture is not shown
    Vec2 range_ = {0, 1};      // values shown black and white
    int channel_ = 4;          // 0 .. 3, or 4 for RGB
    bool srgb_ = true;
    bool fit_wanted_ = true;
};

}  // namespace limn
