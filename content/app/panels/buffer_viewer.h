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

// F4: shows the intermediate textures of the frame. The frame graph keeps the selected one alive
// past its last use; it is mapped to the display range and enlarged, and the texel under the
// pointer is read back. Costs nothing while the panel is closed.

class BufferViewer {
  public:
    /// Fails with the shader compiler's message.
    [[nodiscard]] static Result<BufferViewer> create(gpu::Device& device);

    /// Call before render_frame: requests the selected texture.
    void before_frame(FrameGraph& graph, FrameRequest& request);
    /// Call after render_frame: draws the selected texture, mapped to the display range, into the
    /// viewer's texture.
    void after_frame(gpu::Device& device, const FrameGraph& graph, const FrameOutput& frame);
    /// Draws the panel.
    void draw(const HudStyle& style, const FrameGraph& graph);

    /// Selects the texture of that name.
    void select(std::string name);

    bool open = false;

  private:
    explicit BufferViewer(gpu::Pipeline pipeline) : pipeline_(pipeline) {}
    void fit_range(const gpu::Texture& texture);
    void draw_list(const HudStyle& style, const FrameGraph& graph);
    void draw_mapping(const HudStyle& style);
    void draw_image(const HudStyle& style);

    gpu::Pipeline pipeline_;
    gpu::Texture view_;
    const gpu::Texture* source_ = nullptr;  // the selected texture of this frame, or null
    std::string selected_ = "normal";
    std::string kept_name_;           // name of the texture the graph keeps alive
    const char* why_not_shown_ = "";  // why the selected texture cannot be shown
    Vec2 range_ = {0, 1};             // values mapped to black and white
    int channel_ = 4;                 // 0 .. 3, or 4 for RGB
    bool srgb_ = true;
    bool fit_requested_ = true;
};

}  // namespace limn
