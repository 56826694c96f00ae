#pragma once

namespace limn {

struct RenderView;
class World;

/// Whether there is anything to draw.
[[nodiscard]] bool has_paths(const World& world);

/// Draws the paths of a level with their knots, and the paths of its cameras with their keys,
/// numbered and timed as in the level's file.
void draw_path_overlay(const RenderView& view, const World& world);

}  // namespace limn
