#pragma once

#include "ecs/entity.h"

#include <optional>
#include <span>

namespace limn {

class World;
struct HudStyle;

// M: the clips, morph targets and cameras of a single model. Initially open if it has any of them.

class ModelPanel {
  public:
    /// Whether the model has anything to choose; `cameras` are those of the scene.
    [[nodiscard]] static bool has_choices(const World& world, std::span<const Entity> cameras);

    void draw(const HudStyle& style, World& world, std::span<const Entity> cameras, Entity camera);
    /// The camera chosen since the last call: an index of `cameras`.
    [[nodiscard]] std::optional<std::size_t> take_camera();

    bool open = false;

  private:
    void draw_cameras(const World& world, std::span<const Entity> cameras, Entity camera);

    std::optional<std::size_t> chosen_;
};

}  // namespace limn
