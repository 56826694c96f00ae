#pragma once

#include "content/app/hud.h"
#include "content/app/player_camera.h"
#include "ecs/components/input.h"
#include "ecs/entity.h"

#include <string>
#include <vector>

namespace limn {

class World;

// The keys that the help (F1) lists: those of this level and of what is on screen, no others.

/// What the player is doing.
struct HelpState {
    CameraMode camera = CameraMode::Level;
    Entity level_camera;
    bool drives = false;     ///< the level's camera follows something that the keys drive
    bool model = false;      ///< a model by itself
    bool show = false;       ///< a technique with and without is loaded
    bool inspector = false;  ///< its panel is open
    bool panel = false;      ///< some panel is open
};

/// The group of actions that moves something else than the player's own camera; nullptr: none.
[[nodiscard]] const ActionGroup* driving_group(const World& world, Entity camera);

/// Headings and lines, in reading order.
[[nodiscard]] std::vector<KeyHelp> player_help(const World& world, const HelpState& state);

/// "drive: W S accelerate, brake; A D steer ..." of the actions of a group.
[[nodiscard]] std::string describe_group(const ActionGroup& group, const Bindings* bindings);

}  // namespace limn
