#pragma once

#include "systems/update_world.h"

namespace limn {

// Game rules of single levels: racers, sailboats, walkers, stones. The engine does not depend on
// them.

/// Registers the components and actions of the game and of the engine.
void register_game_components();

/// For make_world_schedule and start_world.
void add_game_systems(SystemList& systems);

}  // namespace limn
