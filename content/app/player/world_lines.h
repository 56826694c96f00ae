#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <optional>
#include <string>

namespace limn {

class LabelLayout;
struct RenderView;

/// Pixel of a point of the world; none behind the near plane.
[[nodiscard]] std::optional<Vec2> find_pixel(const RenderView& view, const Vec3& at);

/// Draws lines and points of the world behind the HUD's panels, clipped at the near plane, without
/// depth test.
class WorldLines {
  public:
    /// `color` is sRGB, 0 .. 1.
    WorldLines(const RenderView& view, const Vec3& color, float opacity = 0.9f);

    void draw_line(const Vec3& from, const Vec3& to, float width = 1.5f);
    /// A dot with an optional label beside it.
    void draw_point(const Vec3& at, float radius = 3.5f, const std::string& label = {});
    /// A label near a point, where there is room for it.
    void draw_label(const Vec3& at, const std::string& label, LabelLayout& layout);

  private:
    const RenderView& view_;
    std::uint32_t color_;
};

}  // namespace limn
